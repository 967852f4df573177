//! An arm: three shoulder angles and one elbow angle, the hand being part of the forearm (arm
//! paper, section 2).
//!
//! With all angles zero the arm hangs straight down. The shoulder's ball joint turns by
//!
//! 1. *elevation* in the scapular plane, 45 degrees in front of the body's side (positive: up and
//!    out),
//! 2. *deviation* out of that plane (positive: inwards to the front, negative: outwards to the
//!    back),
//! 3. *axial rotation* of the upper arm (positive: inwards),
//!
//! and the elbow by *flexion*. The singular directions of this order (deviation +-90 degrees) point
//! inwards to the front and outwards to the back, where an arm cannot go. The limits exclude them.
//!
//! ```
//! use sinew_core::kinematics::forward::posture;
//! use sinew_core::math::Vec3;
//! use sinew_core::skeleton::arm::{FOREARM, UPPER_ARM};
//! use sinew_core::skeleton::{ArmGeometry, Side};
//!
//! // Angles to elbow and hand, and back.
//! let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
//! let pose = [0.6, 0.2, 0.1, 1.2];
//! let places = posture(&arm.skeleton()?, &Vec3::zeros(), &pose).ends;
//! let found = arm.angles_from_joints(&places[UPPER_ARM], &places[FOREARM], &[0.0; 4]);
//! assert!(
//!     found.iter().zip(pose).all(|(found, wanted)| (found - wanted).abs() < 1e-3),
//!     "{found:?}"
//! );
//! assert!((arm.reach_m() - 0.65).abs() < 1e-6);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::tree::{Bone, Joint, Limit, Skeleton};
use crate::error::{ParameterError, Rule, finite};
use crate::math::{Mat3, Vec3, abs, acos, asin, atan2, clamp, sin_cos, transform, turn_columns, unit};
use crate::ranges::{MAX_M, length};
use core::f32::consts::{FRAC_1_SQRT_2, PI};

/// Whose side: the person's own left or right, not the image's.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // A person who faces the camera raises an arm: the left one goes to the image's right.
/// let hand_x_m = |side| {
///     let arm = ArmGeometry::new(side, 0.30, 0.35)?.skeleton()?;
///     Ok(posture(&arm, &Vec3::zeros(), &[1.2, -0.6, 0.0, 0.0]).ends[FOREARM].x)
/// };
/// assert!(hand_x_m(Side::Left)? > 0.4 && hand_x_m(Side::Right)? < -0.4);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Side {
    /// The person's left.
    Left,
    /// The person's right.
    Right,
}

/// Number of angles of an arm.
pub const ARM_ANGLES: usize = 4;
/// Number of bones of an arm: upper arm and forearm.
pub const ARM_BONES: usize = 2;
/// Index of the upper arm, whose end is the elbow.
pub const UPPER_ARM: usize = 0;
/// Index of the forearm, whose end is the hand.
pub const FOREARM: usize = 1;

/// Angles of an arm: elevation, deviation, axial rotation, elbow flexion; radians.
///
/// ```
/// use sinew_core::skeleton::arm::{ARM_LIMITS, ArmAngles};
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // Upper arm hanging, forearm straight to the front: a right angle at the elbow.
/// let bent: ArmAngles = [0.0, 0.0, 0.0, 90.0_f32.to_radians()];
/// assert!(bent.iter().zip(&ARM_LIMITS).all(|(angle, limit)| limit.clamp(*angle) == *angle));
/// // An elbow does not bend backwards.
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// assert_eq!(arm.clamp([0.0, 0.0, 0.0, -0.3])[3], 0.0);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub type ArmAngles = [f32; ARM_ANGLES];

/// The default limits: active range of motion of a healthy adult, rounded outwards to five degrees.
///
/// Chosen: wide enough for everyday poses, and they exclude the singular directions.
pub const ARM_LIMITS: [Limit; ARM_ANGLES] = [
    Limit::from_degrees(-50.0, 175.0),
    Limit::from_degrees(-70.0, 80.0),
    Limit::from_degrees(-95.0, 125.0),
    Limit::from_degrees(0.0, 150.0),
];

