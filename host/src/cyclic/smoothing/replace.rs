//! The smoothed estimates in the place of the forward ones.

use super::Smoothed;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::tracking::TrackedFrame;
use crate::cyclic::turns::least_angle;
use std::f64::consts::TAU;

/// Replaces the forward estimates of `frames` by the smoothed ones: angles, position, velocity and
/// their variances. Likelihood and outlier flags stay those of the forward pass. Cycles count from
/// the smoothed position of the first frame.
///
/// The one of `smoothed` at an index belongs to the frame at that index; frames without one keep
/// the estimate that they have.
pub fn replace_estimates<const N: usize>(frames: &mut [TrackedFrame], smoothed: &[Option<Smoothed<N>>]) {
    let mut first_shift = None;
    for (frame, smoothed) in frames.iter_mut().zip(smoothed) {
        let Some(smoothed) = smoothed else {
            frame.cycles -= first_shift.unwrap_or(0.0);
            continue;
        };
        let estimate = &mut frame.estimate;
        for (i, angle) in frame.angles_rad.iter_mut().enumerate().take(N) {
            *angle += least_angle(smoothed.angles_rad[i] - *angle);
            let turns = (*angle / TAU).round();
            estimate.angles_rad[i] = (*angle - TAU * turns) as f32;
            estimate.turns[i] = turns as i32;
            estimate.angle_variance_rad2[i] = smoothed.angle_variance_rad2[i] as f32;
        }
        if let Some(side) = &mut frame.side {
            let later = smoothed.angles_rad.iter().zip(&smoothed.angle_variance_rad2).skip(ANGLES);
            for ((angle, variance), (to, new)) in
                side.angles_rad.iter_mut().zip(&mut side.angle_variance_rad2).zip(later)
            {
                *angle += least_angle(to - *angle);
                *variance = *new as f32;
            }
        }
        let change = smoothed.cycle_position - f64::from(estimate.cycle_position);
        let shift = change - change.round();
        frame.cycles += shift - *first_shift.get_or_insert(shift);
        estimate.cycle_position = smoothed.cycle_position as f32;
        estimate.cycle_position_variance = smoothed.cycle_position_variance as f32;
        estimate.cycle_velocity_per_frame = smoothed.cycle_velocity as f32;
        estimate.cycle_velocity_variance = smoothed.cycle_velocity_variance as f32;
    }
}
