//! The model between its stored positions: linear along the cycle, which closes on itself.

use crate::cyclic::phase::wrap_position;
use crate::cyclic::{CoupledModel, MotionModel};
use crate::math::{floor, max, min, sqrt};
use crate::numeric::semi_definite::packed_len;
use core::f32::consts::TAU;

/// A cycle position as two neighbouring stored positions and the part of the way between them.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
///
/// // A hundred positions are stored; this one lies between the last and the first.
/// let model = WALKING.model()?;
/// let point = model.point(0.9975);
/// assert_eq!((point.before, point.after), (99, 0));
/// assert!((point.fraction - 0.75).abs() < 1e-3);
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclePoint {
    /// Index of the stored position at or before the point.
    pub before: usize,
    /// Index of the stored position after it; 0 follows the last.
    pub after: usize,
    /// Part of the way from `before` to `after`, in [0, 1].
    pub fraction: f32,
}

impl CoupledModel<'_> {
    /// Where cycle position `position` (any real number, wrapped) lies between the stored ones.
    #[cfg_attr(target_arch = "x86_64", inline)]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    #[must_use]
    pub fn point(&self, position: f32) -> CyclePoint {
        let count = self.position_count();
        let along = wrap_position(position) * count as f32;
        let before = (along as usize).min(count - 1);
        let fraction = min(along - before as f32, 1.0);
        CyclePoint { before, after: if before + 1 == count { 0 } else { before + 1 }, fraction }
    }

    /// As [`Self::point`] for number `index`, below `count`, of `count` positions evenly along the
    /// cycle: exact, in whole numbers.
    #[inline(always)]
    pub(in crate::cyclic) fn point_among(&self, index: usize, count: usize) -> CyclePoint {
        let stored = self.position_count();
        let (before, rest) = (index * stored / count, index * stored % count);
        let fraction = rest as f32 / count as f32;
        CyclePoint { before, after: if before + 1 == stored { 0 } else { before + 1 }, fraction }
    }

    /// Mean pose, radians, unwrapped along the cycle (not in (-pi, pi]); entries beyond the model's
    /// angles are zero.
    ///
    /// From the last stored position on it leads to the first one plus the angle's turns.
    #[inline(never)]
    #[must_use]
    pub fn mean_pose_rad<const N: usize>(&self, point: CyclePoint) -> [f32; N] {
        self.pose_at(point)
    }

    /// As [`Self::mean_pose_rad`], written out where it is asked for: for a loop over many points,
    /// elsewhere it costs flash.
    #[inline(always)]
    pub(in crate::cyclic) fn pose_at<const N: usize>(&self, point: CyclePoint) -> [f32; N] {
        let mut pose = self.row(self.parts().mean_pose_rad, point);
        if point.after == 0 {
            for (angle, &turns) in pose.iter_mut().zip(self.parts().turns_per_cycle) {
                *angle += point.fraction * f32::from(turns) * TAU;
            }
        }
        pose
    }

    /// Root mean square over the cycle of each angle's standard deviation about the mean cycle,
    /// radians; zero where the model has none.
    #[must_use]
    pub fn deviation_std_rad<const N: usize>(&self) -> [f32; N] {
        let deviation = &self.parts().deviation;
        let mut std = [0.0; N];
        for (i, value) in std.iter_mut().enumerate() {
            let part = |parts: &[f32]| parts.get(i).map_or(0.0, |part| part * part);
            let swing = 0.5 * (part(deviation.cosine_std_rad) + part(deviation.sine_std_rad));
            *value = sqrt(part(deviation.offset_std_rad) + swing + part(deviation.rest_std_rad));
        }
        std
    }

    /// Standard deviation of each angle's velocity about the mean cycle's, rad per reference frame,
    /// at the model's mean speed; zero where the model has none.
    ///
    /// Follows from the deviation's parts: a swing moves by 2 pi of itself in a cycle, the rest by
    /// its rate. That rate is the derivative of a Matern process of order 3/2, which is rough.
    /// People's velocities differ by about six tenths of this.
    ///
    /// ```
    /// # #[cfg(feature = "walking-model")] {
    /// use sinew_core::cyclic::model::walking::WALKING;
    ///
    /// // The swing of an elbow (the angle of l_wrist) differs between walkers, that of a neck hardly.
    /// let velocity_std = WALKING.model()?.deviation_velocity_std::<13>();
    /// assert!(velocity_std[3] > 2.0 * velocity_std[0]);
    /// # }
    /// # Ok::<(), sinew_core::cyclic::ModelError>(())
    /// ```
    #[must_use]
    pub fn deviation_velocity_std<const N: usize>(&self) -> [f32; N] {
        let deviation = &self.parts().deviation;
        let mut std = [0.0; N];
        for (i, value) in std.iter_mut().enumerate() {
            let part = |parts: &[f32]| parts.get(i).copied().unwrap_or(0.0);
            let (cosine, sine) = (part(deviation.cosine_std_rad), part(deviation.sine_std_rad));
            let swing2 = 0.5 * TAU * TAU * (cosine * cosine + sine * sine);
            let rest = part(deviation.rest_rate_per_cycle) * part(deviation.rest_std_rad);
            *value = self.mean_cycle_velocity() * sqrt(swing2 + rest * rest);
        }
        std
    }

    /// Slope of the secant of the mean pose from `reach` cycles before `position` to `reach` behind
    /// it, rad per cycle; `reach` is at least half the way between two stored positions.
    ///
    /// ```
    /// # #[cfg(feature = "walking-model")] {
    /// use sinew_core::cyclic::model::walking::WALKING;
    ///
    /// // The right knee, just ahead and over half a cycle: the knee bends and stretches again.
    /// let model = WALKING.model()?;
    /// let [ahead, far] = [0.01, 0.25].map(|reach| model.mean_pose_secant::<13>(0.1, reach)[11]);
    /// assert!(far.abs() < ahead.abs());
    /// # }
    /// # Ok::<(), sinew_core::cyclic::ModelError>(())
    /// ```
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[must_use]
    pub fn mean_pose_secant<const N: usize>(&self, position: f32, reach: f32) -> [f32; N] {
        let reach = max(reach, 0.5 / self.position_count() as f32);
        let (from, to) = (position - reach, position + reach);
        let before = self.mean_pose_rad::<N>(self.point(from));
        let mut slope = self.mean_pose_rad::<N>(self.point(to));
        let (seams, inverse) = (floor(to) - floor(from), 0.5 / reach);
        for (value, start) in slope.iter_mut().zip(before) {
            *value -= start;
        }
        for (value, &turns) in slope.iter_mut().zip(self.parts().turns_per_cycle) {
            *value += seams * f32::from(turns) * TAU;
        }
        slope.map(|way| inverse * way)
    }

    /// The rows of `table` on both sides of a point, interpolated; zero beyond the model's angles.
    #[inline(always)]
    fn row<const N: usize>(&self, table: &[f32], point: CyclePoint) -> [f32; N] {
        let between = |a: f32, b: f32| a + point.fraction * (b - a);
        let columns = self.angle_count();
        let (before, after) = (row_of(table, point.before, columns), row_of(table, point.after, columns));
        if let (Ok(before), Ok(after)) = (<&[f32; N]>::try_from(before), <&[f32; N]>::try_from(after)) {
            return core::array::from_fn(|i| between(before[i], after[i]));
        }
        let mut values = [0.0; N];
        for (value, (&a, &b)) in values.iter_mut().zip(before.iter().zip(after)) {
            *value = between(a, b);
        }
        values
    }
}

