//! The mode of probabilistic inverse kinematics: a least-squares pose inside the limits (PIK paper, section 5.2.1).
//!
//! The paper uses gradient projection with line search. Here each step is a projected Gauss-Newton step with an active
//! set, since its Hessian J'WJ + lambda is needed for the proposal anyway. Both the steps and the halvings of the line
//! search are bounded.

use super::cholesky::Cholesky;
use super::forward::{Posture, posture};
use super::jacobian::column;
use crate::math::{Mat3, Vec3, abs, length, max};
use crate::skeleton::Skeleton;

/// Halvings of a step that does not climb.
const MAX_HALVINGS: usize = 6;
/// A step shorter than this (radians) ends the iteration.
const STEP_TOLERANCE_RAD: f32 = 1.0e-3;

/// A step that promises less log density than this ends the iteration: a draw around the mode costs a hundred times more.
const LEAST_LOG_GAIN: f32 = 0.01;

/// Where an end-effector wants to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// The bone whose end is to go there.
    pub bone: usize,
    /// The place, metres.
    pub position_m: Vec3,
    /// W of eq. (12): inverse covariance of the goal, 1 / m^2.
    pub precision: Mat3,
}

/// log p(theta | g, theta before) of eq. (12), up to its constant.
#[derive(Debug, Clone, Copy)]
pub struct PoseDensity<'a, const BONES: usize, const ANGLES: usize> {
    /// The body.
    pub skeleton: &'a Skeleton<BONES, ANGLES>,
    /// Where its root is, metres.
    pub root_m: Vec3,
    /// Goals of the end-effectors.
    pub goals: &'a [Goal],
    /// Angles of the frame before.
    pub previous_rad: [f32; ANGLES],
    /// lambda of eq. (12), one an angle: inverse variance of its change, 1 / rad^2.
    pub stiffness: [f32; ANGLES],
}

/// The mode and what is known of the density around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode<const ANGLES: usize> {
    /// The most likely pose found, inside the limits.
    pub angles_rad: [f32; ANGLES],
    /// Gradient of the log density there; not zero where a limit is active.
    pub gradient: [f32; ANGLES],
    /// J'WJ + lambda there, eq. (21).
    pub hessian: [[f32; ANGLES]; ANGLES],
    /// log density there, up to the constant of eq. (12).
    pub log_density: f32,
    /// Distance of the worst end-effector from its goal, metres.
    pub residual_m: f32,
    /// Whether the last step was short enough; otherwise this is the best pose so far.
    pub converged: bool,
}

