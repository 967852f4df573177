//! Runners before the simulated stereo camera.

use super::markdown::{Rows, line};
use crate::body::runners::{Seeds, TRACKER, runs};
use crate::body::trial::TrialResult;
use crate::data_split::{Role, motions};
use anyhow::Result;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use std::path::Path;

/// Seeds of a cell. Chosen: errors of one clip differ by a factor of three from cloud to cloud.
const SEEDS: Seeds = Seeds { clouds: 3, trackers: 6 };
/// Particles of the guided model.
const PARTICLES: usize = 30;
/// A row's name, what it changes, and patches without points.
type Row = (&'static str, fn(&mut BodyTuning), u32);

const ROWS: [Row; 4] = [
    ("guided, 30", |_| (), 4),
    ("the same, legs never exchanged", |tuning| tuning.rival.switch_cost = 1.0e15, 4),
    ("the same, `along_share = 0`", |tuning| tuning.smoothing.along_share = 0.0, 4),
    ("guided, 30, no missing patches", |_| (), 0),
];

pub fn runners(recordings: &Path) -> Result<Rows> {
    let mut rows = vec![line([
        "clip",
        "model",
        "joints, cm (runs)",
        "lost, %",
        "nearer than 6 m: joints, cm",
        "lost, %",
        "lost and not flagged, %",
        "(34), cm",
        "(35) over the truth's",
    ])];
    for choice in motions(recordings, TRACKER, Role::Tuning)? {
        let read = choice.read(None)?;
        for (name, change, patches) in ROWS {
            let mut tuning = BodyTuning::default();
            change(&mut tuning);
            let (trials, truth_m) = runs(&read, (BodyModelKind::Guided, PARTICLES), &tuning, (SEEDS, patches))?;
            rows.push(row(&choice.name(), name, &trials, truth_m));
        }
    }
    Ok(rows)
}

/// Means over the runs of one clip and model, with the least and the greatest joint error.
fn row(clip: &str, model: &str, trials: &[TrialResult], truth_m: f64) -> Vec<String> {
    let mean = |value: &dyn Fn(&TrialResult) -> Option<f64>| {
        let values: Vec<f64> = trials.iter().filter_map(value).collect();
        values.iter().sum::<f64>() / values.len().max(1) as f64
    };
    let least = trials.iter().map(|trial| trial.joint_error_m).fold(f64::INFINITY, f64::min);
    let most = trials.iter().map(|trial| trial.joint_error_m).fold(0.0, f64::max);
    let joints_cm = 100.0 * mean(&|trial| Some(trial.joint_error_m));
    line([
        format!("`{clip}`"),
        model.to_owned(),
        format!("{joints_cm:.1} ({:.1} to {:.1})", 100.0 * least, 100.0 * most),
        format!("{:.0}", 100.0 * mean(&|trial| Some(trial.lost_joint_share))),
        format!("{:.1}", 100.0 * mean(&|trial| Some(trial.near?.joint_error_m))),
        format!("{:.0}", 100.0 * mean(&|trial| Some(trial.near?.lost_joint_share))),
        format!("{:.1}", 100.0 * mean(&|trial| Some(trial.near?.lost_unflagged_share))),
        format!("{:.2}", 100.0 * mean(&|trial| Some(trial.error_m))),
        format!("{:.2}", mean(&|trial| Some(trial.smoothness_m)) / truth_m),
    ])
}
