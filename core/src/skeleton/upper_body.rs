//! The upper body of a person whose legs are not seen: 9 bones, 8 of them with flesh, and 17
//! coordinates.
//!
//! Its bones are the first of [`super::full_body`] under the same indices. The trunk does not turn
//! against the pelvis: without legs nothing separates both apart, so the root turns both.
//!
//! ```
//! use sinew_core::skeleton::BodyMeasures;
//! use sinew_core::skeleton::full_body::BODY_ANGLES;
//! use sinew_core::skeleton::upper_body::{UPPER_ANGLES, upper_body, upper_coordinates};
//!
//! let desk = upper_body(&BodyMeasures::of_height(1.75)?)?;
//! assert_eq!(desk.limits().len(), UPPER_ANGLES);
//! // A whole body's numbers, those of the upper body picked out.
//! let whole: [usize; BODY_ANGLES] = std::array::from_fn(|index| index);
//! assert_eq!(upper_coordinates(&whole)[6], 9, "trunk angles are left out");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::body_measures::BodyMeasures;
use super::full_body::{BODY_ANGLES, BODY_BONES, BODY_RADII_M, LIMITS, NO_BONE, TRUNK, fill_bones};
use super::tree::{Joint, Skeleton};
use crate::error::ParameterError;

/// Bones of an upper body: pelvis, trunk, head, collars and arms.
pub const UPPER_BONES: usize = 9;
/// Coordinates of an upper body: three shifts and 14 angles.
pub const UPPER_ANGLES: usize = 17;
/// An upper body.
///
/// ```
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{FOREARMS, HEAD};
/// use sinew_core::skeleton::upper_body::{UpperSkeleton, upper_body};
///
/// let desk: UpperSkeleton = upper_body(&BodyMeasures::of_height(1.75)?)?;
/// // A whole body's indices hold: those of arms and head come first.
/// let forearm = desk.bones()[FOREARMS[1]];
/// assert!((forearm.offset_m.norm() - 0.146 * 1.75).abs() < 1e-5);
/// assert!(!desk.angle_moves(desk.limits().len() - 1, HEAD), "the last angle is an elbow's");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub type UpperSkeleton = Skeleton<UPPER_BONES, UPPER_ANGLES>;

/// Where each coordinate stands among those of a whole body: the root's, the head's and the arms'.
pub const UPPER_COORDINATES: [usize; UPPER_ANGLES] = [0, 1, 2, 3, 4, 5, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19];

/// Entries of a whole body's coordinates that an upper body has, too.
///
/// ```
/// use sinew_core::skeleton::full_body::BODY_ANGLE_NAMES;
/// use sinew_core::skeleton::upper_body::upper_coordinates;
///
/// let names = upper_coordinates(&BODY_ANGLE_NAMES);
/// assert_eq!(names[6], "head_pitch", "the trunk's angles are left out");
/// assert!(names.iter().all(|name| !name.contains("knee")));
/// ```
#[must_use]
pub fn upper_coordinates<T: Copy>(whole: &[T; BODY_ANGLES]) -> [T; UPPER_ANGLES] {
    UPPER_COORDINATES.map(|index| whole[index % BODY_ANGLES])
}

/// Entries of a whole body's bones that an upper body has, too.
///
/// ```
/// use sinew_core::skeleton::full_body::BODY_JOINT_NAMES;
/// use sinew_core::skeleton::upper_body::upper_bones;
///
/// let names = upper_bones(&BODY_JOINT_NAMES);
/// assert_eq!(names[..3], ["pelvis", "neck", "head"]);
/// assert_eq!(names[8], "r_wrist", "legs come after the arms");
/// ```
#[must_use]
pub fn upper_bones<T: Copy>(whole: &[T; BODY_BONES]) -> [T; UPPER_BONES] {
    core::array::from_fn(|bone| whole[bone % BODY_BONES])
}

/// An upper body with the given measures; those of the legs are not read, but have to be lengths.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::HEAD;
/// use sinew_core::skeleton::upper_body::{UPPER_ANGLES, upper_body};
///
/// let desk = upper_body(&BodyMeasures::of_height(1.75)?)?;
/// // A person at a desk, 0.8 m before the camera, bends forward: the head comes nearer.
/// let mut pose = [0.0; UPPER_ANGLES];
/// pose[2] = 0.8;
/// let upright = posture(&desk, &Vec3::zeros(), &pose).ends;
/// pose[5] = 0.3;
/// let leaning = posture(&desk, &Vec3::zeros(), &pose).ends;
/// assert!(leaning[HEAD].z < upright[HEAD].z - 0.1);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// As [`BodyMeasures::checked`].
pub fn upper_body(measures: &BodyMeasures) -> Result<UpperSkeleton, ParameterError> {
    let mut bones = [NO_BONE; UPPER_BONES];
    fill_bones(measures, &mut bones)?;
    bones[TRUNK].joint = Joint::Fixed;
    Skeleton::new(bones, upper_coordinates(&LIMITS))
}

/// Radii of the capsules of an upper body with the given measures, metres; zero for a bone without
/// flesh.
///
/// ```
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{BODY_RADII_M, TRUNK};
/// use sinew_core::skeleton::upper_body::upper_radii_m;
///
/// // Of a body as tall as the reference the radii are those of the table.
/// let radii_m = upper_radii_m(&BodyMeasures::of_height(1.75)?);
/// assert_eq!(radii_m[TRUNK], BODY_RADII_M[TRUNK]);
/// assert_eq!(radii_m.iter().filter(|radius| **radius > 0.0).count(), 8, "all but the pelvis");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[must_use]
pub fn upper_radii_m(measures: &BodyMeasures) -> [f32; UPPER_BONES] {
    upper_bones(&BODY_RADII_M).map(|radius| radius * measures.girth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::math::Vec3;
    use crate::random::Stream;
    use crate::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_PARENTS, full_body};

    #[test]
    fn its_pose_is_that_of_a_whole_body_with_a_stiff_trunk() {
        let measures = BodyMeasures::of_height(1.8).unwrap();
        let (whole, upper) = (full_body(&measures).unwrap(), upper_body(&measures).unwrap());
        let mut stream = Stream::new(3, 0, 0);
        for _ in 0..50 {
            let mut angles = whole.clamp(core::array::from_fn(|_| stream.normal()));
            angles[6..9].fill(0.0);
            let all = posture(&whole, &Vec3::zeros(), &angles);
            let part = posture(&upper, &Vec3::zeros(), &upper_coordinates(&angles));
            for bone in 0..UPPER_BONES {
                assert!((all.ends[bone] - part.ends[bone]).norm() < 1.0e-5, "bone {bone}");
            }
        }
    }

    #[test]
    fn it_has_what_does_not_hang_on_the_legs() {
        assert!(BODY_PARENTS[..UPPER_BONES].iter().flatten().all(|parent| usize::from(*parent) < UPPER_BONES));
        let is_left_out = |name: &str| ["trunk", "hip", "knee", "ankle"].iter().any(|part| name.contains(part));
        for (index, name) in BODY_ANGLE_NAMES.iter().enumerate() {
            assert_eq!(UPPER_COORDINATES.contains(&index), !is_left_out(name), "{name}");
        }
        let measures = BodyMeasures::of_height(1.75).unwrap();
        assert_eq!(upper_radii_m(&measures).iter().filter(|radius| **radius > 0.0).count(), 8);
    }
}
