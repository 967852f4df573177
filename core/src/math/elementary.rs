//! Roots, exponentials, logarithms, angles' functions, and comparisons.

use core::f32::consts::{FRAC_2_PI, PI, TAU};

/// Largest absolute error of [`sin_cos`] (asserted by a test against `f64`).
pub const SIN_COS_MAX_ERROR: f32 = 1.2e-7;
/// Largest argument for which [`SIN_COS_MAX_ERROR`] holds (asserted by the same test).
pub const SIN_COS_MAX_ARGUMENT_RAD: f32 = 1.0e4;

/// Square root; NaN below zero.
///
/// ```
/// use core::f32::consts::SQRT_2;
/// use sinew_core::math::sqrt;
///
/// assert_eq!(sqrt(2.0), SQRT_2, "rounded correctly, to the last bit");
/// assert!(sqrt(-1.0).is_nan());
/// ```
#[inline]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    #[cfg(not(all(target_arch = "arm", target_abi = "eabihf")))]
    return libm::sqrtf(x);
    #[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
    sqrt_by_instruction(x)
}

/// The floating-point unit's own square root.
///
/// Both are rounded correctly, so the bits are those of `libm`, which takes 50 instructions.
#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
#[inline]
#[expect(unsafe_code, reason = "stable Rust has no other way to the instruction without `std`")]
fn sqrt_by_instruction(x: f32) -> f32 {
    let mut bits = x.to_bits();
    // SAFETY: every processor of this calling convention has the instruction. Its register is put
    // back as it was, since Rust cannot name it where the unit has single precision only.
    unsafe {
        core::arch::asm!(
            "vmov {kept}, s0",
            "vmov s0, {bits}",
            "vsqrt.f32 s0, s0",
            "vmov {bits}, s0",
            "vmov s0, {kept}",
            bits = inout(reg) bits,
            kept = out(reg) _,
            options(pure, nomem, nostack, preserves_flags),
        );
    }
    f32::from_bits(bits)
}

/// Relative error of [`sqrt_branch_free`] (asserted by a test).
pub const SQRT_BRANCH_FREE_MAX_ERROR: f32 = 3.0e-7;

/// Square root without a branch or a processor's instruction, for loops over vectors.
///
/// Newton's method for 1/sqrt(x) from the exponent halved. Zero for zero; undefined below zero and
/// below 10^-36.
///
/// ```
/// use sinew_core::math::{SQRT_BRANCH_FREE_MAX_ERROR, sqrt_branch_free};
///
/// // Distances of a block of points at once.
/// let roots = [0.0, 1.0, 2.25, 1.0e6].map(sqrt_branch_free);
/// for (root, exact) in roots.into_iter().zip([0.0, 1.0, 1.5, 1000.0_f32]) {
///     assert!((root - exact).abs() <= SQRT_BRANCH_FREE_MAX_ERROR * exact);
/// }
/// ```
#[inline(always)]
#[must_use]
pub fn sqrt_branch_free(x: f32) -> f32 {
    let mut inverse = f32::from_bits(0x5F37_5A86_u32.wrapping_sub(x.to_bits() >> 1));
    let half = 0.5 * x;
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    x * inverse
}

/// e to the power of `x`.
///
/// ```
/// use core::f32::consts::LN_2;
/// use sinew_core::math::exp;
///
/// // A log-weight that is ln 2 greater is twice the weight.
/// assert!((exp(-3.0 + LN_2) / exp(-3.0) - 2.0).abs() < 1e-6);
/// ```
#[inline]
#[must_use]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Natural logarithm.
///
/// ```
/// use sinew_core::math::ln;
///
/// // Two small likelihoods: their product is lost in `f32`, the sum of their logarithms is not.
/// assert_eq!(1.0e-30_f32 * 1.0e-30, 0.0);
/// assert!((ln(1.0e-30) + ln(1.0e-30) + 138.155).abs() < 1e-3);
/// ```
#[inline]
#[must_use]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Angle of the vector (x, y) in (-pi, pi].
///
/// ```
/// use core::f32::consts::{FRAC_PI_2, PI};
/// use sinew_core::math::atan2;
///
/// // With y downwards, as in an image: a limb that hangs, and one that points to the left.
/// assert_eq!(atan2(1.0, 0.0), FRAC_PI_2);
/// assert_eq!(atan2(0.0, -1.0), PI);
/// ```
#[inline]
#[must_use]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Arc cosine; arguments beyond +-1 are clamped, so rounding never gives NaN.
///
/// ```
/// use sinew_core::math::acos;
///
/// assert!((acos(0.5).to_degrees() - 60.0).abs() < 1e-4);
/// // The scalar product of a unit vector with itself may be a little above one.
/// assert_eq!(acos(1.000_000_1), 0.0);
/// ```
#[inline]
#[must_use]
pub fn acos(x: f32) -> f32 {
    libm::acosf(clamp(x, -1.0, 1.0))
}

