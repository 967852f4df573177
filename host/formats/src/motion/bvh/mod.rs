//! BVH motions. Position channels replace a joint's OFFSET; rotation channels multiply in the order
//! they are listed.

mod header;
#[cfg(test)]
mod tests;

use super::asf::{CMU_METRES_PER_UNIT, about};
use super::error::{MotionError, parsed_number, read_text};
use super::landmarks::Arm;
use super::read_options::ReadOptions;
use super::recording::Motion;
use super::shortfall::{Shortfall, check_positions, whole_rows};
use header::{Channel, Joint, LineReader, hierarchy, motion_header};
use sinew_core::math::{Mat3, Vec3, abs, ln};
use sinew_core::skeleton::Side as ArmSide;
use std::path::Path;

/// Length units that occur: metre, centimetre, millimetre, inch, and the CMU collection's inch /
/// 0.45.
const UNITS_M: [f32; 5] = [1.0, 0.01, 0.001, 0.0254, CMU_METRES_PER_UNIT];
/// Shoulder to wrist of an adult, metres: (0.186 + 0.146) times 1.7 m, after Drillis and Contini.
const SHOULDER_TO_WRIST_M: f32 = 0.332 * 1.7;

/// Reads a BVH file; see [`parse`].
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read_with(path: &Path, options: &ReadOptions<'_>) -> Result<Motion, MotionError> {
    parse_with(&read_text(path)?, path, options)
}

/// Parses the text of a BVH file; `path` is for messages only. An End Site is a joint called
/// `PARENT_end`.
///
/// Without `metres_per_unit` the unit is metre, cm, mm, inch or inch / 0.45: the one that makes the
/// arms most like an adult's. A file without arms is in centimetres.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path, metres_per_unit: Option<f32>) -> Result<Motion, MotionError> {
    parse_with(text, path, &ReadOptions { metres_per_unit, ..ReadOptions::default() })
}

/// As [`parse`], with `options` of which only the unit and `partial` count.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse_with(text: &str, path: &Path, options: &ReadOptions<'_>) -> Result<Motion, MotionError> {
    let mut lines = LineReader::new(text, path);
    let joints = hierarchy(&mut lines)?;
    let header = motion_header(&mut lines)?;
    let rest = lines.lines.map(|(index, row)| (index + 1, row));
    let rows = whole_rows(rest, text.ends_with('\n'), Some(header.frames));
    let shortfall = Shortfall::check(rows.len(), Some(header.frames), options, path, header.line)?;
    if rows.len() > header.frames {
        let rule = format!("`Frames: {}` was promised, {} frames are there", header.frames, rows.len());
        return Err(MotionError::broken(path, header.line, rule));
    }
    check_positions(joints.len(), rows.len(), text.len(), path, header.line)?;
    let mut motion = Motion {
        frames_per_second: 1.0 / header.frame_time_s,
        joints: joints.iter().map(|joint| joint.name.clone()).collect(),
        parents: joints.iter().map(|joint| joint.parent).collect(),
        positions_m: Vec::with_capacity(joints.len() * rows.len()),
        shortfall,
    };
    for (line, row) in rows {
        motion.positions_m.extend(forward_kinematics(&joints, &frame(row, &joints, path, line)?));
    }
    let scale = options.metres_per_unit.unwrap_or_else(|| inferred_unit_m(&motion));
    motion.positions_m.iter_mut().for_each(|position| *position *= scale);
    Ok(motion)
}

/// The numbers of one frame.
fn frame(row: &str, joints: &[Joint], path: &Path, line: usize) -> Result<Vec<f32>, MotionError> {
    let words: Vec<&str> = row.split_whitespace().collect();
    let width = joints.iter().map(|joint| joint.channels.len()).sum::<usize>();
    if words.len() != width {
        let rule = format!("a frame needs {width} numbers, found {}", words.len());
        return Err(MotionError::broken(path, line, rule));
    }
    let owners = joints.iter().flat_map(|joint| joint.channels.iter().map(|_| &joint.name));
    let value = |(word, joint): (&&str, &String)| {
        parsed_number(word).map_err(|rule| MotionError::broken(path, line, format!("{rule} (joint `{joint}`)")))
    };
    words.iter().zip(owners).map(value).collect()
}

fn forward_kinematics(joints: &[Joint], values: &[f32]) -> Vec<Vec3> {
    let mut globals: Vec<(Vec3, Mat3)> = Vec::with_capacity(joints.len());
    let mut next = values.iter();
    for joint in joints {
        let (mut offset, mut rotation) = (joint.offset, Mat3::identity());
        for (channel, value) in joint.channels.iter().zip(&mut next) {
            match *channel {
                Channel::Position(axis) => offset[axis] = *value,
                Channel::Rotation(axis) => rotation *= about(axis, *value * (core::f32::consts::PI / 180.0)),
            }
        }
        let parent = joint.parent.map_or((Vec3::zeros(), Mat3::identity()), |index| globals[index]);
        globals.push((parent.0 + parent.1 * offset, parent.1 * rotation));
    }
    globals.into_iter().map(|(position, _)| position).collect()
}

fn inferred_unit_m(motion: &Motion) -> f32 {
    let Some(arm) = Arm::find(motion, ArmSide::Left).or_else(|| Arm::find(motion, ArmSide::Right)) else {
        return 0.01;
    };
    if motion.is_empty() {
        return 0.01;
    }
    let frame = motion.frame(0);
    let length = (frame[arm.elbow] - frame[arm.shoulder]).norm() + (frame[arm.wrist] - frame[arm.elbow]).norm();
    let misfit = |unit_m: f32| abs(ln(length * unit_m / SHOULDER_TO_WRIST_M));
    UNITS_M.into_iter().fold(0.01, |best, unit_m| if misfit(unit_m) < misfit(best) { unit_m } else { best })
}
