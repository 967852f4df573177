//! The 14 joints of the stick figure in recordings of many makers, by the names that they usually
//! give.
//!
//! Names are compared without case, without what stands before a colon, and without `_`, `.`, `-`
//! and spaces.

use super::error::MotionError;
use super::markers::MarkerMotion;
use sinew_core::math::{Vec3, unit};
use std::path::Path;

/// Joints of the stick figure, in the order of `sinew_core::skeleton::stick_figure::HUMAN`.
pub const JOINTS: usize = 14;
/// Position of the root among the joints.
pub const HIP_CENTER: usize = 0;
/// Position of the neck among the joints.
pub const NECK: usize = 1;
/// Positions of the left and the right shoulder.
pub const SHOULDERS: [usize; 2] = [2, 5];
/// Positions of the left and the right hip.
pub const HIPS: [usize; 2] = [8, 11];

/// Names of one limb joint. Each entry is an alternative; `+` is the middle of two points. `{L}`
/// stands for left or right, `{l}` for l or r. The first choice that is in the file is taken.
///
/// Order matters. Beside `LeftArm`, `LeftShoulder` is where the collar bone begins. Beside
/// `LeftUpLeg`, `LHipJoint` is the middle of the pelvis.
const LIMBS: [(&str, &[&str]); 6] = [
    (
        "shoulder",
        &[
            "{L}arm",
            "upperarm{l}",
            "{L}upperarm",
            "{l}clavicle",
            "{L}shoulder",
            "{l}shoulder",
            "{l}sjc",
            "{l}sho",
            "{l}acromion",
        ],
    ),
    (
        "elbow",
        &[
            "{L}forearm",
            "lowerarm{l}",
            "{L}lowerarm",
            "{l}humerus",
            "{L}elbow",
            "{l}elbow",
            "{l}ejc",
            "{l}elb+{l}elbm",
            "{l}elb",
        ],
    ),
    (
        "wrist",
        &["{L}hand", "hand{l}", "{l}radius", "{L}wrist", "{l}wrist", "{l}wjc", "{l}wra+{l}wrb", "{l}wra", "{l}wrb"],
    ),
    ("hip", &["{L}upleg", "upperleg{l}", "{L}upperleg", "{L}thigh", "{l}hipjoint", "{L}hip", "{l}hip", "{l}hjc"]),
    (
        "knee",
        &[
            "{L}leg",
            "lowerleg{l}",
            "{L}lowerleg",
            "{L}shin",
            "{l}femur",
            "{L}knee",
            "{l}knee",
            "{l}kjc",
            "{l}kne+{l}knem",
            "{l}kne",
        ],
    ),
    ("ankle", &["{L}foot", "foot{l}", "{l}tibia", "{L}ankle", "{l}ankle", "{l}ajc", "{l}ank+{l}ankm", "{l}ank"]),
];
const ROOT: &[&str] = &["hips", "root", "pelvis", "midhip", "hipcenter", "hip", "chip"];
const NECKS: &[&str] = &["neck", "thorax", "c7+clav", "leftshoulder+rightshoulder", "c7"];
/// Front and back of the pelvis (ASIS and PSIS) of one side.
const PELVIS_FRONT: &[&str] = &["{l}asi", "{l}asis", "{l}fwt"];
const PELVIS_BACK: &[&str] = &["{l}psi", "{l}psis", "{l}bwt"];

/// Hip joint centre from the middle of the front of the pelvis, in units of its width: behind,
/// below, to the side (A. L. Bell, R. A. Brand, D. R. Pedersen, Human Movement Science 8, 1989).
const HIP_FROM_FRONT: [f32; 3] = [0.22, 0.30, 0.36];

/// Where a joint comes from.
#[derive(Debug, Clone, PartialEq)]
enum Source {
    /// The middle of these points of the file.
    Points(Vec<usize>),
    /// The middle of two joints of the figure, found before.
    Joints([usize; 2]),
    /// Hip joint from front left, front right, back left, back right of the pelvis; +1 is the left
    /// one.
    Pelvis([usize; 4], f32),
}

/// The joints of one frame, metres; `None` where one was not seen.
pub type SpatialJoints = [Option<Vec3>; JOINTS];

/// Which points of a file make up each joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointSources {
    sources: [Option<Source>; JOINTS],
}

fn plain(name: &str) -> String {
    let name = name.rsplit(':').next().unwrap_or(name);
    name.chars().filter(|letter| !matches!(letter, '_' | '.' | '-' | ' ')).collect::<String>().to_ascii_lowercase()
}

fn sided(pattern: &str, left: bool) -> String {
    let (long, short) = if left { ("left", "l") } else { ("right", "r") };
    pattern.replace("{L}", long).replace("{l}", short)
}

