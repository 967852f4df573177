//! What goes into the cyclic tracker, and what comes out.

use super::status::SinewStatus;
use crate::cyclic::AngleMeasurement;
use crate::math::sqrt;
use crate::tracker::cyclic::CyclicFrame;

/// Most angles of a motion model.
pub const SINEW_MAX_ANGLES: usize = 13;

const _: () = assert!(SINEW_MAX_ANGLES == crate::skeleton::stick_figure::HUMAN_ANGLES);

/// The angles of one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewCyclicFrame {
    /// When the frame was taken, microseconds since any start. Dropped frames are simply not given.
    /// A counter of 32 bits goes through `sinew_clock_us`.
    pub timestamp_us: u64,
    /// Bit i is set if angle i was seen; the others' values are not looked at.
    pub seen: u32,
    /// Number of angles given, at most `SINEW_MAX_ANGLES` and at most those of the model.
    pub angle_count: u32,
    /// Angles, radians, any turn.
    pub angles_rad: [f32; SINEW_MAX_ANGLES],
    /// Standard deviation of each angle, radians, greater than zero.
    pub std_rad: [f32; SINEW_MAX_ANGLES],
}

/// Pose, phase and cadence after a frame. Entries beyond the model's angles are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SinewCyclicResult {
    /// That of the frame.
    pub timestamp_us: u64,
    /// Angles in (-pi, pi].
    pub angles_rad: [f32; SINEW_MAX_ANGLES],
    /// Standard deviation of each angle, radians.
    pub angle_std_rad: [f32; SINEW_MAX_ANGLES],
    /// Whole turns of each angle since the start: the unwrapped angle is `angles_rad` + 2 pi
    /// `turns`.
    pub turns: [i32; SINEW_MAX_ANGLES],
    /// Whole cycles since the first frame; a cycle of walking is two steps.
    pub cycles_completed: i32,
    /// Position in the cycle, from 0 to 1.
    pub cycle_position: f32,
    /// Standard deviation of the position, cycles.
    pub cycle_position_std: f32,
    /// Cycles per minute.
    pub cadence_per_min: f32,
    /// Standard deviation of the cadence, cycles per minute.
    pub cadence_std_per_min: f32,
    /// Natural logarithm of the density of the frame's angles given those before.
    pub log_likelihood: f32,
    /// 1 if the angles are too far from what was expected to belong to the motion.
    pub is_outlier: u32,
    /// 1 while the position in the cycle is not known and the pose is the mean of all positions.
    pub is_searching: u32,
    /// 1 if the person has for a cycle or two differed from the model's mean cycle by far more than
    /// people do in the training: another motion, or wrong angles.
    pub is_misfit: u32,
}

impl SinewCyclicFrame {
    /// The measurement, one frame after the last, with the angles of a model of `model_angles`.
    pub(super) fn measurement(&self, model_angles: usize) -> Result<AngleMeasurement<SINEW_MAX_ANGLES>, SinewStatus> {
        let count = self.angle_count as usize;
        if count > SINEW_MAX_ANGLES || count > model_angles {
            return Err(SinewStatus::OverCapacity);
        }
        if self.seen >> count != 0 {
            return Err(SinewStatus::OutOfRange);
        }
        let mut angles_rad = [None; SINEW_MAX_ANGLES];
        let mut std_rad = [1.0; SINEW_MAX_ANGLES];
        for (index, (slot, angle)) in angles_rad.iter_mut().zip(self.angles_rad).enumerate() {
            if self.seen >> index & 1 == 1 {
                *slot = Some(crate::error::finite("angles_rad", angle)?);
            }
        }
        for (index, (slot, std)) in std_rad.iter_mut().zip(self.std_rad).enumerate() {
            if self.seen >> index & 1 == 1 {
                *slot = std;
            }
        }
        Ok(AngleMeasurement::with_std(&angles_rad, &std_rad)?)
    }
}

impl SinewCyclicResult {
    pub(super) fn of(timestamp_us: u64, frame: &CyclicFrame<SINEW_MAX_ANGLES>, is_searching: bool) -> Self {
        let estimate = &frame.estimate;
        Self {
            timestamp_us,
            angles_rad: estimate.angles_rad,
            angle_std_rad: estimate.angle_variance_rad2.map(std),
            turns: estimate.turns,
            cycles_completed: frame.cycles_completed,
            cycle_position: estimate.cycle_position,
            cycle_position_std: std(estimate.cycle_position_variance),
            cadence_per_min: frame.cadence_per_min,
            cadence_std_per_min: frame.cadence_std_per_min,
            log_likelihood: estimate.log_likelihood,
            is_outlier: u32::from(estimate.outlier),
            is_searching: u32::from(is_searching),
            is_misfit: u32::from(estimate.misfit),
        }
    }
}

fn std(variance: f32) -> f32 {
    sqrt(crate::math::max(variance, 0.0))
}
