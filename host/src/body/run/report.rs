//! What a run says of itself: `run.json` and the summary at its end.

use super::inputs::{BodyInputs, InputFiles};
use super::options::BodyTrackOptions;
use super::table::end_effectors;
use crate::body::tracking::filter::WholeBodyEstimate;
use crate::body::{BodyFile, BodyPart};
use crate::wording::side_name;
use serde::{Deserialize, Serialize};
use sinew_core::skeleton::Side;
use sinew_core::skeleton::full_body::BODY_JOINT_NAMES;
use std::collections::BTreeMap;
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
    /// Frames without a point that could be weighed, those of clouds that could not be read among
    /// them.
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
    /// Frames in which the body was looked for anew, and found elsewhere.
    pub begun_anew: Vec<u64>,
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
    /// Frames in which the points show each end effector.
    pub observed_frames: BTreeMap<&'static str, usize>,
    /// What a user should know of how far the results go: doubts about the start, end effectors
    /// that most frames do not show.
    pub warnings: Vec<String>,
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
            begun_anew: Vec::new(),
            effective_share: 0.0,
            state_crc32: 0,
            error_m: None,
            joint_error_m: None,
            lost_joint_share: None,
            points: PointCounts::default(),
            observed_frames: end_effectors(inputs.part).map(|bone| (BODY_JOINT_NAMES[bone], 0)).collect(),
            warnings: inputs.warnings.clone(),
            skipped: Vec::new(),
            notes: inputs.notes.clone(),
            inputs: inputs.files.clone(),
            part: inputs.part,
            body: BodyFile::from(&inputs.size),
            options,
        }
    }

    /// Counts the end effectors that the points of a frame show.
    pub(super) fn count_observed(&mut self, estimate: &WholeBodyEstimate) {
        for bone in end_effectors(self.part) {
            let frames = self.observed_frames.entry(BODY_JOINT_NAMES[bone]).or_default();
            *frames += usize::from(estimate.observed[bone]);
        }
    }

    /// Says where the body was lost, and of each end effector whether fewer than half of the frames
    /// show it.
    pub(super) fn warn(&mut self) {
        if let Some(frame) = self.begun_anew.first() {
            self.warnings.push(format!(
                "for half a second most points were away from the body, so it was looked for anew in {} frames, first in \
                 frame {frame} (`begun_anew` of run.json); the rows before are of another place",
                self.begun_anew.len()
            ));
        }
        self.warnings.extend(unobserved(&self.observed_frames, self.frames_finished));
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
            (self.skipped.len() as u64, "clouds could not be read; they are frames without points"),
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
        for warning in &self.warnings {
            let _ = writeln!(text, "  warning: {warning}");
        }
        text
    }
}

/// A warning for each end effector that fewer than half of `all` frames show; one for all of them
/// together.
fn unobserved(observed_frames: &BTreeMap<&'static str, usize>, all: usize) -> Vec<String> {
    let few = || observed_frames.iter().filter(|(_, frames)| 2 * **frames < all);
    let count = few().count();
    if count > 0 && count == observed_frames.len() {
        return vec![format!(
            "head, hands and feet were each observed in fewer than half of {all} frames; give points of one person in \
             metres, x to the right, y down, z forward, and cut off what is behind (--inside, --above-plane)"
        )];
    }
    let warning = |(name, frames): (&&str, &usize)| {
        let name = in_words(name);
        format!("the {name} was observed in {frames} of {all} frames; in the others its place is a prediction")
    };
    few().map(warning).collect()
}

/// A joint's name as a person says it.
fn in_words(name: &str) -> String {
    let side = |prefix: &str, side: Side| Some(format!("{} {}", side_name(side), name.strip_prefix(prefix)?));
    side("l_", Side::Left).or_else(|| side("r_", Side::Right)).unwrap_or_else(|| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_that_most_frames_do_not_show_are_warned_of() {
        let of = |head, wrist| unobserved(&BTreeMap::from([("head", head), ("l_wrist", wrist)]), 90);
        assert_eq!(of(45, 90), Vec::<String>::new());
        let wrist = of(90, 44);
        assert!(
            wrist.len() == 1 && wrist[0].starts_with("the left wrist was observed in 44 of 90 frames"),
            "{wrist:?}"
        );
        let all = of(3, 0);
        assert!(all.len() == 1 && all[0].contains("fewer than half of 90 frames"), "{all:?}");
        assert!(unobserved(&BTreeMap::from([("head", 0)]), 0).is_empty());
    }
}
