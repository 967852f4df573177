//! The mode of probabilistic inverse kinematics: the maximum of PIK (12) inside the limits.
//!
//! The PIK paper (section 5.2.1) uses gradient projection with line search. Here each step is a
//! projected Gauss-Newton step with an active set, since its Hessian J'WJ + lambda is needed for
//! the proposal anyway. Both the steps and the halvings of the line search are bounded.

use super::body_information::BodyInformation;
use super::cholesky::Cholesky;
use super::forward::Posture;
pub use super::pose_density::{Goal, PoseDensity, PoseObjective};
use super::solver_memory::SolverMemory;
use crate::math::{abs, max};

/// Largest number of halvings of a step that does not climb; the bound of the work.
const MAX_HALVINGS: usize = 6;
/// A step shorter than this ends the iteration, radians.
///
/// Chosen: 0.06 degrees; `cargo test -p sinew-core --test tracking solver_brute_force` holds the
/// error of the mode.
const STEP_TOLERANCE_RAD: f32 = 1.0e-3;

/// Up to so many angles a direction is found in the solver's own frame, which is faster.
///
/// Chosen: an arm's four do, a body's do not.
const FEW_ANGLES: usize = 8;

/// A step with a smaller predicted gain of log density ends the iteration.
///
/// Chosen: a draw around the mode loses about a hundred times more.
const MIN_LOG_GAIN: f32 = 0.01;

/// The mode and the derivatives of the density there.
///
/// ```
/// use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
/// use sinew_core::math::{Mat3, Vec3};
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // A goal 0.95 m away and an arm of 0.65 m: the answer is the stretched arm, with its residual.
/// let position_m = Vec3::new(0.95, 0.0, 0.0);
/// let goals = [Goal { bone: FOREARM, position_m, precision: Mat3::identity() * 400.0 }];
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let (root_m, previous_rad) = (Vec3::zeros(), [1.2, -0.5, 0.0, 0.5]);
/// let (skeleton, stiffness) = (&arm, [0.01; 4]);
/// let mode =
///     PoseDensity { skeleton, root_m, goals: &goals, previous_rad, stiffness, held: 0 }.mode(30);
/// assert!((mode.residual_m - 0.30).abs() < 0.02 && mode.angles_rad[3] < 0.1, "{mode:?}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode<const ANGLES: usize> {
    /// The most likely pose found, inside the limits.
    pub angles_rad: [f32; ANGLES],
    /// Gradient of the log density there; not zero where a limit is active.
    pub gradient: [f32; ANGLES],
    /// J'WJ + lambda there, PIK (21).
    pub hessian: [[f32; ANGLES]; ANGLES],
    /// log density there, up to the constant of PIK (12).
    pub log_density: f32,
    /// Distance of the worst end-effector from its goal, metres.
    pub residual_m: f32,
    /// Why the search ended; whatever the reason, this is the best pose that it found.
    pub stop: Stop,
    /// How many of the first coordinates were given and stayed.
    pub held: usize,
}

/// Why a search for a mode ended.
///
/// ```
/// use sinew_core::kinematics::inverse::{PoseDensity, Solve, Stop};
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // Without a goal the previous pose is the mode; no step is needed, but one has to be allowed.
/// let skeleton = ArmGeometry::new(Side::Right, 0.30, 0.35)?.skeleton()?;
/// let (root_m, previous_rad) = (Vec3::zeros(), [0.6, 0.1, 0.1, 0.9]);
/// let stiffness = [50.0; 4];
/// let density =
///     PoseDensity { skeleton: &skeleton, root_m, goals: &[], previous_rad, stiffness, held: 0 };
/// assert_eq!(density.mode(0).stop, Stop::StepsUsed);
/// assert!(density.mode(20).converged());
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The last step was shorter than a thousandth of a radian in every angle.
    ShortStep,
    /// The predicted gain of the next step is negligible.
    LittleGain,
    /// No step along the direction climbs.
    NoClimb,
    /// The largest number of steps is reached.
    StepsUsed,
    /// The second derivative cannot be factored: the density is flat in some direction.
    NoCurvature,
}

