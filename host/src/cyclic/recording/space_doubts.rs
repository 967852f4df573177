//! What cannot be right about a motion in space.

use super::MAX_RATE_DIFFERENCE;
use crate::motion::joint_names::SpatialJoints;
use crate::motion::markers::MarkerMotion;
use crate::signal::median::median;
use std::path::Path;

/// Lengths of a leg, metres: thigh and shank. Chosen: a newborn has 0.2, and the tallest man who
/// was measured had less than 1.4.
const LEG_RANGE_M: [f64; 2] = [0.2, 1.5];
/// Hip, knee and ankle of both legs among the joints.
const LEGS: [[usize; 3]; 2] = [[8, 9, 10], [11, 12, 13]];

/// The legs have the length of no person: the file's unit of length is wrong. The median over
/// frames is taken, of the leg that is seen.
pub(super) fn leg_length(frames: &[SpatialJoints], path: &Path) -> Option<String> {
    let length = |[hip, knee, ankle]: [usize; 3]| {
        let of_frame = |joints: &SpatialJoints| {
            let (hip, knee, ankle) = (joints[hip]?, joints[knee]?, joints[ankle]?);
            Some(f64::from((knee - hip).norm() + (ankle - knee).norm()))
        };
        median(&mut frames.iter().filter_map(of_frame).collect::<Vec<f64>>())
    };
    let leg_m = length(LEGS[0]).or_else(|| length(LEGS[1]))?;
    (!(LEG_RANGE_M[0]..=LEG_RANGE_M[1]).contains(&leg_m)).then(|| {
        format!(
            "a leg in `{}` is {leg_m:.4} m long (thigh and shank), and people have {} to {} m: the table has no lengths and places; correct the unit in the file's header (`Units` of a TRC, `POINT:UNITS` of a C3D)",
            path.display(),
            LEG_RANGE_M[0],
            LEG_RANGE_M[1]
        )
    })
}

/// The user's rate is not the file's.
pub(super) fn rate(motion: &MarkerMotion, path: &Path) -> Option<String> {
    let (given, found) = (f64::from(motion.frames_per_second), f64::from(motion.replaced_rate_hz?));
    ((given / found - 1.0).abs() > MAX_RATE_DIFFERENCE).then(|| {
        format!(
            "`--input-rate {given}` replaces the {found:.2} frames per second of `{}`: times, cadence and speeds follow it; leave the option out, unless the file is wrong",
            path.display()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::joint_names::JOINTS;
    use sinew_core::math::Vec3;

    /// Straight legs of this length; the left ankle is not seen.
    fn legs(leg: f32) -> Vec<SpatialJoints> {
        let mut joints = [None; JOINTS];
        for side in LEGS {
            for (place, joint) in side.into_iter().enumerate() {
                joints[joint] = Some(Vec3::new(0.0, 0.5 * leg * (2 - place) as f32, 0.0));
            }
        }
        joints[LEGS[0][2]] = None;
        vec![joints; 3]
    }

    #[test]
    fn legs_of_no_person_are_doubted_with_file_length_and_remedy() {
        for leg_m in [0.21, 0.85, 1.4] {
            assert_eq!(leg_length(&legs(leg_m), Path::new("walk.trc")), None, "{leg_m}");
        }
        for (leg_m, words) in [(850.0, "`walk.trc` is 850.0000 m long"), (0.00085, "is 0.0009 m"), (8.5, "is 8.5000 m")]
        {
            let doubt = leg_length(&legs(leg_m), Path::new("walk.trc")).unwrap();
            assert!(doubt.contains(words) && doubt.contains("`Units` of a TRC"), "{doubt}");
        }
        assert_eq!(leg_length(&[[None; JOINTS]], Path::new("walk.trc")), None, "no legs");
    }

    #[test]
    fn a_rate_that_is_not_the_files_is_doubted_with_both() {
        let of = |given: f32, found: Option<f32>| {
            let motion = MarkerMotion { frames_per_second: given, replaced_rate_hz: found, ..MarkerMotion::default() };
            rate(&motion, Path::new("walk.trc"))
        };
        let doubt = of(30.0, Some(100.0)).unwrap();
        assert!(doubt.starts_with("`--input-rate 30` replaces the 100.00 frames per second of `walk.trc`"), "{doubt}");
        assert_eq!([of(30.0, Some(29.97)), of(30.0, None)], [None, None]);
    }
}
