//! A synthetic motion for the tests of the filters: every angle swings or winds, with correlated
//! noise.

use crate::cyclic::HumanModelTable;
use crate::numeric::semi_definite::{packed_index, packed_len};
use crate::random::Stream;
use core::f32::consts::TAU;

const ANGLES: usize = 13;
const POSITIONS: usize = 100;

/// Angle `index` of the mean cycle at `position`: angle 12 winds once a cycle, the others swing.
pub fn mean_angle(index: usize, position: f32) -> f32 {
    let phase = TAU * (position + 0.07 * index as f32);
    let swing = 0.1 + 0.05 * index as f32;
    let winding = if index == 12 { TAU * position } else { 0.0 };
    0.3 * index as f32 - 1.5 + swing * phase.sin() + 0.1 * (2.0 * phase).cos() + winding
}

/// A model of that motion, 65 frames a cycle. Its acceleration has standard deviation `noise` (rad
/// per frame^2), and its covariance has the `rank` given.
pub fn table(noise: f32, rank: usize) -> Box<HumanModelTable> {
    let mut factor = [[0.0; ANGLES]; ANGLES];
    let mut stream = Stream::new(77, 0, 0);
    for row in &mut factor {
        for value in row.iter_mut() {
            *value = noise / 3.0 * stream.normal();
        }
    }
    let mut table = Box::new(HumanModelTable {
        mean_acceleration: [[0.0; ANGLES]; POSITIONS],
        acceleration_covariance: [[0.0; packed_len(ANGLES)]; POSITIONS],
        mean_pose_rad: [[0.0; ANGLES]; POSITIONS],
        mean_velocity: [[0.0; ANGLES]; POSITIONS],
        offset_std_rad: [0.08; ANGLES],
        cosine_std_rad: [0.05; ANGLES],
        sine_std_rad: [0.05; ANGLES],
        rest_std_rad: [0.03; ANGLES],
        rest_rate_per_cycle: [6.0; ANGLES],
        turns_per_cycle: core::array::from_fn(|i| i8::from(i == 12)),
        mean_duration_frames: 65.0,
        rate_hz: 60.0,
    });
    for l in 0..POSITIONS {
        let at = |offset: f32, i: usize| mean_angle(i, (l as f32 + offset) / POSITIONS as f32);
        let scale = 1.0 + 0.5 * (TAU * l as f32 / POSITIONS as f32).sin();
        for i in 0..ANGLES {
            table.mean_pose_rad[l][i] = at(0.0, i);
            table.mean_velocity[l][i] = 0.5 * (at(1.0, i) - at(-1.0, i));
            table.mean_acceleration[l][i] = at(1.0, i) - 2.0 * at(0.0, i) + at(-1.0, i);
            for j in 0..=i {
                let sum: f32 = (0..rank).map(|k| factor[i][k] * factor[j][k]).sum();
                table.acceleration_covariance[l][packed_index(i, j)] = scale * sum;
            }
        }
    }
    table
}
