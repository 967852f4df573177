//! Several motions at once: every model's filter over the same table, and which motion each frame shows.

use super::options::TrackingOptions;
use super::run::{Tracked, TrackedFrame, cycles, first_seen, measured, step_of};
use crate::cyclic::turns::nearest_turn;
use crate::cyclic::{AngleTable, CyclicModel};
use anyhow::Result;
use sinew_core::cyclic::events::CycleCounter;
use sinew_core::cyclic::motion_bank::{DEFAULT_MEMORY_S, MotionBank, MotionEvidence};
use sinew_core::cyclic::{AngleMeasurement, MotionModel};

/// Most motions of a bank.
pub const MOST_MOTIONS: usize = 32;

/// What a frame shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMotion {
    /// Index of the model; `None` where none of these is likelier.
    pub motion: Option<usize>,
    /// Probability of that, or of "none of these".
    pub probability: f64,
    /// Index of the model whose filter gave the frame's estimate: of the motion last named; before
    /// one was, of the first that is; of the likeliest at the end if none ever is.
    pub shown: usize,
}

/// The motion of each row, from the `runs` of the models.
///
/// # Errors
/// None for rows of the table.
pub(super) fn named<const N: usize>(
    table: &AngleTable,
    models: &[CyclicModel],
    runs: &[Tracked],
    options: &TrackingOptions,
) -> Result<Vec<NamedMotion>> {
    let views: Vec<MotionModel<'_>> = models.iter().map(CyclicModel::view).collect();
    let (first, rows) = (first_seen(table)?, &table.rows()[..runs[0].frames.len()]);
    let sigma_rad = options.sigma_rad as f32;
    let angles = measured::<N>(table, first);
    let mut bank =
        MotionBank::<MOST_MOTIONS, N>::new(runs.len(), &AngleMeasurement::new(&angles, sigma_rad)?, DEFAULT_MEMORY_S);
    let mut shown = bank.best();
    let mut motions: Vec<NamedMotion> = Vec::with_capacity(rows.len());
    motions.resize(first + 1, name(&bank, shown));
    for (index, pair) in rows.windows(2).enumerate().skip(first) {
        let [before, row] = pair else { continue };
        let used = options.updates.uses(table.first_frame(), row.frame);
        let angles = if used { measured(table, index + 1) } else { [None; N] };
        let step_s = step_of(before, row, runs[0].step_frames) / (runs[0].rate_hz * runs[0].step_frames);
        let measurement = AngleMeasurement::new(&angles, sigma_rad)?;
        let evidence = |(view, run): (&MotionModel<'_>, &Tracked)| {
            let estimate = &run.frames[index + 1].estimate;
            MotionEvidence::new(view, &measurement, estimate.cycle_position, estimate.log_likelihood)
        };
        let evidence: Vec<MotionEvidence> = views.iter().zip(runs).map(evidence).collect();
        bank.add(&measurement, step_s as f32, &evidence);
        shown = bank.likeliest().unwrap_or(shown);
        motions.push(name(&bank, shown));
    }
    // Before a motion was named, the one that will be; the likeliest at the end if none ever is.
    let named = motions.iter().position(|named| named.motion.is_some());
    let first_shown = named.map_or(bank.best(), |index| motions[index].shown);
    motions[..named.unwrap_or(rows.len())].iter_mut().for_each(|named| named.shown = first_shown);
    Ok(motions)
}

fn name<const N: usize>(bank: &MotionBank<MOST_MOTIONS, N>, shown: usize) -> NamedMotion {
    let motion = bank.likeliest();
    let probability = motion.map_or(bank.none_probability(), |motion| bank.probabilities()[motion]);
    NamedMotion { motion, probability: f64::from(probability), shown }
}

/// The frames of the shown motions as one run. Angles are unwrapped across a change of motion; the cycles go on by the way to the other
/// motion's position.
pub(super) fn shown(runs: &[Tracked], motions: &[NamedMotion]) -> Tracked {
    let mut frames: Vec<TrackedFrame> = Vec::with_capacity(motions.len());
    let mut counter: Option<CycleCounter> = None;
    for (index, named) in motions.iter().enumerate() {
        let run = &runs[named.shown];
        let mut frame = run.frames[index].clone();
        if let Some(before) = frames.last() {
            for (angle, before) in frame.angles_rad.iter_mut().zip(before.angles_rad) {
                *angle = nearest_turn(*angle, before);
            }
            if let (Some(side), Some(before)) = (&mut frame.side, &before.side) {
                for (angle, before) in side.angles_rad.iter_mut().zip(before.angles_rad) {
                    *angle = nearest_turn(*angle, before);
                }
            }
        }
        let estimate = &frame.estimate;
        match &mut counter {
            None => {
                counter = Some(CycleCounter::new(estimate.cycle_position));
                frame.cycles = 0.0;
            }
            Some(counter) => {
                let before: &TrackedFrame = &frames[index - 1];
                let step = (frame.frame - before.frame) as f64 * run.step_frames;
                counter.advance(estimate.cycle_position, estimate.cycle_velocity_per_frame, step as f32);
                frame.cycles = cycles(counter);
            }
        }
        frames.push(frame);
    }
    Tracked { frames, rate_hz: runs[0].rate_hz, step_frames: runs[0].step_frames }
}