impl MotionModel<'_> {
    /// Mean acceleration, rad per reference frame^2; entries beyond the model's angles are zero.
    #[inline(always)]
    #[must_use]
    pub fn mean_acceleration<const N: usize>(&self, point: CyclePoint) -> [f32; N] {
        self.row(self.parts().mean_acceleration, point)
    }

    /// Mean velocity, rad per reference frame; entries beyond the model's angles are zero.
    #[inline]
    #[must_use]
    pub fn mean_velocity<const N: usize>(&self, point: CyclePoint) -> [f32; N] {
        self.row(self.parts().mean_velocity, point)
    }

    /// Writes the covariance of the acceleration, rad^2 per reference frame^4, as a packed lower
    /// triangle.
    #[inline]
    pub fn acceleration_covariance(&self, point: CyclePoint, packed: &mut [f32]) {
        let (before, after) = self.covariance_pair(point);
        for ((value, &a), &b) in packed.iter_mut().zip(before).zip(after) {
            *value = a + point.fraction * (b - a);
        }
    }

    /// The packed covariances stored on both sides of a point.
    #[inline]
    #[must_use]
    pub fn covariance_pair(&self, point: CyclePoint) -> (&[f32], &[f32]) {
        let packed = packed_len(self.angle_count());
        let all = self.parts().acceleration_covariance;
        (row_of(all, point.before, packed), row_of(all, point.after, packed))
    }
}

