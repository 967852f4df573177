//! The whole body: 17 bones, 16 of them with flesh, and 30 coordinates.
//!
//! Rest pose: upright, facing the camera, arms and legs hanging. In camera axes left is +x, up -y,
//! front -z. The root is free: its three shifts and three angles come first. Euler orders and their
//! singularities:
//!
//! | joint | first | middle, singular at +-90 degrees | last |
//! |---|---|---|---|
//! | root | turn about up | tilt to the left | pitch forward |
//! | trunk, head | pitch forward | tilt to the left | turn about up |
//! | shoulder | as [`super::arm`] | | |
//! | hip | flexion to the front | abduction | inward rotation |
//!
//! ```
//! use sinew_core::kinematics::forward::posture;
//! use sinew_core::math::Vec3;
//! use sinew_core::skeleton::BodyMeasures;
//! use sinew_core::skeleton::full_body::{
//!     BODY_ANGLE_NAMES, BODY_ANGLES, FEET, FOREARMS, HEAD, full_body,
//! };
//!
//! let person = full_body(&BodyMeasures::of_height(1.75)?)?;
//! let mut pose = [0.0; BODY_ANGLES];
//! pose[2] = 3.0; // the root's shift along z: three metres away
//! let standing = posture(&person, &Vec3::zeros(), &pose).ends;
//! assert!(standing[HEAD].y < standing[FEET[0]].y, "y points down");
//!
//! let elbow = BODY_ANGLE_NAMES
//!     .iter()
//!     .position(|name| *name == "l_elbow_flexion")
//!     .expect("it has this name");
//! pose[elbow] = 1.5;
//! let bent = posture(&person, &Vec3::zeros(), &pose).ends;
//! assert!(bent[FOREARMS[0]].z < standing[FOREARMS[0]].z, "the forearm points to the camera");
//! assert_eq!(bent[FOREARMS[1]], standing[FOREARMS[1]], "the other arm stays");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::arm::{ArmGeometry, Side};
use super::body_measures::BodyMeasures;
use super::tree::{Bone, Joint, Limit, Skeleton};
use crate::error::ParameterError;
use crate::math::Vec3;

