//! A body that the solver moves by goals of its joints: the built-in motions.

use crate::body::BodyJoints;
use crate::error::Result;
use sinew_core::kinematics::forward::posture;
use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
use sinew_core::math::{Mat3, Vec3};
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_ANGLES, BodySkeleton, full_body};

/// Height of the built-in person, metres.
pub const HEIGHT_M: f32 = 1.75;
/// Steps of the solver in one frame.
const STEPS: usize = 60;
/// Inverse variance of a goal that has to be met, 1 / m^2: a millimetre.
pub const FIRM: f32 = 1.0e6;

/// A person in a pose.
#[derive(Debug, Clone)]
pub struct AnimatedBody {
    /// The person's measures.
    pub measures: BodyMeasures,
    /// The skeleton.
    pub skeleton: BodySkeleton,
    /// The pose, inside the limits.
    pub angles: [f32; BODY_ANGLES],
    /// lambda of PIK (12): how firmly each coordinate stays from frame to frame.
    pub stiffness: [f32; BODY_ANGLES],
}

/// Index of the coordinate of this name.
pub(super) fn coordinate(name: &str) -> Option<usize> {
    BODY_ANGLE_NAMES.iter().position(|other| *other == name)
}

/// A goal that is equally firm along all axes.
#[must_use]
pub fn goal(bone: usize, position_m: Vec3, precision: f32) -> Goal {
    Goal { bone, position_m, precision: Mat3::identity() * precision }
}

impl AnimatedBody {
    /// An adult of the standard proportions with the given `angles` (name and radians or metres;
    /// all others zero), cut to the limits.
    ///
    /// # Errors
    /// None for the height that is built in.
    pub fn new(angles: &[(&str, f32)]) -> Result<Self> {
        let measures = BodyMeasures::of_height(HEIGHT_M)?;
        let skeleton = full_body(&measures)?;
        let mut body = Self { measures, angles: [0.0; BODY_ANGLES], stiffness: [1.0; BODY_ANGLES], skeleton };
        for (name, value) in angles {
            if let Some(index) = coordinate(name) {
                body.angles[index] = *value;
            }
        }
        body.angles = body.skeleton.clamp(body.angles);
        Ok(body)
    }

    /// Sets the stiffness of every coordinate whose name begins with `start`.
    pub fn stiffen(&mut self, start: &str, stiffness: f32) {
        for (slot, name) in self.stiffness.iter_mut().zip(BODY_ANGLE_NAMES) {
            if name.starts_with(start) {
                *slot = stiffness;
            }
        }
    }

    /// Ends of the bones, metres.
    #[must_use]
    pub fn ends(&self) -> [Vec3; sinew_core::skeleton::full_body::BODY_BONES] {
        posture(&self.skeleton, &Vec3::zeros(), &self.angles).ends
    }

    /// The joints as a recording has them.
    #[must_use]
    pub fn joints(&self) -> BodyJoints {
        self.ends().map(Some)
    }

    /// Moves to the likeliest pose with these goals; returns the distance of the worst one, metres.
    pub fn reach(&mut self, goals: &[Goal]) -> f32 {
        let density = PoseDensity {
            skeleton: &self.skeleton,
            root_m: Vec3::zeros(),
            goals,
            previous_rad: self.angles,
            stiffness: self.stiffness,
            held: 0,
        };
        let mode = density.mode(STEPS);
        self.angles = mode.angles_rad;
        mode.residual_m
    }
}
