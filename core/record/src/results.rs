//! What firmware answers.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::Kind;
use crate::payload::Payload;
use sinew_core::cyclic::CyclicEstimate;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use sinew_core::tracker::arm::{ArmEstimate, ArmJoints, Status};
use sinew_core::tracker::cyclic::CyclicFrame;

/// The cyclic tracker's answer to one frame.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_record::{CyclicResult, decode, encode};
/// use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
///
/// let model = WALKING.model()?;
/// let unseen = AngleMeasurement::nothing().into();
/// let mut tracker = CyclicTracker::new(&model, CyclicTrackerOptions::default(), &unseen, FirstPhase::default())?;
/// let result = CyclicResult::new(1, &tracker.step(&model, &unseen));
/// let mut bytes = [0; 256];
/// encode(&result, &mut bytes)?;
/// assert_eq!(decode(&bytes)?.0.read::<CyclicResult>()?, result, "bit for bit what the tracker said");
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicResult {
    /// Number of the frame.
    pub frame: u32,
    /// Pose, phase and how sure they are.
    pub estimate: CyclicEstimate<HUMAN_ANGLES>,
    /// Whole cycles since the first frame.
    pub cycles_completed: i32,
    /// Cycles per minute, and its standard deviation.
    pub cadence_per_min: [f32; 2],
}

impl CyclicResult {
    /// The answer `answered` to `frame`.
    #[must_use]
    pub const fn new(frame: u32, answered: &CyclicFrame<HUMAN_ANGLES>) -> Self {
        Self {
            frame,
            estimate: answered.estimate,
            cycles_completed: answered.cycles_completed,
            cadence_per_min: [answered.cadence_per_min, answered.cadence_std_per_min],
        }
    }
}

impl Payload for CyclicResult {
    const KIND: Kind = Kind::CyclicResult;
    const MAX_BYTES: usize = 4 + 12 * HUMAN_ANGLES + 5 * 4 + 2 + 4 + 8;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        let estimate = &self.estimate;
        fields.u32(self.frame);
        fields.f32s(&estimate.angles_rad);
        estimate.turns.iter().for_each(|&turns| fields.u32(turns as u32));
        fields.f32s(&estimate.angle_variance_rad2);
        fields.f32s(&[
            estimate.cycle_position,
            estimate.cycle_position_variance,
            estimate.cycle_velocity_per_frame,
            estimate.cycle_velocity_variance,
            estimate.log_likelihood,
        ]);
        fields.u8(u8::from(estimate.outlier));
        fields.u8(u8::from(estimate.misfit));
        fields.u32(self.cycles_completed as u32);
        fields.f32s(&self.cadence_per_min);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let frame = fields.u32()?;
        let angles_rad = fields.f32s()?;
        let mut turns = [0; HUMAN_ANGLES];
        for turn in &mut turns {
            *turn = fields.u32()? as i32;
        }
        let estimate = CyclicEstimate {
            angles_rad,
            turns,
            angle_variance_rad2: fields.f32s()?,
            cycle_position: fields.f32()?,
            cycle_position_variance: fields.f32()?,
            cycle_velocity_per_frame: fields.f32()?,
            cycle_velocity_variance: fields.f32()?,
            log_likelihood: fields.f32()?,
            outlier: fields.flag("outlier")?,
            misfit: fields.flag("misfit")?,
        };
        Ok(Self { frame, estimate, cycles_completed: fields.u32()? as i32, cadence_per_min: fields.f32s()? })
    }
}

/// The arm tracker's answer to one frame.
///
/// ```
/// use sinew_core::camera::Camera;
/// use sinew_core::math::Vec3;
/// use sinew_record::{ArmResult, decode, encode};
/// use sinew_core::skeleton::{ArmGeometry, Side};
/// use sinew_core::tracker::arm::{ArmFrame, ArmModel, ArmOptions, ArmTracker};
///
/// let camera = Camera::from_field_of_view(640, 480, 1.05)?;
/// let arm = ArmGeometry::new(Side::Right, 0.30, 0.35)?;
/// let model = ArmModel::new(camera, (640, 480), arm, ArmOptions::default())?;
/// let shoulder_m = Vec3::new(-0.2, -0.1, 1.2);
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// let estimate = tracker.step(&model, &ArmFrame { timestamp_us: 0, image: None, shoulder_m });
/// let mut bytes = [0; 128];
/// encode(&ArmResult { frame: 0, estimate }, &mut bytes)?;
/// assert_eq!(decode(&bytes)?.0.read::<ArmResult>()?.estimate.joints, estimate.joints);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmResult {
    /// Number of the frame.
    pub frame: u32,
    /// The estimate.
    pub estimate: ArmEstimate,
}

impl Payload for ArmResult {
    const KIND: Kind = Kind::ArmResult;
    const MAX_BYTES: usize = 4 + 3 + 2 * 2 + 4 * (9 + 4 + 4);

