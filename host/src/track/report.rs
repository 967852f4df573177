//! What a run says of itself: `run.json` and the summary at its end.

use super::input::SkippedImage;
use super::options::TrackOptions;
use super::seen::SeenCounts;
use crate::wording::{side_name, status_name};
use serde::Serialize;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Version of the form of `run.json`.
pub const REPORT_VERSION: u32 = 1;

/// What a run read.
#[derive(Debug, Clone, Serialize)]
pub struct Inputs {
    /// The folder as it was given.
    pub folder: PathBuf,
    /// File names in the order of frames.
    pub files: Vec<String>,
}

/// How many frames of one side ended in each status.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct StatusCounts {
    /// A blob that is likely a hand carried the estimate.
    pub tracking: usize,
    /// A blob carried the estimate that is less likely a hand.
    pub uncertain: usize,
    /// The estimate was a prediction.
    pub predicted: usize,
    /// There was no estimate.
    pub lost: usize,
}

/// The content of `run.json`.
#[derive(Debug, Clone, Serialize)]
pub struct RunReport {
    /// Version of the form of this file; a reader checks it first.
    pub version: u32,
    /// Version of the program.
    pub sinew_version: &'static str,
    /// Seed of the run.
    pub seed: u64,
    /// Whether every frame was tracked and every output written.
    pub complete: bool,
    /// Number of frames of the folder, with those whose picture is missing.
    pub frames: usize,
    /// Number of frames in the table.
    pub frames_finished: usize,
    /// Width and height, pixels.
    pub image_size_px: (u32, u32),
    /// Finished frames over the run's time, with reading and drawing.
    pub frames_per_second: f64,
    /// CRC-32 of the trackers' saved state after the last finished frame: runs with the same number
    /// have the same bits.
    pub state_crc32: u32,
    /// Counts of each tracked side.
    pub status_counts: BTreeMap<&'static str, StatusCounts>,
    /// What the frames showed.
    pub seen: SeenCounts,
    /// What a user should know of how far the results go: a side that was not surely seen in most
    /// frames, and the likeliest cause.
    pub warnings: Vec<String>,
    /// Images that are missing or could not be read.
    pub skipped: Vec<SkippedImage>,
    /// All options, with the configuration that they led to.
    pub options: TrackOptions,
    /// What was read.
    pub inputs: Inputs,
}

impl RunReport {
    /// A report before the first frame.
    #[must_use]
    pub fn new(options: TrackOptions, files: Vec<String>, image_size_px: (u32, u32)) -> Self {
        Self {
            version: REPORT_VERSION,
            sinew_version: env!("CARGO_PKG_VERSION"),
            seed: options.seed,
            complete: false,
            frames: files.len(),
            frames_finished: 0,
            image_size_px,
            frames_per_second: 0.0,
            state_crc32: 0,
            status_counts: BTreeMap::new(),
            seen: SeenCounts::default(),
            warnings: Vec::new(),
            skipped: Vec::new(),
            inputs: Inputs { folder: options.folder.clone(), files },
            options,
        }
    }

    /// Counts one side's answer to one frame.
    pub fn count(&mut self, side: Side, status: Status) {
        let counts = self.status_counts.entry(side_name(side)).or_default();
        match status {
            Status::Tracking => counts.tracking += 1,
            Status::Uncertain => counts.uncertain += 1,
            Status::Predicted => counts.predicted += 1,
            Status::Lost => counts.lost += 1,
        }
    }

    /// Says of each side that was not surely seen in most frames why that may be.
    pub(super) fn warn(&mut self) {
        let (face, has_table) = (self.options.face, self.options.hands.is_some());
        let cause = |(side, counts): (&&str, &StatusCounts)| {
            let all = counts.tracking + counts.uncertain + counts.predicted + counts.lost;
            Some(format!("the {side} hand was {}", self.seen.cause([counts.tracking, all], face, has_table)?))
        };
        self.warnings = self.status_counts.iter().filter_map(cause).collect();
    }

    /// A few lines for a person: frames, speed, and each side's counts.
    #[must_use]
    pub fn summary(&self) -> String {
        let (width, height) = self.image_size_px;
        let mut text = format!(
            "tracked {} of {} frames of {width}x{height} pixels, {:.0} frames per second\n",
            self.frames_finished, self.frames, self.frames_per_second
        );
        for (side, counts) in &self.status_counts {
            let numbers = [
                (counts.tracking, Status::Tracking),
                (counts.uncertain, Status::Uncertain),
                (counts.predicted, Status::Predicted),
                (counts.lost, Status::Lost),
            ];
            let words = numbers.map(|(number, status)| format!("{number} {}", status_name(status)));
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {side} arm: {}", words.join(", "));
        }
        if !self.skipped.is_empty() {
            let _ = writeln!(
                text,
                "  {} images are missing or could not be read; their rows are predictions",
                self.skipped.len()
            );
        }
        for warning in &self.warnings {
            let _ = writeln!(text, "  warning: {warning}");
        }
        text
    }
}
