//! What firmware answers of an upper body.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::Kind;
use crate::payload::Payload;
use sinew_core::skeleton::upper_body::{UPPER_ANGLES, UPPER_BONES};
use sinew_core::tracker::body::BodyEstimate;

/// The body tracker's answer to one frame of an upper body.
///
/// ```
/// use sinew_core::skeleton::upper_body::UPPER_ANGLES;
/// use sinew_core::tracker::body::upper::{DEFAULT_UPPER_OPTIONS, UpperBodyTracker};
/// use sinew_record::{BodyResult, decode, encode};
///
/// let mut pose = [0.0; UPPER_ANGLES];
/// pose[2] = 1.5;
/// let mut body = UpperBodyTracker::empty();
/// body.begin(&DEFAULT_UPPER_OPTIONS, pose)?;
/// let (estimate, _) = body.step(&mut [], 0.1).expect("it has begun");
/// let result = BodyResult::new(1, &estimate);
/// let mut bytes = [0; 256];
/// encode(&result, &mut bytes)?;
/// assert_eq!(decode(&bytes)?.0.read::<BodyResult>()?, result, "bit for bit what the tracker said");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyResult {
    /// Number of the frame.
    pub frame: u32,
    /// Coordinates of the pose: three shifts in metres, then angles in radians.
    pub angles_rad: [f32; UPPER_ANGLES],
    /// Ends of all bones, metres.
    pub ends_m: [[f32; 3]; UPPER_BONES],
    /// Whether the points show each bone: bit i for bone i.
    pub observed: u16,
}

impl BodyResult {
    /// The answer `estimate` to `frame`.
    #[must_use]
    pub fn new(frame: u32, estimate: &BodyEstimate<UPPER_BONES, UPPER_ANGLES>) -> Self {
        let mut observed = 0;
        for (bone, is_observed) in estimate.observed.iter().enumerate() {
            observed |= u16::from(*is_observed) << bone;
        }
        Self { frame, angles_rad: estimate.angles_rad, ends_m: estimate.ends_m.map(Into::into), observed }
    }
}

impl Payload for BodyResult {
    const KIND: Kind = Kind::BodyResult;
    const MAX_BYTES: usize = 4 + 4 * UPPER_ANGLES + 12 * UPPER_BONES + 2;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u32(self.frame);
        fields.f32s(&self.angles_rad);
        fields.f32s(self.ends_m.as_flattened());
        fields.u16(self.observed);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        let (frame, angles_rad) = (fields.u32()?, fields.f32s()?);
        let mut ends_m = [[0.0; 3]; UPPER_BONES];
        for end_m in &mut ends_m {
            *end_m = fields.f32s()?;
        }
        Ok(Self { frame, angles_rad, ends_m, observed: fields.u16()? })
    }
}