/// Arc sine; arguments beyond +-1 are clamped, so rounding never gives NaN.
///
/// By the arc tangent, since libm's arc sine takes a root in f64, which a core with
/// single-precision hardware has to emulate.
///
/// ```
/// use sinew_core::math::asin;
///
/// assert!((asin(0.5).to_degrees() - 30.0).abs() < 1e-4);
/// assert_eq!(asin(1.000_000_1), core::f32::consts::FRAC_PI_2);
/// ```
#[inline]
#[must_use]
pub fn asin(x: f32) -> f32 {
    let x = clamp(x, -1.0, 1.0);
    atan2(x, sqrt((1.0 - x) * (1.0 + x)))
}

/// Complementary error function.
///
/// ```
/// use core::f32::consts::FRAC_1_SQRT_2;
/// use sinew_core::math::erfc;
///
/// // 5 % of a normal distribution lie further than 1.96 standard deviations from its mean.
/// assert!((erfc(1.96 * FRAC_1_SQRT_2) - 0.05).abs() < 1e-4);
/// ```
#[inline]
#[must_use]
pub fn erfc(x: f32) -> f32 {
    libm::erfcf(x)
}

/// Largest whole number not above `x`.
///
/// ```
/// use sinew_core::math::floor;
///
/// assert_eq!([floor(1.75), floor(-0.25), floor(-3.0)], [1.0, -1.0, -3.0]);
/// ```
#[inline]
#[must_use]
pub fn floor(x: f32) -> f32 {
    if x > -ROUND_SMALL_LIMIT && x < ROUND_SMALL_LIMIT {
        let nearest = round_small(x);
        if nearest > x { nearest - 1.0 } else { nearest }
    } else {
        libm::floorf(x)
    }
}

/// Nearest whole number, halves away from zero.
///
/// ```
/// use sinew_core::math::round;
///
/// assert_eq!([round(2.4), round(2.5), round(-2.5)], [2.0, 3.0, -3.0]);
/// ```
#[inline]
#[must_use]
pub fn round(x: f32) -> f32 {
    libm::roundf(x)
}

/// Size of an argument below which [`round_small`] gives whole numbers: 2^22.
pub const ROUND_SMALL_LIMIT: f32 = 4_194_304.0;

/// Nearest whole number, halves to the even one, for arguments below [`ROUND_SMALL_LIMIT`] in size.
///
/// Two additions without a branch, so that loops over arrays are vectorised.
///
/// ```
/// use sinew_core::math::{ROUND_SMALL_LIMIT, round_small};
///
/// assert_eq!([2.4, 2.5, 3.5, -0.7].map(round_small), [2.0, 2.0, 4.0, -1.0]);
/// assert_eq!(round_small(ROUND_SMALL_LIMIT - 1.0), ROUND_SMALL_LIMIT - 1.0);
/// ```
#[inline]
#[must_use]
pub fn round_small(x: f32) -> f32 {
    /// 1.5 x 2^23: adding and subtracting it rounds to whole numbers.
    const SHIFT: f32 = 12_582_912.0;
    (x + SHIFT) - SHIFT
}

