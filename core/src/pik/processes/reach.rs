//! A straight reach: the goal runs along the line from the hand to a target (PIK paper, section
//! 4.3, first example).

use crate::kinematics::inverse::Goal;
use crate::math::{Mat3, Vec3, length, min, sqrt};
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals};
use crate::random::Stream;

/// A hand that goes to `target_m` at a speed, and stays there.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalProcess, Goals, MEMORY};
/// use sinew_core::pik::processes::reach::StraightReach;
/// use sinew_core::random::Stream;
///
/// // To a cup, by half a metre a second; the hand is 13 cm away.
/// let cup_m = Vec3::new(0.05, 0.12, 2.0);
/// let reach =
///     StraightReach { hand: [0], target_m: cup_m, speed_m_per_s: 0.5, std_m_per_sqrt_s: 0.0, reach_std_m: 0.02 };
/// let mut at_m = [Vec3::new(0.0, 0.0, 2.0)];
/// for wanted_m in [0.08, 0.03, 0.0] {
///     let past = goal_past(&at_m);
///     let mut goals = Goals::new();
///     reach.draw(&past, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0), &mut goals);
///     at_m[0] = goals[0].position_m;
///     assert!(((cup_m - at_m[0]).norm() - wanted_m).abs() < 1e-4, "it ends at the cup");
/// }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightReach {
    /// The bone whose end reaches.
    pub hand: [usize; 1],
    /// Where to, metres.
    pub target_m: Vec3,
    /// How fast, metres a second.
    pub speed_m_per_s: f32,
    /// Standard deviation of the goal after one second along each axis, metres.
    pub std_m_per_sqrt_s: f32,
    /// How closely a goal is reached, metres.
    pub reach_std_m: f32,
}

impl<const BONES: usize> GoalProcess<BONES> for StraightReach {
    fn end_effectors(&self) -> &[usize] {
        &self.hand
    }

    fn draw(&self, past: &GoalPast<'_, BONES>, _memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        let [bone] = self.hand;
        let Some(reached_m) = past.reached_m.get(bone) else { return };
        let way = self.target_m - reached_m;
        let distance = length(&way);
        let step = min(self.speed_m_per_s * past.dt_s, distance);
        let ahead = if distance > 0.0 { reached_m + way * (step / distance) } else { self.target_m };
        let position_m = ahead + stream.normal3() * (self.std_m_per_sqrt_s * sqrt(past.dt_s));
        let precision = Mat3::identity() / (self.reach_std_m * self.reach_std_m);
        let _ = goals.push(Goal { bone, position_m, precision });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_goal_keeps_to_the_line_and_ends_at_the_target() {
        let reach = StraightReach {
            hand: [0],
            target_m: Vec3::new(1.0, 2.0, 2.0),
            speed_m_per_s: 0.6,
            std_m_per_sqrt_s: 0.0,
            reach_std_m: 0.02,
        };
        let mut at = [Vec3::zeros()];
        let first = at;
        for step in 1..=60 {
            let past = GoalPast {
                reached_m: &at,
                velocity_m_per_s: &first,
                noise_share: &[1.0; 1],
                first_m: &first,
                root_shift_m: Vec3::zeros(),
                dt_s: 0.1,
                is_first: step == 1,
            };
            let mut goals = Goals::new();
            reach.draw(&past, &mut [0.0; 32], &mut Stream::new(1, step, 0), &mut goals);
            at[0] = goals[0].position_m;
            let wanted = Vec3::new(1.0, 2.0, 2.0) / 3.0 * (0.06 * step as f32).min(3.0);
            assert!((at[0] - wanted).norm() < 1.0e-4, "{:?} {wanted:?}", at[0]);
        }
    }
}
