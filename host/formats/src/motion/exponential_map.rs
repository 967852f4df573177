//! CMU motions as text of exponential maps: a row holds the root's position and 38 joints' rotation
//! vectors.
//!
//! The format comes with work on motion prediction and holds no skeleton. The bones here are those
//! of a standard body (`anthropometry`). All zeros are the T-pose, with arms along x and the front
//! along z. A rotation vector belongs to the transposed rotation, as in matrices that multiply row
//! vectors. Recordings of walking confirm it: arms hang and thighs point down. Row 1 is a rest pose
//! and is left out.

use super::anthropometry as fraction;
use super::asf;
use super::error::{MotionError, number, read_text};
use super::recording::Motion;
use sinew_core::math::{Mat3, Vec3, length};
use std::path::Path;

/// Numbers in a row: the root's position and 38 rotation vectors (End Sites count as joints).
pub const COLUMNS: usize = 117;
/// Body height of the standard body, metres.
const HEIGHT_M: f32 = 1.75;
const ROOT: usize = usize::MAX;

/// A joint that is kept. `number` is its place among the file's 38, `parent` its parent's place in
/// this table. `offset` is its rest position from the parent in body heights (left, up, front).
struct Joint {
    name: &'static str,
    number: usize,
    parent: usize,
    offset: [f32; 3],
}

const fn joint(name: &'static str, number: usize, parent: usize, offset: [f32; 3]) -> Joint {
    Joint { name, number, parent, offset }
}

/// Hips to shoulders, upwards, in three equal parts.
const SPINE: f32 = fraction::TRUNK / 3.0;
const HIP: [f32; 3] = [fraction::HIP_HALF_WIDTH, 0.0, 0.0];
const HIP_RIGHT: [f32; 3] = [-fraction::HIP_HALF_WIDTH, 0.0, 0.0];
const SHOULDER: [f32; 3] = [fraction::SHOULDER_HALF_WIDTH, 0.0, 0.0];
const SHOULDER_RIGHT: [f32; 3] = [-fraction::SHOULDER_HALF_WIDTH, 0.0, 0.0];

/// The joints that place torso and arms; parents stand before their children.
const JOINTS: [Joint; 16] = [
    joint("Hips", 0, ROOT, [0.0; 3]),
    joint("LHipJoint", 1, 0, [0.0; 3]),
    joint("LeftUpLeg", 2, 1, HIP),
    joint("RHipJoint", 7, 0, [0.0; 3]),
    joint("RightUpLeg", 8, 3, HIP_RIGHT),
    joint("LowerBack", 13, 0, [0.0; 3]),
    joint("Spine", 14, 5, [0.0, SPINE, 0.0]),
    joint("Spine1", 15, 6, [0.0, SPINE, 0.0]),
    joint("LeftShoulder", 20, 7, [0.0, SPINE, 0.0]),
    joint("LeftArm", 21, 8, SHOULDER),
    joint("LeftForeArm", 22, 9, [fraction::UPPER_ARM, 0.0, 0.0]),
    joint("LeftHand", 23, 10, [fraction::FOREARM, 0.0, 0.0]),
    joint("RightShoulder", 29, 7, [0.0, SPINE, 0.0]),
    joint("RightArm", 30, 12, SHOULDER_RIGHT),
    joint("RightForeArm", 31, 13, [-fraction::UPPER_ARM, 0.0, 0.0]),
    joint("RightHand", 32, 14, [-fraction::FOREARM, 0.0, 0.0]),
];

/// One joint of the whole body. Its offset is in length units of the CMU collection (0.0254 / 0.45
/// m).
const fn cmu(name: &'static str, number: usize, parent: usize, offset: [f32; 3]) -> Joint {
    Joint { name, number, parent, offset }
}

