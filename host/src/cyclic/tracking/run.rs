//! One pass of a filter over an angle table.

use super::filter::{Filter, Pass};
use super::options::TrackingOptions;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::smoothing::replace_estimates;
use crate::cyclic::{AngleRow, AngleTable, CyclicModel};
use anyhow::{Result, bail, ensure};
use sinew_core::cyclic::measurement::MAX_STEP_FRAMES;
use sinew_core::cyclic::{AngleMeasurement, CyclicEstimate};
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use std::f64::consts::TAU;

/// What the filter answered to one row.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackedFrame {
    /// Number of the frame in the table.
    pub frame: u64,
    /// The estimate; velocities are per frame of the model's rate.
    pub estimate: CyclicEstimate<HUMAN_ANGLES>,
    /// Estimated angles, radians, unwrapped along time.
    pub angles_rad: [f64; ANGLES],
    /// Cycles since the first row, with their fraction.
    pub cycles: f64,
}

/// A whole run.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracked {
    /// One entry a row of the table.
    pub frames: Vec<TrackedFrame>,
    /// Frames per second of the recording.
    pub rate_hz: f64,
    /// Frames of the model's rate in one of the recording's.
    pub step_frames: f64,
}

/// Tracks `table`. The first row with an angle gives the first state (see [`super::StartName`]) and is answered with it.
///
/// # Errors
/// An option out of range, a rate so low that a step is too long, a table without any angle.
pub fn track(table: &AngleTable, model: &CyclicModel, options: &TrackingOptions) -> Result<Tracked> {
    options.check()?;
    let view = model.view();
    let model_hz = f64::from(view.rate_hz());
    let rate_hz = options.rate_hz.unwrap_or(model_hz);
    let step_frames = model_hz / rate_hz;
    ensure!(
        step_frames <= f64::from(MAX_STEP_FRAMES),
        "`--rate {rate_hz}`: one frame is {step_frames:.0} of the model's; at most {MAX_STEP_FRAMES} can be bridged"
    );
    let seen = |row: &AngleRow| row.angles_rad.iter().any(Option::is_some);
    let Some(first) = table.rows().iter().position(seen) else {
        bail!("the table has no angle in any row, so there is nothing to track; see `sinew angles --min-confidence`")
    };
    let mut filter = Filter::new(view, options, &measured(&table.rows()[first]), step_frames)?;
    let mut pass = if options.smooth { Pass::begin(&filter) } else { None };
    let mut frames: Vec<TrackedFrame> = Vec::with_capacity(table.rows().len());
    // Rows before the first one with an angle are answered with the first state as well.
    frames.extend(table.rows()[..=first].iter().map(|row| tracked(row.frame, filter.first_estimate(), None)));
    for pair in table.rows()[first..].windows(2) {
        let [before, row] = pair else { continue };
        // A gap longer than the longest step says no more than that one.
        let step = (step_frames * (row.frame - before.frame) as f64).min(f64::from(MAX_STEP_FRAMES));
        let used = options.updates.uses(table.first_frame(), row.frame);
        let angles = if used { measured(row) } else { [None; HUMAN_ANGLES] };
        let measurement = AngleMeasurement::new(&angles, options.sigma_rad as f32)?.after(step as f32)?;
        let estimate = filter.step(&measurement);
        if let Some(pass) = &mut pass {
            pass.add(&filter, measurement);
        }
        let next = tracked(row.frame, estimate, frames.last().map(|before| (before, step)));
        frames.push(next);
    }
    if let Some(pass) = pass {
        replace_estimates(&mut frames[first..], &pass.smoothed());
        let start = frames[first].clone();
        for frame in &mut frames[..first] {
            *frame = TrackedFrame { frame: frame.frame, ..start.clone() };
        }
    }
    Ok(Tracked { frames, rate_hz, step_frames })
}

fn measured(row: &AngleRow) -> [Option<f32>; HUMAN_ANGLES] {
    row.angles_rad.map(|angle| angle.map(|angle| angle as f32))
}

/// The answer of a frame that came `step` frames of the model after the one `before`.
fn tracked(frame: u64, estimate: CyclicEstimate<HUMAN_ANGLES>, before: Option<(&TrackedFrame, f64)>) -> TrackedFrame {
    let angles_rad = std::array::from_fn(|i| f64::from(estimate.angles_rad[i]) + TAU * f64::from(estimate.turns[i]));
    let position = f64::from(estimate.cycle_position);
    let cycles = before.map_or(0.0, |(before, step)| {
        let change = position - f64::from(before.estimate.cycle_position);
        // The turn that fits the velocity: a step may be longer than half a cycle.
        let expected = f64::from(estimate.cycle_velocity_per_frame) * step;
        before.cycles + change + (expected - change).round()
    });
    TrackedFrame { frame, estimate, angles_rad, cycles }
}