/// Limits that only keep an arm's angles unique, for comparisons without joint limits.
pub const WIDE_ARM_LIMITS: [Limit; ARM_ANGLES] = [
    Limit::from_degrees(-180.0, 180.0),
    Limit::from_degrees(-89.0, 89.0),
    Limit::from_degrees(-180.0, 180.0),
    Limit::from_degrees(0.0, 180.0),
];

/// Lengths, place and limits of one arm.
///
/// ```
/// use sinew_core::math::{Vec3, axis_rotation};
/// use sinew_core::skeleton::arm::facing_camera;
/// use sinew_core::skeleton::{ArmGeometry, Limit, Side};
///
/// let mut arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
/// assert!((arm.up() + Vec3::y()).norm() < 1e-6, "y points down");
/// // A person who leans over by a quarter turn, and an elbow that does not stretch.
/// arm.torso = axis_rotation(&Vec3::z(), 90.0_f32.to_radians()) * facing_camera();
/// arm.limits[3] = Limit::from_degrees(20.0, 150.0);
/// assert!((arm.up() - Vec3::x()).norm() < 1e-6);
/// assert!(arm.skeleton()?.clamp([0.0; 4])[3] > 0.3);
/// // An impossible length is refused by its name.
/// assert_eq!(
///     ArmGeometry::new(Side::Left, 0.0, 0.35).map_err(|error| error.parameter),
///     Err("upper_arm_m")
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmGeometry {
    /// The person's own side.
    pub side: Side,
    /// From shoulder to elbow, metres.
    pub upper_arm_m: f32,
    /// From elbow to the middle of the hand, metres.
    pub forearm_m: f32,
    /// Legal angles.
    pub limits: [Limit; ARM_ANGLES],
    /// Turns body axes (left, up, front as columns' images) into camera axes; see
    /// [`facing_camera`].
    pub torso: Mat3,
}

/// The torso's rotation when the person faces the camera upright: left = +x, up = -y, front = -z.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::arm::facing_camera;
///
/// let torso = facing_camera();
/// let front = torso * Vec3::z();
/// assert_eq!(front, -Vec3::z(), "towards the camera");
/// assert!((torso.determinant() - 1.0).abs() < 1e-6, "a rotation, no mirror");
/// ```
#[must_use]
pub fn facing_camera() -> Mat3 {
    Mat3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0)
}

impl ArmGeometry {
    /// An arm of a person who faces the camera, with the default limits.
    ///
    /// # Errors
    /// Both lengths have to be positive, at most [`MAX_M`].
    pub fn new(side: Side, upper_arm_m: f32, forearm_m: f32) -> Result<Self, ParameterError> {
        Ok(Self {
            side,
            upper_arm_m: length("upper_arm_m", upper_arm_m, MAX_M)?,
            forearm_m: length("forearm_m", forearm_m, MAX_M)?,
            limits: ARM_LIMITS,
            torso: facing_camera(),
        })
    }

    /// Greatest distance of the hand from the shoulder, metres.
    #[must_use]
    pub fn reach_m(&self) -> f32 {
        self.upper_arm_m + self.forearm_m
    }

    /// The body's up in camera axes, a unit vector.
    #[must_use]
    pub fn up(&self) -> Vec3 {
        self.torso_axis(1)
    }

    /// Outward, up and front in camera axes.
    fn directions(&self) -> (Vec3, Vec3, Vec3) {
        let left = self.torso_axis(0);
        let outward = if self.side == Side::Left { left } else { -left };
        (outward, self.torso_axis(1), self.torso_axis(2))
    }

    /// A column of the torso's axes: left, up, front.
    fn torso_axis(&self, column: usize) -> Vec3 {
        let [x, y, z] = self.torso.data.0.get(column).copied().unwrap_or_default();
        Vec3::new(x, y, z)
    }

