//! Share of the measured variance that a motion's mean cycle explains.
//!
//! Each angle is compared with the mean cycle at the position of the motion's filter. A constant
//! difference is the person's, so the variance of the difference counts, not its size. Variances
//! are circular, since angles wind: -2 ln of the mean unit vector's length (Mardia and Jupp,
//! *Directional Statistics*, section 2.3).

use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::{clamp, exp, ln, max, min, sin_cos, sqrt};
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::PI;

/// Largest circular variance, rad^2: that of a uniform angle.
const MAX_VARIANCE_RAD2: f32 = PI * PI / 3.0;
/// Share of the cycle's own variance that always counts as unexplained.
///
/// Chosen: a tenth, so that a person who hardly moves does not count as explained.
const REST_SHARE: f32 = 0.1;
/// Standard errors of the measurement noise that are added to the unexplained share. Chosen: half
/// of one, so that noise does not count as a motion.
pub(super) const STANDARD_ERRORS: f32 = 0.5;
/// Smallest squared length of a mean unit vector. Chosen: far below exp(-[`MAX_VARIANCE_RAD2`]).
const MIN_LENGTH2: f32 = 1.0e-6;
/// Largest variance of a measurement, rad^2. Chosen: exp(-13) is near [`MIN_LENGTH2`].
const MAX_NOISE_RAD2: f32 = 13.0;
/// Greatest weight: adding 1 to it gives the same `f32`.
const MAX_WEIGHT: f32 = 16_777_216.0;

/// Exponentially weighted sums of one angle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SwingSums {
    weight: f32,
    /// Unit vectors (cosine, sine) of the measured angle, of the mean cycle's, and of their
    /// difference.
    seen: [f32; 2],
    expected: [f32; 2],
    residual: [f32; 2],
}

impl SwingSums {
    const fn nothing() -> Self {
        Self { weight: 0.0, seen: [0.0; 2], expected: [0.0; 2], residual: [0.0; 2] }
    }

    #[inline(always)]
    fn fade(&mut self, keep: f32) {
        self.weight *= keep;
        self.seen.iter_mut().chain(&mut self.expected).chain(&mut self.residual).for_each(|sum| *sum *= keep);
    }

    #[inline(always)]
    fn add(&mut self, seen_rad: f32, expected_rad: f32) {
        let ((seen_sin, seen_cos), (expected_sin, expected_cos)) = (sin_cos(seen_rad), sin_cos(expected_rad));
        self.weight += 1.0;
        for (sum, unit) in [
            (&mut self.seen, [seen_cos, seen_sin]),
            (&mut self.expected, [expected_cos, expected_sin]),
            (
                &mut self.residual,
                [seen_cos * expected_cos + seen_sin * expected_sin, seen_sin * expected_cos - seen_cos * expected_sin],
            ),
        ] {
            sum[0] += unit[0];
            sum[1] += unit[1];
        }
    }

    /// Sum of squared weights over the squared sum, where weights fall by `keep` a frame: 1 for one
    /// frame, less for more.
    fn squared_weight_share(&self, keep: f32) -> f32 {
        let filled = min(self.weight * (1.0 - keep), 1.0);
        min((2.0 - filled) / max(self.weight * (1.0 + keep), 1.0e-6), 1.0)
    }

    /// Circular variance, rad^2, of an angle by the `sum` of its unit vectors.
    ///
    /// The bias of few frames is removed by `share` ([`Self::squared_weight_share`]), the noise by
    /// `noise_length2`.
    #[inline(never)]
    fn variance_rad2(&self, sum: &[f32; 2], share: f32, noise_length2: f32) -> f32 {
        if share > 0.999 {
            return MAX_VARIANCE_RAD2;
        }
        let length2 = (sum[0] * sum[0] + sum[1] * sum[1]) / (self.weight * self.weight);
        let unbiased = (length2 - share) / (1.0 - share);
        min(-ln(clamp(unbiased / noise_length2, MIN_LENGTH2, 1.0)), MAX_VARIANCE_RAD2)
    }

    /// Unexplained share of the variance and its standard error; `cycle_rad2` is the variance over
    /// the motion's whole cycle.
    fn unexplained(&self, cycle_rad2: f32, std_rad: f32, keep: f32) -> (f32, f32) {
        let (share, noise_length2) = (self.squared_weight_share(keep), noise_length2(std_rad));
        let expected = self.variance_rad2(&self.expected, share, 1.0);
        let seen = self.variance_rad2(&self.seen, share, noise_length2);
        let residual = self.variance_rad2(&self.residual, share, noise_length2);
        let swing = max(max(expected, seen), MIN_LENGTH2);
        let noise = sqrt(share * (1.0 / noise_length2 - 1.0));
        (min((residual + REST_SHARE * cycle_rad2) / swing, 1.0), min(noise / swing, 1.0))
    }
}

