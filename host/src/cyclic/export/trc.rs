//! TRC files: positions of the stick figure's joints over time.

use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::image_joints::Point;
use crate::motion::anthropometry as fraction;
use crate::motion::export::{self, TrcFrame, TrcHeading, TrcUnit};
use crate::motion::joint_names::JOINTS;
use sinew_core::skeleton::stick_figure::HUMAN;

/// Marker names in the order of the joints; the names that Pose2Sim and OpenPose models of OpenSim
/// have.
pub const MARKERS: [&str; JOINTS] = [
    "Hip",
    "Neck",
    "LShoulder",
    "LElbow",
    "LWrist",
    "RShoulder",
    "RElbow",
    "RWrist",
    "LHip",
    "LKnee",
    "LAnkle",
    "RHip",
    "RKnee",
    "RAnkle",
];

/// Places of all joints in one frame.
pub type JointPositions = [Option<Point>; JOINTS];

/// Segment lengths in the side view of an adult of `height_m` metres: hip and shoulder links point
/// at the camera and are short there. For angles that came without lengths.
#[must_use]
pub fn standard_lengths_m(height_m: f64) -> [f64; ANGLES] {
    const LINK: f32 = 0.02;
    let arm = [LINK, fraction::UPPER_ARM, fraction::FOREARM];
    let leg = [LINK, fraction::THIGH, fraction::SHANK];
    let [s, u, f] = arm;
    let [h, t, c] = leg;
    [fraction::TRUNK, s, u, f, s, u, f, h, t, c, h, t, c].map(|share| f64::from(share) * height_m)
}

/// Joints of a pose: x right, y down, in the unit of `root` and `lengths`. A joint is `None` where
/// its angle or its parent is.
#[must_use]
pub fn joint_positions(
    root: Option<Point>,
    lengths: &[f64; ANGLES],
    angles_rad: &[Option<f64>; ANGLES],
) -> JointPositions {
    let mut joints = [None; JOINTS];
    joints[0] = root;
    for (index, joint) in HUMAN.joints().iter().enumerate().skip(1) {
        let parent = joint.parent.and_then(|parent| joints[usize::from(parent)]);
        if let (Some([x, y]), Some(angle)) = (parent, angles_rad[index - 1]) {
            let length: f64 = lengths[index - 1];
            joints[index] = Some([x + length * angle.cos(), y + length * angle.sin()]);
        }
    }
    joints
}

/// The text of a TRC file in metres: x forward, y up, z zero. `frames` hold each frame's number and
/// joints in units of `metres_per_unit` metres, x right and y down. Missing joints are empty cells.
#[must_use]
pub fn to_trc(frames: &[(u64, JointPositions)], rate_hz: f64, metres_per_unit: f64, name: &str) -> String {
    let place_m = |[x, y]: Point| [x * metres_per_unit, -y * metres_per_unit, 0.0];
    let in_space = |(frame, joints): &(u64, JointPositions)| TrcFrame {
        frame: *frame,
        positions_m: joints.iter().map(|joint| joint.map(place_m)).collect(),
    };
    let frames: Vec<TrcFrame> = frames.iter().map(in_space).collect();
    export::to_trc(&TrcHeading { name, markers: &MARKERS, rate_hz, unit: TrcUnit::Metre }, &frames)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::joint_names::JointSources;
    use crate::motion::trc;
    use std::f64::consts::FRAC_PI_2;
    use std::path::Path;

    #[test]
    fn what_is_written_is_read_back() {
        let mut angles = [Some(FRAC_PI_2); ANGLES];
        angles[0] = Some(-FRAC_PI_2);
        angles[8] = Some(0.0);
        let standing = joint_positions(Some([100.0, 50.0]), &standard_lengths_m(180.0), &angles);
        angles[9] = None;
        let lacking = joint_positions(Some([101.0, 50.0]), &standard_lengths_m(180.0), &angles);
        assert!(lacking[10].is_none() && lacking[9].is_some());
        let text = to_trc(&[(7, standing), (8, lacking)], 60.0, 0.01, "walk");
        let motion = trc::parse(&text, Path::new("m.trc")).unwrap();
        assert!((motion.frames_per_second - 60.0).abs() < 1.0e-6);
        let sources = JointSources::find(&motion.names, false, Path::new("m.trc")).unwrap();
        for (frame, wanted) in sources.of_motion(&motion).iter().zip([standing, lacking]) {
            for (found, wanted) in frame.iter().zip(wanted) {
                match (found, wanted) {
                    (None, None) => {}
                    (Some(found), Some([x, y])) => {
                        assert!(
                            (f64::from(found.x) - 0.01 * x).abs() < 1.0e-5
                                && (f64::from(found.y) + 0.01 * y).abs() < 1.0e-5
                        );
                    }
                    other => panic!("{other:?}"),
                }
            }
        }
    }

    #[test]
    fn an_adult_stands_as_high_as_the_fractions_say() {
        let lengths = standard_lengths_m(1.8);
        assert!((lengths[0] - 0.288 * 1.8).abs() < 1.0e-6);
        assert!((lengths[8] + lengths[9] - 0.491 * 1.8).abs() < 1.0e-6);
    }
}
