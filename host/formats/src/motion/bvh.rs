//! BVH motions. Position channels replace a joint's OFFSET; rotation channels multiply in the order
//! they are listed.

use super::asf::{CMU_METRES_PER_UNIT, about};
use super::error::{MotionError, number, parsed_number, read_text};
use super::landmarks::Arm;
use super::read_options::ReadOptions;
use super::recording::Motion;
use super::shortfall::{Shortfall, check_positions, whole_rows};
use crate::limits::{MAX_JOINTS, MAX_NAME_BYTES, MAX_SKELETON_DEPTH};
use sinew_core::math::{Mat3, Vec3, abs, ln};
use sinew_core::skeleton::Side as ArmSide;
use std::iter::Enumerate;
use std::path::Path;
use std::str::Lines;

/// Length units that occur: metre, centimetre, millimetre, inch, and the CMU collection's inch /
/// 0.45.
const UNITS_M: [f32; 5] = [1.0, 0.01, 0.001, 0.0254, CMU_METRES_PER_UNIT];
/// Shoulder to wrist of an adult, metres: (0.186 + 0.146) times 1.7 m, after Drillis and Contini.
const SHOULDER_TO_WRIST_M: f32 = 0.332 * 1.7;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Channel {
    Position(usize),
    Rotation(usize),
}

#[derive(Debug)]
struct Joint {
    name: String,
    parent: Option<usize>,
    offset: Vec3,
    channels: Vec<Channel>,
}

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
    let mut lines = LineReader { path, lines: text.lines().enumerate(), line: 0 };
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

#[derive(Debug)]
struct LineReader<'a> {
    path: &'a Path,
    lines: Enumerate<Lines<'a>>,
    line: usize,
}

impl<'a> LineReader<'a> {
    fn broken(&self, rule: impl Into<String>) -> MotionError {
        MotionError::broken(self.path, self.line, rule)
    }

    /// Words of the next line that is not blank.
    fn next_words(&mut self) -> Option<Vec<&'a str>> {
        loop {
            let (index, content) = self.lines.next()?;
            self.line = index + 1;
            let words: Vec<&str> = content.split_whitespace().collect();
            if !words.is_empty() {
                return Some(words);
            }
        }
    }

    fn expect(&mut self, what: &str) -> Result<Vec<&'a str>, MotionError> {
        self.next_words().ok_or_else(|| self.broken(format!("the file ends where {what} was expected")))
    }
}

fn hierarchy(lines: &mut LineReader<'_>) -> Result<Vec<Joint>, MotionError> {
    if lines.expect("`HIERARCHY`")?[0] != "HIERARCHY" {
        return Err(lines.broken("a BVH file has to begin with `HIERARCHY`"));
    }
    let mut joints: Vec<Joint> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    loop {
        let words = lines.expect("a joint or `MOTION`")?;
        match words.as_slice() {
            ["MOTION"] if open.is_empty() && !joints.is_empty() => return Ok(joints),
            ["MOTION"] => return Err(lines.broken("`MOTION` before the hierarchy is closed by `}`")),
            ["ROOT", ..] if !joints.is_empty() => return Err(lines.broken("a second `ROOT`; one body is read")),
            ["ROOT", name] => push(lines, &mut joints, &mut open, name)?,
            ["JOINT", name] if !open.is_empty() => push(lines, &mut joints, &mut open, name)?,
            ["End", "Site"] if !open.is_empty() => {
                let name = format!("{}_end", joints[*open.last().unwrap_or(&0)].name);
                push(lines, &mut joints, &mut open, &name)?;
            }
            ["OFFSET", x, y, z] if !open.is_empty() => {
                let read = |word| number(lines.path, lines.line, word);
                joints[*open.last().unwrap_or(&0)].offset = Vec3::new(read(x)?, read(y)?, read(z)?);
            }
            ["CHANNELS", count, names @ ..] if !open.is_empty() => {
                joints[*open.last().unwrap_or(&0)].channels = channels(lines, count, names)?;
            }
            ["}"] if open.pop().is_some() => {}
            other => return Err(lines.broken(format!("`{}` has no place here", other.join(" ")))),
        }
    }
}

fn push(
    lines: &mut LineReader<'_>,
    joints: &mut Vec<Joint>,
    open: &mut Vec<usize>,
    name: &str,
) -> Result<(), MotionError> {
    let parent = open.last().copied();
    if open.len() >= MAX_SKELETON_DEPTH || joints.len() >= MAX_JOINTS || name.len() > MAX_NAME_BYTES {
        return Err(lines.broken(format!(
            "joint `{name}` exceeds a limit: {MAX_JOINTS} joints, {MAX_SKELETON_DEPTH} of them below each other, \
            names of {MAX_NAME_BYTES} bytes"
        )));
    }
    if lines.expect("`{`")? != ["{"] {
        return Err(lines.broken(format!("`{{` was expected after joint `{name}`")));
    }
    open.push(joints.len());
    joints.push(Joint { name: name.to_string(), parent, offset: Vec3::zeros(), channels: Vec::new() });
    Ok(())
}