    /// The arm as a tree of bones in camera axes.
    ///
    /// # Errors
    /// As [`Skeleton::new`]; `torso` has to be a rotation.
    pub fn skeleton(&self) -> Result<Skeleton<ARM_BONES, ARM_ANGLES>, ParameterError> {
        finite("torso", self.torso.sum())?;
        if abs(self.torso.determinant() - 1.0) > 1.0e-3 {
            return Err(ParameterError::new("torso determinant", Rule::Within { low: 1.0, high: 1.0 }));
        }
        Skeleton::new(self.bones(), self.limits)
    }

    /// The bones of [`Self::skeleton`], for a body.
    // Apart, so that an arm's own skeleton is made where it stays, with less stack.
    #[inline(never)]
    pub(super) fn bones_of_body(&self) -> [Bone; ARM_BONES] {
        self.bones()
    }

    #[inline(always)]
    fn bones(&self) -> [Bone; ARM_BONES] {
        let (outward, up, front) = self.directions();
        let (in_plane, out_of_plane) = scapular_plane(&outward, &front);
        let down = -up;
        let shoulder = Joint::Ball([down.cross(&in_plane), down.cross(&out_of_plane), front.cross(&-outward)]);
        [
            Bone { parent: None, joint: shoulder, offset_m: down * self.upper_arm_m },
            Bone {
                parent: Some(UPPER_ARM as u8),
                joint: Joint::Hinge(down.cross(&front)),
                offset_m: down * self.forearm_m,
            },
        ]
    }

    /// The angles, cut to the limits, whose elbow and hand lie in the given directions: inverse
    /// kinematics of an arm whose elbow is known.
    ///
    /// `elbow_m` and `hand_m` are relative to the shoulder. Lengths need not fit: the upper arm
    /// points to the elbow and the forearm from there to the hand. A part without direction keeps
    /// the `fallback` angles.
    #[must_use]
    pub fn angles_from_joints(&self, elbow_m: &Vec3, hand_m: &Vec3, fallback: &ArmAngles) -> ArmAngles {
        let (outward, up, front) = self.directions();
        let (in_plane, out_of_plane) = scapular_plane(&outward, &front);
        let mut angles = *fallback;
        if let Some(upper) = unit(*elbow_m) {
            angles[0] = elevation_within(&self.limits[0], atan2(upper.dot(&in_plane), -upper.dot(&up)));
            angles[1] = asin(upper.dot(&out_of_plane));
        }
        for i in 0..2 {
            angles[i] = self.limits[i].clamp(angles[i]);
        }
        if let Some(fore) = unit(hand_m - elbow_m) {
            let down = -up;
            let turn = |axis: Vec3, angle_rad: f32| turn_columns(&axis, sin_cos(angle_rad));
            let (elevation, deviation) =
                (turn(down.cross(&in_plane), angles[0]), turn(down.cross(&out_of_plane), angles[1]));
            let [x, y, z] = deviation.map(|column| transform(&elevation, column));
            // Times the transposed matrix, whose columns are the rows.
            let rows = [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]];
            let local = Vec3::from(transform(&rows, [fore.x, fore.y, fore.z]));
            angles[3] = acos(local.dot(&down));
            let (ahead, inward) = (local.dot(&front), local.dot(&-outward));
            if ahead * ahead + inward * inward > 1.0e-8 {
                angles[2] = atan2(inward, ahead);
            }
        }
        for i in 2..ARM_ANGLES {
            angles[i] = self.limits[i].clamp(angles[i]);
        }
        angles
    }
}

/// Unit vectors in the scapular plane (outwards to the front) and across it (inwards to the front).
fn scapular_plane(outward: &Vec3, front: &Vec3) -> (Vec3, Vec3) {
    ((outward + front) * FRAC_1_SQRT_2, (front - outward) * FRAC_1_SQRT_2)
}

