//! Linear extrapolation as PIK (33) prints it: of the particle's own sampled goals, with full
//! velocity.

use crate::kinematics::inverse::Goal;
use crate::math::{Mat3, Vec3};
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals, MEMORY};
use crate::random::Stream;

/// Goals that are remembered: two triples each.
const MOST: usize = MEMORY / 6;

/// g_t+1 ~ N(g_t + (g_t - g_t-1), sigma^2 I). The goal of the frame before the first is the place
/// reached there.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalPast, GoalProcess, Goals, MEMORY};
/// use sinew_core::pik::processes::paper_extrapolation::PaperGoals;
/// use sinew_core::random::Stream;
///
/// // Goals go on by their own last step, whether the hand follows or not; it stays at the origin here.
/// let hand_m = [Vec3::zeros()];
/// let past = goal_past(&hand_m);
/// let process = PaperGoals { end_effectors: &[0], std_m: 0.01, reach_std_m: 0.02 };
/// let (mut memory, mut stream, mut steps_m) = ([0.0; MEMORY], Stream::new(1, 0, 0), [Vec3::zeros(); 20]);
/// for (frame, step_m) in steps_m.iter_mut().enumerate() {
///     let mut goals = Goals::new();
///     process.draw(&GoalPast { is_first: frame == 0, ..past }, &mut memory, &mut stream, &mut goals);
///     *step_m = goals[0].position_m;
/// }
/// assert!(steps_m[19].norm() > 0.1, "twenty steps of a centimetre each have drifted away: {:?}", steps_m[19]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperGoals<'a> {
    /// Bones whose ends have goals; those beyond the fifth have none.
    pub end_effectors: &'a [usize],
    /// sigma of PIK (33), metres a frame.
    pub std_m: f32,
    /// W = 1 / std^2 of PIK (3), metres.
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
