//! `sinew angles`: a motion in space or 2D keypoints as an angle table, and its flexion angles.

use super::console::Console;
use super::filter_args::FilterArgs;
use crate::cyclic::anatomy::MeasuredAngles;
use crate::cyclic::projection::{UpAxis, View};
use crate::cyclic::recording::{RecordedAngles, RecordingOptions, all_angles, angles};
use crate::error::Error;
use crate::keypoints::{DEFAULT_MIN_CONFIDENCE, Facing, PersonChoice};
use crate::output::{check_writable_file, write_atomically};
use crate::registry::{MOTION, described};
use anyhow::{Context, Result, ensure};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Options of `sinew angles`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate cyclic --model walking --out measured.csv
  sinew track cyclic measured.csv --model walking --out est.csv --report run
  sinew angles run/joints.trc --rate 60 --out walk.csv
  sinew angles run/joints.trc --out walk.csv --anatomical flexion.csv")]
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
    /// Size of the picture in pixels, for keypoints that are shares of it.
    #[arg(long, value_name = "WIDTH,HEIGHT", value_parser = image_size)]
    pub image_size: Option<[f64; 2]>,
    /// Which of several people in keypoints: largest, longest, or a number from 1, counted by the
    /// frames in which they are seen.
    #[arg(long, value_name = "N|largest|longest", default_value = "largest")]
    pub person: PersonChoice,
    /// Write a table for each person in keypoints: `OUT_1.csv`, `OUT_2.csv`, ...
    #[arg(long, conflicts_with_all = ["person", "anatomical"])]
    pub all: bool,
    /// Flexion angles of what was measured to write, degrees: trunk, shoulders, elbows, hips,
    /// knees, and ankles and feet where heels and toes are seen.
    #[arg(long, value_name = "FLEXION.csv")]
    pub anatomical: Option<PathBuf>,
    /// How these are filtered.
    #[command(flatten)]
    pub filter: FilterArgs,
}

fn image_size(text: &str) -> Result<[f64; 2], String> {
    let sides: Vec<f64> = text.split([',', 'x']).filter_map(|side| side.trim().parse().ok()).collect();
    match sides[..] {
        [width, height] if [width, height].iter().all(|side| (1.0..1.0e6).contains(side)) => Ok([width, height]),
        _ => Err("it has to be width and height in pixels, such as `1920,1080`".to_owned()),
    }
}

/// Reads, projects or follows, and writes the table.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn run(args: &AnglesArgs, console: &Console) -> Result<()> {
    let confidence = args.min_confidence;
    ensure!(confidence >= 0.0 && confidence.is_finite(), "`--min-confidence {confidence}`: it has to be zero or more");
    check_writable_file(&args.out)?;
    args.anatomical.as_deref().map_or(Ok(()), check_writable_file)?;
    ensure!(
        args.anatomical.is_none() || args.view != View::Front,
        "`--anatomical` needs the person from the side; leave out `--view front`"
    );
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
        image_size_px: args.image_size,
        person: args.person,
    };
    if !args.all {
        let mut found = angles(&args.motion, &options)?;
        if let Some(path) = &args.anatomical {
            found.notes.extend(write_anatomical(&found, path, &args.filter)?);
        }
        return write(&found, args, &args.out, console);
    }
    for (number, found) in (1..).zip(all_angles(&args.motion, &options)?) {
        let stem = args.out.file_stem().unwrap_or_default().to_string_lossy();
        write(&found, args, &args.out.with_file_name(format!("{stem}_{number}.csv")), console)?;
    }
    Ok(())
}

fn write(found: &RecordedAngles, args: &AnglesArgs, out: &Path, console: &Console) -> Result<()> {
    found.table.write(out)?;
    found.about(&args.motion).write_beside(out)?;
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
    let paths = std::iter::once(out).chain(args.anatomical.as_deref());
    let written: Vec<String> = paths.map(|path| format!("wrote {}\n", path.display())).collect();
    let report = format!(
        "{} frames at {rate}, {:.1} % of the angles missing\n{}",
        rows.len(),
        100.0 * missing_share,
        written.join("")
    );
    let json = json!({
        "frames": rows.len(),
        "rate_hz": found.rate_hz,
        "missing_share": missing_share,
        "notes": found.notes,
        "doubts": found.doubts,
        "out": out,
        "anatomical": args.anatomical,
    });
    console.answer_beside(out, &report, &json)?;
    let doubts = found.doubts.join("; ");
    ensure!(!args.strict || doubts.is_empty(), Error::Invalid(format!("--strict: {doubts}")));
    Ok(())
}

/// Writes the filtered flexion angles; the result is what a user should know of the filter.
fn write_anatomical(found: &RecordedAngles, path: &Path, filter: &FilterArgs) -> Result<Option<String>> {
    let rate_hz = found.rate_hz.context(
        "`--anatomical` filters over time: say with `--input-rate HZ` how many frames a second the recording has",
    )?;
    let (options, note) = filter.options(rate_hz)?;
    let text = MeasuredAngles::of_table(&found.table, rate_hz, &options)?.to_csv();
    write_atomically(path, |writer| Ok(writer.write_all(text.as_bytes())?))?;
    Ok(note)
}
