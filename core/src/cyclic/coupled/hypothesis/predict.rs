//! Prediction of the phase-coupled filter over a step of any length.

use crate::cyclic::CoupledModel;
use crate::cyclic::coupled::constants::{FORGETTING, LINEAR_CYCLES};
use crate::cyclic::coupled::hypothesis::{Hypothesis, spread};
use crate::cyclic::coupled::person::block::PARTS;
use crate::cyclic::substeps::Substeps;
use crate::math::{abs, exp, max};

/// Most substeps of a step. Chosen: bounded work after a gap, with estimates nearly those of a step
/// a frame.
pub const MAX_SUBSTEPS: u8 = 5;

impl<const N: usize> Hypothesis<N> {
    /// Moves on by `step_frames`, in substeps of one frame, longer ones where that would be more
    /// than [`MAX_SUBSTEPS`].
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn predict(&mut self, model: &CoupledModel<'_>, step_frames: f32) {
        for step in Substeps::few(step_frames, MAX_SUBSTEPS) {
            self.advance(model, step);
        }
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn advance(&mut self, model: &CoupledModel<'_>, step: f32) {
        let (map, rest) = self.pair.advance(step);
        let phase = step * max(abs(self.velocity), 0.1 * model.mean_cycle_velocity());
        let memory = exp(-FORGETTING * phase);
        let lost = self.pair.cc > LINEAR_CYCLES * LINEAR_CYCLES;
        for i in 0..model.angle_count().min(N) {
            if lost {
                // The linearisation by (c, v) does not hold.
                self.blocks[i].regression = [[0.0; 2]; PARTS];
            }
            self.blocks[i].advance(&spread(model, i).scaled(self.spread_scale.scale()), phase, memory, &map, &rest);
        }
        self.move_by(step * self.velocity);
    }
}
