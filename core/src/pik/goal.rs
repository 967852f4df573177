//! Goal processes: where an end-effector wants to be next.

use crate::kinematics::inverse::Goal;
use crate::math::{Vec3, sqrt};
use crate::random::Stream;
use heapless::Vec;

/// Most end-effectors that have goals.
pub const MAX_GOALS: usize = 8;
/// Numbers that a process may keep in each particle from frame to frame.
pub const MEMORY: usize = 32;
/// What a process keeps in a particle; zeros at first.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalMemory, GoalProcess, Goals, MEMORY};
/// use sinew_core::pik::processes::paper_extrapolation::PaperGoals;
/// use sinew_core::random::Stream;
///
/// // The paper's process goes on from the goal before, which each particle keeps: zeros at first.
/// let mut memory: GoalMemory = [0.0; MEMORY];
/// let at = [Vec3::new(0.1, 0.2, 2.0)];
/// let past = goal_past(&at);
/// let process = PaperGoals { end_effectors: &[0], std_m: 0.05, reach_std_m: 0.02 };
/// let mut goals = Goals::new();
/// process.draw(&past, &mut memory, &mut Stream::new(1, 0, 0), &mut goals);
/// assert_eq!(memory[..3], *goals[0].position_m.as_slice());
/// ```
pub type GoalMemory = [f32; MEMORY];
/// Goals of one frame.
///
/// ```
/// use sinew_core::kinematics::inverse::Goal;
/// use sinew_core::math::{Mat3, Vec3};
/// use sinew_core::pik::goal::{Goals, MAX_GOALS};
///
/// let goal = Goal { bone: 0, position_m: Vec3::zeros(), precision: Mat3::identity() };
/// let mut goals = Goals::new();
/// assert!((0..MAX_GOALS).all(|_| goals.push(goal).is_ok()));
/// assert!(goals.push(goal).is_err(), "a list without allocation has an end");
/// ```
pub type Goals = Vec<Goal, MAX_GOALS>;

/// What goals may follow from.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::goal::{GoalPast, LinearExtrapolation};
/// use sinew_core::pik::processes::walking::WalkingGoals;
///
/// // A step: the left ankle (bone 0) stands, the right one swings.
/// let ankles_m = [Vec3::new(0.1, 1.0, 3.0), Vec3::new(-0.1, 0.9, 3.0)];
/// let past = GoalPast {
///     reached_m: &ankles_m,
///     velocity_m_per_s: &[Vec3::zeros(), Vec3::new(0.0, 0.5, -1.5)],
///     noise_share: &[1.0; 2],
///     first_m: &ankles_m,
///     root_shift_m: Vec3::zeros(),
///     dt_s: 0.1,
///     is_first: false,
/// };
/// let walking = WalkingGoals {
///     ankles: [0, 1],
///     up: -Vec3::y(),
///     ankle_height_m: -1.0,
///     swing: LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s: 0.3 },
///     planted_std_m_per_sqrt_s: 0.02,
///     reach_std_m: 0.03,
/// };
/// assert_eq!(walking.planted(&past), 0);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct GoalPast<'a, const BONES: usize> {
    /// Ends of all bones that the particle reached in the frame before, metres.
    pub reached_m: &'a [Vec3; BONES],
    /// Their velocities by the filter's estimates, not the particle's own, metres a second. Beyond
    /// PIK (33).
    pub velocity_m_per_s: &'a [Vec3; BONES],
    /// Share of its noise that a goal of each bone's end has in this frame. One is all of it. A
    /// limb at rest may have less and an unobserved one more.
    /// [`LinearGoals`](super::processes::extrapolation::LinearGoals) keeps to it; other processes
    /// may.
    pub noise_share: &'a [f32; BONES],
    /// Ends of all bones in the pose that the tracking began with, metres.
    pub first_m: &'a [Vec3; BONES],
    /// How far the root goes in this frame, by its process or the points, metres.
    pub root_shift_m: Vec3,
    /// Time since the frame before, seconds.
    pub dt_s: f32,
    /// Whether this is the first step, with nothing yet in the memory.
    pub is_first: bool,
}

/// The page for users is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/own_motion_model.md")]
struct OwnMotionModel;

/// A stochastic process of the end-effectors' goals, p(g_t | g_1..t-1) (PIK paper, section 4.2).
/// Users may write their own: docs/own_motion_model.md.
///
/// ```
/// use sinew_core::kinematics::inverse::Goal;
/// use sinew_core::math::{Mat3, Vec3};
/// use sinew_core::pik::example::goal_past;
/// use sinew_core::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals, MEMORY};
/// use sinew_core::random::Stream;
///
/// /// A hand (bone 1 of 2) that is lifted by half a metre a second, y being down.
/// struct Lift;
///
/// impl GoalProcess<2> for Lift {
///     fn end_effectors(&self) -> &[usize] {
///         &[1]
///     }
///
///     fn draw(&self, past: &GoalPast<'_, 2>, _memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
///         let position_m = past.reached_m[1] - Vec3::y() * (0.5 * past.dt_s) + stream.normal3() * 0.01;
///         // One goal always has room.
///         let _ = goals.push(Goal { bone: 1, position_m, precision: Mat3::identity() / (0.02 * 0.02) });
///     }
/// }
///
/// let at = [Vec3::zeros(), Vec3::new(0.0, 0.3, 2.0)];
/// let past = GoalPast { dt_s: 0.2, ..goal_past(&at) };
/// let mut goals = Goals::new();
/// Lift.draw(&past, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0), &mut goals);
/// assert!((goals[0].position_m - Vec3::new(0.0, 0.2, 2.0)).norm() < 0.05);
/// ```
pub trait GoalProcess<const BONES: usize> {
    /// The bones whose ends have goals.
    fn end_effectors(&self) -> &[usize];

