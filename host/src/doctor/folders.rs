//! Folders: of images, of clouds, of runs.

use super::diagnosis::{Diagnosis, Severity};
use super::{frames, recordings};
use crate::body::BodyFile;
use crate::body::pose_file::read_pose;
use crate::cloud::{CloudError, CloudFolder, FoundSource, Region};
use crate::images::list_images;
use crate::report::Page;
use crate::report::document::Level;
use std::path::Path;

/// By what it holds; a run directory before anything else, since it may hold pictures too.
pub(super) fn examine(path: &Path) -> Diagnosis {
    let has = |name: &str| path.join(name).exists();
    if has("points") || has("camera.json") || CloudFolder::open(path).is_ok() {
        return clouds(path);
    }
    if ["run.json", "summary.json", "report.json", "track.csv", "arm.json", "cyclic.json"].iter().any(|name| has(name))
    {
        return run(path);
    }
    match list_images(path) {
        Ok(files) => frames::examine(path, &files),
        Err(_) if holds_keypoints(path) => recordings::examine(path),
        Err(error) => {
            let mut diagnosis = Diagnosis::new(path, "folder");
            diagnosis.add(Severity::Problem, error.to_string());
            diagnosis
        }
    }
}

/// Whether a folder without images has files that pose detectors write.
fn holds_keypoints(folder: &Path) -> bool {
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    files.filter_map(|file| file.extension().map(std::ffi::OsStr::to_owned)).any(|end| end == "json" || end == "txt")
}

/// What a page about the run would say.
fn run(path: &Path) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, "run directory");
    let page = match Page::read(&[path]) {
        Ok(page) => page,
        Err(error) => {
            diagnosis.add(Severity::Problem, error.chain());
            return diagnosis;
        }
    };
    for run in page.runs() {
        diagnosis.what = format!("run directory: {}", run.kind);
        for notice in &run.notices {
            let severity = match notice.level {
                Level::Missing => Severity::Problem,
                Level::Warning | Level::Skipped => Severity::Warning,
                Level::Note => Severity::Good,
            };
            diagnosis.add(severity, notice.text.clone());
        }
        let (plots, tables) = (run.plots.len(), run.tables.len());
        diagnosis.add(Severity::Good, format!("`sinew report` finds {plots} plots and {tables} tables"));
    }
    diagnosis
}

/// The frames of a folder of clouds, or of depth images beside their camera, and notes on that.
fn frames_of(path: &Path) -> Result<(CloudFolder, Vec<String>), CloudError> {
    let found = FoundSource::find(path, None, Region::default())?;
    Ok((found.source.open(&found.folder)?, found.notes))
}

/// A folder that `sinew track body` takes.
fn clouds(path: &Path) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, "folder of point clouds");
    match frames_of(path) {
        Ok((clouds, notes)) => {
            notes.into_iter().for_each(|note| diagnosis.add(Severity::Warning, note));
            diagnosis.add(Severity::Good, format!("{} clouds", clouds.frames.len()));
            if clouds.missing() > 0 {
                let text = format!("{} frame numbers have no cloud; the time steps there are longer", clouds.missing());
                diagnosis.add(Severity::Warning, text);
            }
        }
        Err(error) => diagnosis.add(Severity::Problem, error.to_string()),
    }
    let (person, pose) = (path.join("body.json"), path.join("first_pose.json"));
    if person.is_file() {
        diagnosis.add_result(BodyFile::read(&person).map(|_| "body.json measures the person".to_owned()));
    } else {
        diagnosis.add(
            Severity::Warning,
            "there is no body.json; without --skeleton or --height a person of 1.75 m is assumed",
        );
    }
    if pose.is_file() {
        diagnosis.add_result(read_pose(&pose).map(|_| "first_pose.json holds the pose of the first frame".to_owned()));
    } else {
        diagnosis.add(
            Severity::Warning,
            "there is no first_pose.json; someone who stands or walks is looked for, give others by --init",
        );
    }
    if !path.join("run.json").is_file() {
        diagnosis.add(
            Severity::Warning,
            "there is no run.json with rate_hz; 15 Hz are assumed, another rate is given by --rate",
        );
    }
    diagnosis
}
