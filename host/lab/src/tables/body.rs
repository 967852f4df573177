//! Bodies from points of the simulated stereo camera.

use super::markdown::{Rows, line, named};
use crate::body::hidden_arm::{follow, summaries, windows};
use crate::body::prediction::chain_spread;
use crate::body::trial::{SeenMotion, TrialResult, trial};
use crate::body::{Measured, MotionChoice};
use anyhow::{Context, Result, anyhow};
use rayon::prelude::*;
use sinew::body::BodyPart;
use sinew::body::tracking::BodyModelKind::{Angular, EndEffector, Guided, PelvicLift, Stick};
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::resume::Cells;
use sinew::stereo::Hidden;
use std::path::Path;

/// The report set: three kinds of motion, none of them a tuning clip.
pub(super) const REPORT_SET: [(&str, &str); 6] = [
    ("directing traffic", "cmu-expmap/train_directing_traffic_1.txt@0-5"),
    ("waving", "bandai/dataset-2_wave-both-hands_normal_001.bvh@0-5"),
    ("walk 02_01", "cmu-walk/02/02_01.amc"),
    ("walk 35_01", "cmu-walk/35/35_01.amc"),
    ("jumping jacks", "cmu-exercise/13_29.amc@0-3.9"),
    ("squats", "cmu-exercise/13_29.amc@31.7-36"),
];
/// The same with eight seconds of the two gestures.
const HIDING_SET: [&str; 6] = [
    "cmu-expmap/train_directing_traffic_1.txt@0-8",
    "bandai/dataset-2_wave-both-hands_normal_001.bvh@0-8",
    "cmu-walk/02/02_01.amc",
    "cmu-walk/35/35_01.amc",
    "cmu-exercise/13_29.amc@0-3.9",
    "cmu-exercise/13_29.amc@31.7-36",
];
/// Skeleton of the .amc files that have none beside them.
pub(super) const SKELETON: &str = "cmu-walk/35/35.asf";
/// Frames for which an arm is hidden.
const HIDDEN_FRAMES: usize = 15;

pub(super) fn choice(text: &str) -> Result<MotionChoice> {
    text.parse().map_err(|error: String| anyhow!("{text}: {error}"))
}

/// One trial a seen motion, the first with seed 1: of each of them `value`.
fn trials(
    seen: &[SeenMotion],
    (model, particles): (BodyModelKind, usize),
    value: fn(&TrialResult) -> f64,
) -> Result<Measured> {
    let one = |(seed, seen)| Ok(value(&trial(seen, model, &BodyTuning::default(), particles, seed)?.0));
    Ok(Measured::of(&(1..).zip(seen).map(one).collect::<Result<Vec<f64>>>()?))
}

/// What the seeds 1 to `seeds` see of a motion.
fn seen(motion: &MotionChoice, skeleton: Option<&Path>, seeds: u64) -> Result<Vec<SeenMotion>> {
    let read = motion.read(skeleton)?;
    (1..=seeds).into_par_iter().map(|seed| read.seen(BodyPart::Whole, seed)).collect()
}

pub fn figure_2(_: &Path) -> Result<Rows> {
    let seen = choice("stick-wave")?.seen(None, 1)?;
    let (spread, _) = chain_spread::draw(&seen.measures, seen.first_rad, 1)?;
    let joints = ["neck", "head", "left elbow", "left wrist", "right elbow", "right wrist", "left knee", "left ankle"];
    let cm = |value: f64| format!("{:.1}", 100.0 * value);
    Ok(vec![
        named("", joints.map(str::to_owned)),
        named("noise of angles", spread.joints.iter().map(|joint| cm(joint.angular_m))),
        named("goals", spread.joints.iter().map(|joint| cm(joint.end_effector_m))),
    ])
}

pub fn tuning(_: &Path) -> Result<Rows> {
    const PARTICLES: [usize; 4] = [25, 50, 100, 250];
    let seen = seen(&choice("stick-wave")?, None, 2)?;
    let mut rows = vec![named("particles", PARTICLES.map(|count| count.to_string()))];
    for (model, name) in [(EndEffector, "end-effector, cm on the skin"), (Guided, "guided")] {
        let errors = PARTICLES.map(|count| error_cm(&seen, (model, count), 2));
        rows.push(named(name, errors.into_iter().collect::<Result<Vec<_>>>()?));
    }
    Ok(rows)
}

/// PIK (34), centimetres.
fn error_cm(seen: &[SeenMotion], cell: (BodyModelKind, usize), places: usize) -> Result<String> {
    Ok(format!("{:.places$}", 100.0 * trials(seen, cell, |trial| trial.error_m)?.mean))
}