/// `angle_rad` moved by whole turns to within rounding of [-pi, pi], where either end will do.
/// Without a branch.
///
/// ```
/// use core::f32::consts::TAU;
/// use sinew_core::math::least_angle;
///
/// // How far the angles of many particles are off a measured one, in a loop that becomes vector
/// // instructions.
/// let off_rad = [6.2, 0.1, -3.0].map(|angle_rad| least_angle(angle_rad - 0.05));
/// assert!((off_rad[0] - (6.15 - TAU)).abs() < 1e-5, "the short way");
/// assert!((off_rad[1] - 0.05).abs() < 1e-5 && (off_rad[2] + 3.05).abs() < 1e-5);
/// ```
#[inline]
#[must_use]
pub fn least_angle(angle_rad: f32) -> f32 {
    angle_rad - TAU * round_small(angle_rad * (1.0 / TAU))
}

/// As [`wrap_angle`], without a branch or a call: for loops over many angles of few turns.
///
/// ```
/// use core::f32::consts::PI;
/// use sinew_core::math::wrap_angle_small;
///
/// assert!((wrap_angle_small(1.5 * PI) + 0.5 * PI).abs() < 1e-6);
/// assert_eq!(wrap_angle_small(-PI), PI, "the lower end does not belong to it");
/// ```
#[inline]
#[must_use]
pub fn wrap_angle_small(angle_rad: f32) -> f32 {
    let wrapped = least_angle(angle_rad);
    let above = if wrapped > PI { PI } else { wrapped };
    if above <= -PI { PI } else { above }
}

/// e to the power of `x` in [-80, 0], relative error below [`EXP_SMALL_MAX_ERROR`], exactly 1 at 0.
/// Without a branch or a call: for loops over many numbers. Outside of the interval the result is
/// undefined.
///
/// ```
/// use sinew_core::math::{EXP_SMALL_MAX_ERROR, exp, exp_small};
///
/// // Log-weights relative to the greatest are never above zero.
/// let weights = [0.0, -1.0, -20.0].map(exp_small);
/// assert_eq!(weights[0], 1.0);
/// assert!((weights[2] / exp(-20.0) - 1.0).abs() < 2.0 * EXP_SMALL_MAX_ERROR);
/// ```
#[inline]
#[must_use]
pub fn exp_small(x: f32) -> f32 {
    /// 1.5 x 2^23: adding and subtracting it rounds to whole numbers.
    const SHIFT: f32 = 12_582_912.0;
    /// ln 2 in two parts (Cody and Waite), the first exact in products with small whole numbers.
    const LN_2_HIGH: f32 = 0.693_359_375;
    /// The rest of ln 2 (Cody and Waite).
    const LN_2_LOW: f32 = -2.121_944_4e-4;
    let shifted = x * core::f32::consts::LOG2_E + SHIFT;
    let whole = shifted - SHIFT;
    let r = (x - whole * LN_2_HIGH) - whole * LN_2_LOW;
    let power = 1.0
        + r * (1.0
            + r * (0.5 + r * (1.666_666_7e-1 + r * (4.166_666_7e-2 + r * (8.333_333_3e-3 + r * 1.388_888_9e-3)))));
    let exponent = shifted.to_bits().wrapping_sub(SHIFT.to_bits()).wrapping_add(127);
    power * f32::from_bits(exponent << 23)
}

/// Largest relative error of [`exp_small`] (asserted by a test against `f64`).
pub const EXP_SMALL_MAX_ERROR: f32 = 3.0e-7;

/// Absolute value.
///
/// ```
/// use sinew_core::math::abs;
///
/// let (expected_px, seen_px) = (120.0, 123.5);
/// assert_eq!(abs(expected_px - seen_px), 3.5);
/// ```
#[inline]
#[must_use]
pub fn abs(x: f32) -> f32 {
    x.abs()
}

