//! What stands before the frames of a BVH file: the hierarchy, the number of frames and their time.

use super::super::error::{MotionError, number};
use crate::limits::{MAX_JOINTS, MAX_NAME_BYTES, MAX_SKELETON_DEPTH};
use sinew_core::math::Vec3;
use std::iter::Enumerate;
use std::path::Path;
use std::str::Lines;

/// What a number of a frame stands for, with its axis (0 = x, 1 = y, 2 = z).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Channel {
    Position(usize),
    Rotation(usize),
}

/// A joint or an End Site; parents stand before their children.
#[derive(Debug)]
pub struct Joint {
    pub name: String,
    pub parent: Option<usize>,
    pub offset: Vec3,
    pub channels: Vec<Channel>,
}

/// The lines of a file, with the number of the last one that was taken.
#[derive(Debug)]
pub struct LineReader<'a> {
    path: &'a Path,
    pub lines: Enumerate<Lines<'a>>,
    line: usize,
}

impl<'a> LineReader<'a> {
    pub fn new(text: &'a str, path: &'a Path) -> Self {
        Self { path, lines: text.lines().enumerate(), line: 0 }
    }

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

/// The joints of the part before `MOTION`.
pub fn hierarchy(lines: &mut LineReader<'_>) -> Result<Vec<Joint>, MotionError> {
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
            // Names may have spaces: `Bip01 L Thigh`.
            ["ROOT", name @ ..] if !name.is_empty() => push(lines, &mut joints, &mut open, &name.join(" "))?,
            ["JOINT", name @ ..] if !open.is_empty() && !name.is_empty() => {
                push(lines, &mut joints, &mut open, &name.join(" "))?;
            }
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
pub struct MotionHeader {
    pub frames: usize,
    pub frame_time_s: f32,
    /// The line that gives the number of frames.
    pub line: usize,
}

pub fn motion_header(lines: &mut LineReader<'_>) -> Result<MotionHeader, MotionError> {
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
