//! The standard normal distribution: quantile, tails and draws.
//!
//! A draw is the quantile of one uniform number, so its work is bounded and does not depend on
//! chance. The quantile is the rational approximation AS 241 (Wichura 1988), its form for single
//! precision.

use super::Stream;
use crate::math::{Vec3, erfc, exp, ln, sqrt};
use core::f32::consts::FRAC_1_SQRT_2;

/// ln sqrt(2 pi), of the normal density.
pub const LOG_SQRT_TAU: f32 = 0.918_938_5;

/// z > 0 with upper tail probability `tail` in (0, 0.5].
///
/// ```
/// use sinew_core::random::normal::{QUANTILE_MAX_TAIL_ERROR, upper_quantile, upper_tail};
///
/// let z = upper_quantile(0.025);
/// assert!((z - 1.959_964).abs() < 1e-3);
/// assert!((upper_tail(z) / 0.025 - 1.0).abs() < QUANTILE_MAX_TAIL_ERROR);
/// ```
#[must_use]
pub fn upper_quantile(tail: f32) -> f32 {
    let q = 0.5 - tail;
    if q <= NEAR_MIDDLE { quantile_near_middle(q) } else { quantile_in_tail(sqrt(-ln(tail))) }
}

/// Distance from the median, as a probability, up to which [`quantile_near_middle`] holds: AS 241
/// (Wichura 1988), `SPLIT1` of PPND7.
pub(super) const NEAR_MIDDLE: f32 = 0.425;

/// z with probability `q` in [0, 0.425] between it and the median.
pub(super) const fn quantile_near_middle(q: f32) -> f32 {
    let r = 0.180_625 - q * q;
    q * (((59.109_375 * r + 159.291_13) * r + 50.434_27) * r + 3.387_132_7)
        / (((67.187_56 * r + 78.757_76) * r + 17.895_17) * r + 1.0)
}

/// z whose upper tail has probability exp(-`depth`^2), for tails below 0.075.
pub(super) const fn quantile_in_tail(depth: f32) -> f32 {
    if depth <= 5.0 {
        let r = depth - 1.6;
        (((0.170_238_21 * r + 1.306_728_5) * r + 2.756_815_4) * r + 1.423_437_3)
            / ((0.120_211_33 * r + 0.737_001_64) * r + 1.0)
    } else {
        let r = depth - 5.0;
        (((0.017_337_204 * r + 0.428_682_94) * r + 3.081_226_4) * r + 6.657_905_1)
            / ((0.012_258_203 * r + 0.241_978_94) * r + 1.0)
    }
}

/// Probability that a standard normal exceeds `x`.
///
/// ```
/// use sinew_core::random::normal::upper_tail;
///
/// // One measurement in 741 is more than three standard deviations too great.
/// assert!((1.0 / upper_tail(3.0) - 741.0).abs() < 1.0);
/// ```
#[must_use]
pub fn upper_tail(x: f32) -> f32 {
    0.5 * erfc(x * FRAC_1_SQRT_2)
}

/// Standard deviations beyond which a tail does not change a probability near one. Derived: the
/// tail is 1e-9, below half a unit of the last place of `f32` at one, 3e-8.
const NEGLIGIBLE_TAIL_SIGMAS: f32 = 6.0;

/// As [`upper_tail`], but zero where the tail does not change a probability near one, so that
/// distant limits cost nothing.
#[must_use]
#[inline]
pub(super) fn tail_beside_one(x: f32) -> f32 {
    if x > NEGLIGIBLE_TAIL_SIGMAS { 0.0 } else { upper_tail(x) }
}

/// Natural logarithm of [`upper_tail`], without underflow: for large `x` by Laplace's continued
/// fraction.
///
/// ```
/// use sinew_core::random::normal::{log_upper_tail, upper_tail};
///
/// // Twenty standard deviations out the probability is zero in `f32`; its logarithm is not.
/// assert_eq!(upper_tail(20.0), 0.0);
/// assert!((log_upper_tail(20.0) + 203.917).abs() < 0.01);
/// ```
#[must_use]
pub fn log_upper_tail(x: f32) -> f32 {
    if x < 4.0 {
        return ln(upper_tail(x));
    }
    let mut denominator = x;
    for k in (1..=8_u8).rev() {
        denominator = x + f32::from(k) / denominator;
    }
    -0.5 * x * x - LOG_SQRT_TAU - ln(denominator)
}

/// ln of the standard normal density at `x`.
///
/// ```
/// use sinew_core::math::ln;
/// use sinew_core::random::normal::log_density;
///
/// // A measurement at 2.3 with mean 2 and standard deviation 0.1.
/// let std = 0.1;
/// let log_likelihood = log_density((2.3 - 2.0) / std) - ln(std);
/// assert!((log_likelihood + 3.116).abs() < 1e-3);
/// ```
#[inline]
#[must_use]
pub fn log_density(x: f32) -> f32 {
    -0.5 * x * x - LOG_SQRT_TAU
}

