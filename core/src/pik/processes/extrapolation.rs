//! Linear extrapolation of several end-effectors by PIK (33), with the velocity of the estimate.

use crate::error::{ParameterError, Rule, positive};
use crate::kinematics::inverse::Goal;
use crate::math::{Mat3, Vec3, max};
use crate::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals, LinearExtrapolation, MAX_GOALS};
use crate::random::Stream;
use heapless::Vec;

/// A limb without any noise still has a precision that is a number, square metres.
/// Chosen: a tenth of a millimetre, far below the noise of points.
const MIN_VARIANCE_M2: f32 = 1.0e-8;

/// Each end-effector goes on from the place that it *reached*, with a share of the filter's
/// velocity. Those that the root carries (head, hands) go on relative to it, the others (feet,
/// which stand) in space. Carried ones may go on along an arc about the joint that their limb hangs
/// on.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalPast, GoalProcess, Goals, LinearExtrapolation, MEMORY};
/// use sinew_core::pik::processes::extrapolation::LinearGoals;
/// use sinew_core::random::Stream;
///
/// // A root (bone 0) that stands and a hand (bone 1) that goes a metre a second to the right.
/// let places_m = [Vec3::zeros(), Vec3::new(0.3, 0.0, 2.0)];
/// let past = GoalPast { velocity_m_per_s: &[Vec3::zeros(), Vec3::x()], ..goal_past(&places_m) };
/// let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
/// let hand = LinearGoals::new(&[1], 2, process, 0.05)?.carrying(1);
/// let mut goals = Goals::new();
/// hand.expect(&past, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0), &mut goals);
/// assert!((goals[0].position_m - Vec3::new(0.35, 0.0, 2.0)).norm() < 1e-6, "half of that for a tenth of a second");
/// // A bone that is not there is refused.
/// assert!(LinearGoals::new(&[2], 2, process, 0.05).is_err());
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LinearGoals {
    end_effectors: Vec<usize, MAX_GOALS>,
    /// How many of the first end-effectors the root carries.
    pub carried: usize,
    /// The bones about whose ends the first of the carried end-effectors swing.
    joints: Vec<usize, MAX_GOALS>,
    /// How each goal moves.
    pub process: LinearExtrapolation,
    /// Standard deviations of the first end-effectors after one second, metres, in place of the
    /// process's.
    std_m_per_sqrt_s: Vec<f32, MAX_GOALS>,
    /// How closely a goal is reached along each axis, metres: W = 1 / std^2, of a limb that has all
    /// of its noise. A drawn goal of one at rest, which has less, is reached as much more
    /// closely; what is expected of it is not.
    pub reach_std_m: f32,
}

impl LinearGoals {
    /// The process of the ends of the bones `end_effectors`, of a skeleton with `bones` bones.
    ///
    /// # Errors
    /// At most [`MAX_GOALS`] end-effectors, each in the skeleton; the standard deviation has to be
    /// positive.
    pub fn new(
        end_effectors: &[usize],
        bones: usize,
        process: LinearExtrapolation,
        reach_std_m: f32,
    ) -> Result<Self, ParameterError> {
        Ok(Self {
            end_effectors: list_of("end_effectors", end_effectors, bones)?,
            carried: 0,
            joints: Vec::new(),
            process,
            std_m_per_sqrt_s: Vec::new(),
            reach_std_m: positive("reach_std_m", reach_std_m)?,
        })
    }

    /// The first `count` end-effectors are carried by the root, whose place is the first bone's
    /// end.
    #[must_use]
    pub fn carrying(mut self, count: usize) -> Self {
        self.carried = count;
        self
    }

    /// The first end-effectors, as far as they are carried, swing about the ends of the bones
    /// `joints`, one each, of a skeleton with `bones` bones. They go on along arcs about them
    /// ([`LinearExtrapolation::mean_about`]).
    ///
    /// # Errors
    /// At most [`MAX_GOALS`] bones, each in the skeleton.
    pub fn swinging_about(mut self, joints: &[usize], bones: usize) -> Result<Self, ParameterError> {
        self.joints = list_of("joints", joints, bones)?;
        Ok(self)
    }

    /// The first end-effectors spread by standard deviations of their own: hands are quicker than a
    /// head.
    ///
    /// # Errors
    /// At most [`MAX_GOALS`] numbers, metres by root second, none below zero.
    pub fn spreading_by(mut self, std_m_per_sqrt_s: &[f32]) -> Result<Self, ParameterError> {
        const NAME: &str = "std_m_per_sqrt_s";
        if !std_m_per_sqrt_s.iter().all(|std| std.is_finite() && *std >= 0.0) {
            return Err(ParameterError::new(NAME, Rule::NotNegative));
        }
        let too_many = |_| ParameterError::new(NAME, Rule::Capacity { capacity: MAX_GOALS });
        self.std_m_per_sqrt_s = Vec::from_slice(std_m_per_sqrt_s).map_err(too_many)?;
        Ok(self)
    }

