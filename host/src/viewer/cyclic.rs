//! Runs of `sinew track cyclic --report`: the figure, angles, cadence, pictures where they were
//! drawn.

use super::marks::{Shown, colour, jpeg, scalars};
use super::numbers::Numbers;
use super::recording::{Moment, Recording};
use crate::cyclic::angle_table::angle_columns;
use crate::cyclic::export::trc::MARKERS;
use crate::cyclic::report::ESTIMATES;
use crate::error::{Context, Result};
use crate::images::load_rgb;
use crate::motion::trc;
use crate::report::pictures::overlay_of;
use re_sdk_types::archetypes::{EncodedImage, LineStrips3D, ViewCoordinates};
use serde_json::Value;
use sinew_core::skeleton::stick_figure::HUMAN;
use std::collections::BTreeMap;
use std::path::Path;

/// Columns that are plotted, beside the angles.
const PLOTTED: [&str; 6] = ["cadence_per_min", "cycle_position", "cycles", "log_likelihood", "outlier", "misfit"];

/// Writes the run in `folder`.
pub(super) fn write(folder: &Path, summary: &Value, recording: &mut Recording<'_>) -> Result<Shown> {
    let rate_hz = summary["options"]["rate_hz"].as_f64().filter(|rate| *rate > 0.0);
    let rate_hz = rate_hz.context("summary.json has no rate")?;
    let estimates = Numbers::read(&folder.join(ESTIMATES), |_| true)?;
    let moment = |frame: i64| Moment { frame, time_s: frame as f64 / rate_hz };
    let frames: BTreeMap<i64, Moment> =
        (0..estimates.len()).filter_map(|row| estimates.frame(row)).map(|frame| (frame, moment(frame))).collect();
    let mut shown = Shown { frames: frames.len(), ..Shown::default() };
    let angles =
        angle_columns().map(|column| (column, format!("plots/angles_deg/{}", column.trim_end_matches("_rad"))));
    let others = PLOTTED.into_iter().map(|column| (column, format!("plots/{column}")));
    for (column, entity) in angles.chain(others) {
        let factor = if column.ends_with("_rad") { 1.0_f64.to_degrees() } else { 1.0 };
        let rows = (0..estimates.len())
            .filter_map(|row| Some((*frames.get(&estimates.frame(row)?)?, factor * estimates.get(row, column)?)));
        scalars(recording, &entity, rows)?;
    }
    let figure = figure(folder, &frames, recording);
    if let Err(error) = figure {
        shown.notes.push(format!("no figure: {}", error.chain()));
    }
    pictures(summary, &frames, recording)?;
    Ok(shown)
}

/// The stick figure of `joints.trc`, x forward, y up.
fn figure(folder: &Path, frames: &BTreeMap<i64, Moment>, recording: &mut Recording<'_>) -> Result<()> {
    let motion = trc::read(&folder.join("joints.trc"))?;
    let place_of: BTreeMap<&str, usize> =
        motion.names.iter().enumerate().map(|(index, name)| (name.as_str(), index)).collect();
    recording.constant("world", &ViewCoordinates::RUB())?;
    let rows = frames.values().zip(&motion.positions_m).map(|(&moment, places)| {
        let place = |joint: usize| {
            let place = (*places.get(*place_of.get(MARKERS[joint])?)?)?;
            Some([place[0], place[1], place[2]])
        };
        let bones = HUMAN.joints().iter().enumerate().filter_map(|(index, joint)| {
            Some(([place(usize::from(joint.parent?))?, place(index)?], colour(joint.name)))
        });
        let (strips, colours): (Vec<_>, Vec<_>) = bones.unzip();
        (moment, Ok(LineStrips3D::new(strips).with_colors(colours).with_radii([0.012_f32])))
    });
    recording.rows("world/figure", rows)
}

/// The overlays, where the run has them.
fn pictures(summary: &Value, frames: &BTreeMap<i64, Moment>, recording: &mut Recording<'_>) -> Result<()> {
    let Some(overlay) = summary["overlay"]["folder"].as_str() else { return Ok(()) };
    let names: Vec<&str> =
        summary["overlay"]["images"].as_array().into_iter().flatten().map(|name| name.as_str().unwrap_or("")).collect();
    let rows = frames.values().filter_map(|&moment| {
        let name = names.get(usize::try_from(moment.frame).ok()?)?;
        let image = load_rgb(&overlay_of(Path::new(overlay), name)?).ok()?;
        Some((moment, jpeg(&image).map(|bytes| EncodedImage::new(bytes).with_media_type("image/jpeg"))))
    });
    recording.rows("frame", rows)
}
