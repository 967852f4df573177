//! Moments of the phase-coupled filter and its linear step, for a smoother over a whole recording.

use crate::cyclic::coupled::hypothesis::correct::is_beyond_gate;
use crate::cyclic::coupled::person::block::{AngleBlock, Basis, PARTS};
use crate::cyclic::coupled::phase::cycle_pair::CyclePair;
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::cycle_state::CycleState;
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::sqrt;

/// How one angle's parts move on: parts <- map parts + noise.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// # use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
/// # let model = WALKING.model()?;
/// # let filter = CoupledFilter::<13>::new(&model, &AngleMeasurement::nothing(), Some(0.0), None)?;
/// // Offset and residual of an angle over six frames.
/// let knee = filter.transition(&model, 6.0).blocks[5];
/// assert!(knee.map[0][0] > 0.99, "the offset lasts");
/// assert!(knee.map[3][3] < knee.map[0][0], "the residual is forgotten sooner");
/// assert!(knee.noise[3][3] > knee.noise[0][0], "and has more process noise");
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockTransition {
    /// Row: new part, column: old part.
    pub map: [[f32; PARTS]; PARTS],
    /// Covariance of the noise.
    pub noise: [[f32; PARTS]; PARTS],
}

/// A step of the phase-coupled filter as a linear map with noise. (c, v) move by [1, `step_frames`;
/// 0, 1]; the angles' parts move on each by themselves.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
///
/// // The process noise of position and velocity in a step of two frames.
/// let model = WALKING.model()?;
/// let filter = CoupledFilter::<13>::new(&model, &AngleMeasurement::nothing(), Some(0.0), None)?;
/// let transition = filter.transition(&model, 2.0);
/// let [position_noise, _, velocity_noise] = transition.cycle_noise;
/// assert_eq!(transition.step_frames, 2.0);
/// assert!((velocity_noise - 2.0 * 2.0e-4 * 2.0e-4).abs() < 1e-10, "0.0002 cycles per frame^2");
/// assert!(position_noise > 0.0);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledTransition<const N: usize> {
    /// Length of the step, frames at the model's rate.
    pub step_frames: f32,
    /// Covariance of the noise of (c, v): cc, cv, vv.
    pub cycle_noise: [f32; 3],
    /// Each angle's parts.
    pub blocks: [BlockTransition; N],
}

impl<const N: usize> CoupledFilter<N> {
    /// Position and velocity in the cycle with their covariance.
    #[must_use]
    pub const fn cycle(&self) -> CycleState {
        let CyclePair { cc, cv, vv } = self.leader.pair;
        CycleState {
            position: self.leader.position,
            velocity: self.leader.velocity,
            position_variance: cc,
            covariance: cv,
            velocity_variance: vv,
        }
    }

    /// Coefficients of each angle given (c, v); those beyond the model's angles are meaningless.
    #[must_use]
    pub const fn blocks(&self) -> &[AngleBlock; N] {
        &self.leader.blocks
    }

    /// This filter, led by the hypothesis that leads in `next`, its state a frame later: its own
    /// leader, or a rival that won then. `None` where that one began after this frame.
    #[must_use]
    pub fn led_as_in(&self, next: &Self) -> Option<Self> {
        let mut led = *self;
        if self.leader.number != next.leader.number {
            if !self.rival.exists() || self.rival.hypothesis.number != next.leader.number {
                return None;
            }
            led.lead_by_rival();
        }
        Some(led)
    }