/// Points whose middle the first of `patterns` asks for that is among the `known` plain names.
fn points_called(known: &[String], patterns: &[&str], left: bool) -> Option<Vec<usize>> {
    let point = |name: &str| known.iter().position(|other| other == name);
    patterns.iter().find_map(|pattern| sided(pattern, left).split('+').map(point).collect())
}

/// The points of one more joint, by `patterns` as for the limbs. Each entry is an alternative; `+`
/// is the middle of points, `{L}` and `{l}` the side. `None` where no choice is among `names`.
#[must_use]
pub fn named_points(names: &[String], patterns: &[&str], left: bool) -> Option<Vec<usize>> {
    let known: Vec<String> = names.iter().map(|name| plain(name)).collect();
    points_called(&known, patterns, left)
}

impl JointSources {
    /// Finds the joints among `names`. Without `partial` every limb joint has to be there; `path`
    /// is for the message.
    ///
    /// # Errors
    /// Lists the joints that go by no name that is known, and the names that are there.
    pub fn find(names: &[String], partial: bool, path: &Path) -> Result<Self, MotionError> {
        let known: Vec<String> = names.iter().map(|name| plain(name)).collect();
        let point = |name: &str| known.iter().position(|other| other == name);
        let choose = |patterns: &[&str], left: bool| points_called(&known, patterns, left).map(Source::Points);
        let mut sources: [Option<Source>; JOINTS] = std::array::from_fn(|_| None);
        let pelvis = || {
            let corner =
                |patterns: &[&str], left: bool| patterns.iter().find_map(|pattern| point(&sided(pattern, left)));
            Some([
                corner(PELVIS_FRONT, true)?,
                corner(PELVIS_FRONT, false)?,
                corner(PELVIS_BACK, true)?,
                corner(PELVIS_BACK, false)?,
            ])
        };
        for (side, left) in [(0, true), (1, false)] {
            for (limb, (_, patterns)) in LIMBS.iter().enumerate() {
                let first = if limb < 3 { SHOULDERS[side] } else { HIPS[side] };
                sources[first + limb % 3] = choose(patterns, left);
            }
            let hip = &mut sources[HIPS[side]];
            if hip.is_none() {
                *hip = pelvis().map(|corners| Source::Pelvis(corners, if left { 1.0 } else { -1.0 }));
            }
        }
        sources[HIP_CENTER] = choose(ROOT, true).or(Some(Source::Joints(HIPS)));
        // Both collar bones begin at the neck; but where no `LeftArm` is there, `LeftShoulder` is
        // the shoulder itself.
        let collar_names_shoulder = point("leftarm").is_none();
        let necks: Vec<&str> =
            NECKS.iter().copied().filter(|name| !(collar_names_shoulder && name.contains("shoulder"))).collect();
        sources[NECK] = choose(&necks, true).or(Some(Source::Joints(SHOULDERS)));
        let found = Self { sources };
        let missing = found.missing();
        if missing.is_empty() || (partial && missing.len() < 2 * LIMBS.len()) {
            return Ok(found);
        }
        let remedy = if partial { "" } else { "; with --partial what is there is used" };
        let wanted = format!("{}{remedy}", missing.join(", "));
        Err(MotionError::NoJoint { path: path.to_path_buf(), wanted, joints: names.to_vec() })
    }

    /// Names of the limb joints that were not found, with the names by which they would be.
    fn missing(&self) -> Vec<String> {
        let mut missing = Vec::new();
        for (side, left) in [(0, true), (1, false)] {
            for (limb, (name, patterns)) in LIMBS.iter().enumerate() {
                let first = if limb < 3 { SHOULDERS[side] } else { HIPS[side] };
                if self.sources[first + limb % 3].is_none() {
                    let examples: Vec<String> = patterns.iter().map(|pattern| sided(pattern, left)).collect();
                    let side = if left { "left" } else { "right" };
                    missing.push(format!("{side} {name} ({})", examples.join(", ")));
                }
            }
        }
        missing
    }

    /// The joints of one frame.
    #[must_use]
    pub fn joints(&self, positions_m: &[Option<Vec3>]) -> SpatialJoints {
        let mut joints: SpatialJoints = [None; JOINTS];
        let limbs_first = (2..JOINTS).chain([HIP_CENTER, NECK]);
        for joint in limbs_first {
            joints[joint] = match &self.sources[joint] {
                None => None,
                Some(Source::Points(points)) => middle(points.iter().map(|&point| positions_m[point])),
                Some(Source::Joints(two)) => middle(two.iter().map(|&joint| joints[joint])),
                Some(Source::Pelvis(corners, side)) => hip_centre(corners.map(|corner| positions_m[corner]), *side),
            };
        }
        joints
    }