/// Squared length of the mean unit vector of normal noise: exp(-variance).
fn noise_length2(std_rad: f32) -> f32 {
    exp(-min(std_rad * std_rad, MAX_NOISE_RAD2))
}

/// Circular variance of each angle over the mean cycle at `positions` points, rad^2; 0 beyond the
/// model's angles.
///
/// It weights the angles: one that hardly moves in the cycle, like a short link, has little
/// evidence.
pub(in crate::cyclic) fn cycle_variances_rad2<const N: usize>(model: &CoupledModel<'_>, positions: u8) -> [f32; N] {
    let mut cycle = [SwingSums::nothing(); N];
    for position in 0..positions {
        let pose = model.mean_pose_rad::<N>(model.point(f32::from(position) / f32::from(positions)));
        cycle.iter_mut().zip(&pose).take(model.angle_count()).for_each(|(sums, &angle)| sums.add(angle, angle));
    }
    let mut variances_rad2 = [0.0; N];
    for (variance_rad2, sums) in variances_rad2.iter_mut().zip(&cycle).take(model.angle_count()) {
        *variance_rad2 = sums.variance_rad2(&sums.expected, 0.0, 1.0);
    }
    variances_rad2
}

/// Explained variance of up to `N` angles over about one cycle of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::cyclic) struct ExplainedVariance<const N: usize> {
    angles: [SwingSums; N],
    /// Decay of all weights in the last frame.
    keep: f32,
}

impl<const N: usize> SavedState for ExplainedVariance<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for sums in &mut self.angles {
            visitor.real(&mut sums.weight, &(0.0..=MAX_WEIGHT));
            for sum in [&mut sums.seen, &mut sums.expected, &mut sums.residual] {
                visitor.reals(sum, &(-MAX_WEIGHT..=MAX_WEIGHT));
            }
        }
        visitor.real(&mut self.keep, &(0.0..=1.0));
    }
}

impl<const N: usize> ExplainedVariance<N> {
    /// Without measurements.
    pub(in crate::cyclic) const fn new() -> Self {
        Self { angles: [SwingSums::nothing(); N], keep: 0.0 }
    }

    /// Adds a measurement with the mean cycle's pose `expected_rad`. Earlier frames decay by
    /// exp(-`cycles`).
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(in crate::cyclic) fn add(&mut self, cycles: f32, measurement: &AngleMeasurement<N>, expected_rad: &[f32; N]) {
        self.keep = exp(-cycles);
        for ((sums, seen_rad), expected_rad) in self.angles.iter_mut().zip(measurement.angles_rad()).zip(expected_rad) {
            sums.fade(self.keep);
            if let Some(seen_rad) = *seen_rad {
                sums.add(seen_rad, *expected_rad);
            }
        }
    }

    /// Unexplained share of the variance plus half a standard error, in [0, 1.5]; `None` without
    /// measurements.
    ///
    /// `cycle_rad2` holds the variances over the whole cycle, `std_rad` the measurements' standard
    /// deviations.
    pub(in crate::cyclic) fn unexplained_share(&self, cycle_rad2: &[f32; N], std_rad: &[f32; N]) -> Option<f32> {
        let (mut sum, mut noise2, mut weights) = (0.0, 0.0, 0.0);
        for ((sums, &cycle_rad2), &std_rad) in self.angles.iter().zip(cycle_rad2).zip(std_rad) {
            let weight = sums.weight * cycle_rad2;
            if weight > 0.0 {
                let (unexplained, noise) = sums.unexplained(cycle_rad2, std_rad, self.keep);
                sum += weight * unexplained;
                noise2 += weight * noise * (weight * noise);
                weights += weight;
            }
        }
        (weights > 0.0).then(|| (sum + STANDARD_ERRORS * sqrt(noise2)) / weights)
    }

    /// Confidence in the share: 1 - 1 / weight, from 0 at one frame to nearly 1.
    pub(in crate::cyclic) fn confidence(&self) -> f32 {
        1.0 - 1.0 / max(self.weight(), 1.0)
    }

