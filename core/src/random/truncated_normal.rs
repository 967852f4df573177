//! Draws from a standard normal distribution cut to an interval.
//!
//! One uniform number is turned into a draw by the inverse of the distribution function. So the
//! work is bounded however far out the interval lies. Beyond [`FAR_TAIL`] the inverse is taken in
//! log space.
//!
//! ```
//! use sinew_core::random::Stream;
//!
//! // Far out, where nearly no draw of a normal distribution falls, as fast as anywhere.
//! let mut stream = Stream::new(1, 0, 0);
//! let draws: Vec<f32> = (0..100).map(|_| stream.truncated_normal(20.0, 30.0)).collect();
//! assert!(draws.iter().all(|draw| (20.0..=30.0).contains(draw)));
//! assert!(draws.iter().sum::<f32>() / 100.0 < 20.2, "the tail falls steeply");
//! ```

use super::Stream;
use super::normal::{log_upper_tail, tail_beside_one, upper_quantile, upper_tail};
use crate::math::{clamp, exp, ln, max, min, sqrt};

/// Lower limit, standard deviations, from which the tail is inverted in log space. Chosen: well
/// below 12.9, beyond which the probability leaves the normal range of `f32`.
pub const FAR_TAIL: f32 = 9.0;

impl Stream {
    /// A standard normal draw given that it lies in `low..=high`.
    ///
    /// Infinite ends are allowed. An empty interval (`high <= low`) gives `low`; NaN ends count as
    /// no limit.
    pub fn truncated_normal(&mut self, low: f32, high: f32) -> f32 {
        let low = if low.is_nan() { f32::NEG_INFINITY } else { low };
        let high = if high.is_nan() { f32::INFINITY } else { high };
        let u = self.open_uniform();
        if !(high > low) {
            return low;
        }
        let drawn = if low >= 0.0 {
            upper_part(low, high, u)
        } else if high <= 0.0 {
            -upper_part(-high, -low, u)
        } else {
            straddling(low, high, u)
        };
        clamp(drawn, low, high)
    }
}

/// Draw from an interval around zero.
fn straddling(low: f32, high: f32, u: f32) -> f32 {
    let (below, above) = (tail_beside_one(-low), tail_beside_one(high));
    let lower = below + u * (1.0 - below - above);
    let upper = above + (1.0 - u) * (1.0 - below - above);
    if lower < upper {
        -upper_quantile(max(lower, f32::MIN_POSITIVE))
    } else {
        upper_quantile(max(upper, f32::MIN_POSITIVE))
    }
}

/// Draw from an interval with `low >= 0`.
fn upper_part(low: f32, high: f32, u: f32) -> f32 {
    if low < FAR_TAIL {
        let (near, far) = (upper_tail(low), upper_tail(high));
        return upper_quantile(clamp(near - u * (near - far), f32::MIN_POSITIVE, 0.5));
    }
    // ln of the tail probability relative to that at `low`: the tail falls from 1 to exp(-drop).
    let drop = if high.is_finite() { log_upper_tail(low) - log_upper_tail(high) } else { f32::INFINITY };
    let log_tail = ln(1.0 - u * (1.0 - exp(-min(drop, 80.0))));
    // tail(x) / tail(low) is about exp((low^2 - x^2) / 2) low / x. Two steps of the fixed point are
    // enough out here.
    let mut x = sqrt(low * low - 2.0 * log_tail);
    for _ in 0..2 {
        x = sqrt(low * low - 2.0 * (log_tail + ln(x / low)));
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Mean and variance by numeric integration, relative to the density at the interval's nearest
    /// point to zero.
    fn exact_moments(low: f64, high: f64) -> (f64, f64) {
        let nearest = if low > 0.0 {
            low
        } else if high < 0.0 {
            high
        } else {
            0.0
        };
        let (low, high) = (low.max(nearest - 12.0), high.min(nearest + 12.0));
        let steps = 200_000;
        let (mut mass, mut first, mut second) = (0.0, 0.0, 0.0);
        for i in 0..steps {
            let x = low + (high - low) * (f64::from(i) + 0.5) / f64::from(steps);
            let density = (0.5 * (nearest * nearest - x * x)).exp();
            mass += density;
            first += density * x;
            second += density * x * x;
        }
        let mean = first / mass;
        (mean, second / mass - mean * mean)
    }

    #[test]
    fn draws_have_the_moments_of_the_cut_normal() {
        let intervals = [
            (-1.0, 1.0),
            (0.5, 0.6),
            (-0.1, 4.0),
            (2.0, f32::INFINITY),
            (-3.0, -2.5),
            (8.9, 9.4),
            (9.5, 30.0),
            (-40.0, -15.0),
        ];
        for (case, (low, high)) in intervals.into_iter().enumerate() {
            let n = 100_000_u32;
            let mut stream = Stream::new(21, case as u64, 0);
            let (mut sum, mut square) = (0.0_f64, 0.0_f64);
            let (mean, variance) = exact_moments(f64::from(low), f64::from(high));
            for _ in 0..n {
                let z = f64::from(stream.truncated_normal(low, high)) - mean;
                sum += z;
                square += z * z;
            }
            let bias = sum / f64::from(n);
            let spread = square / f64::from(n);
            assert!(bias.abs() < 4.0 * (variance / f64::from(n)).sqrt() + 2.0e-6, "{low}..{high}: bias {bias:e}");
            assert!((spread / variance - 1.0).abs() < 0.04, "{low}..{high}: variance ratio {}", spread / variance);
        }
    }

    #[test]
    fn an_empty_interval_gives_its_lower_limit() {
        let mut stream = Stream::new(1, 0, 0);
        assert_eq!(stream.truncated_normal(2.0, 2.0), 2.0);
        assert_eq!(stream.truncated_normal(3.0, -3.0), 3.0);
    }

    proptest! {
        #[test]
        fn a_draw_keeps_its_limits(low in -60.0_f32..60.0, width in 1.0e-4_f32..80.0, seed in 0_u64..1000) {
            let high = low + width;
            let z = Stream::new(seed, 0, 0).truncated_normal(low, high);
            prop_assert!(z >= low && z <= high, "{} outside {}..{}", z, low, high);
        }
    }
}
