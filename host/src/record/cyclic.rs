//! What a cyclic tracker was given.

use super::StreamWriter;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::tracking::{FilterName, Measurements, StartName, TrackingOptions};
use crate::cyclic::{AngleTable, CyclicModel};
use crate::error::{Context, Result, ensure};
use sinew_core::tracker::cyclic::FirstPhase;
use sinew_record::{CyclicInput, CyclicSetup, model_checksum};

/// The measurements of `table` as `sinew track cyclic` gives them to the phase-coupled filter with
/// `model`. The tracker begins with the first of them.
///
/// # Errors
/// Another filter or start than the default, smoothing, a model with two angles a joint, or frames
/// beyond 32 bits. Also what [`crate::cyclic::tracking::track`] refuses.
pub fn cyclic_stream(table: &AngleTable, model: &CyclicModel, options: &TrackingOptions) -> Result<Vec<u8>> {
    ensure!(options.filter == FilterName::Coupled, "firmware plays runs of `--filter coupled` only");
    ensure!(options.start == StartName::Standard, "firmware plays runs of `--init standard` only");
    ensure!(!options.smooth, "firmware knows no later frames: track without `--smooth`");
    let view = model.view();
    ensure!(view.angle_count() <= ANGLES, "firmware plays runs with one angle a joint only");
    let measurements = Measurements::<ANGLES>::new(table, &view, options)?;
    let position = options.initial_cycle_position.map(|position| position as f32);
    let velocity_per_frame =
        options.initial_cycle_velocity.map(|velocity| (velocity / measurements.steps().step_frames()) as f32);
    let mut stream = StreamWriter::default();
    let first = FirstPhase { position, velocity_per_frame };
    stream.push(&CyclicSetup { model_checksum: model_checksum(&view), first })?;
    for measured in measurements.iter() {
        let (frame, angles) = measured?;
        let frame =
            u32::try_from(frame).ok().with_context(|| format!("frame {frame} is beyond what firmware counts"))?;
        stream.push(&CyclicInput { frame, angles })?;
    }
    stream.finish()
}