impl<const ANGLES: usize> Mode<ANGLES> {
    /// Whether the search ended at a pose that no step improves.
    #[must_use]
    pub fn converged(&self) -> bool {
        matches!(self.stop, Stop::ShortStep | Stop::LittleGain | Stop::NoClimb)
    }
}

/// A mode without its Hessian, which [`SolverMemory::hessian`] has.
///
/// ```
/// use sinew_core::kinematics::inverse::{PoseDensity, Solve, Stop};
/// use sinew_core::kinematics::solver_memory::SolverMemory;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// let skeleton = ArmGeometry::new(Side::Left, 0.3, 0.3)?.skeleton()?;
/// let (root_m, previous_rad) = (Vec3::zeros(), [0.5; 4]);
/// let stiffness = [1.0; 4];
/// let density =
///     PoseDensity { skeleton: &skeleton, root_m, goals: &[], previous_rad, stiffness, held: 0 };
/// let solution = density.solve_within(&[], 3, &mut SolverMemory::new());
/// assert_eq!((solution.stop, solution.residual_m), (Stop::LittleGain, 0.0));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution<const ANGLES: usize> {
    /// The pose, radians.
    pub angles_rad: [f32; ANGLES],
    /// Gradient of the log density there; of an angle at its limit it may point outside.
    pub gradient: [f32; ANGLES],
    /// log density there, up to a constant.
    pub log_density: f32,
    /// Distance of the worst end-effector from its goal, metres; zero without goals.
    pub residual_m: f32,
    /// Why the search ended.
    pub stop: Stop,
}

/// The solver of any [`PoseObjective`].
///
/// ```
/// use sinew_core::kinematics::inverse::{PoseDensity, Solve};
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // Without a goal the previous pose is the mode, from any start.
/// let skeleton = ArmGeometry::new(Side::Right, 0.30, 0.35)?.skeleton()?;
/// let (root_m, previous_rad) = (Vec3::zeros(), [0.6, 0.1, 0.1, 0.9]);
/// let stiffness = [50.0; 4];
/// let density =
///     PoseDensity { skeleton: &skeleton, root_m, goals: &[], previous_rad, stiffness, held: 0 };
/// let mode = density.mode_from(&[[0.0; 4], [0.2, 0.0, 0.0, 1.5]], 10);
/// assert!(mode.converged() && mode.log_density > -0.01);
/// assert!((mode.angles_rad[3] - 0.9).abs() < 0.01);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub trait Solve<const BONES: usize, const ANGLES: usize>: PoseObjective<BONES, ANGLES> {
    /// Climbs from the previous frame's pose to the mode in at most `max_steps` steps.
    fn mode(&self, max_steps: usize) -> Mode<ANGLES> {
        self.mode_from(&[], max_steps)
    }

    /// As [`Self::mode`], but climbs from the most likely of `starts`, or from the previous pose
    /// where there is none.
    ///
    /// After a jump the way from the previous pose may end at a limit.
    fn mode_from(&self, starts: &[[f32; ANGLES]], max_steps: usize) -> Mode<ANGLES> {
        let SolverMemory { mut postures, mut hessian, mut factor, mut information } = SolverMemory::new();
        // Apart, so that a solver of few angles keeps what it needs in registers.
        let matrices = (&mut hessian, &mut factor, &mut information);
        let Solution { angles_rad, gradient, log_density, residual_m, stop } =
            solve(self, starts, max_steps, postures.each_mut(), matrices);
        Mode { angles_rad, gradient, hessian, log_density, residual_m, stop, held: self.held() }
    }

    /// As [`Self::mode_from`], in memory of the caller, where the Hessian stays.
    #[inline(never)]
    fn solve_within(
        &self,
        starts: &[[f32; ANGLES]],
        max_steps: usize,
        memory: &mut SolverMemory<BONES, ANGLES>,
    ) -> Solution<ANGLES> {
        let SolverMemory { postures, hessian, factor, information } = memory;
        solve(self, starts, max_steps, postures.each_mut(), (hessian, factor, information))
    }
}

