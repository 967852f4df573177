//! Bodies in a plain and in a hard scene, and before and after the deadband, on the report set.

use super::body::{REPORT_SET, SKELETON, choice};
use super::markdown::{Rows, line};
use crate::body::Measured;
use crate::body::motions::ReadMotion;
use crate::body::trial::{PoseMeasures, TrialResult, trial};
use anyhow::{Context, Result};
use rayon::prelude::*;
use sinew::body::tracking::BodyModelKind::{self, Angular, EndEffector, Guided};
use sinew::body::tracking::BodyTuning;
use sinew::stereo::{SceneErrors, StereoOptions};
use std::path::Path;

/// Seeds of camera and tracker. Chosen: each table takes ten minutes.
const SEEDS: u64 = 3;
/// Models with their particles.
const MODELS: [(&str, BodyModelKind, usize); 3] =
    [("end-effector, 100", EndEffector, 100), ("angular, 100", Angular, 100), ("guided, 30", Guided, 30)];

/// The scenes: each error alone, and all together.
fn scenes() -> [(&'static str, SceneErrors); 8] {
    let (none, hard) = (SceneErrors::default(), SceneErrors::HARD);
    [
        ("plain", none),
        ("radii off by 15 %", SceneErrors { radius_share: hard.radius_share, ..none }),
        ("lengths off by 5 %", SceneErrors { length_share: hard.length_share, ..none }),
        ("first pose off by 10 degrees", SceneErrors { first_pose_deg: hard.first_pose_deg, ..none }),
        (
            "windows of 11 px, 5 % false",
            SceneErrors { match_window_px: hard.match_window_px, false_matches: hard.false_matches, ..none },
        ),
        ("10 % of the points on a wall", SceneErrors { background: hard.background, ..none }),
        ("exposure of 1/30 s", SceneErrors { exposure_s: hard.exposure_s, ..none }),
        ("hard: all of them", hard),
    ]
}

/// The report set's motions.
fn motions(recordings: &Path) -> Result<Vec<ReadMotion>> {
    let mocap = recordings.join("mocap");
    let read = |(_, file): (&str, &str)| {
        let path = mocap.join(file);
        choice(path.to_str().context("the folder's name is no text")?)?.read(Some(&mocap.join(SKELETON)))
    };
    REPORT_SET.into_iter().map(read).collect()
}

/// All trials of a model in a scene, and PIK (35) of the truth beside each.
fn trials(
    motions: &[ReadMotion],
    errors: SceneErrors,
    (model, particles): (BodyModelKind, usize),
) -> Result<Vec<(TrialResult, f64)>> {
    let pairs: Vec<(&ReadMotion, u64)> =
        motions.iter().flat_map(|motion| (1..=SEEDS).map(move |seed| (motion, seed))).collect();
    let one = |&(motion, seed): &(&ReadMotion, u64)| {
        let seen = motion.seen_as(StereoOptions { seed, errors, ..StereoOptions::default() })?;
        Ok((trial(&seen, model, &BodyTuning::default(), particles, seed)?.0, seen.smoothness_m()))
    };
    pairs.par_iter().map(one).collect()
}

fn mean(trials: &[(TrialResult, f64)], value: impl Fn(&TrialResult, f64) -> f64) -> f64 {
    Measured::of(&trials.iter().map(|(trial, truth_m)| value(trial, *truth_m)).collect::<Vec<_>>()).mean
}

pub fn hard(recordings: &Path) -> Result<Rows> {
    let motions = motions(recordings)?;
    let mut rows = vec![line(["scene", "model", "joints, cm", "lost, %", "(34), cm", "(35) over the truth's"])];
    for (scene, errors) in scenes() {
        for (name, model, particles) in MODELS {
            let trials = trials(&motions, errors, (model, particles))?;
            rows.push(line([
                scene.to_owned(),
                name.to_owned(),
                format!("{:.1}", 100.0 * mean(&trials, |trial, _| trial.joint_error_m)),
                format!("{:.0}", 100.0 * mean(&trials, |trial, _| trial.lost_joint_share)),
                format!("{:.2}", 100.0 * mean(&trials, |trial, _| trial.error_m)),
                format!("{:.2}", mean(&trials, |trial, truth_m| trial.smoothness_m / truth_m)),
            ]));
        }
    }
    Ok(rows)
}

pub fn deadband(recordings: &Path) -> Result<Rows> {
    let motions = motions(recordings)?;
    let mut rows = vec![line(["model", "pose", "joints, cm", "lost, %", "(34), cm", "(35) over the truth's"])];
    for (name, model, particles) in MODELS {
        let trials = trials(&motions, SceneErrors::default(), (model, particles))?;
        let reported = |trial: &TrialResult| PoseMeasures {
            error_m: trial.error_m,
            joint_error_m: trial.joint_error_m,
            lost_joint_share: trial.lost_joint_share,
            smoothness_m: trial.smoothness_m,
        };
        for (pose, is_before) in [("before the deadband", true), ("as reported", false)] {
            let of = |trial: &TrialResult| if is_before { trial.before_deadband } else { reported(trial) };
            rows.push(line([
                name.to_owned(),
                pose.to_owned(),
                format!("{:.2}", 100.0 * mean(&trials, |trial, _| of(trial).joint_error_m)),
                format!("{:.1}", 100.0 * mean(&trials, |trial, _| of(trial).lost_joint_share)),
                format!("{:.2}", 100.0 * mean(&trials, |trial, _| of(trial).error_m)),
                format!("{:.2}", mean(&trials, |trial, truth_m| of(trial).smoothness_m / truth_m)),
            ]));
        }
    }
    Ok(rows)
}