/// Trunk, head, arms and legs with the bones of an adult of the CMU collection (subject 35, sides
/// averaged). In its rest pose the legs are 20 degrees apart, the collar bones rise, and the hips
/// are below the root.
const WHOLE_BODY: [Joint; 25] = [
    cmu("Hips", 0, ROOT, [0.0; 3]),
    cmu("LHipJoint", 1, 0, [0.0; 3]),
    cmu("LeftUpLeg", 2, 1, [1.68, -1.89, 0.48]),
    cmu("LeftLeg", 3, 2, [2.57, -7.06, 0.0]),
    cmu("LeftFoot", 4, 3, [2.72, -7.48, 0.0]),
    cmu("RHipJoint", 7, 0, [0.0; 3]),
    cmu("RightUpLeg", 8, 5, [-1.68, -1.89, 0.48]),
    cmu("RightLeg", 9, 6, [-2.57, -7.06, 0.0]),
    cmu("RightFoot", 10, 7, [-2.72, -7.48, 0.0]),
    cmu("LowerBack", 13, 0, [0.0; 3]),
    cmu("Spine", 14, 9, [0.0, 2.02, -0.22]),
    cmu("Spine1", 15, 10, [0.0, 2.03, 0.01]),
    cmu("LeftShoulder", 20, 11, [0.0, 2.05, 0.11]),
    cmu("LeftArm", 21, 12, [3.43, 0.90, -0.54]),
    cmu("LeftForeArm", 22, 13, [5.21, 0.0, 0.0]),
    cmu("LeftHand", 23, 14, [3.59, 0.0, 0.0]),
    cmu("RightShoulder", 29, 11, [0.0, 2.05, 0.11]),
    cmu("RightArm", 30, 16, [-3.43, 0.90, -0.54]),
    cmu("RightForeArm", 31, 17, [-5.21, 0.0, 0.0]),
    cmu("RightHand", 32, 18, [-3.59, 0.0, 0.0]),
    cmu("LeftToeBase", 5, 4, [0.22, -0.60, 2.22]),
    cmu("RightToeBase", 11, 8, [-0.22, -0.60, 2.22]),
    cmu("Neck", 16, 11, [0.0, 2.05, 0.11]),
    cmu("Neck1", 17, 22, [0.0, 1.71, 0.21]),
    cmu("Head", 18, 23, [0.0, 1.72, -0.22]),
];

/// Whether a line, or its beginning, is of numbers with commas between them. Other texts have the
/// same ending.
#[must_use]
pub fn is_row(line: &str) -> bool {
    line.split_once(',').is_some_and(|(first, _)| first.trim().parse::<f32>().is_ok())
}

/// Reads a motion, recorded at `frames_per_second`.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path, frames_per_second: f32) -> Result<Motion, MotionError> {
    parse(&read_text(path)?, path, frames_per_second)
}

/// Reads the whole body of a motion, recorded at `frames_per_second`: legs too, with the bones of
/// an adult of the CMU collection.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read_whole_body(path: &Path, frames_per_second: f32) -> Result<Motion, MotionError> {
    parse_joints(&read_text(path)?, path, frames_per_second, &WHOLE_BODY, asf::CMU_METRES_PER_UNIT)
}

/// Parses the text of a motion; `path` is for messages only. The joints are those that place torso
/// and arms.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path, frames_per_second: f32) -> Result<Motion, MotionError> {
    parse_joints(text, path, frames_per_second, &JOINTS, HEIGHT_M)
}

/// Parses the text of a motion of `table`, whose offsets are in units of `unit_m` metres.
fn parse_joints(
    text: &str,
    path: &Path,
    frames_per_second: f32,
    table: &[Joint],
    unit_m: f32,
) -> Result<Motion, MotionError> {
    let joints = table.iter().map(|joint| joint.name.to_string()).collect();
    let parents = table.iter().map(|joint| (joint.parent != ROOT).then_some(joint.parent)).collect();
    let mut motion = Motion { frames_per_second, joints, parents, positions_m: Vec::new(), shortfall: None };
    let mut rows = 0;
    for (index, content) in text.lines().enumerate().filter(|(_, content)| !content.trim().is_empty()) {
        let words: Vec<&str> = content.split(',').map(str::trim).collect();
        if words.len() != COLUMNS {
            let rule = format!("a row needs {COLUMNS} numbers with commas between them, found {}", words.len());
            return Err(MotionError::broken(path, index + 1, rule));
        }
        let values = words.iter().map(|word| number(path, index + 1, word)).collect::<Result<Vec<f32>, _>>()?;
        rows += 1;
        if rows > 1 {
            place(&values, table, unit_m, &mut motion.positions_m);
        }
    }
    if motion.is_empty() {
        return Err(MotionError::broken(path, rows, "a motion needs the rest pose and at least one more row"));
    }
    Ok(motion)
}