/// The turn of `angle_rad` that lies in `limit`, or that is nearest to it.
fn elevation_within(limit: &Limit, angle_rad: f32) -> f32 {
    let middle = 0.5 * (limit.low_rad + limit.high_rad);
    let turned = middle + crate::math::wrap_angle(angle_rad - middle);
    clamp(turned, middle - PI, middle + PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use proptest::prelude::*;

    fn arm(side: Side) -> ArmGeometry {
        ArmGeometry::new(side, 0.3, 0.35).unwrap()
    }

    proptest! {
        #[test]
        fn a_transformed_vector_has_the_bits_of_nalgebra_s_product(
            columns in prop::array::uniform3(prop::array::uniform3(-2.0_f32..2.0)),
            vector in prop::array::uniform3(-2.0_f32..2.0),
        ) {
            let product = Mat3::from(columns) * Vec3::from(vector);
            prop_assert_eq!(transform(&columns, vector), [product.x, product.y, product.z]);
        }
    }

    #[test]
    fn a_bent_elbow_points_to_the_camera_and_inward_rotation_points_inwards() {
        for (side, inward) in [(Side::Left, -1.0), (Side::Right, 1.0)] {
            let skeleton = arm(side).skeleton().unwrap();
            let bent = posture(&skeleton, &Vec3::zeros(), &[0.0, 0.0, 0.0, PI / 2.0]);
            assert!((bent.ends[FOREARM] - Vec3::new(0.0, 0.3, -0.35)).norm() < 1.0e-5);
            let turned = posture(&skeleton, &Vec3::zeros(), &[0.0, 0.0, PI / 2.0, PI / 2.0]);
            assert!((turned.ends[FOREARM] - Vec3::new(0.35 * inward, 0.3, 0.0)).norm() < 1.0e-5);
            let raised = posture(&skeleton, &Vec3::zeros(), &[PI / 2.0, -PI / 4.0, 0.0, 0.0]);
            assert!((raised.ends[FOREARM] - Vec3::new(-0.65 * inward, 0.0, 0.0)).norm() < 1.0e-5, "out to the side");
        }
    }

    proptest! {
        #[test]
        fn angles_come_back_from_elbow_and_hand(
            e in -0.8_f32..3.0, d in -1.2_f32..1.35, t in -1.6_f32..2.1, f in 0.05_f32..2.6, left in any::<bool>(),
        ) {
            let geometry = arm(if left { Side::Left } else { Side::Right });
            let skeleton = geometry.skeleton().unwrap();
            let angles = [e, d, t, f];
            let there = posture(&skeleton, &Vec3::zeros(), &angles);
            let back = geometry.angles_from_joints(&there.ends[UPPER_ARM], &there.ends[FOREARM], &[0.0; 4]);
            let again = posture(&skeleton, &Vec3::zeros(), &back);
            prop_assert!((there.ends[FOREARM] - again.ends[FOREARM]).norm() < 2.0e-4, "{:?} {:?}", angles, back);
            prop_assert!((there.ends[UPPER_ARM] - again.ends[UPPER_ARM]).norm() < 2.0e-4);
        }

        #[test]
        fn any_two_points_give_a_legal_pose(
            ex in -1.0_f32..1.0, ey in -1.0_f32..1.0, ez in -1.0_f32..1.0,
            hx in -1.0_f32..1.0, hy in -1.0_f32..1.0, hz in -1.0_f32..1.0,
        ) {
            let angles = arm(Side::Left).angles_from_joints(&Vec3::new(ex, ey, ez), &Vec3::new(hx, hy, hz), &[0.0; 4]);
            for (angle, limit) in angles.iter().zip(&ARM_LIMITS) {
                prop_assert!(*angle >= limit.low_rad && *angle <= limit.high_rad);
            }
        }
    }

    #[test]
    fn a_point_without_direction_keeps_the_fallback() {
        let fallback = [0.3, 0.2, 0.1, 0.4];
        assert_eq!(arm(Side::Left).angles_from_joints(&Vec3::zeros(), &Vec3::zeros(), &fallback), fallback);
    }
}
