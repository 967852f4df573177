//! Pages of `sinew track cyclic --report`.

use super::cyclic_plots::{cycle_plots, estimate_plots};
use super::document::{Bone, Colour, Fact, Figure, Level, Player, Run};
use super::facts::{facts_of, number, options_table};
use super::folder::RunFolder;
use super::pictures::{Pictures, overlay_of};
use super::table::Table;
use crate::cyclic::export::trc::MARKERS;
use crate::cyclic::report::document::VERSION;
use crate::cyclic::report::{ESTIMATES, MEASURED};
use crate::motion::trc;
use serde_json::Value;
use sinew_core::skeleton::stick_figure::HUMAN;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Name of the table with the joints' places.
const JOINTS_TABLE: &str = "joints.csv";

/// Tables of feet and of what was measured, with what they hold.
const GAIT_TABLES: [(&str, &str); 4] = [
    ("strides.csv", "Each stride from foot strike to foot strike"),
    ("events.csv", "Foot strikes and toe-offs"),
    ("gait_curves.csv", "Each joint from foot strike to foot strike, mean and standard deviation"),
    ("measured_anatomical.csv", "Flexion angles of what was measured, filtered, without a model of the motion"),
];

/// The run in `folder`.
pub fn cyclic_run(mut folder: RunFolder, pictures: &mut Pictures) -> Run {
    let summary = folder.json("summary.json").unwrap_or_default();
    let mut run =
        Run { name: folder.path().display().to_string(), kind: "Cyclic motion in angles".to_owned(), ..Run::default() };
    if !summary.is_null() {
        folder.check_version("summary.json", &summary, u64::from(VERSION));
        tell_what_was_run(&mut run, &mut folder, &summary);
    }
    let rate_hz = summary["options"]["rate_hz"].as_f64();
    let estimates = folder.table(ESTIMATES, "Angles, position in the cycle, cadence and likelihood of each frame");
    let measured =
        folder.optional_table(MEASURED, "The angles that the filter was given, in the turn nearest to the estimate");
    let curves = folder.table("curves.csv", "Each joint over the cycle, mean and standard deviation over the cycles");
    let anatomical = folder.table("anatomical.csv", "Flexion angles of each frame");
    let repetitions = folder.optional_table("repetitions.csv", "Each whole cycle");
    let symmetry = folder.optional_table("symmetry.csv", "Left against right");
    let gait: Vec<Table> = GAIT_TABLES.iter().filter_map(|(name, what)| folder.optional_table(name, what)).collect();
    let joints = joints(&mut folder, estimates.as_ref());
    run.plots.extend(estimates.iter().flat_map(|estimates| estimate_plots(estimates, measured.as_ref(), rate_hz)));
    run.plots.extend(cycle_plots(curves.as_ref(), anatomical.as_ref(), repetitions.as_ref()));
    run.player = player(&mut folder, &summary, estimates.as_ref(), joints.as_ref(), pictures);
    run.tables = [repetitions, symmetry].into_iter().flatten().chain(gait).collect();
    run.tables.extend([curves, anatomical, estimates, measured, joints].into_iter().flatten());
    if !summary["options"].is_null() {
        run.tables.push(options_table("options", &summary["options"]));
    }
    run.notices = folder.into_notices();
    run
}

fn tell_what_was_run(run: &mut Run, folder: &mut RunFolder, summary: &Value) {
    run.highlights.extend(number(&summary["cadence_per_min"], 2, "a minute").map(|value| Fact::new("Cadence", value)));
    run.highlights.extend(number(&summary["cycles"], 2, "").map(|value| Fact::new("Cycles", value)));
    run.highlights.extend(number(&summary["duration_s"], 2, "s").map(|value| Fact::new("Duration", value)));
    run.highlights
        .extend(facts_of(summary, &[("frames", "Frames"), ("outliers", "Outliers"), ("misfits", "Unlike the model")]));
    run.facts = facts_of(
        summary,
        &[("sinew_version", "Version"), ("seed", "Seed"), ("table", "Input"), ("model", "Motion model")],
    );
    let options = [
        ("filter", "Filter"),
        ("sigma_deg", "Sigma, degrees"),
        ("rate_hz", "Frame rate, Hz"),
        ("finished", "Finished recording"),
        ("smooth", "Smoothed"),
    ];
    run.facts.extend(facts_of(&summary["options"], &options));
    run.facts.extend(facts_of(&summary["recording"], &[("facing", "The person faces"), ("source", "Recording")]));
    if let Some(facing) = summary["recording"]["facing"].as_str().filter(|facing| *facing == "left") {
        folder.notice(Level::Note, format!("the person faces {facing}; left and right are the person's own"));
    }
    for doubt in summary["doubts"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        folder.notice(Level::Warning, format!("doubt: {doubt}"));
    }
    for note in summary["notes"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        folder.notice(Level::Note, note);
    }
    run.highlights.extend(gait_facts(&summary["gait"]));
    if let Some(skipped) = summary["skipped_frames"].as_u64().filter(|count| *count > 0) {
        folder.notice(Level::Skipped, format!("the table leaves out {skipped} frames between its first and its last"));
    }
    let shares = summary["measured_shares"].as_object().into_iter().flatten();
    let guessed: Vec<String> = shares
        .filter_map(|(angle, share)| Some((angle, share.as_f64()?)))
        .filter(|(_, share)| *share < 0.9)
        .map(|(angle, share)| {
            format!("{}: measured in {:.0} % of the rows", angle.trim_end_matches("_rad"), 100.0 * share)
        })
        .collect();
    let what = "what was not measured is the model's guess in between; an angle that never was is left out";
    folder.notice_of(Level::Warning, what, guessed);
    if summary["repetitions"].as_array().is_some_and(Vec::is_empty) {
        folder.notice(Level::Note, "there is no whole cycle; curves over the cycle need a longer recording");
    }
}

