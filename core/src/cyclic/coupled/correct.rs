//! Correction of the phase-coupled filter: an extended Kalman update of phase and angles.

use crate::cyclic::coupled::block::{Basis, Outlook};
use crate::cyclic::coupled::evidence::{Judgement, PhaseEvidence};
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::{AngleMeasurement, MotionModel};
use crate::math::{clamp, sqrt, wrap_angle};

/// An angle this many standard deviations off says nothing about the phase, and its own constant is learned anew.
pub(super) const GATE_SIGMAS: f32 = 4.0;

impl<const N: usize> CoupledFilter<N> {
    /// The extended Kalman correction about the present position; gives how the measurement fitted the prediction.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn correct_phase(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> Judgement {
        let point = model.point(self.position);
        let (pose, slope) = (model.mean_pose_rad::<N>(point), self.pose_slope(model));
        let basis = Basis::at(self.position);
        let (told_scale, share) = (self.watch.nis.noise_scale(), self.watch.noise.share());
        let mut evidence = PhaseEvidence::none(model.winds(), self.watch.noise.score());
        let mut seen: [Option<(Outlook, f32, f32)>; N] = [None; N];
        for i in 0..model.angle_count().min(N) {
            let Some(measured) = measurement.angle_rad(i) else { continue };
            let told = told_scale * measurement.std_rad()[i] * measurement.std_rad()[i];
            let noise = share * told;
            let residual = wrap_angle(measured - pose[i] - self.blocks[i].deviation(&basis));
            let mut outlook = self.blocks[i].outlook(&basis, slope[i]);
            let given = outlook.variance + noise;
            let (total, is_believed) = (given + self.pair.along(&outlook.gradient), self.winding.is_believed(i));
            if is_believed {
                evidence.add(&outlook.gradient, given, residual);
                evidence.noise.add(told, total - noise, residual);
            } else {
                evidence.add_apart(total, residual);
            }
            if residual * residual > GATE_SIGMAS * GATE_SIGMAS * total {
                self.blocks[i].loosen_offset(residual * residual);
                outlook.loosen_offset(residual * residual);
            } else if is_believed {
                evidence.trust(&outlook.gradient, given, residual);
            }
            seen[i] = Some((outlook, noise, residual));
        }
        self.watch.noise.see(&evidence.noise);
        let judgement = evidence.judge(&self.pair, told_scale * share);
        let shift = self.pair.correct(&evidence.trusted);
        for (block, seen) in self.blocks.iter_mut().zip(&seen) {
            block.follow(shift);
            if let Some((outlook, noise, residual)) = seen {
                block.correct(outlook, *noise, *residual, shift);
                block.mean[0] = wrap_angle(block.mean[0]);
            }
        }
        self.velocity = clamp(self.velocity + shift[1], -0.5, 0.5);
        self.move_by(clamp(shift[0], -0.5, 0.5));
        self.update_angles(model, measurement);
        judgement
    }

    /// Change of the mean pose with the position, rad per cycle, over as much of the cycle as the position is uncertain by (statistical
    /// linearisation): where the mean pose jumps its tangent would hold the position there.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn pose_slope(&self, model: &MotionModel<'_>) -> [f32; N] {
        model.mean_pose_secant(self.position, sqrt(self.pair.cc))
    }

    /// Angles from the state.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn update_angles(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) {
        let pose = model.mean_pose_rad::<N>(model.point(self.position));
        let basis = Basis::at(self.position);
        self.winding.complete(self.cycles);
        for i in 0..model.angle_count().min(N) {
            let (before, angle) = (self.angles_rad[i], wrap_angle(pose[i] + self.blocks[i].deviation(&basis)));
            self.turn_to(i, angle);
            let beyond = self.path.turns(i, [before, angle], measurement);
            self.turns[i] = self.turns[i].saturating_add(beyond);
            let turns_a_cycle = model.parts().turns_per_cycle.get(i).map_or(0, |turns| i32::from(*turns));
            self.winding.see(
                i,
                self.turns[i].wrapping_sub(turns_a_cycle.wrapping_mul(self.cycles)),
                self.angles_rad[i] - pose[i],
            );
        }
        self.winding.begin();
    }
}