    /// Covariance of the angles, rad^2, symmetric, with the variances of the estimate on its
    /// diagonal. Angles are tied to each other by the cycle alone: each has its own deviation.
    /// `None` while the phase is unknown. Those beyond the model's angles are zero.
    #[must_use]
    pub fn angle_covariance_rad2(&self, model: &CoupledModel<'_>) -> Option<[[f32; N]; N]> {
        if self.is_searching() {
            return None;
        }
        let (slope, basis) = (self.leader.pose_slope(model), Basis::at(self.leader.position));
        let count = model.angle_count().min(N);
        let predictions: [_; N] = core::array::from_fn(|i| self.leader.blocks[i].predict_angle(&basis, slope[i]));
        let bands: [f32; N] = core::array::from_fn(|i| sqrt(self.band_scale(i)));
        let mut covariance_rad2 = [[0.0; N]; N];
        for i in 0..count {
            covariance_rad2[i][i] = self.angle_variance_rad2(i, &predictions[i]);
            for j in 0..i {
                let gradients = [&predictions[i].gradient, &predictions[j].gradient];
                covariance_rad2[i][j] = bands[i] * bands[j] * self.leader.pair.between(gradients);
                covariance_rad2[j][i] = covariance_rad2[i][j];
            }
        }
        Some(covariance_rad2)
    }

    /// The linear step of [`Self::predict`] from here, by its effect on unit vectors and on zero
    /// covariance.
    #[must_use]
    pub fn transition(&self, model: &CoupledModel<'_>, step_frames: f32) -> CoupledTransition<N> {
        let mut still = self.leader;
        still.pair = CyclePair { cc: 0.0, cv: 0.0, vv: 0.0 };
        for block in &mut still.blocks {
            *block = AngleBlock::zero();
        }
        let mut noise = still;
        noise.predict(model, step_frames);
        let mut blocks = core::array::from_fn(|i| BlockTransition {
            map: [[0.0; PARTS]; PARTS],
            noise: noise.blocks[i].covariance_matrix(),
        });
        for part in 0..PARTS {
            let mut unit = still;
            for block in &mut unit.blocks {
                block.mean[part] = 1.0;
            }
            unit.predict(model, step_frames);
            for (block, moved) in blocks.iter_mut().zip(&unit.blocks) {
                for (row, value) in block.map.iter_mut().zip(moved.mean) {
                    row[part] = value;
                }
            }
        }
        CoupledTransition { step_frames, cycle_noise: [noise.pair.cc, noise.pair.cv, noise.pair.vv], blocks }
    }