impl<const BONES: usize, const ANGLES: usize, T: PoseObjective<BONES, ANGLES> + ?Sized> Solve<BONES, ANGLES> for T {}

#[inline(always)]
fn solve<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    starts: &[[f32; ANGLES]],
    max_steps: usize,
    // Two buffers in turn: a posture is too large to be copied.
    [mut here, mut there]: [&mut Posture<BONES, ANGLES>; 2],
    (hessian, factor, information): (&mut [[f32; ANGLES]; ANGLES], &mut Cholesky<ANGLES>, &mut BodyInformation<BONES>),
) -> Solution<ANGLES> {
    let (mut angles_rad, mut log_density) = likeliest_start(objective, starts, (&mut here, &mut there), information);
    let mut gradient = [0.0; ANGLES];
    differentiate(objective, (&angles_rad, here), (&mut gradient, hessian), information);
    let mut stop = Stop::StepsUsed;
    for _ in 0..max_steps {
        let found = if ANGLES > FEW_ANGLES {
            free_direction_within(objective, &angles_rad, &gradient, hessian, factor)
        } else {
            free_direction(objective, &angles_rad, &gradient, hessian)
        };
        let Some((direction, gain)) = found else {
            stop = Stop::NoCurvature;
            break;
        };
        if gain < MIN_LOG_GAIN {
            stop = Stop::LittleGain;
            break;
        }
        let Some((next, log_next)) = climb(objective, (&angles_rad, log_density), &direction, there, information)
        else {
            stop = Stop::NoClimb;
            break;
        };
        let mut longest = 0.0;
        for (next, last) in next.iter().zip(&angles_rad) {
            longest = max(longest, abs(next - last));
        }
        (angles_rad, log_density) = (next, log_next);
        core::mem::swap(&mut here, &mut there);
        differentiate(objective, (&angles_rad, here), (&mut gradient, hessian), information);
        if longest < STEP_TOLERANCE_RAD {
            stop = Stop::ShortStep;
            break;
        }
    }
    Solution { angles_rad, gradient, log_density, residual_m: objective.residual_m(here), stop }
}

/// The most likely of `starts`, and its log density. Its posture is then the first of the two, and
/// `information` is its.
#[inline(always)]
fn likeliest_start<'a, const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    starts: &[[f32; ANGLES]],
    (here, there): (&mut &'a mut Posture<BONES, ANGLES>, &mut &'a mut Posture<BONES, ANGLES>),
    information: &mut BodyInformation<BONES>,
) -> ([f32; ANGLES], f32) {
    let (first, others) =
        starts.split_first().map_or((objective.start_rad(), starts), |(first, others)| (*first, others));
    let mut angles_rad = objective.skeleton().clamp(first);
    here.turn(objective.skeleton(), &objective.root_m(), &angles_rad);
    if others.is_empty() {
        let log_density = inform(objective, &angles_rad, here, information);
        return (angles_rad, log_density);
    }
    let mut log_density = objective.log_density(&angles_rad, here);
    for start in others {
        let other = objective.skeleton().clamp(*start);
        there.turn(objective.skeleton(), &objective.root_m(), &other);
        let log_other = objective.log_density(&other, there);
        if log_other > log_density {
            (angles_rad, log_density) = (other, log_other);
            core::mem::swap(here, there);
        }
    }
    inform(objective, &angles_rad, here, information);
    (angles_rad, log_density)
}

