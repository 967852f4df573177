//! Options of the cyclic particle filter.

use super::cyclic_config::SinewCyclicConfig;
use super::object::config_room;
use super::status::{Answer, SinewStatus, status};
use crate::checksum::Crc32;
use crate::cyclic::CoupledModel;
use crate::cyclic::particle::propose::{ParticleOptions, Spread};
use crate::error::within;
use crate::tracker::cyclic::FirstPhase;

/// Most particles of a cyclic particle filter. Chosen: a step of so many takes a Cortex-M4F of 168
/// MHz about half of the time between two frames of 60 a second.
pub const SINEW_CYCLIC_PARTICLES: usize = 100;

/// Seed, spreads and start of a cyclic particle filter; see
/// `sinew_cyclic_particles_default_config`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewCyclicParticlesConfig {
    /// Bytes of this structure, as the function that fills it writes them; any other number is
    /// refused.
    pub struct_bytes: u32,
    /// Particles, 1 to `SINEW_CYCLIC_PARTICLES`. The time of a step grows with them.
    pub particles: u32,
    /// All random numbers follow from it: the same seed and frames give the same bits.
    pub seed: u64,
    /// 1 where `first_position` is known. 0: particles begin at all positions that fit the first
    /// frame.
    pub has_first_position: u32,
    /// Position in the cycle at the first frame, from 0 to 1, as a switch on a treadmill knows it.
    pub first_position: f32,
    /// Cadence at the first frame, cycles per minute; 0: the model's mean.
    pub first_cadence_per_min: f32,
    /// First standard deviation of each angle, radians, 0 to 3.
    pub first_angle_std_rad: f32,
    /// First standard deviation of each angle's velocity, as a share of how far people differ from
    /// the model's mean velocity, 0 to 10.
    pub first_velocity_share: f32,
    /// First standard deviation of a known position, cycles, 0 to 1.
    pub first_position_std: f32,
    /// First standard deviation of the velocity through the cycle, cycles per frame of the model,
    /// 0 to 0.5.
    pub first_cycle_velocity_std: f32,
    /// Standard deviation of the acceleration through the cycle, cycles per squared frame of the
    /// model, 0 to 0.1.
    pub cycle_acceleration_std: f32,
}

impl SinewCyclicParticlesConfig {
    /// See `sinew_cyclic_particles_default_config`.
    pub(super) fn standard() -> Self {
        let options = ParticleOptions::default();
        Self {
            struct_bytes: size_of::<Self>() as u32,
            particles: SINEW_CYCLIC_PARTICLES as u32,
            seed: 1,
            has_first_position: 0,
            first_position: 0.0,
            first_cadence_per_min: 0.0,
            first_angle_std_rad: options.start_std,
            first_velocity_share: options.deviation_velocity_share,
            first_position_std: options.position_std,
            first_cycle_velocity_std: options.velocity_std,
            cycle_acceleration_std: options.temporal_acceleration_std,
        }
    }

    /// Checks all numbers that do not depend on the model.
    ///
    /// The ranges are wide about the defaults. With any of them every number of a filter stays
    /// finite (`tests/c_interface/tests/fuzz/cyclic_particles.rs`).
    pub(super) fn check(&self) -> Answer {
        if self.particles as usize > SINEW_CYCLIC_PARTICLES {
            return Err(SinewStatus::OverCapacity);
        }
        if self.particles == 0 {
            return Err(SinewStatus::OutOfRange);
        }
        within("first_angle_std_rad", self.first_angle_std_rad, 0.0, 3.0)?;
        within("first_velocity_share", self.first_velocity_share, 0.0, 10.0)?;
        within("first_position_std", self.first_position_std, 0.0, 1.0)?;
        within("first_cycle_velocity_std", self.first_cycle_velocity_std, 0.0, 0.5)?;
        within("cycle_acceleration_std", self.cycle_acceleration_std, 0.0, 0.1)?;
        Ok(())
    }

    /// Where and how fast a filter with `model` begins.
    pub(super) fn first_phase(&self, model: &CoupledModel<'_>) -> Result<FirstPhase, SinewStatus> {
        let of_tracker = SinewCyclicConfig {
            struct_bytes: size_of::<SinewCyclicConfig>() as u32,
            has_first_position: self.has_first_position,
            first_position: self.first_position,
            first_cadence_per_min: self.first_cadence_per_min,
        };
        of_tracker.first_phase(model)
    }

    /// The filter's options.
    pub(super) const fn options(&self) -> ParticleOptions {
        ParticleOptions {
            spread: if self.has_first_position == 0 { Spread::UniformPosition } else { Spread::Standard },
            start_std: self.first_angle_std_rad,
            deviation_velocity_share: self.first_velocity_share,
            position_std: self.first_position_std,
            velocity_std: self.first_cycle_velocity_std,
            temporal_acceleration_std: self.cycle_acceleration_std,
        }
    }

    /// A checksum of what a saved state belongs to: the model, the number of particles, and what
    /// moves them. Seed and start may differ.
    pub(super) fn fingerprint(&self, model_checksum: u32) -> u32 {
        let words = [model_checksum, self.particles, self.cycle_acceleration_std.to_bits()];
        words.into_iter().fold(Crc32::new(), Crc32::and_word).value()
    }
}

/// Writes options: seed 1, `SINEW_CYCLIC_PARTICLES` particles at any position that fits the first
/// frame, and the spreads that the host's command has.
///
/// `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
/// with the header of another version.
///
/// # Safety
/// `config` points at room of the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_cyclic_particles_default_config(
    config: *mut SinewCyclicParticlesConfig,
    config_bytes: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    let room = unsafe { config_room(config, config_bytes) };
    status(room.map(|room| {
        room.write(SinewCyclicParticlesConfig::standard());
    }))
}
