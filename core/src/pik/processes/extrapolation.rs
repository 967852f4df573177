//! Linear extrapolation of several end-effectors (PIK paper, eq. 33, with DESIGN.md's changes).

use crate::error::{ParameterError, Rule, positive};
use crate::kinematics::inverse::Goal;
use crate::math::{Mat3, Vec3};
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals, LinearExtrapolation, MAX_GOALS};
use crate::random::Stream;
use heapless::Vec;

/// Each end-effector goes on from the place that it *reached*, with a share of the filter's velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearGoals {
    end_effectors: Vec<usize, MAX_GOALS>,
    /// How each goal moves.
    pub process: LinearExtrapolation,
    /// How closely a goal is reached along each axis: W = 1 / std^2, metres.
    pub reach_std_m: f32,
}

impl LinearGoals {
    /// The process of the ends of the bones `end_effectors`, of a skeleton with `bones` bones.
    ///
    /// # Errors
    /// At most [`MAX_GOALS`] end-effectors, each in the skeleton; the standard deviation has to be positive.
    pub fn new(
        end_effectors: &[usize],
        bones: usize,
        process: LinearExtrapolation,
        reach_std_m: f32,
    ) -> Result<Self, ParameterError> {
        let mut list = Vec::new();
        for &bone in end_effectors {
            if bone >= bones {
                let rule = Rule::Within { low: 0.0, high: bones as f32 - 1.0 };
                return Err(ParameterError::new("end_effectors", rule));
            }
            let full = ParameterError::new("end_effectors", Rule::Capacity { capacity: MAX_GOALS });
            list.push(bone).map_err(|_| full)?;
        }
        Ok(Self { end_effectors: list, process, reach_std_m: positive("reach_std_m", reach_std_m)? })
    }

    fn goal(&self, bone: usize, position_m: Vec3, std_m: f32) -> Goal {
        Goal { bone, position_m, precision: Mat3::identity() / (self.reach_std_m * self.reach_std_m + std_m * std_m) }
    }
}

impl<const BONES: usize> GoalProcess<BONES> for LinearGoals {
    fn end_effectors(&self) -> &[usize] {
        &self.end_effectors
    }

    fn draw(&self, past: &GoalPast<'_, BONES>, _memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        for &bone in &self.end_effectors {
            let (Some(reached_m), Some(velocity)) = (past.reached_m.get(bone), past.velocity_m_per_s.get(bone)) else {
                continue;
            };
            let position_m = self.process.draw(reached_m, velocity, past.dt_s, stream);
            // As many goals as end-effectors fit.
            let _ = goals.push(self.goal(bone, position_m, 0.0));
        }
    }

    fn expect(&self, past: &GoalPast<'_, BONES>, _memory: &mut GoalMemory, _stream: &mut Stream, goals: &mut Goals) {
        for &bone in &self.end_effectors {
            let (Some(reached_m), Some(velocity)) = (past.reached_m.get(bone), past.velocity_m_per_s.get(bone)) else {
                continue;
            };
            let position_m = self.process.mean(reached_m, velocity, past.dt_s);
            let _ = goals.push(self.goal(bone, position_m, self.process.std_m(past.dt_s)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_effector_that_is_not_in_the_skeleton_is_refused() {
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
        let error = LinearGoals::new(&[2, 17], 17, process, 0.05).unwrap_err();
        assert_eq!((error.parameter, error.rule), ("end_effectors", Rule::Within { low: 0.0, high: 16.0 }));
        assert!(LinearGoals::new(&[1; 9], 17, process, 0.05).is_err());
        assert_eq!(LinearGoals::new(&[1], 17, process, 0.0).unwrap_err().parameter, "reach_std_m");
    }

    #[test]
    fn what_is_expected_is_the_mean_of_what_is_drawn_and_its_whole_spread() {
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
        let goals_of = LinearGoals::new(&[1], 2, process, 0.03).unwrap();
        let (reached, velocity) = ([Vec3::zeros(), Vec3::z()], [Vec3::zeros(), Vec3::x()]);
        let past = GoalPast {
            reached_m: &reached,
            velocity_m_per_s: &velocity,
            first_m: &reached,
            dt_s: 0.25,
            is_first: true,
        };
        let (mut memory, mut stream, mut expected) = ([0.0; 32], Stream::new(1, 0, 0), Goals::new());
        goals_of.expect(&past, &mut memory, &mut stream, &mut expected);
        let n = 4000;
        let (mut mean, mut square) = (Vec3::zeros(), 0.0);
        for _ in 0..n {
            let mut drawn = Goals::new();
            goals_of.draw(&past, &mut memory, &mut stream, &mut drawn);
            let off = drawn[0].position_m - expected[0].position_m;
            mean += off / n as f32;
            square += off.norm_squared() / (3 * n) as f32;
        }
        assert!(mean.norm() < 4.0 * 0.1 * (3.0 / n as f32).sqrt(), "{mean:?}");
        let variance = 1.0 / expected[0].precision[(0, 0)];
        assert!((variance / (square + 0.03 * 0.03) - 1.0).abs() < 0.06, "{variance} {square}");
    }
}
