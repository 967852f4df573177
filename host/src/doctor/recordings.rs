//! Recordings of a person who moves: keypoints and motions in space, as `sinew angles` reads them,
//! and what is known beside an angle table.

use super::diagnosis::{Diagnosis, Severity};
use crate::cyclic::AngleTable;
use crate::cyclic::about::About;
use crate::cyclic::recording::{RecordingOptions, angles};
use crate::keypoints::DEFAULT_MIN_CONFIDENCE;
use crate::registry::{Kind, find};
use std::path::Path;

/// Kinds of files that `sinew angles` reads, and tables and JSON are looked into besides.
const KINDS: [Kind; 2] = [Kind::JointMotion, Kind::MarkerMotion];

/// Whether the name says that it is a motion in space.
pub(super) fn is_motion(path: &Path) -> bool {
    find(path, &KINDS).is_some()
}

/// What `sinew angles` would make of it.
pub(super) fn examine(path: &Path) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, if is_motion(path) { "motion in space" } else { "keypoints" });
    let options = RecordingOptions { min_confidence: DEFAULT_MIN_CONFIDENCE, ..RecordingOptions::default() };
    let recorded = match angles(path, &options) {
        Ok(recorded) => recorded,
        Err(error) => {
            diagnosis.add(Severity::Problem, error.chain());
            return diagnosis;
        }
    };
    let layout = recorded.layout.map_or_else(String::new, |layout| format!(", {layout}"));
    let rows = recorded.table.rows().len();
    diagnosis.add(Severity::Good, format!("`sinew angles` takes it: {rows} frames{layout}"));
    rate(&mut diagnosis, recorded.rate_hz, "--input-rate HZ");
    recorded.notes.into_iter().for_each(|note| diagnosis.add(Severity::Good, note));
    recorded.doubts.into_iter().for_each(|doubt| diagnosis.add(Severity::Warning, format!("doubt: {doubt}")));
    diagnosis
}

/// The rate of an angle table, and the doubts of its recording.
pub(super) fn beside(path: &Path, table: &AngleTable, diagnosis: &mut Diagnosis) {
    rate(diagnosis, table.rate_hz(), "--rate HZ");
    match About::read_beside(path) {
        Ok(about) => {
            let doubts = about.into_iter().flat_map(|about| about.doubts);
            doubts.for_each(|doubt| diagnosis.add(Severity::Warning, format!("doubt: {doubt}")));
        }
        Err(error) => diagnosis.add(Severity::Problem, error.chain()),
    }
}

fn rate(diagnosis: &mut Diagnosis, rate_hz: Option<f64>, option: &str) {
    match rate_hz {
        Some(rate_hz) => diagnosis.add(Severity::Good, format!("{rate_hz} frames a second")),
        None => {
            diagnosis.add(Severity::Warning, format!("does not say how many frames a second it has: give {option}"));
        }
    }
}
