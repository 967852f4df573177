//! The pelvic lift: hands, feet and head stay where they were at first (PIK (38), section 7.3). The
//! root's part, PIK (39), is [`crate::pik::root::RootProcess::pelvic_lift`].

use crate::kinematics::inverse::Goal;
use crate::math::Mat3;
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals};
use crate::random::Stream;

/// g_t+1 = g_1 for every end-effector.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalPast, GoalProcess, Goals, MEMORY};
/// use sinew_core::pik::processes::pelvic_lift::FixedGoals;
/// use sinew_core::random::Stream;
///
/// // Feet that stay where they first were, though the pose has slipped by three centimetres.
/// let (first_m, slipped_m) = ([Vec3::new(0.1, 0.9, 3.0)], [Vec3::new(0.13, 0.9, 3.0)]);
/// let past = GoalPast { first_m: &first_m, is_first: false, ..goal_past(&slipped_m) };
/// let feet = FixedGoals { end_effectors: &[0], reach_std_m: 0.02 };
/// let mut goals = Goals::new();
/// feet.draw(&past, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0), &mut goals);
/// assert_eq!(goals[0].position_m, first_m[0]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedGoals<'a> {
    /// Bones whose ends stay.
    pub end_effectors: &'a [usize],
    /// How closely they stay, metres.
    pub reach_std_m: f32,
}

impl<const BONES: usize> GoalProcess<BONES> for FixedGoals<'_> {
    fn end_effectors(&self) -> &[usize] {
        self.end_effectors
    }

    fn draw(&self, past: &GoalPast<'_, BONES>, _memory: &mut GoalMemory, _stream: &mut Stream, goals: &mut Goals) {
        let precision = Mat3::identity() / (self.reach_std_m * self.reach_std_m);
        for &bone in self.end_effectors {
            if let Some(&position_m) = past.first_m.get(bone) {
                // Goals beyond the capacity are no goals; MAX_GOALS says so.
                let _ = goals.push(Goal { bone, position_m, precision });
            }
        }
    }
}