/// The log density; of many angles with what [`differentiate`] needs at this pose.
#[inline(always)]
fn inform<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    angles_rad: &[f32; ANGLES],
    posture: &Posture<BONES, ANGLES>,
    information: &mut BodyInformation<BONES>,
) -> f32 {
    if ANGLES > FEW_ANGLES {
        objective.inform(angles_rad, posture, information)
    } else {
        objective.log_density(angles_rad, posture)
    }
}

/// Writes gradient and Hessian: those of many angles in place, those of few in registers.
#[inline(always)]
fn differentiate<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    (angles_rad, posture): (&[f32; ANGLES], &Posture<BONES, ANGLES>),
    (gradient, hessian): (&mut [f32; ANGLES], &mut [[f32; ANGLES]; ANGLES]),
    information: &mut BodyInformation<BONES>,
) {
    if ANGLES > FEW_ANGLES {
        objective.write_derivatives((angles_rad, posture), (gradient, hessian), information);
    } else {
        (*gradient, *hessian) = objective.derivatives(angles_rad, posture);
    }
}

/// Holds the angles that a limit holds: rows and columns of the identity in `hessian`, zeros in
/// `gradient`.
#[inline(always)]
fn hold<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    angles_rad: &[f32; ANGLES],
    gradient: &mut [f32; ANGLES],
    hessian: &mut [[f32; ANGLES]; ANGLES],
) {
    // A constant bound, so that no index is checked.
    for i in 0..ANGLES {
        let limit = &objective.skeleton().limits()[i];
        let held = i < objective.held()
            || (angles_rad[i] <= limit.low_rad && gradient[i] < 0.0)
            || (angles_rad[i] >= limit.high_rad && gradient[i] > 0.0);
        if held {
            gradient[i] = 0.0;
            for k in 0..ANGLES {
                hessian[i][k] = 0.0;
                hessian[k][i] = 0.0;
            }
            hessian[i][i] = 1.0;
        }
    }
}

/// Gauss-Newton direction of the angles that no limit holds, and its predicted gain of log density.
///
/// `None` where the Hessian cannot be factored.
#[inline(always)]
fn free_direction<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    angles_rad: &[f32; ANGLES],
    gradient: &[f32; ANGLES],
    hessian: &[[f32; ANGLES]; ANGLES],
) -> Option<([f32; ANGLES], f32)> {
    let (mut right, mut reduced) = (*gradient, *hessian);
    hold(objective, angles_rad, &mut right, &mut reduced);
    let direction = Cholesky::from(&reduced, objective.held())?.solve_from(&right, objective.held());
    Some((direction, gain(&right, &direction)))
}

/// As [`free_direction`], with the matrices of many angles in the caller's memory.
#[inline(never)]
fn free_direction_within<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    angles_rad: &[f32; ANGLES],
    gradient: &[f32; ANGLES],
    hessian: &[[f32; ANGLES]; ANGLES],
    factor: &mut Cholesky<ANGLES>,
) -> Option<([f32; ANGLES], f32)> {
    let mut right = *gradient;
    factor.lower = *hessian;
    hold(objective, angles_rad, &mut right, &mut factor.lower);
    if !factor.factor_in_place(objective.held()) {
        return None;
    }
    let direction = factor.solve_from(&right, objective.held());
    Some((direction, gain(&right, &direction)))
}

#[inline(always)]
fn gain<const ANGLES: usize>(gradient: &[f32; ANGLES], direction: &[f32; ANGLES]) -> f32 {
    let mut gain = 0.0;
    for i in 0..ANGLES {
        gain += 0.5 * gradient[i] * direction[i];
    }
    gain
}

