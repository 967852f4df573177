//! Correction of the phase-coupled filter: an extended Kalman update of phase and angles.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::constants::GATE_SIGMAS;
use crate::cyclic::coupled::hypothesis::Hypothesis;
use crate::cyclic::coupled::measurement::measurement_noise::MeasurementNoise;
use crate::cyclic::coupled::measurement::winding::Winding;
use crate::cyclic::coupled::person::block::{AnglePrediction, Basis};
use crate::cyclic::coupled::person::spread_scale::FrameProducts;
use crate::cyclic::coupled::phase::evidence::{FrameInnovation, PhaseEvidence};
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::{max, sqrt, wrap_angle};

/// Whether an angle's innovation of that variance, rad^2, lies beyond the gate. It does not inform
/// the phase then, and its offset is learned again.
#[inline(always)]
pub(crate) fn is_beyond_gate(residual: f32, variance: f32) -> bool {
    residual * residual > GATE_SIGMAS * GATE_SIGMAS * variance && is_on(Part::AngleGate)
}

impl<const N: usize> Hypothesis<N> {
    /// The extended Kalman correction about the present position; returns the innovation.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(crate) fn correct(
        &mut self,
        model: &CoupledModel<'_>,
        measurement: &AngleMeasurement<N>,
        winding: &Winding<N>,
        (noises, learns): (&mut MeasurementNoise<N>, bool),
    ) -> FrameInnovation {
        let point = model.point(self.position);
        let (pose, slope) = (model.mean_pose_rad::<N>(point), self.pose_slope(model));
        let basis = Basis::at(self.position);
        let mut evidence = PhaseEvidence::none(model.winds());
        let mut products = FrameProducts::NONE;
        let mut seen: [Option<(AnglePrediction, f32, f32)>; N] = [None; N];
        for i in 0..model.angle_count().min(N) {
            let Some(measured) = measurement.angle_rad(i) else { continue };
            let stated = measurement.std_rad()[i] * measurement.std_rad()[i];
            let noise = noises.scale(i) * stated;
            let residual = self.residual(i, measured - pose[i], &basis);
            let mut prediction = self.blocks[i].predict_angle(&basis, slope[i]);
            let given = prediction.variance + noise;
            let (total, informs_phase) = (given + self.pair.along(&prediction.gradient), winding.informs_phase(i));
            let innovations = [residual, self.last_innovation_rad[i]];
            self.last_innovation_rad[i] = residual;
            products.add(innovations, max(total, total - noise + stated));
            if informs_phase {
                evidence.add(&prediction.gradient, given, residual);
                if learns {
                    noises.add(i, [stated, noise, total - noise], innovations);
                }
            } else {
                evidence.add_excluded(total, residual);
            }
            if is_beyond_gate(residual, total) {
                self.blocks[i].inflate_offset(residual * residual);
                prediction.inflate_offset(residual * residual);
            } else if informs_phase {
                evidence.add_gated(&prediction.gradient, given, residual);
            }
            seen[i] = Some((prediction, noise, residual));
        }
        if learns {
            noises.update();
        }
        let innovation = evidence.innovation(&self.pair);
        let shift = self.pair.correct(&evidence.gated);
        for (block, seen) in self.blocks.iter_mut().zip(&seen) {
            block.follow(shift);
            if let Some((prediction, noise, residual)) = seen {
                block.correct(prediction, *noise, *residual, shift);
                block.mean[0] = wrap_angle(block.mean[0]);
            }
        }
        // In an even circle an offset and a leading phase are the same: no spread can be learned.
        let growth = if model.winds() { 1.0 } else { self.spread_scale.update(&products, model.mean_cycle_velocity()) };
        if growth > 1.0 {
            self.blocks.iter_mut().for_each(|block| block.inflate(growth));
        }
        self.shift_by(model, shift);
        innovation
    }

    /// Innovation of the angle at `index`, which is measured `off_rad` from the mean pose.
    #[inline(always)]
    pub(crate) fn residual(&self, index: usize, off_rad: f32, basis: &Basis) -> f32 {
        wrap_angle(off_rad - self.blocks[index].deviation(basis))
    }

    /// Slope of the mean pose by the position, rad per cycle: the secant over one standard
    /// deviation of c to either side (statistical linearisation). A tangent would hold the position
    /// at a jump.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn pose_slope(&self, model: &CoupledModel<'_>) -> [f32; N] {
        let half_width = if is_on(Part::Secant) { sqrt(self.pair.cc) } else { 0.0 };
        model.mean_pose_secant(self.position, half_width)
    }
}
