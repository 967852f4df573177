//! How much of the swing that is seen does a motion's mean cycle tell?
//!
//! A person stands, leans and holds the arms otherwise than the mean cycle, which says nothing of the motion; but whoever moves as the cycle
//! does keeps that difference. So each angle is compared with the mean cycle's, at the position that the motion's filter has found, by how much
//! their difference varies, not by its size. Variances are circular ones (-2 ln of the mean unit vector's length; Mardia and Jupp, *Directional
//! Statistics*, 2.3), as angles wind.

use crate::cyclic::{AngleMeasurement, MotionModel};
use crate::math::{clamp, exp, ln, max, min, sin_cos, sqrt};
use crate::saved_state::{FINITE, NOT_NEGATIVE, SavedState, StateVisitor};
use core::f32::consts::PI;

/// Greatest circular variance told apart, rad^2: that of an angle anywhere on the circle.
const MAX_VARIANCE_RAD2: f32 = PI * PI / 3.0;
/// Part of the cycle's own variance that counts as left over even where the mean cycle tells everything, so that a person
/// who hardly moves is not taken for one who moves as told.
const REST_SHARE: f32 = 0.1;
/// Standard errors, from the measurements' noise, by which a swing has to be told apart from noise.
const STANDARD_ERRORS: f32 = 0.5;
/// Least squared length of a mean unit vector: far below that of `MAX_VARIANCE_RAD2`.
const MIN_LENGTH2: f32 = 1.0e-6;
/// Greatest variance of a measurement, rad^2: beyond it there is nothing in it.
const MAX_NOISE_RAD2: f32 = 13.0;

/// Fading sums of one angle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SwingSums {
    weight: f32,
    /// Unit vectors (cosine, sine) of the angle seen, of the mean cycle's, and of their difference.
    seen: [f32; 2],
    told: [f32; 2],
    left: [f32; 2],
}

impl SwingSums {
    const fn nothing() -> Self {
        Self { weight: 0.0, seen: [0.0; 2], told: [0.0; 2], left: [0.0; 2] }
    }

    #[inline(always)]
    fn fade(&mut self, keep: f32) {
        self.weight *= keep;
        self.seen.iter_mut().chain(&mut self.told).chain(&mut self.left).for_each(|sum| *sum *= keep);
    }

    #[inline(always)]
    fn add(&mut self, seen_rad: f32, told_rad: f32) {
        let ((seen_sin, seen_cos), (told_sin, told_cos)) = (sin_cos(seen_rad), sin_cos(told_rad));
        self.weight += 1.0;
        for (sum, unit) in [
            (&mut self.seen, [seen_cos, seen_sin]),
            (&mut self.told, [told_cos, told_sin]),
            (&mut self.left, [seen_cos * told_cos + seen_sin * told_sin, seen_sin * told_cos - seen_cos * told_sin]),
        ] {
            sum[0] += unit[0];
            sum[1] += unit[1];
        }
    }

    /// Sum of squared weights over the squared sum, of weights that fall by `keep`: 1 of a single frame, less the more frames count.
    fn share_of_a_frame(&self, keep: f32) -> f32 {
        let filled = min(self.weight * (1.0 - keep), 1.0);
        min((2.0 - filled) / max(self.weight * (1.0 + keep), 1.0e-6), 1.0)
    }

    /// Circular variance, rad^2, of an angle by the sum of its unit vectors: without what the squared length of few of them
    /// is too large by, `share` of a frame, and without the noise that leaves `clear2` of it.
    #[inline(never)]
    fn variance_rad2(&self, sum: &[f32; 2], share: f32, clear2: f32) -> f32 {
        if share > 0.999 {
            return MAX_VARIANCE_RAD2;
        }
        let length2 = (sum[0] * sum[0] + sum[1] * sum[1]) / (self.weight * self.weight);
        let unbiased = (length2 - share) / (1.0 - share);
        min(-ln(clamp(unbiased / clear2, MIN_LENGTH2, 1.0)), MAX_VARIANCE_RAD2)
    }