#[inline]
fn row_of(table: &[f32], row: usize, columns: usize) -> &[f32] {
    table.get(row * columns..(row + 1) * columns).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::cyclic::model::motion_model::{ModelParts, MotionModel};
    use crate::cyclic::{Deviation, phase::wrap_position};
    use core::f32::consts::TAU;
    use proptest::prelude::*;

    /// One angle that swings as a sine, one that winds once a cycle.
    fn tables() -> ([f32; 80], [f32; 120]) {
        let mut pose = [0.0; 80];
        let mut covariance = [0.0; 120];
        for i in 0..40 {
            let phase = i as f32 / 40.0;
            pose[2 * i] = (TAU * phase).sin();
            pose[2 * i + 1] = TAU * phase + 0.5;
            covariance[3 * i] = 1.0 + phase;
            covariance[3 * i + 2] = 1.0;
        }
        (pose, covariance)
    }

    fn model<'a>(pose: &'a [f32], covariance: &'a [f32]) -> MotionModel<'a> {
        MotionModel::new(ModelParts {
            angle_count: 2,
            mean_acceleration: pose,
            acceleration_covariance: covariance,
            mean_pose_rad: pose,
            mean_velocity: pose,
            turns_per_cycle: &[0, 1],
            mean_duration_frames: 70.0,
            rate_hz: 60.0,
            deviation: Deviation::default(),
        })
        .unwrap()
    }

    proptest! {
        #[test]
        fn poses_follow_the_curves(position in -3.0_f32..3.0) {
            let (pose, covariance) = tables();
            let model = model(&pose, &covariance);
            let c = wrap_position(position);
            let point = model.point(position);
            let [swing, wind] = model.mean_pose_rad::<2>(point);
            prop_assert!((swing - (TAU * c).sin()).abs() < 4.0e-3);
            prop_assert!((wind - (TAU * c + 0.5)).abs() < 1.0e-3);
        }

        #[test]
        fn a_position_among_many_is_the_point_there(count in 1_usize..200, part in 0.0_f32..1.0) {
            let (pose, covariance) = tables();
            let model = model(&pose, &covariance);
            let index = (part * count as f32) as usize;
            let (exact, near) = (model.point_among(index, count), model.point(index as f32 / count as f32));
            let along = |point: super::CyclePoint| point.before as f32 + point.fraction;
            prop_assert!((along(exact) - along(near)).abs() < 1.0e-4, "{index} of {count}: {exact:?}, {near:?}");
            prop_assert!(exact.fraction < 1.0 && exact.after == (exact.before + 1) % 40);
        }

        /// Over a part of the cycle, the seam in it or not.
        #[test]
        fn a_secant_has_the_mean_of_the_slopes_under_it(position in -3.0_f32..3.0, reach in 0.005_f32..0.2) {
            let (pose, covariance) = tables();
            let [swing, wind] = model(&pose, &covariance).mean_pose_secant::<2>(position, reach);
            let mean = TAU * (TAU * position).cos() * (TAU * reach).sin() / (TAU * reach);
            prop_assert!((swing - mean).abs() < 0.6, "{swing} {mean}");
            prop_assert!((wind - TAU).abs() < 5.0e-3, "{wind}");
        }
    }

    #[test]
    fn the_covariance_is_interpolated_across_the_seam() {
        let (pose, covariance) = tables();
        let model = model(&pose, &covariance);
        let mut packed = [0.0; 3];
        model.acceleration_covariance(model.point(79.0 / 80.0), &mut packed);
        assert!((packed[0] - 0.5 * (1.0 + 1.975)).abs() < 1.0e-4, "{packed:?}");
        assert_eq!(model.mean_acceleration::<3>(model.point(0.0)), [0.0, 0.5, 0.0], "a greater capacity is filled up");
    }
}
