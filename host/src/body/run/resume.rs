//! Going on with a run that did not reach its end: the tracker's state and what each frame was
//! answered with.
//!
//! Animation, markers, errors and pictures are made anew from the answers; of clouds only those on
//! the contact sheet are read again.

use super::answer::NO_ANSWER;
use super::options::BodyTrackOptions;
use super::report::{PointCounts, SkippedCloud};
use super::track::{BodyTrackRun, read_cloud};
use crate::body::tracking::StreamState;
use crate::error::Result;
use crate::resume::{Begun, Left, List, ResumeFile, file_crc32, from_text, identity, to_text};
use serde::{Deserialize, Serialize};
use sinew_core::saved_state::StateKind;
use std::path::Path;

pub(super) const COMMAND: &str = "track body";

/// What the tables of a run do not hold.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct BodyState {
    skipped: Vec<SkippedCloud>,
    points: PointCounts,
    /// Wall time of the steps, seconds.
    step_s: f64,
    /// The tracker.
    tracker: StreamState,
    /// The answer to each finished frame.
    answers: String,
}

/// What `run` leaves if it ends now.
pub(super) fn left(run: &mut BodyTrackRun) -> Result<Left<BodyState>> {
    let mut answers = List::new(std::mem::take(&mut run.answers), NO_ANSWER);
    let state = BodyState {
        skipped: run.report.skipped.clone(),
        points: run.report.points,
        step_s: run.step_s,
        tracker: run.stream.state()?,
        answers: to_text(StateKind::Body, &mut answers)?,
    };
    run.answers = answers.entries;
    let begun = run.begun()?;
    let seconds = run.seconds + run.started.elapsed().as_secs_f64();
    Left::new(begun, run.report.frames_finished, seconds, run.last_cloud_crc32, state)
        .with_tables(&mut run.table, run.particles.as_mut())
}

/// Where a run in `out` keeps what it leaves.
pub(super) fn file_in(out: &Path) -> ResumeFile {
    ResumeFile::in_folder(out, COMMAND)
}

/// How a run with these options is begun, before anything is read. Results do not depend on the
/// threads.
fn begun(options: &BodyTrackOptions) -> Result<Begun> {
    Begun::new(COMMAND, options, &["folder", "threads"])?.on(&options.folder)
}

/// The same with what `run` reads.
fn read_by(mut begun: Begun, run: &BodyTrackRun) -> Result<Begun> {
    let files = &run.inputs.files;
    for path in
        [&files.camera, &files.skeleton, &files.init, &files.stick, &files.truth, &files.scene].into_iter().flatten()
    {
        begun = begun.reading(format!("`{}`", path.display()), file_crc32(path)?);
    }
    let clouds = &run.inputs.clouds.frames;
    Ok(begun.with_frames(clouds.iter().map(|cloud| identity(&cloud.path)).collect()))
}

fn cloud_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

impl BodyTrackRun {
    /// How this run was begun: with the inputs as they were then.
    fn begun(&mut self) -> Result<Begun> {
        if let Some(begun) = &self.begun {
            return Ok(begun.clone());
        }
        let begun = read_by(begun(&self.report.options)?, self)?;
        Ok(self.begun.insert(begun).clone())
    }

    /// Checks everything as [`BodyTrackRun::prepare`] does, and resumes the run in `out` that did
    /// not reach its end. Its output is bit for bit that of a run without a break, except for
    /// the times in `run.json`.
    ///
    /// # Errors
    /// As [`BodyTrackRun::prepare`]; there is no such run in `out`, or it was begun with other
    /// options, inputs or another version.
    pub fn resume(options: BodyTrackOptions, out: &Path) -> Result<Self> {
        let left: Left<BodyState> = file_in(out).read(out)?;
        let now = begun(&options)?;
        left.begun.check_options(&now, out)?;
        let mut run = Self::set_up(options, out, &|name, out, _| {
            Ok(csv::Writer::from_writer(left.reopened(name, &out.join(name))?))
        })?;
        left.begun.check_inputs(&read_by(now, &run)?)?;
        run.begun = Some(left.begun.clone());
        let mut answers = List::new(Vec::new(), NO_ANSWER);
        from_text(StateKind::Body, &left.state.answers, &mut answers)?;
        for (index, answer) in answers.entries.into_iter().enumerate() {
            let wants = run.pictures.as_ref().is_some_and(|pictures| pictures.wants(index));
            let cloud = run.inputs.clouds.frames.get(index).filter(|_| wants);
            let points_m = match cloud {
                Some(cloud) => read_cloud(cloud, &run.inputs.source, &run.stream)?
                    .map_or_else(|_| Vec::new(), |cloud| cloud.seen.points_m),
                None => Vec::new(),
            };
            run.take(index, answer, &points_m);
        }
        if let Some(last) = run.last_cloud() {
            left.check_last(&cloud_name(last), file_crc32(last).ok())?;
        }
        run.stream.set_state(&left.state.tracker)?;
        run.last_cloud_crc32 = left.last_crc32;
        run.seconds = left.seconds;
        run.step_s = left.state.step_s;
        (run.report.skipped, run.report.points) = (left.state.skipped, left.state.points);
        Ok(run)
    }

    /// File of the last finished frame.
    fn last_cloud(&self) -> Option<&Path> {
        let last = self.report.frames_finished.checked_sub(1)?;
        Some(&self.inputs.clouds.frames.get(last)?.path)
    }
}
