//! Options of the cyclic tracker.

use super::object::config_room;
use super::status::{SinewStatus, status};
use crate::cyclic::CoupledModel;
use crate::error::within;
use crate::tracker::cyclic::FirstPhase;

/// Options of a cyclic tracker; see `sinew_cyclic_default_config`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewCyclicConfig {
    /// Bytes of this structure, as the function that fills it writes them; any other number is
    /// refused.
    pub struct_bytes: u32,
    /// 1 where `first_position` is known; 0: the one that fits the first frame.
    pub has_first_position: u32,
    /// Position in the cycle at the first frame, from 0 to 1, as a switch on a treadmill knows it.
    pub first_position: f32,
    /// Cadence at the first frame, cycles per minute; 0: the model's mean.
    pub first_cadence_per_min: f32,
}

/// Cycles per frame beyond which no filter begins; that of the coupled filter's `begin`.
const MAX_VELOCITY_PER_FRAME: f32 = 0.5;

impl SinewCyclicConfig {
    /// Where and how fast a tracker with `model` begins.
    pub(super) fn first_phase(&self, model: &CoupledModel<'_>) -> Result<FirstPhase, SinewStatus> {
        let position = match self.has_first_position {
            0 => None,
            1 => Some(within("first_position", self.first_position, 0.0, 1.0)?),
            _ => return Err(SinewStatus::OutOfRange),
        };
        let velocity_per_frame = self.first_cadence_per_min / (60.0 * model.rate_hz());
        within("first_cadence_per_min", velocity_per_frame, 0.0, MAX_VELOCITY_PER_FRAME)?;
        let is_known = velocity_per_frame > 0.0;
        Ok(FirstPhase { position, velocity_per_frame: is_known.then_some(velocity_per_frame) })
    }
}

/// Writes options: position and cadence are found.
///
/// `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
/// with the header of another version.
///
/// # Safety
/// `config` points at room of the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_cyclic_default_config(
    config: *mut SinewCyclicConfig,
    config_bytes: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    let room = unsafe { config_room(config, config_bytes) };
    status(room.map(|room| {
        room.write(SinewCyclicConfig {
            struct_bytes: size_of::<SinewCyclicConfig>() as u32,
            has_first_position: 0,
            first_position: 0.0,
            first_cadence_per_min: 0.0,
        });
    }))
}