    /// Sum of the weights of the most often measured angle.
    fn weight(&self) -> f32 {
        self.angles.iter().map(|sums| sums.weight).fold(0.0, max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic::{mean_angle, table};
    use crate::math::wrap_angle;
    use crate::random::Stream;
    use core::f32::consts::TAU;
    use proptest::prelude::*;

    /// Unexplained share after `frames` of `angle(index, cycle position, frame)` with noise of
    /// `std_rad`, by the synthetic motion at its true position.
    fn unexplained_share(frames: u16, std_rad: f32, angle: impl Fn(usize, f32, f32) -> f32) -> f32 {
        let table = table(4.0e-3, 9);
        let model = table.model().unwrap();
        let cycle_rad2 = cycle_variances_rad2(&model, 100);
        let mut swing = ExplainedVariance::<13>::new();
        let mut stream = Stream::new(11, 0, 0);
        assert_eq!(swing.unexplained_share(&cycle_rad2, &[std_rad; 13]), None);
        for frame in 0..frames {
            let position = f32::from(frame) / 65.0;
            let seen = core::array::from_fn(|i| Some(angle(i, position, f32::from(frame)) + std_rad * stream.normal()));
            let seen = AngleMeasurement::new(&seen, std_rad).unwrap();
            swing.add(1.0 / 65.0, &seen, &model.mean_pose_rad(model.point(position)));
        }
        swing.unexplained_share(&cycle_rad2, &[std_rad; 13]).unwrap()
    }

    #[test]
    fn the_motion_itself_leaves_a_tenth_unexplained_with_any_offset() {
        for std_rad in [0.01, 0.1, 0.5] {
            let same = unexplained_share(300, std_rad, |i, position, _| mean_angle(i, position));
            let with_offsets =
                unexplained_share(300, std_rad, |i, position, _| mean_angle(i, position) + 0.2 * i as f32);
            assert!((0.08..0.3).contains(&same), "{std_rad}: {same}");
            assert!((same - with_offsets).abs() < 0.05, "{std_rad}: {same}, {with_offsets}");
        }
    }

    #[test]
    fn standing_or_another_motion_is_nearly_all_unexplained() {
        for std_rad in [0.01, 0.1, 0.5] {
            let standing = unexplained_share(300, std_rad, |i, _, _| mean_angle(i, 0.0));
            let slower = unexplained_share(300, std_rad, |i, position, _| mean_angle(i, 0.37 * position));
            let random = unexplained_share(300, std_rad, |i, _, frame| {
                let hash = (frame * 12.9898 + i as f32 * 78.233).sin() * 43_758.547;
                TAU * (hash - hash.floor())
            });
            for (what, left) in [("standing", standing), ("slower", slower), ("random", random)] {
                assert!((0.75..1.1).contains(&left), "{what}, {std_rad}: {left}");
            }
        }
    }

    proptest! {
        /// A constant offset of an angle changes nothing, nor do whole turns.
        #[test]
        fn a_constant_offset_leaves_the_unexplained_share(turned_rad in -30.0_f32..30.0, index in 0_usize..13) {
            let plain = unexplained_share(100, 0.05, |i, position, _| 0.7 * mean_angle(i, position));
            let turned = |i: usize, position: f32| {
                let angle = 0.7 * mean_angle(i, position) + if i == index { turned_rad } else { 0.0 };
                wrap_angle(angle)
            };
            let turned = unexplained_share(100, 0.05, |i, position, _| turned(i, position));
            prop_assert!((plain - turned).abs() < 1.0e-3, "{plain}, {turned}");
        }

        #[test]
        fn the_unexplained_share_and_its_companions_stay_within_their_bounds(seed in 0_u64..1000, std_rad in 0.01_f32..3.0, missing in 0_usize..14) {
            let table = table(4.0e-3, 9);
            let model = table.model().unwrap();
            let cycle_rad2 = cycle_variances_rad2(&model, 20);
            let mut swing = ExplainedVariance::<13>::new();
            let mut stream = Stream::new(seed, 0, 0);
            for _ in 0..40 {
                let seen = core::array::from_fn(|i| (i >= missing).then(|| TAU * stream.uniform()));
                let seen = AngleMeasurement::new(&seen, std_rad).unwrap();
                swing.add(0.2 * stream.uniform(), &seen, &model.mean_pose_rad(model.point(stream.uniform())));
                let left = swing.unexplained_share(&cycle_rad2, seen.std_rad());
                prop_assert!(left.is_none_or(|left| (0.0..=1.0 + STANDARD_ERRORS + 1.0e-4).contains(&left)), "{left:?}");
                prop_assert!((0.0..1.0).contains(&swing.confidence()));
            }
            prop_assert_eq!(swing.unexplained_share(&cycle_rad2, &[std_rad; 13]).is_none(), missing == 13);
        }
    }
}
