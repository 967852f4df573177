//! Several motions at once: every model's filter over the same table, and which motion each frame
//! shows.

use super::measurements::Measurements;
use super::options::TrackingOptions;
use super::run::{Tracked, TrackedFrame, cycles};
use crate::cyclic::turns::nearest_turn;
use crate::cyclic::{AngleTable, CyclicModel};
use crate::error::Result;
use sinew_core::cyclic::MotionModel;
use sinew_core::cyclic::events::CycleCounter;
use sinew_core::cyclic::recognition::bank::MotionBank;

/// Maximum number of motions of a bank.
pub const MAX_MOTIONS: usize = 32;

/// What a frame shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMotion {
    /// Index of the model; `None` where none of these is likelier.
    pub motion: Option<usize>,
    /// Probability of that, or of "none of these".
    pub probability: f64,
    /// Index of the model whose filter gave the frame's estimate. It is the motion last named.
    /// Until one is named it is the first that will be, or the likeliest at the end if none is.
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
    let measurements = Measurements::<N>::new(table, &views[0], options)?;
    let mut bank = MotionBank::<MAX_MOTIONS, N>::new(&views);
    let mut shown = bank.best();
    let mut motions: Vec<NamedMotion> = Vec::with_capacity(runs[0].frames.len());
    motions.resize(measurements.first() + 1, name(&bank, shown));
    for index in motions.len()..runs[0].frames.len() {
        let positions: Vec<f32> = runs.iter().map(|run| run.frames[index].estimate.cycle_position).collect();
        bank.add(&views, &measurements.at(index)?, &positions);
        shown = bank.likeliest().unwrap_or(shown);
        motions.push(name(&bank, shown));
    }
    // Before a motion was named, the one that will be; the likeliest at the end if none ever is.
    let named = motions.iter().position(|named| named.motion.is_some());
    let first_shown = named.map_or(bank.best(), |index| motions[index].shown);
    motions[..named.unwrap_or(runs[0].frames.len())].iter_mut().for_each(|named| named.shown = first_shown);
    Ok(motions)
}

fn name<const N: usize>(bank: &MotionBank<MAX_MOTIONS, N>, shown: usize) -> NamedMotion {
    let motion = bank.likeliest();
    let probability = motion.map_or(bank.none_probability(), |motion| bank.probabilities()[motion]);
    NamedMotion { motion, probability: f64::from(probability), shown }
}

/// The frames of the shown motions as one run. Angles are unwrapped across a change of motion; the
/// cycles go on by the way to the other motion's position.
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
