//! Recordings that end earlier than their headers say, as files that were cut off do.

use super::error::MotionError;
use super::read_options::ReadOptions;
use crate::limits::FREE_POSITIONS;
use std::fmt;
use std::path::Path;

/// Frames of a recording, and how many its header promises: more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shortfall {
    /// Frames that are there.
    pub frames: usize,
    /// Frames that the header promises.
    pub promised: usize,
}

/// Which commands have the option.
const WHERE: &str = " (sinew angles, simulate, track body, evaluate body)";

impl Shortfall {
    /// The shortfall of a recording with `frames` that may have been `promised`, if there is one.
    ///
    /// # Errors
    /// There is one, and `options` do not allow it; or no frame is there. `line` is the header's.
    pub fn check(
        frames: usize,
        promised: Option<usize>,
        options: &ReadOptions<'_>,
        path: &Path,
        line: usize,
    ) -> Result<Option<Self>, MotionError> {
        let shortfall = promised.filter(|&promised| promised > frames).map(|promised| Self { frames, promised });
        match shortfall {
            Some(_) if options.partial && frames > 0 => Ok(shortfall),
            Some(short) if frames > 0 => {
                let rule = format!("{short}; export it again, or take what is there with --partial{WHERE}");
                Err(MotionError::broken(path, line, rule))
            }
            Some(short) => Err(MotionError::broken(path, line, format!("{short}; export it again"))),
            None => Ok(None),
        }
    }
}

impl fmt::Display for Shortfall {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, promised } = self;
        write!(out, "the recording ends early: {frames} of the {promised} frames that its header promises are there")
    }
}

/// The rows of frames in a text, each with its line counted from 1. Where fewer are there than
/// `promised`, a row that ends with the file but not with its line is left out. Its last number may
/// be cut.
pub(crate) fn whole_rows<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    ends_with_line: bool,
    promised: Option<usize>,
) -> Vec<(usize, &'a str)> {
    let mut rows: Vec<(usize, &str)> = lines.filter(|(_, row)| !row.trim().is_empty()).collect();
    if !ends_with_line && promised.is_some_and(|promised| rows.len() < promised) {
        rows.pop();
    }
    rows
}

/// Refuses a motion with far more positions than its text of `bytes` can hold: joints without
/// numbers of their own take memory in each frame.
pub(crate) fn check_positions(
    joints: usize,
    frames: usize,
    bytes: usize,
    path: &Path,
    line: usize,
) -> Result<(), MotionError> {
    if joints.saturating_mul(frames) <= FREE_POSITIONS.saturating_add(bytes) {
        return Ok(());
    }
    let rule = format!("{frames} frames of {joints} joints are more than a file of {bytes} bytes can hold");
    Err(MotionError::broken(path, line, rule))
}