    /// How the end-effector at `index` of the list moves.
    fn process_of(&self, index: usize) -> LinearExtrapolation {
        let std_m_per_sqrt_s = self.std_m_per_sqrt_s.get(index).copied().unwrap_or(self.process.std_m_per_sqrt_s);
        LinearExtrapolation { std_m_per_sqrt_s, ..self.process }
    }

    /// Where each end-effector goes on the mean, how far it spreads and how closely it is reached,
    /// metres, with its bone.
    fn means<'p, const BONES: usize>(
        &'p self,
        past: &'p GoalPast<'_, BONES>,
    ) -> impl Iterator<Item = (usize, Vec3, Looseness)> + 'p {
        let root_velocity = past.velocity_m_per_s.first().copied().unwrap_or_default();
        let place = move |bone: usize| Some((*past.reached_m.get(bone)?, *past.velocity_m_per_s.get(bone)?));
        self.end_effectors.iter().enumerate().filter_map(move |(index, &bone)| {
            let (reached_m, velocity) = place(bone)?;
            let share = past.noise_share.get(bone).copied().unwrap_or(1.0);
            let std_m = self.process_of(index).std_m(past.dt_s) * share;
            let loose = Looseness { std_m, reach_std_m: self.reach_std_m * share };
            if index >= self.carried {
                return Some((bone, self.process.mean(&reached_m, &velocity, past.dt_s), loose));
            }
            let with_root = |(place_m, velocity)| (place_m + past.root_shift_m, velocity - root_velocity);
            let (reached_m, velocity) = with_root((reached_m, velocity));
            let mean_m = match self.joints.get(index).and_then(|&joint| place(joint)).map(with_root) {
                Some(joint) => self.process.mean_about((reached_m, velocity), joint, past.dt_s),
                None => self.process.mean(&reached_m, &velocity, past.dt_s),
            };
            Some((bone, mean_m, loose))
        })
    }
}

/// How far a goal may be missed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Looseness {
    /// Spread of the goal itself, metres.
    std_m: f32,
    /// How closely the end-effector comes to it, metres.
    reach_std_m: f32,
}

/// The goal of a bone's end that is missed by so much along each axis; a tenth of a millimetre
/// counts as none.
fn goal(bone: usize, position_m: Vec3, variance_m2: f32) -> Goal {
    Goal { bone, position_m, precision: Mat3::identity() / max(variance_m2, MIN_VARIANCE_M2) }
}

/// A list of bones of a skeleton with `bones` bones.
fn list_of(name: &'static str, members: &[usize], bones: usize) -> Result<Vec<usize, MAX_GOALS>, ParameterError> {
    let mut list = Vec::new();
    for &bone in members {
        if bone >= bones {
            let rule = Rule::Within { low: 0.0, high: bones as f32 - 1.0 };
            return Err(ParameterError::new(name, rule));
        }
        list.push(bone).map_err(|_| ParameterError::new(name, Rule::Capacity { capacity: MAX_GOALS }))?;
    }
    Ok(list)
}

impl<const BONES: usize> GoalProcess<BONES> for LinearGoals {
    fn end_effectors(&self) -> &[usize] {
        &self.end_effectors
    }

