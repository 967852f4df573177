//! Where the motion of a scene comes from.

use crate::error::{Error, Result};
use crate::motion::{self, ArmMotion, ReadOptions, Shortfall, reach};
use std::path::Path;

/// Name of the motion that needs no file: random reaches.
pub const BUILTIN: &str = "builtin";
/// Frames of that motion where no number is given.
const BUILTIN_FRAMES: usize = 250;

/// A motion file, or [`BUILTIN`], and what of it is used.
#[derive(Debug, Clone, Copy)]
pub struct MotionSource<'a> {
    /// The file.
    pub path: &'a Path,
    /// Skeleton of a .amc motion.
    pub skeleton: Option<&'a Path>,
    /// Frames per second of a file that does not say.
    pub rate_hz: f32,
    /// Part that is used, seconds from the beginning.
    pub between: Option<(f32, f32)>,
    /// Take a file with fewer frames than its header promises.
    pub partial: bool,
    /// Exchange left and right.
    pub mirror: bool,
}

impl<'a> MotionSource<'a> {
    /// All of a file.
    #[must_use]
    pub fn of(path: &'a Path) -> Self {
        let rate_hz = motion::DEFAULT_FRAMES_PER_SECOND;
        Self { path, skeleton: None, rate_hz, between: None, partial: false, mirror: false }
    }

    /// The motion at the camera's rate, and whether its recording ends early. `seed` and `frames`
    /// are for the built-in one.
    ///
    /// # Errors
    /// A file that cannot be read, or has no frame in the part that is used.
    pub fn motion(&self, seed: u64, camera_hz: f32, frames: Option<usize>) -> Result<(ArmMotion, Option<Shortfall>)> {
        if self.path == Path::new(BUILTIN) {
            return Ok((reach::random_reaches(seed, camera_hz, frames.unwrap_or(BUILTIN_FRAMES))?, None));
        }
        let options = ReadOptions {
            skeleton: self.skeleton,
            frames_per_second: Some(self.rate_hz),
            partial: self.partial,
            ..ReadOptions::default()
        };
        let recorded = motion::read(self.path, &options)?;
        let motion = ArmMotion::from_motion(&recorded, self.path)?;
        let motion = if self.mirror { motion.mirrored() } else { motion };
        let motion = match self.between {
            Some((start, end)) if start >= 0.0 && start < end => motion.between(start, end),
            Some(_) => {
                let rule = "--between START,END needs 0 <= START < END, in seconds";
                return Err(Error::Option(rule.to_owned()));
            }
            None => motion,
        };
        Ok((motion.resampled(camera_hz)?, recorded.shortfall))
    }
}