/// The longest of the step and its halvings, cut to the limits, that raises the density, and the
/// density.
///
/// Its posture is left in `there`, and `information` is its.
fn climb<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    (angles_rad, log_density): (&[f32; ANGLES], f32),
    direction: &[f32; ANGLES],
    there: &mut Posture<BONES, ANGLES>,
    information: &mut BodyInformation<BONES>,
) -> Option<([f32; ANGLES], f32)> {
    let mut scale = 1.0;
    for _ in 0..=MAX_HALVINGS {
        let mut next = *angles_rad;
        for i in 0..ANGLES {
            next[i] += scale * direction[i];
        }
        let next = objective.skeleton().clamp(next);
        there.turn(objective.skeleton(), &objective.root_m(), &next);
        let log_next = inform(objective, &next, there, information);
        if log_next > log_density {
            return Some((next, log_next));
        }
        scale *= 0.5;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::math::{Mat3, Vec3};
    use crate::skeleton::arm::{ARM_LIMITS, FOREARM};
    use crate::skeleton::{ArmGeometry, Side};
    use proptest::prelude::*;

    fn goal(position_m: Vec3) -> Goal {
        Goal { bone: FOREARM, position_m, precision: Mat3::identity() * 400.0 }
    }

    proptest! {
        #[test]
        fn a_reachable_goal_is_reached_inside_the_limits(
            e in 0.2_f32..2.5, d in -0.9_f32..1.0, t in -1.0_f32..1.5, f in 0.3_f32..2.2,
        ) {
            let skeleton = ArmGeometry::new(Side::Left, 0.3, 0.35).unwrap().skeleton().unwrap();
            let root_m = Vec3::new(0.2, -0.1, 1.2);
            let target = posture(&skeleton, &root_m, &[e, d, t, f]).ends[FOREARM];
            let goals = [goal(target)];
            let near = [e + 0.3, d - 0.2, t + 0.2, f - 0.25];
            let density = PoseDensity { skeleton: &skeleton, root_m, goals: &goals, previous_rad: near, stiffness: [0.1; 4], held: 0 };
            let mode = density.mode(12);
            prop_assert!(mode.residual_m < 0.01, "missed by {}", mode.residual_m);
            for (angle, limit) in mode.angles_rad.iter().zip(&ARM_LIMITS) {
                prop_assert!(*angle >= limit.low_rad && *angle <= limit.high_rad);
            }
        }

        #[test]
        fn the_mode_is_never_worse_than_the_start(x in -2.0_f32..2.0, y in -2.0_f32..2.0, z in -2.0_f32..2.0,
                                                  start in prop::array::uniform4(-4.0_f32..4.0)) {
            let skeleton = ArmGeometry::new(Side::Right, 0.3, 0.35).unwrap().skeleton().unwrap();
            let goals = [goal(Vec3::new(x, y, z))];
            let previous_rad = skeleton.clamp(start);
            let density = PoseDensity {
                skeleton: &skeleton, root_m: Vec3::zeros(), goals: &goals, previous_rad, stiffness: [2.0; 4], held: 0,
            };
            let mode = density.mode(3);
            let before = density.log_density(&previous_rad, &density.posture(&previous_rad));
            prop_assert!(mode.log_density >= before);
            prop_assert!(mode.residual_m.is_finite());
            prop_assert_eq!(skeleton.clamp(mode.angles_rad), mode.angles_rad);
        }
    }

    #[test]
    fn an_unreachable_goal_gives_the_stretched_arm_and_its_residual() {
        let skeleton = ArmGeometry::new(Side::Left, 0.3, 0.3).unwrap().skeleton().unwrap();
        let goals = [goal(Vec3::new(0.9, 0.0, 0.0))];
        let density = PoseDensity {
            skeleton: &skeleton,
            root_m: Vec3::zeros(),
            goals: &goals,
            previous_rad: [1.2, -0.5, 0.0, 0.5],
            stiffness: [0.01; 4],
            held: 0,
        };
        let mode = density.mode(30);
        assert!((mode.residual_m - 0.3).abs() < 0.02, "residual {}", mode.residual_m);
        assert!(mode.angles_rad[3] < 0.1, "elbow {}", mode.angles_rad[3]);
    }
}