/// Bones of a body.
pub const BODY_BONES: usize = 17;
/// Coordinates of a body: three shifts and 27 angles.
pub const BODY_ANGLES: usize = 30;
/// A whole body.
///
/// ```
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{
///     BODY_ANGLE_NAMES, BodySkeleton, FEET, FOREARMS, full_body,
/// };
///
/// let person: BodySkeleton = full_body(&BodyMeasures::of_height(1.75)?)?;
/// // Coordinates are found by name; this one moves the left foot and no hand.
/// let knee = BODY_ANGLE_NAMES
///     .iter()
///     .position(|name| *name == "l_knee_flexion")
///     .expect("it has this name");
/// assert!(person.angle_moves(knee, FEET[0]) && !person.angle_moves(knee, FOREARMS[0]));
/// assert_eq!(person.limits()[knee].low_rad, 0.0, "a knee does not bend forwards");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub type BodySkeleton = Skeleton<BODY_BONES, BODY_ANGLES>;

/// Middle of the hips: has no length.
pub const PELVIS: usize = 0;
/// Ends at the base of the neck.
pub const TRUNK: usize = 1;
/// Ends in the middle of the head.
pub const HEAD: usize = 2;
/// End at the shoulders, left and right.
pub const COLLARS: [usize; 2] = [3, 6];
/// End at the elbows.
pub const UPPER_ARMS: [usize; 2] = [4, 7];
/// End at the wrists: the hands' end-effectors.
pub const FOREARMS: [usize; 2] = [5, 8];
/// End at the hip joints.
pub const HIPS: [usize; 2] = [9, 13];
/// End at the knees.
pub const THIGHS: [usize; 2] = [10, 14];
/// End at the ankles.
pub const SHANKS: [usize; 2] = [11, 15];
/// End at the tips of the feet.
pub const FEET: [usize; 2] = [12, 16];

/// Names of the bones' ends, in the bones' order.
pub const BODY_JOINT_NAMES: [&str; BODY_BONES] = [
    "pelvis",
    "neck",
    "head",
    "l_shoulder",
    "l_elbow",
    "l_wrist",
    "r_shoulder",
    "r_elbow",
    "r_wrist",
    "l_hip",
    "l_knee",
    "l_ankle",
    "l_toe",
    "r_hip",
    "r_knee",
    "r_ankle",
    "r_toe",
];

/// Names of the coordinates; the first three are metres, the others radians.
pub const BODY_ANGLE_NAMES: [&str; BODY_ANGLES] = [
    "root_x",
    "root_y",
    "root_z",
    "root_turn",
    "root_tilt",
    "root_pitch",
    "trunk_pitch",
    "trunk_tilt",
    "trunk_turn",
    "head_pitch",
    "head_tilt",
    "head_turn",
    "l_shoulder_elevation",
    "l_shoulder_deviation",
    "l_shoulder_rotation",
    "l_elbow_flexion",
    "r_shoulder_elevation",
    "r_shoulder_deviation",
    "r_shoulder_rotation",
    "r_elbow_flexion",
    "l_hip_flexion",
    "l_hip_abduction",
    "l_hip_rotation",
    "l_knee_flexion",
    "l_ankle_flexion",
    "r_hip_flexion",
    "r_hip_abduction",
    "r_hip_rotation",
    "r_knee_flexion",
    "r_ankle_flexion",
];

/// Radii of the bones' capsules for a girth of one, metres; the pelvis has none.
///
/// Chosen: half-widths of an adult of [`super::body_measures::REFERENCE_HEIGHT_M`].
pub const BODY_RADII_M: [f32; BODY_BONES] = [
    0.0, 0.125, 0.095, 0.060, 0.050, 0.042, 0.060, 0.050, 0.042, 0.090, 0.080, 0.055, 0.042, 0.090, 0.080, 0.055, 0.042,
];

/// Index of each bone's parent; the pelvis has none.
pub const BODY_PARENTS: [Option<u8>; BODY_BONES] = [
    None,
    Some(0),
    Some(1),
    Some(1),
    Some(3),
    Some(4),
    Some(1),
    Some(6),
    Some(7),
    Some(0),
    Some(9),
    Some(10),
    Some(11),
    Some(0),
    Some(13),
    Some(14),
    Some(15),
];

const LEFT: Vec3 = Vec3::new(1.0, 0.0, 0.0);
const UP: Vec3 = Vec3::new(0.0, -1.0, 0.0);
const FRONT: Vec3 = Vec3::new(0.0, 0.0, -1.0);

/// Largest shift of the root from the camera, metres.
///
/// Chosen: a box that no recording reaches.
const MAX_SHIFT_M: f32 = 100.0;
/// Largest turn about the vertical, degrees.
///
/// Chosen: a hundred turns, which no recording reaches.
const MAX_TURN_DEG: f32 = 36_000.0;

/// Ranges of motion of a healthy adult, rounded outwards, since a hip or a trunk of one joint
/// stands for several.
pub(super) const LIMITS: [Limit; BODY_ANGLES] = {
    let shift = Limit { low_rad: -MAX_SHIFT_M, high_rad: MAX_SHIFT_M };
    let degrees = Limit::from_degrees;
    let shoulder = super::arm::ARM_LIMITS;
    let hip = [degrees(-45.0, 140.0), degrees(-45.0, 75.0), degrees(-70.0, 70.0)];
    let (knee, ankle) = (degrees(0.0, 160.0), degrees(-70.0, 60.0));
    [
        shift,
        shift,
        shift,
        degrees(-MAX_TURN_DEG, MAX_TURN_DEG),
        degrees(-80.0, 80.0),
        degrees(-180.0, 180.0),
        degrees(-45.0, 100.0),
        degrees(-50.0, 50.0),
        degrees(-60.0, 60.0),
        degrees(-70.0, 80.0),
        degrees(-50.0, 50.0),
        degrees(-85.0, 85.0),
        shoulder[0],
        shoulder[1],
        shoulder[2],
        shoulder[3],
        shoulder[0],
        shoulder[1],
        shoulder[2],
        shoulder[3],
        hip[0],
        hip[1],
        hip[2],
        knee,
        ankle,
        hip[0],
        hip[1],
        hip[2],
        knee,
        ankle,
    ]
};

/// A body with the given measures.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{BODY_ANGLES, FEET, HEAD, full_body};
///
/// let person = full_body(&BodyMeasures::of_height(1.75)?)?;
/// // Standing, three metres before the camera.
/// let mut pose = [0.0; BODY_ANGLES];
/// pose[2] = 3.0;
/// let standing = posture(&person, &Vec3::zeros(), &pose).ends;
/// let from_toe_to_head_m = standing[FEET[0]].y - standing[HEAD].y;
/// assert!(
///     (1.55..1.75).contains(&from_toe_to_head_m),
///     "a head ends above its middle: {from_toe_to_head_m}"
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// As [`BodyMeasures::checked`].
pub fn full_body(measures: &BodyMeasures) -> Result<BodySkeleton, ParameterError> {
    let mut bones = [NO_BONE; BODY_BONES];
    fill_bones(measures, &mut bones)?;
    Skeleton::new(bones, LIMITS)
}

/// Holds a bone's place until it is known.
pub(super) const NO_BONE: Bone = Bone { parent: None, joint: Joint::Fixed, offset_m: Vec3::new(0.0, 0.0, 0.0) };

/// Writes as many of the body's bones as there is room for.
// Not inlined: it leaves the stack before the skeleton needs it.
#[inline(never)]
pub(super) fn fill_bones(measures: &BodyMeasures, bones: &mut [Bone]) -> Result<(), ParameterError> {
    let measures = measures.checked()?;
    let mut set = |index: usize, joint: Joint, offset_m: Vec3| {
        if let (Some(bone), Some(&parent)) = (bones.get_mut(index), BODY_PARENTS.get(index)) {
            *bone = Bone { parent, joint, offset_m };
        }
    };
    let bend = Joint::Ball([UP.cross(&FRONT), UP.cross(&LEFT), UP]);
    let root = Joint::Free([Vec3::x(), Vec3::y(), Vec3::z(), UP, UP.cross(&LEFT), UP.cross(&FRONT)]);
    set(PELVIS, root, Vec3::zeros());
    set(TRUNK, bend, UP * measures.trunk_m);
    set(HEAD, bend, UP * measures.head_m);
    for (side, outward) in [LEFT, -LEFT].into_iter().enumerate() {
        let place = |offset: Vec3| outward * offset.x + UP * offset.y + FRONT * offset.z;
        let arm_side = if side == 0 { Side::Left } else { Side::Right };
        let arm = ArmGeometry::new(arm_side, measures.upper_arm_m, measures.forearm_m)?;
        let [upper_arm, forearm] = arm.bones_of_body();
        set(COLLARS[side], Joint::Fixed, place(measures.shoulder_m));
        set(UPPER_ARMS[side], upper_arm.joint, upper_arm.offset_m);
        set(FOREARMS[side], forearm.joint, forearm.offset_m);
        let down = -UP;
        let hip = Joint::Ball([down.cross(&FRONT), down.cross(&outward), FRONT.cross(&-outward)]);
        set(HIPS[side], Joint::Fixed, place(measures.hip_m));
        set(THIGHS[side], hip, down * measures.thigh_m);
        set(SHANKS[side], Joint::Hinge(FRONT.cross(&down)), down * measures.shank_m);
        set(FEET[side], Joint::Hinge(FRONT.cross(&UP)), place(measures.foot_m));
    }
    Ok(())
}

/// Radii of the capsules of a body with the given measures, metres; zero for a bone without flesh.
///
/// ```
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{BODY_RADII_M, PELVIS, THIGHS, body_radii_m};
///
/// let slim = BodyMeasures { girth: 0.9, ..BodyMeasures::of_height(1.75)? };
/// let radii_m = body_radii_m(&slim);
/// assert!((radii_m[THIGHS[0]] - 0.9 * BODY_RADII_M[THIGHS[0]]).abs() < 1e-6);
/// assert_eq!(radii_m[PELVIS], 0.0, "no flesh of its own");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[must_use]
pub fn body_radii_m(measures: &BodyMeasures) -> [f32; BODY_BONES] {
    BODY_RADII_M.map(|radius| radius * measures.girth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use proptest::prelude::*;

    fn adult() -> BodySkeleton {
        full_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap()
    }

    /// The posture with one coordinate changed, `degrees` away from rest.
    fn with(name: &str, degrees: f32) -> crate::kinematics::forward::Posture<BODY_BONES, BODY_ANGLES> {
        let mut angles = [0.0; BODY_ANGLES];
        let index = BODY_ANGLE_NAMES.iter().position(|other| *other == name).unwrap();
        angles[index] = degrees.to_radians();
        posture(&adult(), &Vec3::zeros(), &angles)
    }

    #[test]
    fn signs_are_those_of_the_words() {
        let rest = posture(&adult(), &Vec3::zeros(), &[0.0; BODY_ANGLES]);
        let moved = |name: &str, bone: usize, towards: Vec3| {
            let change = with(name, 30.0).ends[bone] - rest.ends[bone];
            assert!(change.dot(&towards) > 0.01, "{name}: {change:?}");
        };
        moved("trunk_pitch", HEAD, FRONT);
        moved("trunk_tilt", HEAD, LEFT);
        moved("trunk_turn", FOREARMS[1], FRONT);
        moved("root_pitch", HEAD, FRONT);
        moved("root_tilt", HEAD, LEFT);
        moved("root_turn", FOREARMS[1], FRONT);
        for (side, outward) in [("l", LEFT), ("r", -LEFT)] {
            let i = usize::from(side == "r");
            moved(&format!("{side}_shoulder_elevation"), FOREARMS[i], outward);
            moved(&format!("{side}_elbow_flexion"), FOREARMS[i], FRONT);
            moved(&format!("{side}_hip_flexion"), SHANKS[i], FRONT);
            moved(&format!("{side}_hip_abduction"), SHANKS[i], outward);
            moved(&format!("{side}_hip_rotation"), FEET[i], -outward);
            moved(&format!("{side}_knee_flexion"), SHANKS[i], -FRONT);
            moved(&format!("{side}_ankle_flexion"), FEET[i], UP);
        }
    }

    #[test]
    fn every_joint_hangs_on_its_name() {
        let rest = posture(&adult(), &Vec3::new(0.0, 0.0, 3.0), &[0.0; BODY_ANGLES]);
        for (i, name) in BODY_JOINT_NAMES.iter().enumerate() {
            let side = rest.ends[i].dot(&LEFT);
            assert_eq!(name.starts_with("l_"), side > 0.02, "{name}");
            assert_eq!(name.starts_with("r_"), side < -0.02, "{name}");
            assert_eq!(BODY_RADII_M[i] > 0.0, i != PELVIS);
        }
        assert!(rest.ends[HEAD].dot(&UP) > rest.ends[TRUNK].dot(&UP));
        assert!(rest.ends[FEET[0]].dot(&FRONT) > rest.ends[SHANKS[0]].dot(&FRONT) + 0.1);
    }

    proptest! {
        #[test]
        fn the_jacobian_of_every_end_is_the_slope_of_forward_kinematics(
            shares in prop::collection::vec(0.02_f32..0.98, BODY_ANGLES), bone in 0..BODY_BONES, angle in 0..BODY_ANGLES,
        ) {
            let skeleton = adult();
            let mut angles = [0.0; BODY_ANGLES];
            for i in 0..BODY_ANGLES {
                let limit = skeleton.limits()[i];
                let (low, high) = (limit.low_rad.max(-3.0), limit.high_rad.min(3.0));
                angles[i] = low + (high - low) * shares[i];
            }
            let step = 0.01;
            let (mut below, mut above) = (angles, angles);
            below[angle] -= step;
            above[angle] += step;
            let root = Vec3::zeros();
            let slope = (posture(&skeleton, &root, &above).ends[bone] - posture(&skeleton, &root, &below).ends[bone])
                / (2.0 * step);
            let exact = crate::kinematics::jacobian::column(&skeleton, &posture(&skeleton, &root, &angles), bone, angle);
            prop_assert!((slope - exact).norm() < 3.0e-4, "{} instead of {}", slope, exact);
        }
    }
}
