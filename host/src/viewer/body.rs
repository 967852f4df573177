//! Runs of `sinew track body`: points, skeleton, ends of limbs over the particles.

use super::marks::{Shown, colour, scalars, weighted_points};
use super::numbers::Numbers;
use super::recording::{Moment, Recording};
use crate::cloud::{self, CloudFolder};
use crate::error::{Context, Result};
use crate::report::body::BONES;
use re_sdk_types::archetypes::{LineStrips3D, Points3D, ViewCoordinates};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Ends of limbs whose particles are shown.
const ENDS: [&str; 5] = ["head", "l_wrist", "r_wrist", "l_ankle", "r_ankle"];
/// Colour of the points, red, green, blue, opacity.
const POINT: u32 = 0xffe680ff;

/// Writes the run in `folder`.
pub(super) fn write(folder: &Path, report: &Value, recording: &mut Recording<'_>) -> Result<Shown> {
    let rate_hz = report["rate_hz"].as_f64().filter(|rate| *rate > 0.0).context("run.json has no rate_hz")?;
    let track = Numbers::read(&folder.join("track.csv"), |_| true)?;
    let moment = |frame: i64| Moment { frame, time_s: frame as f64 / rate_hz };
    let frames: BTreeMap<i64, Moment> =
        (0..track.len()).filter_map(|row| track.frame(row)).map(|frame| (frame, moment(frame))).collect();
    let mut shown = Shown { frames: frames.len(), ..Shown::default() };
    recording.constant("world", &ViewCoordinates::RDF())?;
    let clouds = report["inputs"]["clouds"].as_str().context("run.json has no clouds");
    match clouds.and_then(|clouds| Ok(CloudFolder::open(Path::new(clouds))?)) {
        Ok(clouds) => points(&clouds, &frames, recording)?,
        Err(error) => shown.notes.push(format!("no points: {}", error.chain())),
    }
    let skeleton = (0..track.len()).filter_map(|row| {
        let moment = *frames.get(&track.frame(row)?)?;
        let place = |joint: &str| track.place(row, joint, ["x_m", "y_m", "z_m"]);
        let bones = BONES.iter().filter_map(|(from, to)| Some(([place(from)?, place(to)?], colour(to))));
        let (strips, colours): (Vec<_>, Vec<_>) = bones.unzip();
        Some((moment, Ok(LineStrips3D::new(strips).with_colors(colours).with_radii([0.012_f32]))))
    });
    recording.rows("world/skeleton", skeleton)?;
    let spreads = ENDS.map(|joint| (format!("{joint}_spread_m"), format!("plots/spread_m/{joint}")));
    let others = ["effective_sample_size", "log_evidence", "points"];
    let others = others.map(|column| (column.to_owned(), format!("plots/{column}")));
    for (column, entity) in spreads.into_iter().chain(others) {
        let rows =
            (0..track.len()).filter_map(|row| Some((*frames.get(&track.frame(row)?)?, track.get(row, &column)?)));
        scalars(recording, &entity, rows)?;
    }
    let particles = folder.join("particles.csv");
    if particles.is_file() {
        let wanted = |name: &str| {
            ["frame", "weight"].contains(&name)
                || ENDS.iter().any(|joint| name.starts_with(joint) && name.ends_with("_m"))
        };
        let particles = Numbers::read(&particles, wanted)?;
        for joint in ENDS {
            weighted_points(&particles, joint, &frames, recording)?;
        }
    } else {
        shown.notes.push("no particles: track with --particles-csv".to_owned());
    }
    Ok(shown)
}

/// The clouds as they were read; a frame whose cloud is missing or broken has no points.
fn points(clouds: &CloudFolder, frames: &BTreeMap<i64, Moment>, recording: &mut Recording<'_>) -> Result<()> {
    let files: BTreeMap<i64, &Path> =
        clouds.frames.iter().filter_map(|one| Some((i64::try_from(one.frame).ok()?, one.path.as_path()))).collect();
    let rows = frames.values().map(|&moment| {
        let cloud = files.get(&moment.frame).and_then(|path| cloud::read(path).ok()).unwrap_or_default();
        let points = cloud.points_m.iter().map(|point| [point.x, point.y, point.z]);
        (moment, Ok(Points3D::new(points).with_colors([POINT]).with_radii([0.004_f32])))
    });
    recording.rows("world/points", rows)
}