    /// The joints of all frames of `motion`.
    #[must_use]
    pub fn of_motion(&self, motion: &MarkerMotion) -> Vec<SpatialJoints> {
        motion.positions_m.iter().map(|positions_m| self.joints(positions_m)).collect()
    }
}

/// Middle of some points; `None` where one of them is missing.
pub fn middle(points: impl ExactSizeIterator<Item = Option<Vec3>>) -> Option<Vec3> {
    let count = points.len() as f32;
    let mut sum = Vec3::zeros();
    for point in points {
        sum += point?;
    }
    Some(sum / count)
}

fn hip_centre(corners_m: [Option<Vec3>; 4], side: f32) -> Option<Vec3> {
    let [front_left, front_right, back_left, back_right] = corners_m;
    let (front_left, front_right) = (front_left?, front_right?);
    let front = (front_left + front_right) / 2.0;
    let back = (back_left? + back_right?) / 2.0;
    let across = front_left - front_right;
    let left = unit(across)?;
    let ahead = front - back;
    let ahead = unit(ahead - left * ahead.dot(&left))?;
    let up = ahead.cross(&left);
    let [behind, below, beside] = HIP_FROM_FRONT.map(|fraction| fraction * across.norm());
    Some(front - ahead * behind - up * below + left * (side * beside))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(list: &str) -> Vec<String> {
        list.split_whitespace().map(str::to_owned).collect()
    }

    /// Each point is at (its number, 0, 0), so a joint's place shows its points.
    fn found(list: &str) -> [Option<f32>; JOINTS] {
        let names = names(list);
        let sources = JointSources::find(&names, false, Path::new("m")).unwrap();
        let positions: Vec<_> = (0..names.len()).map(|i| Some(Vec3::new(i as f32, 0.0, 0.0))).collect();
        sources.joints(&positions).map(|joint| joint.map(|position| position.x))
    }

    #[test]
    fn the_usual_skeletons_are_known() {
        let cmu = "root lhipjoint lfemur ltibia lfoot rhipjoint rfemur rtibia lowerback thorax lclavicle lhumerus lradius lhand rclavicle rhumerus rradius";
        let wanted = [0.0, 9.0, 10.0, 11.0, 12.0, 14.0, 15.0, 16.0, 1.0, 2.0, 3.0, 5.0, 6.0, 7.0].map(Some);
        assert_eq!(found(cmu), wanted);
        let exported = "Hips LHipJoint LeftUpLeg LeftLeg LeftFoot RHipJoint RightUpLeg RightLeg RightFoot Spine LeftShoulder LeftArm LeftForeArm \
            LeftHand RightShoulder RightArm RightForeArm RightHand";
        let wanted = [0.0, 12.0, 11.0, 12.0, 13.0, 15.0, 16.0, 17.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0].map(Some);
        assert_eq!(found(exported), wanted);
        let pose = "LShoulder LElbow LWrist RShoulder RElbow RWrist L.Hip L.Knee L_Ankle x:RHip RKnee RAnkle Neck";
        let wanted = [7.5, 12.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0].map(Some);
        assert_eq!(found(pose), wanted);
    }

    #[test]
    fn missing_joints_are_listed_with_their_names() {
        let legs = names("LHip LKnee LAnkle RHip RKnee");
        let message = JointSources::find(&legs, false, Path::new("m.trc")).unwrap_err().to_string();
        for part in ["m.trc", "left shoulder (leftarm", "right ankle (rightfoot", "--partial", "LHip, LKnee"] {
            assert!(message.contains(part), "{message} lacks {part}");
        }
        assert!(!message.contains("left knee"));
        let sources = JointSources::find(&legs, true, Path::new("m.trc")).unwrap();
        let joints = sources.joints(&[Some(Vec3::x()); 5]);
        assert!(joints[8].is_some() && joints[HIP_CENTER].is_some() && joints[NECK].is_none() && joints[13].is_none());
        assert!(JointSources::find(&names("a b"), true, Path::new("m.trc")).is_err());
    }

    #[test]
    fn hip_joints_follow_from_the_pelvis() {
        // Facing x, up z, left y: fronts at y = +-1, width 2.
        let corners =
            [[1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]].map(|p| Some(Vec3::from(p)));
        let left = hip_centre(corners, 1.0).unwrap();
        assert!((left - Vec3::new(1.0 - 0.44, 0.72, 0.4)).norm() < 1.0e-6, "{left:?}");
        assert!(hip_centre([None; 4], 1.0).is_none());
    }
}
