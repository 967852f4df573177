//! Files: configurations, models, persons, angle tables.

use super::diagnosis::{Diagnosis, Severity};
use super::recordings;
use crate::body::BodyFile;
use crate::body::run::tuning_file;
use crate::config::Config;
use crate::cyclic::angle_table::{ANGLES, COLUMNS};
use crate::cyclic::{AngleTable, CyclicModel};
use crate::file::read_text;
use crate::images::{VideoFacts, VideoFrames, is_video, load_rgb};
use crate::json_file::read_json;
use crate::registry::{Kind, find};
use crate::skin::SkinModel;
use image::RgbImage;
use serde_json::Value;
use std::path::Path;

/// Share of an angle's rows below which it is reported.
const SELDOM: f64 = 0.5;

pub(super) fn examine(path: &Path) -> Diagnosis {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match extension.as_str() {
        "toml" => configuration(path),
        "json" => json(path),
        "csv" => table(path),
        _ if recordings::is_motion(path) => recordings::examine(path),
        _ if is_video(path) => video(path),
        _ if find(path, &[Kind::Image]).is_some() => {
            let mut diagnosis = Diagnosis::new(path, "image");
            let size = load_rgb(path).map(|image| format!("{}x{} pixels", image.width(), image.height()));
            diagnosis.add_result(size.map_err(Into::into));
            diagnosis
        }
        _ => {
            let mut diagnosis = Diagnosis::new(path, "file");
            let known = "folders of images, clouds or keypoints, run directories, .toml, .json, .csv, motions in space, images and videos";
            diagnosis.add(Severity::Problem, format!("this kind of file is not known here; examined are {known}"));
            diagnosis
        }
    }
}

fn video(path: &Path) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, "video");
    let facts = VideoFacts::read(path).and_then(|facts| {
        let frames = VideoFrames::open(path, facts.rate_hz)?;
        let (width, height) = frames.first().map_or((0, 0), RgbImage::dimensions);
        Ok(format!("{} frames of {width}x{height} pixels, {:.3} per second", facts.frames, facts.rate_hz))
    });
    diagnosis.add_result(facts.map_err(Into::into));
    diagnosis
}

/// A configuration of arms or of bodies; the problem reported is that of the kind whose sections it
/// has.
fn configuration(path: &Path) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, "configuration");
    let (arm, body) = (Config::load(path), tuning_file::load(path));
    let text = read_text(path).unwrap_or_default();
    let of_body = ["[root", "[end_effector", "[guided", "[angular", "[points", "stick_", "lift_"];
    let is_body = text.lines().any(|line| of_body.iter().any(|start| line.trim_start().starts_with(start)));
    match (arm, body) {
        (Ok(_), _) => diagnosis.add(Severity::Good, "`sinew track arm --config` takes it"),
        (_, Ok(_)) => diagnosis.add(Severity::Good, "`sinew track body --config` takes it"),
        (_, Err(error)) if is_body => diagnosis.add(Severity::Problem, error.chain()),
        (Err(error), _) => diagnosis.add(Severity::Problem, error.chain()),
    }
    diagnosis
}

fn json(path: &Path) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, "JSON file");
    let record: Value = match read_json(path) {
        Ok(record) => record,
        Err(error) => {
            let reason = error.chain();
            diagnosis.add(
                Severity::Problem,
                format!("it is no JSON ({reason}); a file that was cut off has to be made anew"),
            );
            return diagnosis;
        }
    };
    let option = path.display().to_string();
    match record["format"].as_str() {
        Some("sinew-cyclic") => {
            diagnosis.what = "motion model".to_owned();
            diagnosis.add_result(CyclicModel::from_option(&option).map(|_| "`--model` takes it".to_owned()));
        }
        Some("sinew-skin") => {
            diagnosis.what = "skin model".to_owned();
            diagnosis.add_result(SkinModel::from_option(&option).map(|_| "`--skin` takes it".to_owned()));
        }
        Some(other) => {
            diagnosis.add(Severity::Warning, format!("a record of the form `{other}`; examine its folder instead"));
        }
        None if !record["upper_arm_m"].is_null() => {
            diagnosis.what = "person".to_owned();
            diagnosis.add_result(BodyFile::read(path).map(|_| "`sinew track body --skeleton` takes it".to_owned()));
        }
        None => return recordings::examine(path),
    }
    diagnosis
}

/// An angle table of `sinew track cyclic`, or a table of keypoints.
fn table(path: &Path) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, "angle table");
    let header = read_text(path).unwrap_or_default().lines().next().unwrap_or_default().to_owned();
    let table = match AngleTable::read(path) {
        Ok(table) => table,
        Err(_) if !header.contains(COLUMNS[1]) => return recordings::examine(path),
        Err(error) => {
            diagnosis.add(Severity::Problem, error.to_string());
            return diagnosis;
        }
    };
    let rows = table.rows();
    diagnosis.add(
        Severity::Good,
        format!("{} rows, frames {} to {}", rows.len(), table.first_frame(), table.end_frame() - 1),
    );
    recordings::beside(path, &table, &mut diagnosis);
    let missing = table.end_frame() - table.first_frame() - rows.len() as u64;
    if missing > 0 {
        diagnosis.add(
            Severity::Warning,
            format!("{missing} frames are left out; they count as frames without a measurement"),
        );
    }
    let mut never = Vec::new();
    for angle in 0..ANGLES {
        let share = rows.iter().filter(|row| row.angles_rad[angle].is_some()).count() as f64 / rows.len() as f64;
        let name = COLUMNS[angle + 1].trim_end_matches("_rad");
        if share == 0.0 {
            never.push(name);
        } else if share < SELDOM {
            let percent = 100.0 * share;
            diagnosis.add(
                Severity::Warning,
                format!("{name} is measured in {percent:.0} % of the rows; it is the model's guess in between"),
            );
        }
    }
    if !never.is_empty() {
        diagnosis.add(Severity::Warning, format!("never measured: {}", never.join(", ")));
    }
    diagnosis
}