    /// Variance by which [`Self::correct`] inflates the offset of each angle beyond the gate,
    /// rad^2; 0 for the others. To be called before it, on the predicted filter.
    #[must_use]
    pub fn gated_variance_rad2(&self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> [f32; N] {
        let point = model.point(self.leader.position);
        let (pose, slope) = (model.mean_pose_rad::<N>(point), self.leader.pose_slope(model));
        let basis = Basis::at(self.leader.position);
        let mut inflation_rad2 = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let Some(measured) = measurement.angle_rad(i) else { continue };
            let noise = self.noise.scale(i) * measurement.std_rad()[i] * measurement.std_rad()[i];
            let residual = self.leader.residual(i, measured - pose[i], &basis);
            let prediction = self.leader.blocks[i].predict_angle(&basis, slope[i]);
            let total = prediction.variance + noise + self.leader.pair.along(&prediction.gradient);
            if is_beyond_gate(residual, total) {
                inflation_rad2[i] = residual * residual;
            }
        }
        inflation_rad2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic::{mean_angle, table};

    const N: usize = 13;

    fn started(model: &CoupledModel<'_>) -> CoupledFilter<N> {
        let first = core::array::from_fn(|i| Some(mean_angle(i, 0.2) + 0.05));
        let first = AngleMeasurement::new(&first, 0.01).unwrap();
        let mut filter = CoupledFilter::<N>::new(model, &first, Some(0.2), None).unwrap();
        for frame in 1..20 {
            let seen = core::array::from_fn(|i| Some(mean_angle(i, 0.2 + frame as f32 / 65.0) + 0.05));
            filter.step(model, &AngleMeasurement::new(&seen, 0.05).unwrap());
        }
        filter
    }

    /// The effect of predict on means and, without regression on (c, v), on covariances.
    #[test]
    fn the_transition_is_that_of_predict() {
        let table = table(0.001, 9);
        let model = table.model().unwrap();
        let mut filter = started(&model);
        for block in &mut filter.leader.blocks {
            block.regression = [[0.0; 2]; PARTS];
        }
        let transition = filter.transition(&model, 2.5);
        let mut moved = filter;
        moved.predict(&model, 2.5);
        for ((old, new), step) in filter.blocks().iter().zip(moved.blocks()).zip(&transition.blocks) {
            for i in 0..PARTS {
                let mean: f32 = (0..PARTS).map(|j| step.map[i][j] * old.mean[j]).sum();
                assert!((mean - new.mean[i]).abs() < 1.0e-5, "{mean} beside {}", new.mean[i]);
                for j in 0..PARTS {
                    let sum = (0..PARTS * PARTS).map(|k| {
                        let (a, b) = (k / PARTS, k % PARTS);
                        step.map[i][a] * old.covariance(a, b) * step.map[j][b]
                    });
                    let moved = sum.sum::<f32>() + step.noise[i][j];
                    let scale = (new.covariance(i, i) * new.covariance(j, j)).sqrt();
                    assert!((moved - new.covariance(i, j)).abs() < 1.0e-4 * scale, "{i} {j}");
                }
            }
        }
        let (old, new) = (filter.cycle(), moved.cycle());
        let vv = old.velocity_variance + transition.cycle_noise[2];
        assert!((vv / new.velocity_variance - 1.0).abs() < 1.0e-5);
        let cc =
            old.position_variance + 5.0 * old.covariance + 6.25 * old.velocity_variance + transition.cycle_noise[0];
        assert!((cc / new.position_variance - 1.0).abs() < 1.0e-4);
    }

    #[test]
    fn the_covariance_has_the_estimates_variances_and_is_positive() {
        let table = table(0.001, 9);
        let model = table.model().unwrap();
        let mut filter = started(&model);
        let angles = core::array::from_fn(|i| Some(mean_angle(i, 0.5)));
        let estimate = filter.step(&model, &AngleMeasurement::new(&angles, 0.05).unwrap());
        let covariance = filter.angle_covariance_rad2(&model).unwrap();
        let matrix = nalgebra::DMatrix::from_fn(N, N, |i, j| f64::from(covariance[i][j]));
        assert_eq!(core::array::from_fn(|i| covariance[i][i]), estimate.angle_variance_rad2);
        assert!(matrix.symmetric_eigenvalues().min() > 0.0);
        let correlated = |(i, j): (usize, usize)| covariance[i][j].abs() / (covariance[i][i] * covariance[j][j]).sqrt();
        let strongest = (0..N).flat_map(|i| (0..i).map(move |j| (i, j))).map(correlated).fold(0.0, f32::max);
        assert!((0.01..1.0).contains(&strongest), "{strongest}: a late phase moves all angles");
        let searching = CoupledFilter::<N>::anywhere(&model, &AngleMeasurement::nothing()).unwrap();
        assert_eq!(searching.angle_covariance_rad2(&model), None);
    }

    #[test]
    fn an_angle_beyond_the_gate_inflates_its_offset() {
        let table = table(0.001, 9);
        let model = table.model().unwrap();
        let mut filter = started(&model);
        filter.predict(&model, 1.0);
        let position = filter.cycle().position;
        let seen = core::array::from_fn(|i| Some(mean_angle(i, position) + if i == 4 { 2.0 } else { 0.05 }));
        let measurement = AngleMeasurement::new(&seen, 0.05).unwrap();
        let opened = filter.gated_variance_rad2(&model, &measurement);
        assert!(opened[4] > 1.0 && opened.iter().filter(|variance| **variance > 0.0).count() == 1, "{opened:?}");
        let mut corrected = filter;
        corrected.correct(&model, &measurement);
        assert!(corrected.blocks()[4].covariance(0, 0) < opened[4]);
        assert!((corrected.blocks()[4].mean[0] - filter.blocks()[4].mean[0]).abs() > 1.0, "learned anew");
        assert!(filter.led_as_in(&corrected).is_some());
    }
}
