//! Whole recordings without a break: does the position in the cycle stay with the person?
//!
//! A list cuts the cycles of each recording one after the other. The true position in each is the
//! time since its start over its duration.

use super::protocol::{Protocol, TestCycle, measurements};
use anyhow::{Result, ensure};
use rayon::prelude::*;
use serde::Serialize;
use sinew::cyclic::tracking::{FilterName, Summary, TrackedFrame, TrackingOptions, track};
use sinew::cyclic::{AngleRow, AngleTable, Cut, CutList, CyclicModel};

/// Measurement noise of the evaluation's own runs, degrees.
pub const LONG_RUN_SIGMA_DEG: f64 = 6.0;
/// Errors of the position beyond which a run was lost for a while, cycles.
const LOST_CYCLES: f64 = 0.2;

/// One recording with one filter.
#[derive(Debug, Clone, Serialize)]
pub struct LongRun {
    /// File and first frame.
    pub name: String,
    /// Filter.
    pub filter: FilterName,
    /// True number of cycles.
    pub cycles: f64,
    /// Cycles that the filter counted.
    pub counted_cycles: f64,
    /// Root of the mean squared error of the position, cycles.
    pub phase_rms: f64,
    /// The same about the errors' mean: where a person's cycle is said to begin is then left out.
    pub phase_spread: f64,
    /// Largest error of the position, cycles.
    pub phase_max: f64,
    /// Relative error of the mean of the reported cadence from the third cycle on, beside the true
    /// number of cycles in that time.
    pub cadence_error: f64,
}

impl LongRun {
    /// Whether the position was lost for a while.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.phase_max > LOST_CYCLES
    }

    /// Mean of the cadence's errors, relative, and share of lost runs.
    pub fn cadence_error_and_lost<'a>(runs: impl IntoIterator<Item = &'a Self>) -> [f64; 2] {
        let (mut count, mut sums) = (0.0, [0.0; 2]);
        for run in runs {
            count += 1.0;
            sums[0] += run.cadence_error.abs();
            sums[1] += f64::from(u8::from(run.is_lost()));
        }
        sums.map(|sum| sum / count)
    }
}

/// Cycles of a recording that follow each other.
#[derive(Debug, Clone)]
pub struct Recording {
    cycle: TestCycle,
    /// Starts of all cycles and the end of the last, frames.
    borders: Vec<u64>,
}

impl Recording {
    /// The recording `truth`, whose cycles lie between `borders`, frames.
    #[must_use]
    pub const fn new(name: String, truth: AngleTable, borders: Vec<u64>) -> Self {
        Self { cycle: TestCycle { name, truth }, borders }
    }

    /// Cycles since the first start.
    fn true_cycles(&self, frame: u64) -> f64 {
        let later = self.borders.partition_point(|&border| border <= frame);
        let index = later.clamp(1, self.borders.len() - 1) - 1;
        let (start, end) = (self.borders[index], self.borders[index + 1]);
        index as f64 + (frame - start) as f64 / (end - start) as f64
    }
}

/// Smallest number of cycles in a row that count as a recording.
const MIN_CYCLES: usize = 3;

fn recordings(list: &CutList) -> Result<Vec<Recording>> {
    let mut all = Vec::new();
    let follows = |before: &Cut, after: &Cut| before.file == after.file && before.end_frame == after.start_frame;
    for cuts in list.cuts().chunk_by(follows).filter(|cuts| cuts.len() >= MIN_CYCLES) {
        let (first, last) = (&cuts[0], &cuts[cuts.len() - 1]);
        let table = AngleTable::read(&list.table_path(first))?;
        let inside = |row: &&AngleRow| (first.start_frame..last.end_frame).contains(&row.frame);
        let rows: Vec<AngleRow> =
            table.rows().iter().filter(inside).map(|row| AngleRow { extra: Vec::new(), ..row.clone() }).collect();
        let mut borders: Vec<u64> = cuts.iter().map(|cut| cut.start_frame).collect();
        borders.push(last.end_frame);
        let name = format!("{}:{}", first.file, first.start_frame);
        all.push(Recording::new(name, AngleTable::new(rows, Vec::new())?, borders));
    }
    ensure!(
        !all.is_empty(),
        "`{}` has no {MIN_CYCLES} cycles that follow each other in one table; `sinew cut` makes such lists",
        list.path().display()
    );
    Ok(all)
}

/// Tracks every recording of `list` with every filter, with measurements whose noise of `sigma_deg`
/// degrees is drawn from `seed`.
///
/// # Errors
/// A table that cannot be read, no three cycles in a row, a filter that cannot start.
pub fn long_runs(
    list: &CutList,
    model: &CyclicModel,
    rate_hz: f64,
    filters: &[FilterName],
    noise: (f64, u64),
) -> Result<Vec<LongRun>> {
    tracked(&recordings(list)?, model, rate_hz, filters, noise)
}

/// As [`long_runs`], of `recordings`.
///
/// # Errors
/// A filter that cannot start.
pub fn tracked(
    recordings: &[Recording],
    model: &CyclicModel,
    rate_hz: f64,
    filters: &[FilterName],
    noise: (f64, u64),
) -> Result<Vec<LongRun>> {
    let jobs: Vec<(&Recording, FilterName)> =
        recordings.iter().flat_map(|recording| filters.iter().map(move |&filter| (recording, filter))).collect();
    jobs.into_par_iter().map(|(recording, filter)| long_run(recording, model, rate_hz, filter, noise)).collect()
}

fn long_run(
    recording: &Recording,
    model: &CyclicModel,
    rate_hz: f64,
    filter: FilterName,
    (sigma_deg, seed): (f64, u64),
) -> Result<LongRun> {
    let options = TrackingOptions {
        filter,
        sigma_rad: sigma_deg.to_radians(),
        initial_cycle_position: Some(0.0),
        rate_hz: Some(rate_hz),
        ..TrackingOptions::default()
    };
    let truth = &recording.cycle.truth;
    let tracked = track(&measurements(truth, Protocol::Noisy, options.sigma_rad, seed), model, &options)?;
    let true_cycles = |frame: u64| recording.true_cycles(frame);
    let errors: Vec<f64> = tracked
        .frames
        .iter()
        .map(|frame| {
            let error = frame.cycles - true_cycles(frame.frame);
            error - error.round()
        })
        .collect();
    // A frame's velocity belongs to the way to it, so the first frame of the third cycle is the
    // first one left out.
    let settled: Vec<&TrackedFrame> = tracked.frames.iter().filter(|frame| true_cycles(frame.frame) > 2.0).collect();
    let velocities =
        settled.iter().map(|frame| f64::from(frame.estimate.cycle_velocity_per_frame) * tracked.step_frames);
    let velocity = velocities.sum::<f64>() / settled.len() as f64;
    let last = &tracked.frames[tracked.frames.len() - 1];
    let third = recording.borders[2];
    let true_velocity = (true_cycles(last.frame) - 2.0) / (last.frame - third) as f64;
    let rms =
        |about: f64| (errors.iter().map(|error| (error - about).powi(2)).sum::<f64>() / errors.len() as f64).sqrt();
    Ok(LongRun {
        name: recording.cycle.name.clone(),
        filter,
        cycles: true_cycles(last.frame),
        counted_cycles: Summary::of(&tracked).cycles,
        phase_rms: rms(0.0),
        phase_spread: rms(errors.iter().sum::<f64>() / errors.len() as f64),
        phase_max: errors.iter().fold(0.0, |worst: f64, error| worst.max(error.abs())),
        cadence_error: velocity / true_velocity - 1.0,
    })
}