/// Smaller of two numbers; `b` where they compare equal or either is NaN.
///
/// ```
/// use sinew_core::math::min;
///
/// assert_eq!(min(0.2, 0.3), 0.2);
/// // Bit for bit the same on every target, zeros and NaN included.
/// assert_eq!(min(0.0, -0.0).to_bits(), (-0.0_f32).to_bits());
/// assert_eq!(min(f32::NAN, 0.3), 0.3);
/// ```
#[inline]
#[must_use]
pub fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Greater of two numbers; `b` where they compare equal or either is NaN.
///
/// ```
/// use sinew_core::math::max;
///
/// // A variance that rounding took below zero.
/// assert_eq!(max(-1.0e-9, 0.0), 0.0);
/// assert_eq!(max(f32::NAN, 0.0), 0.0, "what is no number gives the second");
/// ```
#[inline]
#[must_use]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `x` moved into `low..=high`; `low` wins where the interval is inverted.
///
/// ```
/// use sinew_core::math::clamp;
///
/// // An elbow bends from 0 to 150 degrees.
/// assert_eq!([-4.0, 90.0, 170.0].map(|bent| clamp(bent, 0.0, 150.0)), [0.0, 90.0, 150.0]);
/// assert_eq!(clamp(0.5, 1.0, 0.0), 1.0, "limits the wrong way round do not panic");
/// ```
#[inline]
#[must_use]
pub fn clamp(x: f32, low: f32, high: f32) -> f32 {
    max(min(x, high), low)
}

/// Sine and cosine of `x_rad`.
///
/// Reduction by multiples of pi/2 (Cody and Waite, three parts), then Taylor polynomials of degree
/// 9 and 10 on [-pi/4, pi/4]. NaN for NaN and infinity. Beyond [`SIN_COS_MAX_ARGUMENT_RAD`] the
/// error grows with the argument.
///
/// ```
/// use sinew_core::math::{SIN_COS_MAX_ERROR, sin_cos};
///
/// let (sine, cosine) = sin_cos(30.0_f32.to_radians());
/// assert!((sine - 0.5).abs() <= 2.0 * SIN_COS_MAX_ERROR);
/// assert!((cosine * cosine - 0.75).abs() <= 4.0 * SIN_COS_MAX_ERROR);
/// ```
#[cfg_attr(target_arch = "arm", inline(never))]
#[cfg_attr(not(target_arch = "arm"), inline)]
#[must_use]
pub fn sin_cos(x_rad: f32) -> (f32, f32) {
    if !x_rad.is_finite() {
        return (f32::NAN, f32::NAN);
    }
    sin_cos_finite(x_rad)
}