    /// Draws the next goals and adds them to `goals`, which is empty and takes [`MAX_GOALS`].
    fn draw(&self, past: &GoalPast<'_, BONES>, memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals);

    /// The goals' means, with the spread of the process added to what W forgives: what a guided
    /// proposal sets out from. Unless written, a draw.
    fn expect(&self, past: &GoalPast<'_, BONES>, memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        self.draw(past, memory, stream, goals);
    }
}

/// Linear extrapolation (PIK (33)) of the reached place, with a velocity that fades and white
/// noise.
///
/// The velocity is that of the filter's estimate, not of the particle: a particle does not go on
/// with its own noise.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::goal::LinearExtrapolation;
///
/// // Half of a metre a second goes on for a tenth of a second: five centimetres.
/// let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
/// let mean_m = process.mean(&Vec3::new(0.0, 0.0, 2.0), &Vec3::new(1.0, 0.0, 0.0), 0.1);
/// assert!((mean_m - Vec3::new(0.05, 0.0, 2.0)).norm() < 1e-6);
/// // The spread grows with the root of time.
/// assert!((process.std_m(0.4) - 2.0 * process.std_m(0.1)).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearExtrapolation {
    /// Share of the velocity that goes on, in [0, 1]; 1 is the paper's.
    pub persistence: f32,
    /// Standard deviation along each axis after one second, metres; it grows with the root of time.
    pub std_m_per_sqrt_s: f32,
}

impl LinearExtrapolation {
    /// Draws the next place, metres, from the place that was `reached_m`, `dt_s` seconds later.
    pub fn draw(&self, reached_m: &Vec3, velocity_m_per_s: &Vec3, dt_s: f32, stream: &mut Stream) -> Vec3 {
        self.mean(reached_m, velocity_m_per_s, dt_s) + stream.normal3() * self.std_m(dt_s)
    }

    /// Mean of the draw.
    #[must_use]
    pub fn mean(&self, reached_m: &Vec3, velocity_m_per_s: &Vec3, dt_s: f32) -> Vec3 {
        reached_m + velocity_m_per_s * (self.persistence * dt_s)
    }

    /// Mean of the draw of a place that swings about a joint, which was at `joint_m` and moved with
    /// `joint_velocity_m_per_s`. About it the place goes on along an arc. A hand at speed would
    /// leave the arm's reach along a straight line.
    ///
    /// ```
    /// use sinew_core::math::Vec3;
    /// use sinew_core::pik::goal::LinearExtrapolation;
    ///
    /// // An arm of half a metre that swings by four radians a second is as long a tenth of a second later.
    /// let process = LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s: 0.2 };
    /// let shoulder = (Vec3::new(0.0, 0.0, 2.0), Vec3::zeros());
    /// let hand = (Vec3::new(0.5, 0.0, 2.0), Vec3::new(0.0, 2.0, 0.0));
    /// let mean_m = process.mean_about(hand, shoulder, 0.1);
    /// assert!(((mean_m - shoulder.0).norm() - 0.5).abs() < 1e-6 && mean_m.y > 0.18, "{mean_m:?}");
    /// ```
    #[must_use]
    pub fn mean_about(
        &self,
        (reached_m, velocity_m_per_s): (Vec3, Vec3),
        (joint_m, joint_velocity_m_per_s): (Vec3, Vec3),
        dt_s: f32,
    ) -> Vec3 {
        let (limb_m, velocity) = (reached_m - joint_m, velocity_m_per_s - joint_velocity_m_per_s);
        let (length_m, straight_m) = (limb_m.norm(), self.mean(&limb_m, &velocity, dt_s));
        let joint_m = self.mean(&joint_m, &joint_velocity_m_per_s, dt_s);
        let straight_length_m = straight_m.norm();
        if !(length_m > 0.0 && straight_length_m > 0.0) {
            return joint_m + straight_m;
        }
        let next_length_m = length_m + self.persistence * dt_s * velocity.dot(&limb_m) / length_m;
        joint_m + straight_m * (next_length_m / straight_length_m)
    }

    /// Standard deviation of the draw along each axis, metres.
    #[must_use]
    pub fn std_m(&self, dt_s: f32) -> f32 {
        self.std_m_per_sqrt_s * sqrt(dt_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_have_the_stated_mean_and_spread() {
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
        let velocity = Vec3::new(1.0, 0.0, 0.0);
        let mut stream = Stream::new(4, 0, 0);
        let n = 20_000_u16;
        let (mut sum, mut square) = (Vec3::zeros(), 0.0);
        for _ in 0..n {
            let miss = process.draw(&Vec3::z(), &velocity, 0.25, &mut stream) - Vec3::new(0.125, 0.0, 1.0);
            sum += miss;
            square += miss.norm_squared();
        }
        let n = f32::from(n);
        assert!((sum / n).norm() < 4.0 * 0.1 * 3.0_f32.sqrt() / n.sqrt());
        assert!((square / n / 3.0 / 0.01 - 1.0).abs() < 0.03);
    }
}
