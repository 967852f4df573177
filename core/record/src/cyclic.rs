//! What the cyclic tracker is given.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::Kind;
use crate::payload::Payload;
use sinew_core::cyclic::{AngleMeasurement, CoupledModel};
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use sinew_core::tracker::cyclic::FirstPhase;

/// Begins the recording of a motion: which model, and what is known of the first state.
///
/// ```
/// use sinew_record::{CyclicSetup, decode, encode};
/// use sinew_core::tracker::cyclic::FirstPhase;
///
/// // The position in the cycle is to be found; the person is said to walk a cycle in 64 frames.
/// let first = FirstPhase { position: None, velocity_per_frame: Some(1.0 / 64.0) };
/// let mut bytes = [0; 64];
/// encode(&CyclicSetup { model_checksum: 0x1234_5678, first }, &mut bytes)?;
/// assert_eq!(decode(&bytes)?.0.read::<CyclicSetup>()?.first, first);
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicSetup {
    /// [`model_checksum`] of the model.
    pub model_checksum: u32,
    /// First position and velocity.
    pub first: FirstPhase,
}

/// Checksum of the numbers that the phase-coupled filter reads of a model: firmware finds by it
/// whether it holds the model of a recording, in either form.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::{ModelParts, MotionModel};
/// use sinew_record::model_checksum;
///
/// // Another rate, another model.
/// let model = WALKING.model()?;
/// let slower = MotionModel::new(ModelParts { rate_hz: 30.0, ..model.parts() })?;
/// assert_ne!(model_checksum(&slower), model_checksum(&model));
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[must_use]
pub fn model_checksum(model: &CoupledModel<'_>) -> u32 {
    model.checksum()
}

impl Payload for CyclicSetup {
    const KIND: Kind = Kind::CyclicSetup;
    const MAX_BYTES: usize = 4 + 2 * 5;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u32(self.model_checksum);
        fields.optional_f32(self.first.position);
        fields.optional_f32(self.first.velocity_per_frame);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let model_checksum = fields.u32()?;
        let position = fields.optional_f32("position")?;
        let velocity_per_frame = fields.optional_f32("velocity_per_frame")?;
        Ok(Self { model_checksum, first: FirstPhase { position, velocity_per_frame } })
    }
}

/// One frame's angles, just as the filter gets them.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_record::{CyclicInput, decode, encode};
///
/// // One of the angles was not seen; that survives, too.
/// let mut angles_rad = [Some(0.2); 13];
/// angles_rad[4] = None;
/// let angles = AngleMeasurement::new(&angles_rad, 0.1).expect("a standard deviation above zero");
/// let mut bytes = [0; 256];
/// encode(&CyclicInput { frame: 8, angles }, &mut bytes)?;
/// let played = decode(&bytes)?.0.read::<CyclicInput>()?;
/// assert_eq!((played.frame, played.angles.angle_rad(4)), (8, None));
/// assert_eq!(played.angles, angles);
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicInput {
    /// Number of the frame in the recording; rises from record to record.
    pub frame: u32,
    /// The measurement.
    pub angles: AngleMeasurement<HUMAN_ANGLES>,
}

impl Payload for CyclicInput {
    const KIND: Kind = Kind::CyclicInput;
    const MAX_BYTES: usize = 3 * 4 + 8 * HUMAN_ANGLES;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u32(self.frame);
        fields.f32(self.angles.step_frames());
        let seen = self.angles.angles_rad();
        fields.u32(seen.iter().rev().fold(0, |bits, angle| bits << 1 | u32::from(angle.is_some())));
        seen.iter().for_each(|angle| fields.f32(angle.unwrap_or(0.0)));
        fields.f32s(self.angles.std_rad());
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let frame = fields.u32()?;
        let step_frames = fields.f32()?;
        let seen = fields.u32()?;
        if seen >> HUMAN_ANGLES != 0 {
            return Err(RecordError::Value { field: "seen" });
        }
        let angles = fields.f32s::<HUMAN_ANGLES>()?;
        let std_rad = fields.f32s::<HUMAN_ANGLES>()?;
        let mut angles_rad = angles.map(Some);
        for (index, angle) in angles_rad.iter_mut().enumerate() {
            *angle = angle.filter(|_| seen >> index & 1 == 1);
        }
        let angles = AngleMeasurement::with_std(&angles_rad, &std_rad)
            .and_then(|angles| angles.after(step_frames))
            .map_err(|error| RecordError::Value { field: error.parameter })?;
        Ok(Self { frame, angles })
    }
}