fn channels(lines: &LineReader<'_>, count: &str, names: &[&str]) -> Result<Vec<Channel>, MotionError> {
    if count.parse() != Ok(names.len()) {
        return Err(lines.broken(format!("`CHANNELS {count}` is followed by {} names", names.len())));
    }
    let channel = |name: &&str| {
        let (axis, kind) = name.split_at_checked(1).unwrap_or(("", ""));
        let axis = "xyz".find(axis.to_ascii_lowercase().as_str()).filter(|_| !axis.is_empty());
        match (axis, kind.to_ascii_lowercase().as_str()) {
            (Some(axis), "position") => Ok(Channel::Position(axis)),
            (Some(axis), "rotation") => Ok(Channel::Rotation(axis)),
            _ => Err(lines.broken(format!("`{name}` is no channel (Xposition .. Zrotation)"))),
        }
    };
    names.iter().map(channel).collect()
}

/// What stands between the hierarchy and the frames.
#[derive(Debug)]
struct MotionHeader {
    frames: usize,
    frame_time_s: f32,
    /// The line that gives the number of frames.
    line: usize,
}

fn motion_header(lines: &mut LineReader<'_>) -> Result<MotionHeader, MotionError> {
    let frames = match lines.expect("`Frames:`")?.as_slice() {
        ["Frames:", count] => count.parse().ok().filter(|&count: &usize| count > 0),
        _ => None,
    };
    let frames = frames.ok_or_else(|| lines.broken("`Frames:` with a count above zero was expected"))?;
    let line = lines.line;
    let words = lines.expect("`Frame Time:`")?;
    let ["Frame", "Time:", seconds] = words.as_slice() else {
        return Err(lines.broken("`Frame Time:` was expected"));
    };
    let frame_time_s = number(lines.path, lines.line, seconds)?;
    // Times that are not normal numbers would give an infinite rate.
    if frame_time_s >= f32::MIN_POSITIVE {
        Ok(MotionHeader { frames, frame_time_s, line })
    } else {
        Err(lines.broken("the frame time has to be greater than zero"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BVH: &str = "HIERARCHY\nROOT Hips\n{\n OFFSET 5 5 5\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n \
        JOINT Arm\n {\n  OFFSET 10 0 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  JOINT Hand\n  {\n   OFFSET 20 0 0\n   \
        CHANNELS 4 Xposition Zrotation Xrotation Yrotation\n   End Site\n   {\n    OFFSET 0 3 0\n   }\n  }\n }\n}\n\
        MOTION\nFrames: 1\nFrame Time: 0.05\n1 2 3 0 0 90 90 0 0 30 0 90 0\n";

    fn parsed(text: &str) -> Result<Motion, MotionError> {
        parse(text, Path::new("m.bvh"), Some(0.01))
    }

    /// Root at (1, 2, 3) instead of its offset, turned 90 degrees about y: x -> -z. Arm: at -10 z,
    /// its own 90 degrees about z turn x to y. Hand: 30 instead of 20, along y. Its 90 degrees
    /// about x turn the end's y to z, which the root turns to x.
    #[test]
    fn positions_replace_offsets_and_rotations_chain() {
        let motion = parsed(BVH).unwrap();
        let expected = [[1.0, 2.0, 3.0], [1.0, 2.0, -7.0], [1.0, 32.0, -7.0], [4.0, 32.0, -7.0]];
        for (found, wanted) in motion.frame(0).iter().zip(expected) {
            assert!((found * 100.0 - Vec3::from(wanted)).norm() < 1.0e-4, "{found:?} is not {wanted:?} cm");
        }
        assert_eq!(motion.joints, ["Hips", "Arm", "Hand", "Hand_end"]);
        assert!((motion.frames_per_second - 20.0).abs() < 1.0e-4);
    }

    #[test]
    fn the_unit_follows_from_the_arms() {
        for (scale, unit_m) in [(0.3, 1.0), (29.0, 0.01), (290.0, 0.001), (11.5, 0.0254), (5.2, 0.0254 / 0.45)] {
            let text = format!(
                "HIERARCHY\nROOT LeftArm\n{{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT LeftForeArm\n{{\nOFFSET {scale} 0 0\nCHANNELS 1 Zrotation\n\
                JOINT LeftHand\n{{\nOFFSET {scale} 0 0\nCHANNELS 0\n}}\n}}\n}}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0\n"
            );
            let motion = parse(&text, Path::new("m.bvh"), None).unwrap();
            let length_m = motion.frame(0)[2].norm();
            assert!((length_m - 2.0 * scale * unit_m).abs() < 1.0e-5, "{scale}: {length_m} m");
        }
    }

    #[test]
    fn broken_files_name_file_line_and_rule() {
        let changes = [
            ("HIERARCHY", "HIERACHY", "m.bvh:1: a BVH file has to begin"),
            ("CHANNELS 3", "CHANNELS 2", "m.bvh:9: `CHANNELS 2` is followed by 3 names"),
            ("Xposition Yposition", "Xposition Qposition", "m.bvh:5: `Qposition` is no channel"),
            ("  }\n }\n}\n", "  }\n }\n", "m.bvh:20: `MOTION` before the hierarchy is closed"),
            ("30 0 90 0", "30 0 90", "m.bvh:24: a frame needs 13 numbers, found 12"),
            ("30 0 90 0", "30 0 inf 0", "m.bvh:24: `inf` is not finite"),
            ("Frames: 1", "Frames: 2", "m.bvh:22: the recording ends early: 1 of the 2 frames that its header"),
            ("30 0 90 0", "30 0 1e10 0", "m.bvh:24: `1e10` is beyond 1e9; every value has to be within (joint `Hand`)"),
            ("Frame Time: 0.05", "Frame Time: 0", "m.bvh:23: the frame time has to be"),
            ("OFFSET 10 0 0", "OFFSET 10 0", "m.bvh:8: `OFFSET 10 0` has no place"),
            ("JOINT Arm\n {", "JOINT Arm\n", "m.bvh:8: `{` was expected after joint `Arm`"),
        ];
        for (from, to, message) in changes {
            let found = parsed(&BVH.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(found.starts_with(message), "{found} does not start with {message}");
        }
        let found = parsed(&format!("{BVH}1 2 3 0 0 90 90 0 0 30 0 90 0")).unwrap_err().to_string();
        assert!(found.starts_with("m.bvh:22: `Frames: 1` was promised, 2 frames are there"), "{found}");
        assert!(parsed("HIERARCHY\nROOT a\n{\n").unwrap_err().to_string().contains("the file ends where"));
    }
    fn partial(text: &str) -> Result<Motion, MotionError> {
        parse_with(text, Path::new("m.bvh"), &ReadOptions { partial: true, ..ReadOptions::default() })
    }

    #[test]
    fn a_file_that_was_cut_is_read_as_far_as_it_is_whole() {
        let row = "1 2 3 0 0 90 90 0 0 30 0 90 0\n";
        let text = BVH.replace("Frames: 1", "Frames: 9") + row + row;
        for missing in [0, 1, 3, row.len() - 1] {
            let cut = &text[..text.len() - missing];
            let message = parsed(cut).unwrap_err().to_string();
            let frames = if missing == 0 { 3 } else { 2 };
            assert!(
                message.contains(&format!("{frames} of the 9 frames")) && message.contains("--partial"),
                "{message}"
            );
            let motion = partial(cut).unwrap();
            assert_eq!((motion.len(), motion.shortfall), (frames, Some(Shortfall { frames, promised: 9 })));
        }
        // A whole file whose last line has no end.
        assert_eq!(partial(BVH.trim_end()).unwrap().shortfall, None);
        let none = text.lines().take(23).collect::<Vec<_>>().join("\n") + "\n";
        assert!(partial(&none).unwrap_err().to_string().contains("0 of the 9 frames"));
    }

    #[test]
    fn depth_number_and_names_of_joints_are_bounded() {
        let nested = |depth: usize| {
            let open = "JOINT b\n{\nOFFSET 0 0 0\n".repeat(depth);
            format!(
                "HIERARCHY\nROOT a\n{{\nCHANNELS 1 Xrotation\n{open}{}}}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n",
                "}\n".repeat(depth)
            )
        };
        assert_eq!(parsed(&nested(MAX_SKELETON_DEPTH - 1)).unwrap().joints.len(), MAX_SKELETON_DEPTH);
        let message = parsed(&nested(MAX_SKELETON_DEPTH)).unwrap_err().to_string();
        assert!(message.contains("256 of them below each other") && message.len() < 400, "{message}");
        let many = format!("HIERARCHY\nROOT a\n{{\n{}", "End Site\n{\n}\n".repeat(MAX_JOINTS));
        assert!(parsed(&many).unwrap_err().to_string().contains("4096 joints"));
        let long = parsed(&BVH.replace("Arm", &"m".repeat(100_000))).unwrap_err().to_string();
        assert!(long.contains("names of 256 bytes") && long.len() < 400, "{long}");
        let ends = "End Site\n{\n}\n".repeat(4000);
        let wide = format!(
            "HIERARCHY\nROOT a\n{{\nCHANNELS 1 Xrotation\n{ends}}}\nMOTION\nFrames: 9000\nFrame Time: 1\n{}",
            "0\n".repeat(9000)
        );
        assert!(parsed(&wide).unwrap_err().to_string().contains("more than a file of"));
    }
}