    /// Share of the swing that is not told, and its standard error; `cycle_rad2` is the variance over the motion's whole cycle.
    fn untold(&self, cycle_rad2: f32, std_rad: f32, keep: f32) -> (f32, f32) {
        let (share, clear2) = (self.share_of_a_frame(keep), clear2(std_rad));
        let told = self.variance_rad2(&self.told, share, 1.0);
        let seen = self.variance_rad2(&self.seen, share, clear2);
        let left = self.variance_rad2(&self.left, share, clear2);
        let swing = max(max(told, seen), MIN_LENGTH2);
        let noise = sqrt(share * (1.0 / clear2 - 1.0));
        (min((left + REST_SHARE * cycle_rad2) / swing, 1.0), min(noise / swing, 1.0))
    }
}

/// What noise leaves of the squared length of a mean unit vector.
fn clear2(std_rad: f32) -> f32 {
    exp(-min(std_rad * std_rad, MAX_NOISE_RAD2))
}

/// Circular variance of each angle of the mean cycle, rad^2, by so many `positions` of it; 0 beyond the model's angles.
///
/// By it angles count: what hardly moves in a cycle, short links above all, tells nothing of it.
pub(in crate::cyclic) fn cycle_variances_rad2<const N: usize>(model: &MotionModel<'_>, positions: u8) -> [f32; N] {
    let mut cycle = [SwingSums::nothing(); N];
    for position in 0..positions {
        let pose = model.mean_pose_rad::<N>(model.point(f32::from(position) / f32::from(positions)));
        cycle.iter_mut().zip(&pose).take(model.angle_count()).for_each(|(sums, &angle)| sums.add(angle, angle));
    }
    let mut variances_rad2 = [0.0; N];
    for (variance_rad2, sums) in variances_rad2.iter_mut().zip(&cycle).take(model.angle_count()) {
        *variance_rad2 = sums.variance_rad2(&sums.told, 0.0, 1.0);
    }
    variances_rad2
}

/// Swing of up to `N` angles that was seen of late, and that one motion's mean cycle told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::cyclic) struct ExplainedVariance<const N: usize> {
    angles: [SwingSums; N],
    /// Factor of all weights in the last frame.
    keep: f32,
}

impl<const N: usize> SavedState for ExplainedVariance<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for sums in &mut self.angles {
            visitor.real(&mut sums.weight, &NOT_NEGATIVE);
            for sum in [&mut sums.seen, &mut sums.told, &mut sums.left] {
                visitor.reals(sum, &FINITE);
            }
        }
        visitor.real(&mut self.keep, &(0.0..=1.0));
    }
}

impl<const N: usize> ExplainedVariance<N> {
    /// Nothing seen.
    pub(in crate::cyclic) const fn new() -> Self {
        Self { angles: [SwingSums::nothing(); N], keep: 0.0 }
    }

