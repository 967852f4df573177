//! A made-up cyclic motion, and a person who moves by it.

use core::array::from_fn;
use core::f32::consts::TAU;
use sinew_core::cyclic::ModelTable;
use sinew_core::math::sin_cos;
use sinew_core::numeric::semi_definite::{packed_index, packed_len};
use sinew_core::random::Stream;
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;

/// Positions of the reference cycle.
pub const POSITIONS: usize = 32;
const PACKED: usize = packed_len(HUMAN_ANGLES);
/// Independent sources of the accelerations: fewer than angles, as after a few training cycles.
const SOURCES: usize = 6;
/// Frames of a mean cycle, at 60 frames a second.
const MEAN_DURATION: f32 = 64.0;

/// The model's numbers.
pub type Table = ModelTable<POSITIONS, HUMAN_ANGLES, PACKED>;

/// Angle `index` of the mean cycle, radians, unwrapped: the last winds once a cycle, the others
/// swing.
pub fn mean_angle_rad(index: usize, position: f32) -> f32 {
    let i = index as f32;
    let phase = TAU * (position + 0.07 * i);
    let winding = if index == HUMAN_ANGLES - 1 { TAU * position } else { 0.0 };
    0.3 * i - 1.5 + (0.1 + 0.05 * i) * sin_cos(phase).0 + 0.1 * sin_cos(2.0 * phase).1 + winding
}

/// A model of the motion.
pub fn table(seed: u64) -> Table {
    let mut stream = Stream::new(seed, 0, 0);
    let factor: [[f32; SOURCES]; HUMAN_ANGLES] = from_fn(|_| from_fn(|_| 1.5e-3 * stream.normal()));
    let at = |l: usize, step: f32, i: usize| mean_angle_rad(i, (l as f32 + step) / POSITIONS as f32);
    Table {
        mean_acceleration: from_fn(|l| from_fn(|i| at(l, 1.0, i) - 2.0 * at(l, 0.0, i) + at(l, -1.0, i))),
        acceleration_covariance: from_fn(|l| {
            let scale = 1.0 + 0.5 * sin_cos(TAU * l as f32 / POSITIONS as f32).0;
            let mut packed = [0.0; PACKED];
            for i in 0..HUMAN_ANGLES {
                for j in 0..=i {
                    let products = factor[i].iter().zip(&factor[j]).map(|(a, b)| a * b);
                    packed[packed_index(i, j)] = scale * products.fold(0.0, |sum, term| sum + term);
                }
            }
            packed
        }),
        mean_pose_rad: from_fn(|l| from_fn(|i| at(l, 0.0, i))),
        mean_velocity: from_fn(|l| from_fn(|i| 0.5 * (at(l, 1.0, i) - at(l, -1.0, i)))),
        offset_std_rad: [0.08; HUMAN_ANGLES],
        cosine_std_rad: [0.05; HUMAN_ANGLES],
        sine_std_rad: [0.05; HUMAN_ANGLES],
        rest_std_rad: [0.03; HUMAN_ANGLES],
        rest_rate_per_cycle: [6.0; HUMAN_ANGLES],
        turns_per_cycle: from_fn(|i| i8::from(i == HUMAN_ANGLES - 1)),
        mean_duration_frames: MEAN_DURATION,
        rate_hz: 60.0,
    }
}

/// A person whose pose differs a little from the mean and whose speed changes.
#[derive(Debug)]
pub struct Person {
    seed: u64,
    cycles: f32,
    offsets_rad: [f32; HUMAN_ANGLES],
}

/// What a frame shows of the person.
#[derive(Debug)]
pub struct Shown {
    /// Angles with noise; some frames are empty, some angles missing, one frame in fifty is wrong,
    /// a few are not numbers.
    pub angles_rad: [Option<f32>; HUMAN_ANGLES],
    /// Frames of the model's rate since the last one.
    pub step_frames: f32,
}

impl Person {
    /// Standing at the beginning of the cycle.
    pub fn new(seed: u64) -> Self {
        let mut stream = Stream::new(seed, 0, 1);
        Self { seed, cycles: 0.0, offsets_rad: from_fn(|_| 0.06 * stream.normal()) }
    }

    /// The pose now, radians, unwrapped.
    pub fn pose_rad(&self) -> [f32; HUMAN_ANGLES] {
        from_fn(|i| mean_angle_rad(i, self.cycles) + self.offsets_rad[i])
    }

    /// Moves on to `frame`.
    pub fn show(&mut self, frame: u32, noise_rad: f32) -> Shown {
        let mut stream = Stream::new(self.seed, u64::from(frame), 2);
        let step_frames = if frame.is_multiple_of(17) { 2.0 + stream.uniform() } else { 1.0 };
        let faster = 1.0 + 0.2 * sin_cos(TAU * frame as f32 / 300.0).0;
        self.cycles += step_frames * faster / MEAN_DURATION;
        let hidden = (300..330).contains(&(frame % 500));
        let wrong = if frame.is_multiple_of(50) { 2.0 } else { 0.0 };
        let pose = self.pose_rad();
        let angles_rad = from_fn(|i| {
            let seen = pose[i] + wrong + noise_rad * stream.normal();
            match stream.below(100) {
                _ if hidden => None,
                0..10 => None,
                10 => Some(f32::NAN),
                _ => Some(seen),
            }
        });
        Shown { angles_rad, step_frames }
    }
}