/// [`sin_cos`] of each of several angles, to the same bits: all sines and all cosines. Processors
/// compute several at a time.
///
/// ```
/// use sinew_core::math::{sin_cos, sin_cos_each};
///
/// let (sines, cosines) = sin_cos_each(&[0.0, 0.5, -2.0]);
/// assert_eq!((sines[2], cosines[2]), sin_cos(-2.0));
/// ```
#[inline]
#[must_use]
pub fn sin_cos_each<const N: usize>(x_rad: &[f32; N]) -> ([f32; N], [f32; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    sin_cos_into(x_rad, &mut sines, &mut cosines);
    (sines, cosines)
}

/// One loop for any number of angles: were its length known, a short one would be unrolled and its
/// vectors lost.
#[inline(never)]
fn sin_cos_into(x_rad: &[f32], sines: &mut [f32], cosines: &mut [f32]) {
    for ((&x_rad, sine_out), cosine_out) in x_rad.iter().zip(sines).zip(cosines) {
        // A processor without vectors of numbers would only have a longer loop to keep.
        let (sine, cosine) = if cfg!(target_arch = "arm") { sin_cos(x_rad) } else { sin_cos_finite(x_rad) };
        let is_finite = x_rad.is_finite();
        *sine_out = if is_finite { sine } else { f32::NAN };
        *cosine_out = if is_finite { cosine } else { f32::NAN };
    }
}

/// Without a branch, so that a loop over angles is a loop over vectors.
#[inline(always)]
fn sin_cos_finite(x_rad: f32) -> (f32, f32) {
    /// pi / 2 in three parts (Cody and Waite), the first exact in products with whole numbers.
    const PI_HALF_HIGH: f32 = 1.570_312_5;
    /// The second part (Cody and Waite).
    const PI_HALF_MIDDLE: f32 = 4.837_512_97e-4;
    /// The third part (Cody and Waite).
    const PI_HALF_LOW: f32 = 7.549_789_95e-8;
    let scaled = x_rad * FRAC_2_PI;
    let quarter_turns = (scaled + if scaled < 0.0 { -0.5 } else { 0.5 }) as i32;
    let whole = quarter_turns as f32;
    let r = ((x_rad - whole * PI_HALF_HIGH) - whole * PI_HALF_MIDDLE) - whole * PI_HALF_LOW;
    let r2 = r * r;
    let sine = r + r * r2 * (-1.666_666_7e-1 + r2 * (8.333_333_3e-3 + r2 * (-1.984_127e-4 + r2 * 2.755_731_9e-6)));
    let cosine = 1.0
        + r2 * (-0.5 + r2 * (4.166_666_7e-2 + r2 * (-1.388_888_9e-3 + r2 * (2.480_158_7e-5 - r2 * 2.755_731_9e-7))));
    // Each quarter of a turn changes places and signs.
    let (a, b) = if quarter_turns & 1 == 0 { (sine, cosine) } else { (cosine, sine) };
    let sign_if = |bit: i32| ((bit & 2) as u32) << 30;
    (
        f32::from_bits(a.to_bits() ^ sign_if(quarter_turns)),
        f32::from_bits(b.to_bits() ^ sign_if(quarter_turns.wrapping_add(1))),
    )
}

/// `angle_rad` moved by whole turns into (-pi, pi].
///
/// ```
/// use core::f32::consts::PI;
/// use sinew_core::math::wrap_angle;
///
/// assert!((wrap_angle(7.0 * PI / 3.0) - PI / 3.0).abs() < 1e-6);
/// assert_eq!(wrap_angle(-PI), PI, "of the two names of a half turn one is used");
/// ```
#[inline]
#[must_use]
pub fn wrap_angle(angle_rad: f32) -> f32 {
    if angle_rad > -PI && angle_rad <= PI {
        return angle_rad;
    }
    let wrapped = angle_rad - TAU * floor((angle_rad + PI) / TAU);
    if wrapped <= -PI { PI } else { min(wrapped, PI) }
}

/// `angle_rad` of an undirected line moved by half turns into [0, pi).
///
/// ```
/// use sinew_core::math::wrap_orientation;
///
/// // A line has no front end: at -30 degrees it is the one at 150.
/// let orientation_rad = wrap_orientation(-30.0_f32.to_radians());
/// assert!((orientation_rad.to_degrees() - 150.0).abs() < 1e-4);
/// ```
#[inline]
#[must_use]
pub fn wrap_orientation(angle_rad: f32) -> f32 {
    let wrapped = angle_rad - PI * floor(angle_rad / PI);
    if (0.0..PI).contains(&wrapped) { wrapped } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_branch_free_root_is_the_root() {
        assert_eq!(sqrt_branch_free(0.0), 0.0);
        for i in -1000..1000 {
            let x = f64::from(i) * 0.02;
            let x = x.exp() as f32;
            let error = (f64::from(sqrt_branch_free(x)) / f64::from(x).sqrt() - 1.0).abs();
            assert!(error < f64::from(SQRT_BRANCH_FREE_MAX_ERROR), "{x}: {error:e}");
        }
    }

    #[test]
    fn the_branch_free_exponential_is_the_exponential() {
        let mut worst = 0.0_f64;
        for i in 0..=80_000_u32 {
            let x = -(i as f32) * 1.0e-3;
            let exact = f64::from(x).exp();
            worst = worst.max(((f64::from(exp_small(x)) - exact) / exact).abs());
        }
        assert!(worst < f64::from(EXP_SMALL_MAX_ERROR) && worst > 0.2 * f64::from(EXP_SMALL_MAX_ERROR), "{worst:e}");
        assert_eq!(exp_small(0.0), 1.0);
    }

    #[test]
    fn the_arc_sine_is_the_arc_sine() {
        for i in -100_000..=100_000_i32 {
            let x = i as f32 * 1.0e-5;
            let exact = f64::from(x).asin();
            let error = (f64::from(asin(x)) - exact).abs();
            assert!(error <= 2.0e-7 * exact.abs().max(1.0e-3), "{x}: {error:e}");
        }
        assert_eq!(asin(1.5), core::f32::consts::FRAC_PI_2);
        assert_eq!(asin(-1.5), -core::f32::consts::FRAC_PI_2);
    }

    #[test]
    fn the_short_floor_is_the_floor() {
        for i in -40_000..=40_000_i32 {
            for x in [i as f32 * 0.25, i as f32 * 104.857_6, i as f32 * 1.0e-7, i as f32 * 1.0e6] {
                assert_eq!(floor(x), x.floor(), "{x}");
            }
        }
        assert!(floor(f32::NAN).is_nan());
        assert_eq!(floor(f32::NEG_INFINITY), f32::NEG_INFINITY);
    }

    #[test]
    fn the_branch_free_wrap_is_the_wrap() {
        for i in -4000..=4000_i32 {
            let angle = i as f32 * 0.01;
            let wrapped = wrap_angle_small(angle);
            assert!(wrapped > -PI && wrapped <= PI);
            let off = wrap_angle(wrapped - wrap_angle(angle)).abs();
            assert!(off < 1.0e-5, "{angle}: {wrapped}");
            assert!((least_angle(angle).abs() - wrapped.abs()).abs() < 1.0e-5, "{angle}");
        }
        assert_eq!(wrap_angle_small(-PI), PI);
        assert_eq!(wrap_angle_small(PI), PI);
        assert_eq!(wrap_angle_small(0.3), 0.3, "no turn, no change");
    }

    #[test]
    fn sine_and_cosine_stay_within_the_stated_error() {
        let mut worst = 0.0_f64;
        for i in -400_000..=400_000_i32 {
            let x = i as f32 * (SIN_COS_MAX_ARGUMENT_RAD / 400_000.0);
            let (s, c) = sin_cos(x);
            let exact = f64::from(x);
            worst = worst.max((f64::from(s) - libm::sin(exact)).abs());
            worst = worst.max((f64::from(c) - libm::cos(exact)).abs());
        }
        assert!(worst <= f64::from(SIN_COS_MAX_ERROR), "worst error {worst:e}");
        assert!(worst >= 1.0e-8, "an error of {worst:e} is too good to be true");
    }

    #[test]
    fn sine_of_infinity_is_nan() {
        assert!(sin_cos(f32::INFINITY).0.is_nan());
        assert!(sin_cos(f32::NAN).1.is_nan());
        let (sines, cosines) = sin_cos_each(&[1.0, f32::INFINITY, f32::NAN, 2.0]);
        assert_eq!(sines.map(f32::is_nan), [false, true, true, false]);
        assert_eq!(cosines.map(f32::is_nan), [false, true, true, false]);
    }

    #[test]
    fn each_sine_and_cosine_is_that_of_its_angle_alone() {
        for i in -40_000..=40_000_i32 {
            let x_rad: [f32; 5] = core::array::from_fn(|k| i as f32 * [1.0e-3, 0.25 * PI, 1.0e-7, 0.1, 1.0e6][k]);
            let (sines, cosines) = sin_cos_each(&x_rad);
            for k in 0..5 {
                let (sine, cosine) = sin_cos(x_rad[k]);
                assert_eq!(
                    [sines[k].to_bits(), cosines[k].to_bits()],
                    [sine.to_bits(), cosine.to_bits()],
                    "{}",
                    x_rad[k]
                );
            }
        }
    }

    #[test]
    fn wrapping_keeps_the_half_open_interval() {
        assert_eq!(wrap_angle(PI), PI);
        assert_eq!(wrap_angle(-PI), PI);
        assert!(wrap_angle(3.0 * PI) > PI - 1.0e-5);
        assert_eq!(wrap_orientation(PI), 0.0);
        assert_eq!(wrap_orientation(-1.0e-9), 0.0);
    }
}
