//! A step of the phase-coupled filter: predict, update the grid, correct, estimate.

use crate::cyclic::coupled::block::Basis;
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::{AngleMeasurement, CoupledModel, CyclicEstimate};

impl<const N: usize> CoupledFilter<N> {
    /// One frame: predict over the measurement's step, then correct by the angles seen. On x86-64
    /// what every frame needs is inlined, so that a caller compiled for wider vectors than the
    /// crate has them. Elsewhere it would cost flash.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn step(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        self.predict(model, measurement.step_frames());
        self.correct(model, measurement)
    }

    /// Corrects by the measured angles, after the grid was updated and the filter relocked where
    /// needed.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn correct(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        let mode = if measurement.is_empty(model.angle_count()) { None } else { self.watch(model, measurement) };
        if self.watch.searching {
            return self.estimate_of_all_places(model, measurement, mode);
        }
        let innovation = self.correct_phase(model, measurement);
        self.watch.nis.update(&innovation, measurement.step_frames());
        self.estimate(model, innovation.log_likelihood, innovation.outlier)
    }

    /// The estimate after the last correction, by `measurement`, without its likelihood.
    pub fn current_estimate(
        &mut self,
        model: &CoupledModel<'_>,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        if self.watch.searching {
            return self.estimate_of_all_places(model, measurement, None);
        }
        self.estimate(model, 0.0, false)
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn estimate(&self, model: &CoupledModel<'_>, log_likelihood: f32, outlier: bool) -> CyclicEstimate<N> {
        let slope = self.pose_slope(model);
        let basis = Basis::at(self.position);
        let mut angle_variance_rad2 = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let prediction = self.blocks[i].predict_angle(&basis, slope[i]);
            angle_variance_rad2[i] = self.band_scale(i) * (prediction.variance + self.pair.along(&prediction.gradient));
        }
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2,
            cycle_position: self.position,
            cycle_position_variance: self.pair.cc,
            cycle_velocity_per_frame: self.travelled_velocity(model),
            cycle_velocity_variance: self.pair.vv,
            log_likelihood,
            outlier,
            misfit: self.spread_scale.is_misfit(),
        }
    }

    /// Factor of the reported variance of the angle at `index`, at least one: the inverse of a
    /// learned noise scale below one.
    ///
    /// Noise that moves slowly looks like absent noise, so bands stay as wide as the stated noise
    /// makes them.
    #[must_use]
    pub fn band_scale(&self, index: usize) -> f32 {
        self.noise.band_scale(index)
    }
}
