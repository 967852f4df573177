//! The estimate while the phase is unknown: the mean over the grid.

use crate::cyclic::coupled::measurement::measured_path::MeasuredPath;
use crate::cyclic::coupled::person::block::Basis;
use crate::cyclic::coupled::phase::phase_grid::{POSITIONS, PhaseMode};
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::phase::position_difference;
use crate::cyclic::{AngleMeasurement, CoupledModel, CyclicEstimate};
use crate::math::{max, wrap_angle};
use crate::numeric::chi_square::{DEFAULT_GATE_SIGMAS, is_outlier};
use crate::numeric::log_product::LogProduct;
use core::f32::consts::TAU;

impl<const N: usize> CoupledFilter<N> {
    /// The mean pose over the grid's positions by weight, corrected angle by angle. `mode` is the
    /// grid's mode where it is known.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(crate) fn estimate_of_all_places(
        &mut self,
        model: &CoupledModel<'_>,
        measurement: &AngleMeasurement<N>,
        mode: Option<PhaseMode>,
    ) -> CyclicEstimate<N> {
        let mode = mode.unwrap_or_else(|| self.grid.mode(model));
        self.leader.move_by(position_difference(mode.position, self.leader.position));
        self.leader.velocity = mode.velocity;
        self.path = MeasuredPath::new();
        let (mean, mut variance) = self.pose_of_all_places(model);
        let (mut squares, mut volume, mut count) = (0.0, LogProduct::one(), 0);
        for i in 0..model.angle_count().min(N) {
            let mut angle = mean[i];
            if let Some(measured) = measurement.angle_rad(i) {
                let total = variance[i] + measurement.std_rad()[i] * measurement.std_rad()[i];
                let residual = wrap_angle(measured - angle);
                squares += residual * residual / total;
                volume.multiply(TAU * total);
                count += 1;
                angle += variance[i] / total * residual;
                // Rounding takes it below zero where the noise is small beside it.
                variance[i] = max(variance[i] - variance[i] * variance[i] / total, 0.0);
            }
            self.turn_to(i, wrap_angle(angle));
        }
        let elsewhere = 1.0 - mode.weight;
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2: variance,
            cycle_position: self.leader.position,
            // The rest of the weight has the variance of a uniform position.
            cycle_position_variance: mode.weight * mode.covariance[0] + elsewhere / 12.0,
            cycle_velocity_per_frame: self.leader.velocity,
            cycle_velocity_variance: mode.covariance[2],
            log_likelihood: -0.5 * (squares + volume.ln()),
            outlier: is_outlier(squares, count, DEFAULT_GATE_SIGMAS),
            misfit: self.is_misfit(),
        }
    }

    /// Mean and variance of each angle over the grid's positions, with the person's learned
    /// deviation.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn pose_of_all_places(&self, model: &CoupledModel<'_>) -> ([f32; N], [f32; N]) {
        let reference = model.mean_pose_rad::<N>(model.point(self.leader.position));
        let (mut mean, mut square) = ([0.0; N], [0.0; N]);
        for (cell, weight) in self.grid.by_position().into_iter().enumerate() {
            let pose = model.mean_pose_rad::<N>(model.point(cell as f32 / POSITIONS as f32));
            for i in 0..model.angle_count().min(N) {
                let off = wrap_angle(pose[i] - reference[i]);
                mean[i] += weight * off;
                square[i] += weight * off * off;
            }
        }
        let basis = Basis::at(self.leader.position);
        let mut variance = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let prediction = self.leader.blocks[i].predict_angle(&basis, 0.0);
            variance[i] = max(square[i] - mean[i] * mean[i], 0.0) + prediction.variance;
            mean[i] += reference[i] + self.leader.blocks[i].deviation(&basis);
        }
        (mean, variance)
    }
}
