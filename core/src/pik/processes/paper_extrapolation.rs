//! Linear extrapolation as the PIK paper prints it (eq. 33): of the particle's own sampled goals, with full velocity.

use crate::kinematics::inverse::Goal;
use crate::math::{Mat3, Vec3};
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals, MEMORY};
use crate::random::Stream;

/// Goals that are remembered: two triples each.
const MOST: usize = MEMORY / 6;

/// g_t+1 ~ N(g_t + (g_t - g_t-1), sigma^2 I). The goal of the frame before the first is the place reached there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperGoals<'a> {
    /// Bones whose ends have goals; those beyond the fifth have none.
    pub end_effectors: &'a [usize],
    /// sigma of eq. (33), metres a frame.
    pub std_m: f32,
    /// W = 1 / std^2 of eq. (3), metres.
    pub reach_std_m: f32,
}

impl<const BONES: usize> GoalProcess<BONES> for PaperGoals<'_> {
    fn end_effectors(&self) -> &[usize] {
        self.end_effectors.get(..MOST).unwrap_or(self.end_effectors)
    }

    fn draw(&self, past: &GoalPast<'_, BONES>, memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        let bones = GoalProcess::<BONES>::end_effectors(self);
        for (&bone, kept) in bones.iter().zip(memory.chunks_exact_mut(6)) {
            let Some(reached_m) = past.reached_m.get(bone) else { continue };
            if past.is_first {
                kept[..3].copy_from_slice(reached_m.as_slice());
                kept[3..].copy_from_slice(reached_m.as_slice());
            }
            let (now, before) = (Vec3::new(kept[0], kept[1], kept[2]), Vec3::new(kept[3], kept[4], kept[5]));
            let position_m = now + (now - before) + stream.normal3() * self.std_m;
            kept[3..].copy_from_slice(now.as_slice());
            kept[..3].copy_from_slice(position_m.as_slice());
            let precision = Mat3::identity() / (self.reach_std_m * self.reach_std_m);
            // No more than memory has room for, which is less than goals have.
            let _ = goals.push(Goal { bone, position_m, precision });
        }
    }
}