    fn draw(&self, past: &GoalPast<'_, BONES>, _memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        for (bone, mean_m, Looseness { std_m, reach_std_m }) in self.means(past) {
            let position_m = mean_m + stream.normal3() * std_m;
            // As many goals as end-effectors fit.
            let _ = goals.push(goal(bone, position_m, reach_std_m * reach_std_m));
        }
    }

    fn expect(&self, past: &GoalPast<'_, BONES>, _memory: &mut GoalMemory, _stream: &mut Stream, goals: &mut Goals) {
        for (bone, mean_m, Looseness { std_m, .. }) in self.means(past) {
            // The spread, which is most of it, follows the pace; W stays as it is.
            let _ = goals.push(goal(bone, mean_m, self.reach_std_m * self.reach_std_m + std_m * std_m));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_end_effector_that_is_not_in_the_skeleton_is_refused() {
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
        let error = LinearGoals::new(&[2, 17], 17, process, 0.05).unwrap_err();
        assert_eq!((error.parameter, error.rule), ("end_effectors", Rule::Within { low: 0.0, high: 16.0 }));
        assert!(LinearGoals::new(&[1; 9], 17, process, 0.05).is_err());
        let swinging = LinearGoals::new(&[2], 17, process, 0.05).unwrap().swinging_about(&[17], 17);
        assert_eq!(swinging.unwrap_err().parameter, "joints");
        assert_eq!(LinearGoals::new(&[1], 17, process, 0.0).unwrap_err().parameter, "reach_std_m");
        let spreading = LinearGoals::new(&[2], 17, process, 0.05).unwrap().spreading_by(&[-0.1]);
        assert_eq!(spreading.unwrap_err().parameter, "std_m_per_sqrt_s");
    }

    #[test]
    fn what_is_expected_is_the_mean_of_what_is_drawn_and_its_whole_spread() {
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
        // The process's own spread is not read where the end-effector has one.
        let unread = LinearExtrapolation { std_m_per_sqrt_s: 9.0, ..process };
        // Half of its own: a limb that hardly moves.
        let goals_of = LinearGoals::new(&[1], 2, unread, 0.03).unwrap().spreading_by(&[0.4]).unwrap();
        let (reached, velocity) = ([Vec3::zeros(), Vec3::z()], [Vec3::zeros(), Vec3::x()]);
        let past = GoalPast {
            reached_m: &reached,
            velocity_m_per_s: &velocity,
            noise_share: &[1.0, 0.5],
            first_m: &reached,
            root_shift_m: Vec3::zeros(),
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
        let mut drawn = Goals::new();
        goals_of.draw(&past, &mut memory, &mut stream, &mut drawn);
        let reach_std_m = (1.0 / drawn[0].precision[(0, 0)]).sqrt();
        assert!((reach_std_m - 0.015).abs() < 1.0e-6, "half of it too: {reach_std_m}");
        let variance = 1.0 / expected[0].precision[(0, 0)];
        assert!((variance / (square + 0.03 * 0.03) - 1.0).abs() < 0.06, "{variance} {square}");
    }

    #[test]
    fn what_the_root_carries_goes_with_it_and_feet_stay() {
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.0 };
        let goals_of = LinearGoals::new(&[1, 2], 3, process, 0.03).unwrap().carrying(1);
        let reached = [Vec3::zeros(), Vec3::z(), Vec3::y()];
        let velocity = [Vec3::x(), Vec3::x() * 3.0, Vec3::zeros()];
        let root_shift_m = Vec3::new(0.2, 0.1, 0.0);
        let past = GoalPast {
            reached_m: &reached,
            velocity_m_per_s: &velocity,
            noise_share: &[1.0; 3],
            first_m: &reached,
            root_shift_m,
            dt_s: 0.1,
            is_first: false,
        };
        let mut goals = Goals::new();
        goals_of.draw(&past, &mut [0.0; 32], &mut Stream::new(1, 0, 0), &mut goals);
        // Half of the two metres a second that it is faster than the root.
        assert!((goals[0].position_m - (Vec3::z() + root_shift_m + Vec3::x() * 0.1)).norm() < 1.0e-6);
        assert_eq!(goals[1].position_m, Vec3::y());
    }

    proptest! {
        /// About its joint a place keeps its distance but for what it goes out or in, and goes the
        /// way that it went.
        #[test]
        fn what_swings_goes_along_an_arc(x in -1.0_f32..1.0, y in -1.0_f32..1.0, z in -3.0_f32..3.0, out in -0.5_f32..0.5) {
            let process = LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s: 0.0 };
            let goals_of = LinearGoals::new(&[2], 3, process, 0.03).unwrap().carrying(1);
            let goals_of = goals_of.swinging_about(&[1], 3).unwrap();
            // A limb of half a metre along the third axis, on a joint that goes with the root.
            let root_velocity = Vec3::new(x, y, z);
            let turning = Vec3::new(z, x, 0.0);
            let reached = [Vec3::zeros(), Vec3::x(), Vec3::x() + Vec3::z() * 0.5];
            let velocity = [root_velocity, root_velocity, root_velocity + turning + Vec3::z() * out];
            let past = GoalPast {
                reached_m: &reached, velocity_m_per_s: &velocity, noise_share: &[1.0; 3], first_m: &reached,
                root_shift_m: root_velocity * 0.1, dt_s: 0.1, is_first: false,
            };
            let mut goals = Goals::new();
            goals_of.draw(&past, &mut [0.0; 32], &mut Stream::new(1, 0, 0), &mut goals);
            let limb_m = goals[0].position_m - (reached[1] + past.root_shift_m);
            prop_assert!((limb_m.norm() - (0.5 + 0.1 * out)).abs() < 1.0e-5);
            let straight_m = Vec3::z() * (0.5 + 0.1 * out) + turning * 0.1;
            prop_assert!(limb_m.normalize().dot(&straight_m.normalize()) > 1.0 - 1.0e-5);
        }
    }
}
