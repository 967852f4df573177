//! Makes the recordings that lie in flash: a walk as angles, and a camera's frames as runs of
//! pixels.

#[path = "src/layout.rs"]
mod layout;

use layout::{ANGLES, FRAMES, HEIGHT, UNITS_PER_RAD, WALK_FRAMES, WIDTH};
use sinew_core::cyclic::model::walking::WALKING;
use std::env;
use std::fs;
use std::path::Path;

/// Colours, RGB565: a hand's skin, a wall, a sleeve.
const SKIN: u16 = 0xcc6c;
const WALL: u16 = 0x6b2c;
const SLEEVE: u16 = 0x2a0a;
/// Cycles in a minute; 54 are a comfortable walk.
const CYCLES_PER_MIN: f32 = 54.0;
/// Standard deviation of the noise of the angles, radians.
const NOISE_STD_RAD: f32 = 0.1;

/// About a normal number: the sum of four uniform ones.
fn noise(state: &mut u32) -> f32 {
    let sum: i32 = (0..4)
        .map(|_| {
            *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (*state >> 16) as i32 - 32768
        })
        .sum();
    sum as f32 / 37837.0
}

fn walk() -> Vec<u8> {
    let model = WALKING.model().expect("the model is sound");
    let mut state = 1;
    let frames_per_cycle = 60.0 * model.rate_hz() / CYCLES_PER_MIN;
    let frame = |frame: usize| model.mean_pose_rad::<ANGLES>(model.point((frame as f32 / frames_per_cycle) % 1.0));
    let angles = (0..WALK_FRAMES).flat_map(frame);
    angles
        .map(|angle| ((angle + NOISE_STD_RAD * noise(&mut state)) * UNITS_PER_RAD).round() as i16)
        .flat_map(i16::to_le_bytes)
        .collect()
}

fn colour(frame: i32, u: i32, v: i32) -> u16 {
    let is_in_disc = |centre: (i32, i32), radius: i32| (u - centre.0).pow(2) + (v - centre.1).pow(2) <= radius * radius;
    // The person's left hand is on the right of the picture; it waves, and comes back to where it
    // began.
    let step = if frame < FRAMES as i32 / 2 { frame } else { FRAMES as i32 - frame };
    if is_in_disc((160, 50), 20) || is_in_disc((195 + 4 * step, 165 - 5 * step), 13) {
        SKIN
    } else if u > 185 && u < 215 && v > 110 && v < 200 {
        SLEEVE
    } else {
        WALL
    }
}

/// Lines one after the other, each as runs: length less one, colour.
fn frames() -> Vec<u8> {
    let mut runs = Vec::new();
    for frame in 0..FRAMES as i32 {
        for v in 0..HEIGHT as i32 {
            let line: Vec<u16> = (0..WIDTH as i32).map(|u| colour(frame, u, v)).collect();
            for part in line.chunk_by(|left, right| left == right).flat_map(|run| run.chunks(256)) {
                runs.push((part.len() - 1) as u8);
                runs.extend(part[0].to_le_bytes());
            }
        }
    }
    runs
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=src/layout.rs");
    let out = env::var("OUT_DIR")?;
    fs::write(Path::new(&out).join("walk.bin"), walk())?;
    fs::write(Path::new(&out).join("frames.bin"), frames())?;
    Ok(())
}