pub fn built_in(_: &Path) -> Result<Rows> {
    let stick = seen(&choice("stick-wave")?, None, 5)?;
    let lift = seen(&choice("pelvic-lift")?, None, 3)?;
    let none = String::new;
    let of_stick = |model| error_cm(&stick, (model, 100), 2);
    let of_stick_2500 = |model| error_cm(&stick[..1], (model, 2500), 2);
    let of_lift = |model| error_cm(&lift, (model, 100), 1);
    let row = |motion: &str, particles: &str, cells: [String; 4]| {
        named(format!("`{motion}`"), std::iter::once(particles.to_owned()).chain(cells))
    };
    let wave = [of_stick(Stick)?, of_stick(EndEffector)?, of_stick(Angular)?, none()];
    let wave_2500 = [none(), of_stick_2500(EndEffector)?, of_stick_2500(Angular)?, none()];
    let pelvis = [none(), of_lift(EndEffector)?, none(), of_lift(PelvicLift)?];
    Ok(vec![
        line(["motion", "particles", "stick", "end-effector", "angular", "pelvic lift"]),
        row("stick-wave", "100", wave),
        row("stick-wave", "2500", wave_2500),
        row("pelvic-lift", "100", pelvis),
    ])
}

pub fn hdm05(recordings: &Path) -> Result<Rows> {
    let file = recordings.join("mocap/hdm05/HDM_dg_06-03_03_120.c3d");
    let motion = MotionChoice::File { path: file, between_s: None };
    let hidden: Hidden = "r_arm:8-20".parse().map_err(|error| anyhow!("{error}"))?;
    let views: [(f32, &[Hidden]); 4] = [(0.0, &[]), (0.0, std::slice::from_ref(&hidden)), (90.0, &[]), (-90.0, &[])];
    let mut rows = vec![line([
        "model, 100 particles",
        "all points",
        "`--hide r_arm:8-20`",
        "`--heading 90`, trunk before the left arm",
        "`--heading -90`, before the right arm",
    ])];
    rows.extend([EndEffector, Angular, Guided].map(|model| line([model.name()])));
    for (heading_deg, hidden) in views {
        let read = motion.read_turned(None, heading_deg.to_radians(), false)?;
        let seeds = (1..=5_u64).into_par_iter();
        let seen: Vec<SeenMotion> =
            seeds.map(|seed| read.seen_hiding(BodyPart::Whole, seed, hidden)).collect::<Result<_>>()?;
        for (row, model) in rows[1..].iter_mut().zip([EndEffector, Angular, Guided]) {
            let recorded = trials(&seen, (model, 100), |trial| trial.recorded_error_m.unwrap_or(f64::NAN))?.mean;
            row.push(format!("{:.2} ({})", 100.0 * recorded, error_cm(&seen, (model, 100), 2)?));
        }
    }
    Ok(rows)
}

pub fn smoothness(recordings: &Path) -> Result<Rows> {
    let mocap = recordings.join("mocap");
    let cells: [(&str, BodyModelKind, usize, usize); 8] = [
        ("guided, 30 particles", Guided, 30, 5),
        ("guided, 100", Guided, 100, 5),
        ("end-effector, 50", EndEffector, 50, 5),
        ("end-effector, 100", EndEffector, 100, 5),
        ("end-effector, 1000, one seed", EndEffector, 1000, 1),
        ("angular, 50", Angular, 50, 5),
        ("angular, 100", Angular, 100, 5),
        ("angular, 1000", Angular, 1000, 1),
    ];
    let mut rows = vec![named("", REPORT_SET.map(|(name, _)| name.to_owned()))];
    rows.extend(cells.iter().map(|(name, ..)| line([*name])));
    for (_, file) in REPORT_SET {
        let motion = choice(mocap.join(file).to_str().context("the folder's name is no text")?)?;
        let seen = seen(&motion, Some(&mocap.join(SKELETON)), 5)?;
        let truth = Measured::of(&seen.iter().map(SeenMotion::smoothness_m).collect::<Vec<_>>()).mean;
        for (row, (_, model, particles, seeds)) in rows[1..].iter_mut().zip(cells) {
            let found = trials(&seen[..seeds], (model, particles), |trial| trial.smoothness_m)?.mean;
            row.push(format!("{:.2}", found / truth));
        }
    }
    Ok(rows)
}

pub fn hidden(recordings: &Path) -> Result<Rows> {
    let mocap = recordings.join("mocap");
    let mut rows = vec![line(["model", "particles", "back", "grew", "unobserved", "all three (asked: 90 %)"])];
    let cells =
        [(Guided, 30, 4, "guided"), (EndEffector, 100, 8, "end-effector, `--trials 8`"), (Angular, 100, 4, "angular")];
    for (model, particles, seeds, name) in cells {
        let mut arms = Vec::new();
        for file in HIDING_SET {
            let motion = choice(mocap.join(file).to_str().context("the folder's name is no text")?)?;
            let read = motion.read(Some(&mocap.join(SKELETON)))?;
            let frames = read.seen(BodyPart::Whole, 1)?.clouds_m.len();
            for seed in 1..=seeds {
                let windows = windows(frames, HIDDEN_FRAMES, seed);
                let seen = read.seen_hiding(BodyPart::Whole, seed, &windows)?;
                let with = (&BodyTuning::default(), &Cells::not_kept());
                arms.extend(follow(&motion.name(), (&seen, &windows), (model, particles), with, seed)?);
            }
        }
        for found in summaries(&arms) {
            let shares = [found.came_back, found.spread_grew, found.said_unobserved, found.as_wanted];
            let shares = shares.map(|share| format!("{:.0} %", 100.0 * share));
            rows.push(named(name, std::iter::once(particles.to_string()).chain(shares)));
        }
    }
    Ok(rows)
}