impl<const BONES: usize, const ANGLES: usize> PoseDensity<'_, BONES, ANGLES> {
    /// The posture of `angles_rad`.
    #[must_use]
    pub fn posture(&self, angles_rad: &[f32; ANGLES]) -> Posture<BONES, ANGLES> {
        posture(self.skeleton, &self.root_m, angles_rad)
    }

    /// log density of a pose inside the limits, up to the constant of eq. (12).
    #[must_use]
    pub fn log_density(&self, angles_rad: &[f32; ANGLES], posture: &Posture<BONES, ANGLES>) -> f32 {
        let mut sum = 0.0;
        for goal in self.goals {
            let Some(end) = posture.ends.get(goal.bone) else { continue };
            let miss = goal.position_m - end;
            sum -= 0.5 * miss.dot(&(goal.precision * miss));
        }
        for i in 0..ANGLES {
            let change = angles_rad[i] - self.previous_rad[i];
            sum -= 0.5 * self.stiffness[i] * change * change;
        }
        sum
    }

    /// Gradient of the log density (eq. 23) and J'WJ + lambda (eq. 21).
    #[must_use]
    pub fn derivatives(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
    ) -> ([f32; ANGLES], [[f32; ANGLES]; ANGLES]) {
        let mut gradient = [0.0; ANGLES];
        let mut hessian = [[0.0; ANGLES]; ANGLES];
        for i in 0..ANGLES {
            gradient[i] = -self.stiffness[i] * (angles_rad[i] - self.previous_rad[i]);
            hessian[i][i] = self.stiffness[i];
        }
        for goal in self.goals {
            let Some(end) = posture.ends.get(goal.bone) else { continue };
            let miss = goal.position_m - end;
            let mut columns = [Vec3::zeros(); ANGLES];
            for i in 0..ANGLES {
                columns[i] = column(self.skeleton, posture, goal.bone, i);
                let weighted = goal.precision * columns[i];
                gradient[i] += weighted.dot(&miss);
                for j in 0..=i {
                    hessian[i][j] += weighted.dot(&columns[j]);
                }
            }
        }
        for i in 0..ANGLES {
            for j in i + 1..ANGLES {
                hessian[i][j] = hessian[j][i];
            }
        }
        (gradient, hessian)
    }

    /// Climbs from the pose of the frame before to the mode in at most `max_steps` steps.
    #[must_use]
    pub fn mode(&self, max_steps: usize) -> Mode<ANGLES> {
        self.mode_from(&[], max_steps)
    }

    /// As [`Self::mode`], but climbs from the likeliest of the pose of the frame before and other `starts`: after a jump
    /// the way from the old pose may end at a limit.
    #[must_use]
    pub fn mode_from(&self, starts: &[[f32; ANGLES]], max_steps: usize) -> Mode<ANGLES> {
        let mut angles_rad = self.skeleton.clamp(self.previous_rad);
        // Two places in turns: a posture is too large to be handed on.
        let (mut here, mut there) = (Posture::folded(), Posture::folded());
        here.turn(self.skeleton, &self.root_m, &angles_rad);
        let mut log_density = self.log_density(&angles_rad, &here);
        for start in starts {
            let other = self.skeleton.clamp(*start);
            there.turn(self.skeleton, &self.root_m, &other);
            let log_other = self.log_density(&other, &there);
            if log_other > log_density {
                (angles_rad, log_density) = (other, log_other);
                core::mem::swap(&mut here, &mut there);
            }
        }
        let mut converged = false;
        let (mut gradient, mut hessian) = self.derivatives(&angles_rad, &here);
        for _ in 0..max_steps {
            let Some((direction, gain)) = self.free_direction(&angles_rad, &gradient, &hessian) else { break };
            if gain < LEAST_LOG_GAIN {
                converged = true;
                break;
            }
            let Some((next, log_next)) = self.climb(&angles_rad, &direction, log_density, &mut there) else {
                converged = true;
                break;
            };
            let mut longest = 0.0;
            for i in 0..ANGLES {
                longest = max(longest, abs(next[i] - angles_rad[i]));
            }
            (angles_rad, log_density) = (next, log_next);
            core::mem::swap(&mut here, &mut there);
            (gradient, hessian) = self.derivatives(&angles_rad, &here);
            if longest < STEP_TOLERANCE_RAD {
                converged = true;
                break;
            }
        }
        Mode { angles_rad, gradient, hessian, log_density, residual_m: self.residual_m(&here), converged }
    }

    /// Distance of the worst end-effector from its goal, metres.
    fn residual_m(&self, posture: &Posture<BONES, ANGLES>) -> f32 {
        let mut worst = 0.0;
        for goal in self.goals {
            if let Some(end) = posture.ends.get(goal.bone) {
                worst = max(worst, length(&(goal.position_m - end)));
            }
        }
        worst
    }

    /// Gauss-Newton direction of the angles that no limit holds and the gain of log density that it promises; `None` where
    /// the Hessian cannot be factored.
    fn free_direction(
        &self,
        angles_rad: &[f32; ANGLES],
        gradient: &[f32; ANGLES],
        hessian: &[[f32; ANGLES]; ANGLES],
    ) -> Option<([f32; ANGLES], f32)> {
        let (mut reduced, mut right) = (*hessian, *gradient);
        for (i, limit) in self.skeleton.limits().iter().enumerate() {
            let held = (angles_rad[i] <= limit.low_rad && gradient[i] < 0.0)
                || (angles_rad[i] >= limit.high_rad && gradient[i] > 0.0);
            if held {
                right[i] = 0.0;
                for k in 0..ANGLES {
                    reduced[i][k] = 0.0;
                    reduced[k][i] = 0.0;
                }
                reduced[i][i] = 1.0;
            }
        }
        let direction = Cholesky::new(&reduced)?.solve(&right);
        let mut gain = 0.0;
        for i in 0..ANGLES {
            gain += 0.5 * right[i] * direction[i];
        }
        Some((direction, gain))
    }

    /// The longest of the step and its halvings, cut to the limits, that raises the density, and the density; its posture is left in
    /// `there`.
    fn climb(
        &self,
        angles_rad: &[f32; ANGLES],
        direction: &[f32; ANGLES],
        log_density: f32,
        there: &mut Posture<BONES, ANGLES>,
    ) -> Option<([f32; ANGLES], f32)> {
        let mut scale = 1.0;
        for _ in 0..=MAX_HALVINGS {
            let mut next = *angles_rad;
            for i in 0..ANGLES {
                next[i] += scale * direction[i];
            }
            let next = self.skeleton.clamp(next);
            there.turn(self.skeleton, &self.root_m, &next);
            let log_next = self.log_density(&next, there);
            if log_next > log_density {
                return Some((next, log_next));
            }
            scale *= 0.5;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
            let density = PoseDensity { skeleton: &skeleton, root_m, goals: &goals, previous_rad: near, stiffness: [0.1; 4] };
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
                skeleton: &skeleton, root_m: Vec3::zeros(), goals: &goals, previous_rad, stiffness: [2.0; 4],
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
        };
        let mode = density.mode(30);
        assert!((mode.residual_m - 0.3).abs() < 0.02, "residual {}", mode.residual_m);
        assert!(mode.angles_rad[3] < 0.1, "elbow {}", mode.angles_rad[3]);
    }
}
