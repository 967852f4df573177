//! A step of the phase-coupled filter: predict, update the grid, correct, estimate.

use crate::cyclic::coupled::person::block::{AnglePrediction, Basis};
use crate::cyclic::coupled::phase::evidence::FrameInnovation;
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::{AngleMeasurement, CoupledModel, CyclicEstimate};
use crate::math::max;

impl<const N: usize> CoupledFilter<N> {
    /// One frame: predict over the measurement's step, then correct by the angles seen. On x86-64
    /// what every frame needs is inlined, so that a caller compiled for wider vectors than the
    /// crate has them. Elsewhere it would cost flash.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn step(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        self.predict(model, measurement.step_frames());
        self.correct(model, measurement)
    }

    /// Moves on by `step_frames`, in substeps of one frame, longer ones where that would be more
    /// than [`MAX_SUBSTEPS`](crate::cyclic::coupled::hypothesis::predict::MAX_SUBSTEPS).
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn predict(&mut self, model: &CoupledModel<'_>, step_frames: f32) {
        self.leader.predict(model, step_frames);
        if self.rival.exists() {
            self.rival.hypothesis.predict(model, step_frames);
        }
        self.unwatched_frames += step_frames;
        let cycles = step_frames * model.mean_cycle_velocity();
        self.misfit_cycles = max(self.misfit_cycles - cycles, 0.0);
        if self.second_speed_cycles > 0.0 {
            self.second_speed_cycles = max(self.second_speed_cycles - cycles, 0.0);
            if self.second_speed_cycles == 0.0 {
                self.rival.end();
            }
        }
    }

    /// Corrects by the measured angles, after the grid was updated. The better of leader and rival
    /// leads.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn correct(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        let mode = if measurement.is_empty(model.angle_count()) { None } else { self.watch(model, measurement) };
        if self.searching {
            return self.estimate_of_all_places(model, measurement, mode);
        }
        let innovation = self.correct_hypotheses(model, measurement);
        self.update_angles(model, measurement);
        self.estimate(model, innovation.log_likelihood, innovation.outlier)
    }

    /// Corrects leader and rival; returns the innovation of the one that leads then. The rival
    /// comes first, so that both are judged by the same noise: the leader's correction learns it.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn correct_hypotheses(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> FrameInnovation {
        let (winding, noise) = (&self.winding, &mut self.noise);
        if !self.rival.exists() {
            return self.leader.correct(model, measurement, winding, (noise, true));
        }
        let other = self.rival.hypothesis.correct(model, measurement, winding, (noise, false));
        let learns = self.second_speed_cycles > 0.0;
        let innovation = self.leader.correct(model, measurement, winding, (noise, learns));
        if !self.rival.beats(&other, &innovation) {
            return innovation;
        }
        self.lead_by_rival();
        other
    }

    /// The estimate after the last correction, by `measurement`, without its likelihood.
    pub fn current_estimate(
        &mut self,
        model: &CoupledModel<'_>,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        if self.searching {
            return self.estimate_of_all_places(model, measurement, None);
        }
        self.estimate(model, 0.0, false)
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn estimate(&self, model: &CoupledModel<'_>, log_likelihood: f32, outlier: bool) -> CyclicEstimate<N> {
        let slope = self.leader.pose_slope(model);
        let basis = Basis::at(self.leader.position);
        let mut angle_variance_rad2 = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let prediction = self.leader.blocks[i].predict_angle(&basis, slope[i]);
            angle_variance_rad2[i] = self.angle_variance_rad2(i, &prediction);
        }
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2,
            cycle_position: self.leader.position,
            cycle_position_variance: self.leader.pair.cc,
            cycle_velocity_per_frame: self.leader.travelled_velocity(model),
            cycle_velocity_variance: self.leader.pair.vv,
            log_likelihood,
            outlier,
            misfit: self.is_misfit(),
        }
    }

    /// Variance of the angle at `index`, rad^2, by the leader's prediction of it.
    #[inline(always)]
    pub(super) fn angle_variance_rad2(&self, index: usize, prediction: &AnglePrediction) -> f32 {
        self.band_scale(index) * (prediction.variance + self.leader.pair.along(&prediction.gradient))
    }

    /// Whether the motion is another than the model's, or was within the last cycle.
    pub(super) fn is_misfit(&self) -> bool {
        self.leader.spread_scale.is_misfit() || self.misfit_cycles > 0.0
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
