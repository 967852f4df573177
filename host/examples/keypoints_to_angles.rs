//! A pose detector's keypoints to knee angles: a table in memory, one person, no files.
//!
//!     cargo run --release -p sinew --example keypoints_to_angles

use anyhow::{Context, Result, ensure};
use sinew::cyclic::anatomy::{ANATOMICAL_ANGLES, AnatomicalSeries};
use sinew::cyclic::image_joints::ExtraColumns;
use sinew::keypoints::{self, TrackOptions};
use std::fmt::Write;
use std::path::Path;

const FRAMES: usize = 60;
const RATE_HZ: f64 = 30.0;
/// Pixels of a thigh and of a shank.
const SEGMENT_PX: f64 = 100.0;

/// Flexion of the left knee, degrees: a squat each second.
fn true_flexion_deg(frame: usize) -> f64 {
    45.0 - 45.0 * (std::f64::consts::TAU * frame as f64 / RATE_HZ).cos()
}

/// Keypoints as a detector writes them: a row each frame, pixels, and how sure it is of each point.
fn detections() -> String {
    let mut text = String::from("left_hip_x,left_hip_y,left_knee_x,left_knee_y,left_ankle_x,left_ankle_y\n");
    for frame in 0..FRAMES {
        let half = 0.5 * true_flexion_deg(frame).to_radians();
        let (sine, cosine) = (SEGMENT_PX * half.sin(), SEGMENT_PX * half.cos());
        // The person faces right: the knee goes forwards, hip and ankle stay above each other.
        let _ = writeln!(text, "300,200,{:.2},{:.2},300,{:.2}", 300.0 + sine, 200.0 + cosine, 200.0 + 2.0 * cosine);
    }
    text
}

fn main() -> Result<()> {
    let name = Path::new("detections.csv"); // for messages only
    let detections = keypoints::table::parse(&detections(), name)?;
    let track = keypoints::track(&detections, &TrackOptions::default(), name)?;
    let table = track.joints.angle_table(ExtraColumns::None)?;
    let series = AnatomicalSeries::of_table(&table, RATE_HZ);

    let knee = ANATOMICAL_ANGLES.iter().position(|name| *name == "l_knee_flexion").context("the knee has a name")?;
    let mut worst_deg = 0.0_f64;
    for frame in 0..FRAMES {
        let flexion_deg = series.at(knee, frame as f64).context("the knee is seen in every frame")?;
        worst_deg = worst_deg.max((flexion_deg - true_flexion_deg(frame)).abs());
    }
    println!("left knee over {FRAMES} frames: largest difference from the truth {worst_deg:.2} degrees");
    ensure!(worst_deg < 0.1, "{worst_deg} degrees");
    Ok(())
}