    fn write(&self, fields: &mut FieldWriter<'_>) {
        let estimate = &self.estimate;
        fields.u32(self.frame);
        fields.u8(u8::from(estimate.side == Side::Right));
        fields.u8(match estimate.status {
            Status::Uncertain => 3,
            Status::Tracking => 2,
            Status::Predicted => 1,
            Status::Lost => 0,
        });
        fields.u8(u8::from(estimate.degenerate));
        fields.u16(estimate.candidate.map_or(u16::MAX, |index| index as u16));
        fields.u16(estimate.dropped_candidates as u16);
        let joints = &estimate.joints;
        for place in [joints.shoulder_m, joints.elbow_m, joints.hand_m] {
            fields.f32s(place.as_slice());
        }
        fields.f32s(&estimate.angles_rad);
        fields.f32s(&[
            estimate.hand_std_m,
            estimate.effective_sample_size,
            estimate.log_evidence,
            estimate.hand_likelihood,
        ]);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let frame = fields.u32()?;
        let side = if fields.flag("side")? { Side::Right } else { Side::Left };
        let status = match fields.u8()? {
            0 => Status::Lost,
            1 => Status::Predicted,
            2 => Status::Tracking,
            3 => Status::Uncertain,
            _ => return Err(RecordError::Value { field: "status" }),
        };
        let degenerate = fields.flag("degenerate")?;
        let candidate = Some(fields.u16()?).filter(|&index| index != u16::MAX).map(usize::from);
        let dropped_candidates = usize::from(fields.u16()?);
        let [shoulder_m, elbow_m, hand_m] =
            [fields.f32s::<3>()?, fields.f32s::<3>()?, fields.f32s::<3>()?].map(Vec3::from);
        let angles_rad = fields.f32s()?;
        let [hand_std_m, effective_sample_size, log_evidence, hand_likelihood] = fields.f32s()?;
        let estimate = ArmEstimate {
            side,
            status,
            joints: ArmJoints { shoulder_m, elbow_m, hand_m },
            angles_rad,
            hand_std_m,
            effective_sample_size,
            log_evidence,
            degenerate,
            hand_likelihood,
            candidate,
            dropped_candidates,
        };
        Ok(Self { frame, estimate })
    }
}

/// A record that could not be used; the tracker goes on with the next one.
///
/// ```
/// use sinew_record::{Failure, RecordError};
///
/// // Frame 11 was answered, then a record came with a wrong checksum.
/// let failure = Failure { frame: 11, code: RecordError::Checksum.code() };
/// assert!(failure.code < Failure::REFUSED, "the record was at fault, not what it said");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Failure {
    /// Number of the last frame that was answered, 0 before the first.
    pub frame: u32,
    /// [`RecordError::code`], or 64 for a parameter that the tracker refuses, or 65 for another
    /// model.
    pub code: u16,
}

impl Failure {
    /// [`Self::code`] of a parameter that the tracker refuses.
    pub const REFUSED: u16 = 64;
    /// [`Self::code`] of a recording for another model than the one at hand.
    pub const OTHER_MODEL: u16 = 65;
}

impl Payload for Failure {
    const KIND: Kind = Kind::Failure;
    const MAX_BYTES: usize = 6;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u32(self.frame);
        fields.u16(self.code);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        Ok(Self { frame: fields.u32()?, code: fields.u16()? })
    }
}

/// What a part of the work cost over all frames.
///
/// ```
/// use sinew_record::Cost;
///
/// // Instructions of three frames, one of them much dearer.
/// let mut cost = Cost { part: 1, ..Cost::zero() };
/// for instructions in [40_000, 41_000, 96_000] {
///     cost.add(instructions);
/// }
/// assert_eq!((cost.total / u64::from(cost.frames), cost.worst), (59_000, 96_000));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Which part; firmware and its reader agree on the numbers.
    pub part: u16,
    /// Number of frames.
    pub frames: u32,
    /// Sum over all frames; instructions, or bytes for memory.
    pub total: u64,
    /// Greatest of all frames.
    pub worst: u32,
}

impl Cost {
    /// Nothing spent yet, on no part: all zero, so that a static with it needs no flash.
    #[must_use]
    pub const fn zero() -> Self {
        Self { part: 0, frames: 0, total: 0, worst: 0 }
    }

    /// Counts one more frame.
    pub fn add(&mut self, amount: u32) {
        self.frames = self.frames.saturating_add(1);
        self.total = self.total.saturating_add(u64::from(amount));
        self.worst = self.worst.max(amount);
    }
}

impl Payload for Cost {
    const KIND: Kind = Kind::Cost;
    const MAX_BYTES: usize = 2 + 4 + 8 + 4;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u16(self.part);
        fields.u32(self.frames);
        fields.u64(self.total);
        fields.u32(self.worst);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        Ok(Self { part: fields.u16()?, frames: fields.u32()?, total: fields.u64()?, worst: fields.u32()? })
    }
}
