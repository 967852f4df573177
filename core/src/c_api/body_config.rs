//! Options of the body tracker.

use super::body_frame::SINEW_BODY_COORDINATES;
use super::object::config_room;
use super::status::{Answer, SinewStatus, status};
use crate::checksum::Crc32;
use crate::error::within;
use crate::ranges::MAX_M;
use crate::skeleton::tree::SHIFTS;
use crate::tracker::body::upper::{DEFAULT_UPPER_OPTIONS, UpperBodyOptions};
use core::f32::consts::TAU;

/// Body, first pose and options of a body tracker; see `sinew_body_default_config`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewBodyConfig {
    /// Bytes of this structure, as the function that fills it writes them; any other number is
    /// refused.
    pub struct_bytes: u32,
    /// Most steps of the pose solver, 1 to 20. The time of a frame grows with them.
    pub solver_steps: u32,
    /// Height of the person, metres, 0.5 to 2.5; lengths and radii of all bones follow from it.
    pub height_m: f32,
    /// Standard deviation of a point's distance from the skin, metres, 0.001 to 1.
    pub point_std_m: f32,
    /// Points farther from the skin than this count as outliers, metres, 0.001 to 1.
    pub outlier_m: f32,
    /// How far the pelvis may get in a second, metres (standard deviation), 0.001 to 10.
    pub root_shift_std_m_per_sqrt_s: f32,
    /// How far it may turn in a second, radians (standard deviation), 0.001 to 10.
    pub root_turn_std_rad_per_sqrt_s: f32,
    /// Deadband of the reported pose at rest, metres, 0 to 1.
    pub jitter_std_m: f32,
    /// The pose to begin with: three shifts, metres, then angles, radians.
    pub first_coordinates: [f32; SINEW_BODY_COORDINATES],
    /// Zero.
    pub reserved: u32,
}

impl SinewBodyConfig {
    /// The tracker's options.
    pub(super) const fn options(&self) -> UpperBodyOptions {
        UpperBodyOptions {
            height_m: self.height_m,
            point_std_m: self.point_std_m,
            outlier_m: self.outlier_m,
            root_shift_std_m_per_sqrt_s: self.root_shift_std_m_per_sqrt_s,
            root_turn_std_rad_per_sqrt_s: self.root_turn_std_rad_per_sqrt_s,
            jitter_std_m: self.jitter_std_m,
            solver_steps: self.solver_steps as usize,
        }
    }

    /// Whether a tracker can begin with it.
    pub(super) fn check(&self) -> Answer {
        if self.reserved != 0 {
            return Err(SinewStatus::OutOfRange);
        }
        self.options().check()?;
        for (index, value) in self.first_coordinates.iter().enumerate() {
            let most = if index < SHIFTS { MAX_M } else { TAU };
            within("first_coordinates", *value, -most, most)?;
        }
        Ok(())
    }

    /// A checksum of what a saved state belongs to: all but the first pose.
    pub(super) fn fingerprint(&self) -> u32 {
        let options = [
            self.height_m,
            self.point_std_m,
            self.outlier_m,
            self.root_shift_std_m_per_sqrt_s,
            self.root_turn_std_rad_per_sqrt_s,
            self.jitter_std_m,
        ];
        let words = [self.solver_steps].into_iter().chain(options.map(f32::to_bits));
        words.fold(Crc32::new(), Crc32::and_word).value()
    }
}

/// Writes a configuration: an adult of 1.75 metres who faces the camera with hanging arms, the
/// pelvis `distance_m` before it and half a metre below its axis, and the options that the host's
/// command has.
///
/// `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
/// with the header of another version. Returns SINEW_STATUS_OUT_OF_RANGE for a distance that does
/// not lie between 0.2 and 20.
///
/// # Safety
/// `config` points at room of the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_body_default_config(
    distance_m: f32,
    config: *mut SinewBodyConfig,
    config_bytes: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    let room = unsafe { config_room(config, config_bytes) };
    status(room.and_then(|room| {
        within("distance_m", distance_m, 0.2, 20.0)?;
        let options = DEFAULT_UPPER_OPTIONS;
        let mut first_coordinates = [0.0; SINEW_BODY_COORDINATES];
        (first_coordinates[1], first_coordinates[2]) = (0.5, distance_m);
        room.write(SinewBodyConfig {
            struct_bytes: size_of::<SinewBodyConfig>() as u32,
            solver_steps: options.solver_steps as u32,
            height_m: options.height_m,
            point_std_m: options.point_std_m,
            outlier_m: options.outlier_m,
            root_shift_std_m_per_sqrt_s: options.root_shift_std_m_per_sqrt_s,
            root_turn_std_rad_per_sqrt_s: options.root_turn_std_rad_per_sqrt_s,
            jitter_std_m: options.jitter_std_m,
            first_coordinates,
            reserved: 0,
        });
        Ok(())
    }))
}
