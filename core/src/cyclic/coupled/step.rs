//! A frame of the phase-coupled filter: predict, look at the grid of phases, correct, estimate.

use crate::cyclic::coupled::block::Basis;
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::{AngleMeasurement, CyclicEstimate, MotionModel};

/// Share of the computed variance of an angle that is reported. The spread between people is taken wider and the evidence on the
/// phase weaker than measured, for the gains' sake; without this share the bands hold more than they say.
pub const BAND_CALIBRATION: f32 = 0.9;

impl<const N: usize> CoupledFilter<N> {
    /// One frame: predict over the measurement's step, then correct by the angles seen. On x86-64 what every frame needs is inlined, so
    /// that a caller compiled for wider vectors than the crate has them; elsewhere it would cost flash.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn step(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        self.predict(model, measurement.step_frames());
        self.correct(model, measurement)
    }

    /// Corrects by the angles seen, after the grid has told whether the position is still the right one.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn correct(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        let mode = if measurement.is_empty(model.angle_count()) { None } else { self.watch(model, measurement) };
        if self.watch.searching {
            return self.estimate_of_all_places(model, measurement, mode);
        }
        let judgement = self.correct_phase(model, measurement);
        self.watch.nis.see(&judgement, measurement.step_frames());
        self.estimate(model, judgement.log_likelihood, judgement.outlier)
    }

    /// The estimate after `measurement` was taken in, without its likelihood.
    pub fn present(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        if self.watch.searching {
            return self.estimate_of_all_places(model, measurement, None);
        }
        self.estimate(model, 0.0, false)
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn estimate(&self, model: &MotionModel<'_>, log_likelihood: f32, outlier: bool) -> CyclicEstimate<N> {
        let slope = self.pose_slope(model);
        let (basis, band_calibration) = (Basis::at(self.position), self.band_calibration());
        let mut angle_variance_rad2 = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let outlook = self.blocks[i].outlook(&basis, slope[i]);
            angle_variance_rad2[i] = band_calibration * (outlook.variance + self.pair.along(&outlook.gradient));
        }
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2,
            cycle_position: self.position,
            cycle_position_variance: self.pair.cc,
            cycle_velocity_per_frame: self.velocity,
            cycle_velocity_variance: self.pair.vv,
            log_likelihood,
            outlier,
        }
    }

    /// Factor of the computed variances of the angles that is reported: [`BAND_CALIBRATION`], and more where measurements are taken for
    /// better than their standard deviations say. Noise that moves slowly cannot be told from such, so that bands stay as wide as told.
    #[must_use]
    pub fn band_calibration(&self) -> f32 {
        BAND_CALIBRATION * self.watch.noise.band_scale()
    }
}