    /// Takes in a measurement, of which the motion's mean cycle tells `told_rad`. What was seen before fades as it does in so many
    /// `cycles` of the motion: to 1/e in one.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(in crate::cyclic) fn add(&mut self, cycles: f32, measurement: &AngleMeasurement<N>, told_rad: &[f32; N]) {
        self.keep = exp(-cycles);
        for (i, sums) in self.angles.iter_mut().enumerate() {
            sums.fade(self.keep);
            if let Some(seen_rad) = measurement.angle_rad(i) {
                sums.add(seen_rad, told_rad[i]);
            }
        }
    }

    /// Share of the swing that the mean cycle leaves over, 0 to 1, plus half a standard error, so that it is at most 1.5; `None`
    /// before anything was seen. `cycle_rad2` are the variances over the whole cycle, `std_rad` the measurements' standard deviations.
    pub(in crate::cyclic) fn unexplained_share(&self, cycle_rad2: &[f32; N], std_rad: &[f32; N]) -> Option<f32> {
        let (mut sum, mut noise2, mut weights) = (0.0, 0.0, 0.0);
        for ((sums, &cycle_rad2), &std_rad) in self.angles.iter().zip(cycle_rad2).zip(std_rad) {
            let weight = sums.weight * cycle_rad2;
            if weight > 0.0 {
                let (untold, noise) = sums.untold(cycle_rad2, std_rad, self.keep);
                sum += weight * untold;
                noise2 += weight * noise * (weight * noise);
                weights += weight;
            }
        }
        (weights > 0.0).then(|| (sum + STANDARD_ERRORS * sqrt(noise2)) / weights)
    }

    /// How much swing is seen, as a share of that over the whole cycle: at most 1.
    pub(in crate::cyclic) fn seen(&self, cycle_rad2: &[f32; N], std_rad: &[f32; N]) -> f32 {
        let (mut sum, mut weights) = (0.0, MIN_LENGTH2);
        for ((sums, &cycle_rad2), &std_rad) in self.angles.iter().zip(cycle_rad2).zip(std_rad) {
            let weight = sums.weight * cycle_rad2;
            if weight > 0.0 {
                let share = sums.share_of_a_frame(self.keep);
                sum += weight * min(sums.variance_rad2(&sums.seen, share, clear2(std_rad)), cycle_rad2);
                weights += weight * cycle_rad2;
            }
        }
        sum / weights
    }

    /// How much of a long time has been seen, from 0 to 1.
    pub(in crate::cyclic) fn filled(&self) -> f32 {
        min(self.weight() * (1.0 - self.keep), 1.0)
    }

    /// How much is known, from 0 with a single frame, or none for some cycles, to nearly 1.
    pub(in crate::cyclic) fn knowledge(&self) -> f32 {
        1.0 - 1.0 / max(self.weight(), 1.0)
    }

    /// Measurements that count, of the angle seen most.
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

    /// What is left over after `frames` of `angle(index, cycle position, frame)`, with noise of `std_rad`, by the made-up motion at its true position.
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
    fn the_motion_itself_leaves_a_tenth_whoever_holds_the_arms_otherwise() {
        for std_rad in [0.01, 0.1, 0.5] {
            let same = unexplained_share(300, std_rad, |i, position, _| mean_angle(i, position));
            let leaning = unexplained_share(300, std_rad, |i, position, _| mean_angle(i, position) + 0.2 * i as f32);
            assert!((0.08..0.3).contains(&same), "{std_rad}: {same}");
            assert!((same - leaning).abs() < 0.05, "{std_rad}: {same}, {leaning}");
        }
    }

    #[test]
    fn who_stands_or_moves_otherwise_leaves_nearly_all() {
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
        /// Turning an angle by any amount, for good, changes nothing; nor do whole turns.
        #[test]
        fn what_is_left_does_not_depend_on_where_an_angle_is(turned_rad in -30.0_f32..30.0, index in 0_usize..13) {
            let plain = unexplained_share(100, 0.05, |i, position, _| 0.7 * mean_angle(i, position));
            let turned = |i: usize, position: f32| {
                let angle = 0.7 * mean_angle(i, position) + if i == index { turned_rad } else { 0.0 };
                wrap_angle(angle)
            };
            let turned = unexplained_share(100, 0.05, |i, position, _| turned(i, position));
            prop_assert!((plain - turned).abs() < 1.0e-3, "{plain}, {turned}");
        }

        #[test]
        fn what_is_left_is_a_share(seed in 0_u64..1000, std_rad in 0.01_f32..3.0, missing in 0_usize..14) {
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
                prop_assert!((0.0..=1.0001).contains(&swing.seen(&cycle_rad2, seen.std_rad())));
                prop_assert!((0.0..1.0).contains(&swing.knowledge()) && (0.0..=1.0).contains(&swing.filled()));
            }
            prop_assert_eq!(swing.unexplained_share(&cycle_rad2, &[std_rad; 13]).is_none(), missing == 13);
        }
    }
}
