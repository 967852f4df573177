//! The density of a pose given goals of its end-effectors (PIK paper, eq. 12), and what the solver asks of any density.

use super::forward::{Posture, posture};
use super::jacobian::moving_column;
use crate::math::{Mat3, Vec3, length, max};
use crate::skeleton::Skeleton;

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
    /// How many of the first coordinates are given, those of a root that was drawn before: they stay at `previous_rad`.
    pub held: usize,
}

/// A log density of poses that has its greatest values where some squares are least: what the solver climbs.
pub trait PoseObjective<const BONES: usize, const ANGLES: usize> {
    /// The body.
    fn skeleton(&self) -> &Skeleton<BONES, ANGLES>;

    /// Where its root is before any shift, metres.
    fn root_m(&self) -> Vec3;

    /// Where the search begins.
    fn start_rad(&self) -> [f32; ANGLES];

    /// How many of the first coordinates are given and stay.
    fn held(&self) -> usize;

    /// log density of a pose inside the limits, up to a constant.
    fn log_density(&self, angles_rad: &[f32; ANGLES], posture: &Posture<BONES, ANGLES>) -> f32;

    /// Its gradient, and minus its second derivative by Gauss and Newton. What belongs to a held coordinate is not read.
    fn derivatives(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
    ) -> ([f32; ANGLES], [[f32; ANGLES]; ANGLES]);

    /// Distance of the worst end-effector from its goal, metres; zero without goals.
    fn residual_m(&self, posture: &Posture<BONES, ANGLES>) -> f32;

    /// The posture of `angles_rad`.
    fn posture(&self, angles_rad: &[f32; ANGLES]) -> Posture<BONES, ANGLES> {
        posture(self.skeleton(), &self.root_m(), angles_rad)
    }
}

impl<const BONES: usize, const ANGLES: usize> PoseObjective<BONES, ANGLES> for PoseDensity<'_, BONES, ANGLES> {
    fn skeleton(&self) -> &Skeleton<BONES, ANGLES> {
        self.skeleton
    }

    fn root_m(&self) -> Vec3 {
        self.root_m
    }

    fn start_rad(&self) -> [f32; ANGLES] {
        self.previous_rad
    }

    fn held(&self) -> usize {
        self.held
    }

    /// log density of a pose inside the limits, up to the constant of eq. (12).
    fn log_density(&self, angles_rad: &[f32; ANGLES], posture: &Posture<BONES, ANGLES>) -> f32 {
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
    fn derivatives(
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
            // Bounds that are constants, so that small skeletons are unrolled.
            for i in 0..ANGLES {
                // What does not move the end adds nothing.
                if i < self.held || !self.skeleton.angle_moves(i, goal.bone) {
                    continue;
                }
                columns[i] = moving_column(self.skeleton, posture, goal.bone, i);
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
}