/// What a coach asks of the feet: left and right beside each other.
fn gait_facts(gait: &Value) -> Vec<Fact> {
    let mean = |foot: &str, name: &str, scale: f64, decimals: usize| {
        gait[foot][name]["mean"].as_f64().map_or_else(|| "-".to_owned(), |mean| format!("{:.decimals$}", scale * mean))
    };
    let fact = |label: &str, name: &str, scale: f64, decimals: usize, unit: &str| {
        let is_known = ["left", "right"].iter().any(|foot| gait[*foot][name]["mean"].is_number());
        let [left, right] = ["left", "right"].map(|foot| mean(foot, name, scale, decimals));
        is_known.then(|| Fact::new(label, format!("left {left}, right {right} {unit}")))
    };
    [
        fact("Stance", "stance_share", 100.0, 1, "% of the stride"),
        fact("Step time", "step_time_s", 1.0, 3, "s"),
        fact("Flight time", "flight_time_s", 1.0, 3, "s"),
        fact("Step length", "step_length_m", 1.0, 2, "m"),
        fact("Speed", "speed_m_per_s", 1.0, 2, "m/s"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// `joints.trc` as a table whose frames are those of the estimates.
fn joints(folder: &mut RunFolder, estimates: Option<&Table>) -> Option<Table> {
    let path = folder.path().join("joints.trc");
    if !path.is_file() {
        folder.notice(Level::Missing, "joints.trc is not there; the player draws no figure");
        return None;
    }
    let motion = match trc::read(&path) {
        Ok(motion) => motion,
        Err(error) => {
            folder.notice(Level::Missing, format!("the player draws no figure: {error}"));
            return None;
        }
    };
    let frames = estimates.map_or_else(Vec::new, |estimates| estimates.distinct("frame"));
    let columns: Vec<String> =
        motion.names.iter().flat_map(|name| [format!("{name}_x_m"), format!("{name}_y_m")]).collect();
    let columns: Vec<&str> = std::iter::once("frame").chain(columns.iter().map(String::as_str)).collect();
    let mut table = Table::new(JOINTS_TABLE, "Joints of joints.trc: x forward, y up", &columns);
    for (index, places) in motion.positions_m.iter().enumerate() {
        let mut cells = vec![frames.get(index).cloned().unwrap_or_else(|| index.to_string())];
        for place in places {
            for axis in 0..2 {
                let mut cell = String::new();
                if let Some(place) = place {
                    // Writing to a string cannot fail.
                    let _ = write!(cell, "{:.4}", place[axis]);
                }
                cells.push(cell);
            }
        }
        table.rows.push(cells);
    }
    Some(table)
}

fn player(
    folder: &mut RunFolder,
    summary: &Value,
    estimates: Option<&Table>,
    joints: Option<&Table>,
    pictures: &mut Pictures,
) -> Option<Player> {
    let frames = estimates.or(joints)?.distinct("frame");
    let mut player = Player {
        table: estimates.map(|estimates| estimates.name.clone()),
        rate_hz: summary["options"]["rate_hz"].as_f64(),
        figures: joints.map(figure).into_iter().collect(),
        shown: [
            "frame",
            "cycle_position",
            "cadence_per_min",
            "cycles",
            "log_likelihood",
            "outlier",
            "misfit",
            "motion",
        ]
        .map(str::to_owned)
        .to_vec(),
        ..Player::default()
    };
    if let Some(recorded) = summary["overlay"]["folder"].as_str() {
        match folder.find(recorded) {
            Some(overlay) => {
                let names: Vec<&str> = summary["overlay"]["images"]
                    .as_array()
                    .into_iter()
                    .flatten()
                    .map(|name| name.as_str().unwrap_or(""))
                    .collect();
                let image = |frame: &String| {
                    names.get(frame.parse::<usize>().ok()?).and_then(|name| overlay_of(&overlay, name))
                };
                player.pictures = Some(pictures.add(frames.iter().map(image).collect()));
            }
            None => folder.notice(Level::Missing, format!("the pictures, {recorded}, are not found from here")),
        }
    }
    player.frames = frames;
    Some(player)
}

fn figure(joints: &Table) -> Figure {
    let mut bones = Vec::new();
    for (index, joint) in HUMAN.joints().iter().enumerate().skip(1) {
        let Some(parent) = joint.parent else { continue };
        let [from, to] = [usize::from(parent), index]
            .map(|joint| [format!("{}_x_m", MARKERS[joint]), format!("{}_y_m", MARKERS[joint])]);
        let colour = match MARKERS[index].as_bytes() {
            [b'L', ..] => Colour::Left,
            [b'R', ..] => Colour::Right,
            _ => Colour::Middle,
        };
        let known: BTreeSet<&str> = joints.columns.iter().map(String::as_str).collect();
        if known.contains(from[0].as_str()) && known.contains(to[0].as_str()) {
            bones.push(Bone { table: joints.name.clone(), only: Vec::new(), from, to, colour, truth: false });
        }
    }
    Figure { title: "The figure from the side".to_owned(), bones, ..Figure::default() }
}
