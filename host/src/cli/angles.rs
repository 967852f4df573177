//! `sinew angles`: a motion in space or 2D keypoints as an angle table.

use super::console::Console;
use crate::cyclic::about::About;
use crate::cyclic::projection::{UpAxis, View};
use crate::cyclic::recording::{RecordedAngles, RecordingOptions, angles};
use crate::error::Error;
use crate::keypoints::{DEFAULT_MIN_CONFIDENCE, Facing};
use crate::output::check_writable_file;
use crate::registry::{MOTION, described};
use anyhow::{Result, ensure};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew angles`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate cyclic --model walking --out measured.csv
  sinew track cyclic measured.csv --model walking --out est.csv --report run
  sinew angles run/joints.trc --rate 60 --out walk.csv")]
pub struct AnglesArgs {
    /// Motion in space or 2D keypoints.
    #[arg(help = format!(
        "Motion in space ({}) or 2D keypoints (a folder of OpenPose JSON, a COCO .json, a .csv)",
        described(MOTION)
    ))]
    pub motion: PathBuf,
    /// Skeleton of an AMC file [default: the only .asf in its folder].
    #[arg(long, value_name = "FILE.asf")]
    pub skeleton: Option<PathBuf>,
    /// Frames per second of the table [default: those of the recording].
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Frames per second of the recording [default: what the file says; 120 for AMC and exponential
    /// maps].
    #[arg(long, value_name = "HZ")]
    pub input_rate: Option<f64>,
    /// Angle table to write.
    #[arg(long, value_name = "TABLE.csv")]
    pub out: PathBuf,
    /// From where a motion in space is seen.
    #[arg(long, value_enum, default_value_t = View::Auto)]
    pub view: View,
    /// Coordinate that points up in space [default: the one that standing people lie along].
    #[arg(long, value_enum)]
    pub up: Option<UpAxis>,
    /// Which way the person faces; left is mirrored [default: found in keypoints, right in space].
    #[arg(long, value_enum)]
    pub facing: Option<Facing>,
    /// Keypoints of which the detector was less sure are missing.
    #[arg(long, value_name = "C", default_value_t = DEFAULT_MIN_CONFIDENCE)]
    pub min_confidence: f64,
    /// Take a motion in space that lacks joints, whose angles are then missing, or that has fewer
    /// frames than its header promises.
    #[arg(long)]
    pub partial: bool,
    /// Exchange the names of left and right: the same motion led by the other side, a second one to
    /// train on.
    #[arg(long)]
    pub swap_sides: bool,
    /// End with an error where something speaks against the table; it is written all the same.
    #[arg(long)]
    pub strict: bool,
    /// Names of a motion in space that are not known: lines as `left_hip,NAME`, or
    /// `left_knee,NAME,NAME` for the middle of two. Joints: hips, neck, and left_ and right_
    /// shoulder, elbow, wrist, hip, knee, ankle, heel, toe. `#` begins a comment.
    #[arg(long, value_name = "FILE")]
    pub names: Option<PathBuf>,
}

/// Reads, projects or follows, and writes the table.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn run(args: &AnglesArgs, console: &Console) -> Result<()> {
    let confidence = args.min_confidence;
    ensure!(confidence >= 0.0 && confidence.is_finite(), "`--min-confidence {confidence}`: it has to be zero or more");
    check_writable_file(&args.out)?;
    let options = RecordingOptions {
        skeleton: args.skeleton.clone(),
        rate_hz: args.rate,
        input_rate_hz: args.input_rate,
        view: args.view,
        up: args.up,
        facing: args.facing,
        min_confidence: confidence,
        partial: args.partial,
        swap_sides: args.swap_sides,
        names: args.names.clone(),
    };
    let found = angles(&args.motion, &options)?;
    found.table.write(&args.out)?;
    about(args, &found).write_beside(&args.out)?;
    for note in &found.notes {
        console.note(note);
    }
    for doubt in &found.doubts {
        console.note(format!("doubt: {doubt}"));
    }
    let rows = found.table.rows();
    let count = found.table.angle_count();
    let cells = (0..rows.len()).flat_map(|row| (0..count).map(move |angle| (row, angle)));
    let missing = cells.filter(|(row, angle)| found.table.row_angle_rad(*row, *angle).is_none()).count();
    let missing_share = missing as f64 / (count * rows.len()) as f64;
    let rate = found.rate_hz.map_or_else(|| "an unknown rate".to_owned(), |rate| format!("{rate} frames per second"));
    let report = format!(
        "{} frames at {rate}, {:.1} % of the angles missing\nwrote {}\n",
        rows.len(),
        100.0 * missing_share,
        args.out.display()
    );
    let json = json!({
        "frames": rows.len(),
        "rate_hz": found.rate_hz,
        "missing_share": missing_share,
        "notes": found.notes,
        "doubts": found.doubts,
        "out": args.out,
    });
    console.answer_beside(&args.out, &report, &json)?;
    let doubts = found.doubts.join("; ");
    ensure!(!args.strict || doubts.is_empty(), Error::Invalid(format!("--strict: {doubts}")));
    Ok(())
}

/// What later commands read beside the table.
fn about(args: &AnglesArgs, found: &RecordedAngles) -> About {
    let mut about = About::of_source(&args.motion);
    about.rate_hz = found.rate_hz;
    about.facing = found.facing;
    about.notes.clone_from(&found.notes);
    about.doubts.clone_from(&found.doubts);
    about
}