/// ln of the probability that a standard normal lies in `low..=high`; negative infinity where the
/// interval is empty.
///
/// ```
/// use sinew_core::math::exp;
/// use sinew_core::random::normal::log_interval_mass;
///
/// // Two thirds lie within one standard deviation.
/// assert!((exp(log_interval_mass(-1.0, 1.0)) - 0.6827).abs() < 1e-4);
/// // Finite for limits of a joint at thirty standard deviations from the mean.
/// assert!(log_interval_mass(30.0, 31.0).is_finite());
/// ```
#[must_use]
pub fn log_interval_mass(low: f32, high: f32) -> f32 {
    if !(high > low) {
        return f32::NEG_INFINITY;
    }
    let width = high - low;
    if width < 0.02 {
        return log_density(0.5 * (low + high)) + ln(width);
    }
    if low < 0.0 && high > 0.0 {
        let outside = tail_beside_one(high) + tail_beside_one(-low);
        return if outside > 0.0 { ln(1.0 - outside) } else { 0.0 };
    }
    let (near, far) = if low >= 0.0 { (low, high) } else { (-high, -low) };
    let near_log = log_upper_tail(near);
    near_log + ln(1.0 - exp(log_upper_tail(far) - near_log))
}

impl Stream {
    /// A draw from the standard normal distribution; within +-6.3.
    #[inline]
    pub fn normal(&mut self) -> f32 {
        let bits = self.bits();
        let tail = ((bits >> 1) as f32 + 0.5) * (0.5 / 2_147_483_648.0);
        let size = upper_quantile(if tail < 0.5 { tail } else { 0.5 });
        if bits & 1 == 0 { size } else { -size }
    }

    /// Three independent standard normal draws.
    #[inline]
    pub fn normal3(&mut self) -> Vec3 {
        Vec3::new(self.normal(), self.normal(), self.normal())
    }
}

/// Largest relative error of the tail of [`upper_quantile`]. Measured: asserted by a test.
pub const QUANTILE_MAX_TAIL_ERROR: f32 = 2.0e-4;

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f32, b: f32, relative: f32) -> bool {
        (a - b).abs() <= relative * a.abs().max(b.abs())
    }

    #[test]
    fn the_quantile_inverts_the_tail() {
        let mut tail = 0.4999_f32;
        while tail > 1.0e-30 {
            let back = upper_tail(upper_quantile(tail));
            // An error e in z is one of about z e in ln(tail).
            assert!(close(back, tail, QUANTILE_MAX_TAIL_ERROR), "{tail:e} came back as {back:e}");
            tail *= 0.83;
        }
    }

    #[test]
    fn the_tail_in_logarithms_continues_the_plain_one() {
        for i in 0..80_u8 {
            let x = f32::from(i) * 0.1;
            assert!(close(log_upper_tail(x), ln(upper_tail(x)), 2.0e-5), "at {x}");
        }
        assert!(close(log_upper_tail(40.0), -804.608_44, 1.0e-6));
    }

    #[test]
    fn interval_masses_add_up() {
        for (low, middle, high) in [(-8.0, -1.0, 8.0), (2.0, 2.5, 3.0), (-3.0, -2.9, 5.0), (9.0, 9.1, 12.0)] {
            let parts = exp(log_interval_mass(low, middle) - log_interval_mass(low, high))
                + exp(log_interval_mass(middle, high) - log_interval_mass(low, high));
            assert!((parts - 1.0).abs() < 1.0e-4, "{low} {middle} {high}: {parts}");
        }
        assert!((log_interval_mass(-9.0, 9.0)).abs() < 1.0e-6);
        assert_eq!(log_interval_mass(1.0, 1.0), f32::NEG_INFINITY);
    }

    #[test]
    fn draws_have_the_moments_and_tails_of_a_normal() {
        let n = 400_000_u32;
        let mut stream = Stream::new(11, 0, 0);
        let mut sums = [0.0_f64; 4];
        let mut beyond_two = 0_u32;
        for _ in 0..n {
            let z = f64::from(stream.normal());
            for (power, sum) in sums.iter_mut().enumerate() {
                *sum += z.powi(power as i32 + 1);
            }
            beyond_two += u32::from(z.abs() > 2.0);
        }
        let moment = sums.map(|s| s / f64::from(n));
        let root_n = f64::from(n).sqrt();
        assert!(moment[0].abs() < 4.0 / root_n, "mean {}", moment[0]);
        assert!((moment[1] - 1.0).abs() < 4.0 * 2.0_f64.sqrt() / root_n, "variance {}", moment[1]);
        assert!(moment[2].abs() < 4.0 * 15.0_f64.sqrt() / root_n, "third moment {}", moment[2]);
        assert!((moment[3] - 3.0).abs() < 4.0 * 96.0_f64.sqrt() / root_n, "fourth moment {}", moment[3]);
        let share = f64::from(beyond_two) / f64::from(n);
        assert!((share - 0.0455).abs() < 4.0 * (0.0455_f64).sqrt() / root_n, "beyond two: {share}");
    }
}
