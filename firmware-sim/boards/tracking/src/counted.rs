//! Tracks the recordings and counts what each part takes, in instructions.

use crate::camera::Camera;
use crate::layout::{HEIGHT, WALK_FRAMES, WIDTH};
use crate::recording::Lines;
use crate::walker::Walker;
use core::fmt::Arguments;

/// What counts and prints.
pub trait Machine {
    /// A counter that wraps.
    fn ticks() -> u32;
    /// Instructions in so many of its ticks.
    fn instructions(ticks: u32) -> u64;
    /// Prints a line.
    fn print(line: Arguments<'_>);
}

/// Frames of the camera: the recording five times.
const FRAMES: u64 = 60;
/// Microseconds from one frame to the next: 15 a second.
const FRAME_US: u64 = 66_667;
/// Particles and most pairs of edge pixels: the defaults, and two smaller settings.
const SETTINGS: [(usize, usize); 3] = [(50, 1000), (20, 200), (10, 100)];

#[derive(Default)]
struct Cost {
    total: u64,
    worst: u64,
    count: u64,
}

impl Cost {
    fn add(&mut self, spent: u64) {
        (self.total, self.worst, self.count) = (self.total + spent, self.worst.max(spent), self.count + 1);
    }

    fn print<M: Machine>(&self, part: Arguments<'_>) {
        M::print(format_args!("{part}|{}|{}", self.total / self.count.max(1), self.worst));
    }
}

fn spent<M: Machine, T>(work: impl FnOnce() -> T) -> (u64, T) {
    let before = M::ticks();
    let answer = work();
    (M::instructions(M::ticks().wrapping_sub(before)), answer)
}

/// Follows the walk and the arm with each setting; whether they were where they have to be.
pub fn run<M: Machine>(walker: &mut Walker, camera: &mut Camera) -> bool {
    walk::<M>(walker) & SETTINGS.iter().all(|&(particles, max_pairs)| watch::<M>(camera, particles, max_pairs))
}

fn walk<M: Machine>(walker: &mut Walker) -> bool {
    let (mut cost, mut sum_per_min) = (Cost::default(), 0.0);
    if walker.begin().is_err() {
        return false;
    }
    for number in 0..WALK_FRAMES {
        let (instructions, Some(frame)) = spent::<M, _>(|| walker.step()) else { return false };
        cost.add(instructions);
        sum_per_min += if number < WALK_FRAMES / 2 { 0.0 } else { frame.cadence_per_min };
    }
    let cadence_per_min = sum_per_min / (WALK_FRAMES - WALK_FRAMES / 2) as f32;
    cost.print::<M>(format_args!("cyclic step"));
    M::print(format_args!("cadence: {cadence_per_min} a minute"));
    // The recording has 54; the first half is for the filter to find it.
    (53.0..55.0).contains(&cadence_per_min)
}

fn watch<M: Machine>(camera: &mut Camera, particles: usize, max_pairs: usize) -> bool {
    let (mut lines, mut front_end, mut arm) = (Lines::new(), Cost::default(), Cost::default());
    let mut distance_m = 0.0;
    if camera.begin((WIDTH as u16, HEIGHT as u16), particles, max_pairs).is_err() {
        return false;
    }
    for frame in 0..FRAMES {
        let (mut pixels, mut of_frame) = ([0; WIDTH], 0);
        for row in 0..HEIGHT {
            lines.read(&mut pixels);
            of_frame += spent::<M, _>(|| camera.line(row, &pixels)).0;
        }
        front_end.add(of_frame);
        let (instructions, Some(estimate)) = spent::<M, _>(|| camera.end(frame * FRAME_US)) else { return false };
        arm.add(instructions);
        distance_m = estimate.joints.hand_m.z;
    }
    if (particles, max_pairs) == SETTINGS[0] {
        front_end.print::<M>(format_args!("lines of a frame, 320 x 240"));
    }
    arm.print::<M>(format_args!("arm step, {particles} particles, {max_pairs} pairs"));
    M::print(format_args!("hand: {distance_m} m away"));
    // The person stands at 1.25 m, and the arm is 0.63 m long.
    (0.6..1.9).contains(&distance_m)
}