/// Forward kinematics of one row.
fn place(values: &[f32], table: &[Joint], unit_m: f32, positions_m: &mut Vec<Vec3>) {
    let root_m = Vec3::new(values[0], values[1], values[2]) * asf::CMU_METRES_PER_UNIT;
    let mut globals: Vec<(Vec3, Mat3)> = Vec::with_capacity(table.len());
    for joint in table {
        let at = 3 + 3 * joint.number;
        let vector = Vec3::new(values[at], values[at + 1], values[at + 2]);
        let angle_rad = length(&vector);
        let rotation =
            if angle_rad > 1.0e-9 { asf::rotation(&(vector / angle_rad), -angle_rad) } else { Mat3::identity() };
        let (parent, frame) = globals.get(joint.parent).copied().unwrap_or((root_m, Mat3::identity()));
        globals.push((parent + frame * Vec3::from(joint.offset) * unit_m, frame * rotation));
    }
    positions_m.extend(globals.into_iter().map(|(position_m, _)| position_m));
}

#[cfg(test)]
mod tests {
    use super::super::arm_motion::{ArmMotion, ArmSide};
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    fn row(change: &[(usize, f32)]) -> String {
        let mut values = vec![0.0_f32; COLUMNS];
        for &(column, value) in change {
            values[column] = value;
        }
        values.iter().map(f32::to_string).collect::<Vec<_>>().join(",")
    }

    fn parsed(rows: &[String]) -> Result<Motion, MotionError> {
        parse(&rows.join("\n"), Path::new("m.txt"), 120.0)
    }

    /// A rotation by millions of turns is one all the same: bones keep their length.
    #[test]
    fn any_number_of_turns_is_a_rotation() {
        let turned = row(&[(3 + 3 * 15, 875_557_001.0), (3 + 3 * 15 + 1, 5.0)]);
        let motion = parsed(&[row(&[]), turned]).unwrap();
        assert!(motion.positions_m.iter().all(|position_m| position_m.norm() < 2.0));
    }

    #[test]
    fn zeros_are_the_t_pose_and_the_first_row_is_left_out() {
        let motion = parsed(&[row(&[(0, 9.0)]), row(&[(1, 0.45 / 0.0254)])]).unwrap();
        assert_eq!(motion.len(), 1);
        let arms = ArmMotion::from_motion(&motion, Path::new("m.txt")).unwrap();
        assert!((arms.side(ArmSide::Left)[0].upper_arm - Vec3::x()).norm() < 1.0e-5);
        assert!((arms.side(ArmSide::Right)[0].forearm + Vec3::x()).norm() < 1.0e-5);
        assert!((motion.frame(0)[0] - Vec3::y()).norm() < 1.0e-5, "the root is 1 m high");
    }

    /// A vector (0, 0, pi/2) of the left upper arm belongs to the turn by -pi/2 about z: x -> -y,
    /// the arm hangs.
    #[test]
    fn a_vector_belongs_to_the_transposed_rotation() {
        let left_arm = 3 + 3 * 21;
        let motion = parsed(&[row(&[]), row(&[(left_arm + 2, FRAC_PI_2), (left_arm + 4, FRAC_PI_2)])]).unwrap();
        let arms = ArmMotion::from_motion(&motion, Path::new("m.txt")).unwrap();
        let left = arms.side(ArmSide::Left)[0];
        assert!((left.upper_arm + Vec3::y()).norm() < 1.0e-5);
        // The forearm's own (0, pi/2, 0): x -> z, which the upper arm's turn about z leaves.
        assert!((left.forearm - Vec3::z()).norm() < 1.0e-5, "{:?}", left.forearm);
    }

    #[test]
    fn broken_files_name_file_line_and_rule() {
        let cases = [
            (vec![row(&[]), "1,2".into()], "m.txt:2: a row needs 117 numbers with commas between them, found 2"),
            (vec![row(&[]), row(&[(5, f32::NAN)])], "m.txt:2: `NaN` is not finite"),
            (vec![row(&[])], "m.txt:1: a motion needs the rest pose"),
        ];
        for (rows, message) in cases {
            let found = parsed(&rows).unwrap_err().to_string();
            assert!(found.starts_with(message), "{found}");
        }
    }
}
