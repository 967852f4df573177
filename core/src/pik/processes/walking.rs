//! Walking: one foot is planted, the other never below the floor (PIK paper, section 4.3, second
//! example).

use crate::kinematics::inverse::Goal;
use crate::math::{Mat3, Vec3, length, sqrt};
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals, LinearExtrapolation};
use crate::random::Stream;

/// Goals of both ankles; the floor is a plane.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalPast, GoalProcess, Goals, LinearExtrapolation, MEMORY};
/// use sinew_core::pik::processes::walking::WalkingGoals;
/// use sinew_core::random::Stream;
///
/// // The floor is a metre below the camera; y is down. The first ankle stands on it, the other comes down upon it.
/// let walking = WalkingGoals {
///     ankles: [0, 1],
///     up: -Vec3::y(),
///     ankle_height_m: -1.0,
///     swing: LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s: 0.0 },
///     planted_std_m_per_sqrt_s: 0.01,
///     reach_std_m: 0.03,
/// };
/// let ankles_m = [Vec3::new(0.1, 1.0, 3.0), Vec3::new(-0.1, 0.95, 3.0)];
/// let past = GoalPast { velocity_m_per_s: &[Vec3::zeros(), Vec3::new(0.0, 1.0, -2.0)], ..goal_past(&ankles_m) };
/// let mut goals = Goals::new();
/// walking.draw(&past, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0), &mut goals);
/// assert!((goals[0].position_m - ankles_m[0]).norm() < 0.02, "planted");
/// assert!((goals[1].position_m - Vec3::new(-0.1, 1.0, 2.8)).norm() < 1e-6, "it would have gone through the floor");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WalkingGoals {
    /// Bones that end at the ankles.
    pub ankles: [usize; 2],
    /// Unit normal of the floor, upwards.
    pub up: Vec3,
    /// Height of the lowest place that an ankle can have: `up` times it, metres.
    pub ankle_height_m: f32,
    /// How the swinging foot goes on.
    pub swing: LinearExtrapolation,
    /// Standard deviation of the planted foot's goal after one second, metres.
    pub planted_std_m_per_sqrt_s: f32,
    /// How closely a goal is reached, metres.
    pub reach_std_m: f32,
}

impl WalkingGoals {
    /// Which of the two ankles is planted: the slower one by the filter's velocities, or the lower
    /// one where both stand.
    #[must_use]
    pub fn planted<const BONES: usize>(&self, past: &GoalPast<'_, BONES>) -> usize {
        let speeds = self.ankles.map(|bone| past.velocity_m_per_s.get(bone).map_or(0.0, length));
        let heights = self.ankles.map(|bone| past.reached_m.get(bone).map_or(0.0, |place| place.dot(&self.up)));
        // A metre a second of speed counts as much as a metre of height.
        usize::from(speeds[1] + heights[1] < speeds[0] + heights[0])
    }

    /// `place_m`, lifted to the floor where it lies below.
    fn above_floor(&self, place_m: Vec3) -> Vec3 {
        let below = self.ankle_height_m - place_m.dot(&self.up);
        if below > 0.0 { place_m + self.up * below } else { place_m }
    }
}

impl<const BONES: usize> GoalProcess<BONES> for WalkingGoals {
    fn end_effectors(&self) -> &[usize] {
        &self.ankles
    }

    fn draw(&self, past: &GoalPast<'_, BONES>, _memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        let planted = self.planted(past);
        for (foot, &bone) in self.ankles.iter().enumerate() {
            let (Some(reached_m), Some(velocity)) = (past.reached_m.get(bone), past.velocity_m_per_s.get(bone)) else {
                continue;
            };
            let drawn = if foot == planted {
                reached_m + stream.normal3() * (self.planted_std_m_per_sqrt_s * sqrt(past.dt_s))
            } else {
                self.swing.draw(reached_m, velocity, past.dt_s, stream)
            };
            let precision = Mat3::identity() / (self.reach_std_m * self.reach_std_m);
            let _ = goals.push(Goal { bone, position_m: self.above_floor(drawn), precision });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_foot_stays_and_none_goes_below_the_floor() {
        let walking = WalkingGoals {
            ankles: [0, 1],
            up: -Vec3::y(),
            ankle_height_m: -1.0,
            swing: LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s: 0.3 },
            planted_std_m_per_sqrt_s: 0.02,
            reach_std_m: 0.03,
        };
        let reached_m = [Vec3::new(0.1, 1.0, 3.0), Vec3::new(-0.1, 0.9, 3.0)];
        let velocity_m_per_s = [Vec3::zeros(), Vec3::new(0.0, 0.5, 1.5)];
        let past = GoalPast {
            reached_m: &reached_m,
            velocity_m_per_s: &velocity_m_per_s,
            noise_share: &[1.0; 2],
            first_m: &reached_m,
            root_shift_m: Vec3::zeros(),
            dt_s: 0.1,
            is_first: false,
        };
        assert_eq!(walking.planted(&past), 0);
        let mut lifted = 0;
        for seed in 0..300 {
            let mut goals = Goals::new();
            walking.draw(&past, &mut [0.0; 32], &mut Stream::new(seed, 0, 0), &mut goals);
            assert!((goals[0].position_m - reached_m[0]).norm() < 0.05);
            assert!(goals.iter().all(|goal| goal.position_m.y <= 1.0 + 1.0e-6));
            lifted += usize::from(goals[1].position_m.y == 1.0);
        }
        assert!((30..200).contains(&lifted), "{lifted} swinging goals met the floor");
    }
}
