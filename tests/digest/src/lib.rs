//! Whether the trackers give the same bits everywhere: each reads a made-up stream of frames, and
//! one number stands for all that it answers.
//!
//! The streams come from the core's random numbers and the core's mathematics alone, so a target
//! that computes anything differently gets another digest. `expected.txt` holds the digests over
//! [`FRAMES`] frames; every target's test reads that one file.

#![no_std]

mod arm_pair;
mod bits;
mod cyclic;
mod front_end;
mod motion;

use core::fmt;
use sinew_core::error::ParameterError;

/// Frames of a full run.
pub const FRAMES: u32 = 1000;
/// The seed of all streams and trackers.
const SEED: u64 = 2024;

/// What a digest is taken of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// The cyclic tracker, coupled filter, from joints, with root and lengths.
    Coupled,
    /// The cyclic tracker, the paper's filter in both readings.
    Paper,
    /// The cyclic particle filter from an unknown position.
    Particles,
    /// Two arms from blobs and edges.
    ArmPair,
    /// The front end for camera lines, RGB565 and YUYV.
    FrontEnd,
}

impl Subject {
    /// All of them, in the order of `expected.txt`.
    pub const ALL: [Self; 5] = [Self::Coupled, Self::Paper, Self::Particles, Self::ArmPair, Self::FrontEnd];

    /// Name in `expected.txt`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Coupled => "cyclic-coupled",
            Self::Paper => "cyclic-paper",
            Self::Particles => "cyclic-particle",
            Self::ArmPair => "arm-pair",
            Self::FrontEnd => "front-end",
        }
    }

    /// Digest of the bits of every answer to the first `frames` frames.
    ///
    /// # Errors
    /// None with the constants of this crate.
    pub fn digest(self, frames: u32) -> Result<u64, ParameterError> {
        match self {
            Self::Coupled => cyclic::coupled(frames),
            Self::Paper => cyclic::paper(frames),
            Self::Particles => cyclic::particles(frames),
            Self::ArmPair => arm_pair::digest(frames),
            Self::FrontEnd => front_end::digest(frames),
        }
    }
}

/// A line of `expected.txt`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// What the digest is of.
    pub subject: Subject,
    /// The digest.
    pub digest: u64,
}

impl fmt::Display for Line {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {:016x}", self.subject.name(), self.digest)
    }
}
