//! What a run says of itself: `run.json` and the summary at its end.

use super::inputs::{BodyInputs, InputFiles};
use super::options::BodyTrackOptions;
use crate::body::{BodyFile, BodyPart};
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// Version of the form of `run.json`.
pub const REPORT_VERSION: u32 = 1;

/// A cloud that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SkippedCloud {
    /// Number of the frame.
    pub frame: u64,
    /// Name of the file.
    pub file: String,
    /// What is wrong with it.
    pub reason: String,
}

/// How many points there were.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct PointCounts {
    /// Points that were weighed.
    pub used: u64,
    /// Points that are none: not finite, at the camera's centre, or too far away.
    pub skipped: u64,
    /// Points outside of the region that counts.
    #[serde(default)]
    pub outside: u64,
    /// Points left out by chance, since their cloud had more than can be weighed.
    pub over_cap: u64,
    /// Clouds that had more points than can be weighed.
    pub frames_over_cap: usize,
    /// Frames without a point that could be weighed.
    pub frames_without_points: usize,
}

/// The content of `run.json`.
#[derive(Debug, Clone, Serialize)]
pub struct BodyRunReport {
    /// Version of the form of this file.
    pub version: u32,
    /// Version of the program.
    pub sinew_version: &'static str,
    /// Seed of the run.
    pub seed: u64,
    /// Whether every frame was tracked and every output written.
    pub complete: bool,
    /// Number of clouds in the folder.
    pub frames: usize,
    /// Rows of the table.
    pub frames_finished: usize,
    /// Frame numbers between the first and the last that have no file: they have no row, and time
    /// runs on.
    pub frames_missing: u64,
    /// Frames in a second of the camera.
    pub rate_hz: f32,
    /// Finished frames over the run's time, with reading and drawing.
    pub frames_per_second: f64,
    /// Wall time of the tracker's step alone, seconds a frame.
    pub seconds_per_step: f64,
    /// Frames in which no particle had a weight: they count as frames without points.
    pub degenerate_frames: usize,
    /// Mean share of effective particles.
    pub effective_share: f64,
    /// CRC-32 of the tracker's saved state after the last frame: the same for the same options,
    /// inputs and seed.
    pub state_crc32: u32,
    /// Mean distance of the true markers from the skin of the estimate, PIK (34), from the second
    /// frame on, metres.
    pub error_m: Option<f64>,
    /// Mean distance of the joints from the true ones, from the second frame on, metres.
    pub joint_error_m: Option<f64>,
    /// Share of those frames that have a joint more than 10 cm off.
    pub lost_joint_share: Option<f64>,
    /// How many points there were.
    pub points: PointCounts,
    /// Clouds that could not be read; their rows are predictions.
    pub skipped: Vec<SkippedCloud>,
    /// What was chosen where inputs said nothing.
    pub notes: Vec<String>,
    /// Where the inputs came from.
    pub inputs: InputFiles,
    /// How much of the person is tracked.
    pub part: BodyPart,
    /// The person.
    pub body: BodyFile,
    /// All options, with the numbers of the models.
    pub options: BodyTrackOptions,
}

impl BodyRunReport {
    /// A report before the first frame.
    #[must_use]
    pub fn new(options: BodyTrackOptions, inputs: &BodyInputs) -> Self {
        Self {
            version: REPORT_VERSION,
            sinew_version: env!("CARGO_PKG_VERSION"),
            seed: options.seed,
            complete: false,
            frames: inputs.clouds.frames.len(),
            frames_finished: 0,
            frames_missing: inputs.clouds.missing(),
            rate_hz: inputs.rate_hz,
            frames_per_second: 0.0,
            seconds_per_step: 0.0,
            degenerate_frames: 0,
            effective_share: 0.0,
            state_crc32: 0,
            error_m: None,
            joint_error_m: None,
            lost_joint_share: None,
            points: PointCounts::default(),
            skipped: Vec::new(),
            notes: inputs.notes.clone(),
            inputs: inputs.files.clone(),
            part: inputs.part,
            body: BodyFile::from(&inputs.size),
            options,
        }
    }

    /// A few lines for a person.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = format!(
            "tracked {} of {} frames by {} particles ({}), {:.0} frames per second\n",
            self.frames_finished,
            self.frames,
            self.options.particles,
            self.options.model.name(),
            self.frames_per_second
        );
        let points = &self.points;
        let counts = [
            (self.skipped.len() as u64, "clouds could not be read; their rows are predictions"),
            (self.frames_missing, "frame numbers have no file and no row"),
            (points.frames_without_points as u64, "frames without points; their rows are predictions"),
            (points.skipped, "points were not finite, at the camera, or too far away"),
            (points.outside, "points were outside of --inside or not above --above-plane"),
            (points.over_cap, "points were left out of clouds that had too many"),
            (self.degenerate_frames as u64, "frames in which no particle fitted"),
        ];
        for (count, what) in counts.into_iter().filter(|(count, _)| *count > 0) {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {count} {what}");
        }
        if let (Some(error_m), Some(joint_error_m)) = (self.error_m, self.joint_error_m) {
            let (error_cm, joint_error_cm) = (100.0 * error_m, 100.0 * joint_error_m);
            let _ = writeln!(
                text,
                "  error against the truth: {error_cm:.2} cm on the skin, {joint_error_cm:.2} cm at joints"
            );
        }
        if let Some(share) = self.lost_joint_share {
            let _ = writeln!(text, "  frames with a joint more than 10 cm off: {:.1} %", 100.0 * share);
        }
        text
    }
}
