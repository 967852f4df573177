//! Pages of `sinew track body`.

use super::arm::TRUTH_TABLE;
use super::body_plots::body_plots;
use super::document::{Bone, Colour, Fact, Figure, Level, Player, Run};
use super::facts::{facts_of, number, options_table, text};
use super::folder::RunFolder;
use super::pictures::Pictures;
use super::table::Table;
use crate::body::run::REPORT_VERSION;
use serde_json::Value;
use sinew_core::skeleton::full_body::BODY_JOINT_NAMES;

/// Name of the table of distances between track and truth.
pub const ERROR_TABLE: &str = "joint_error.csv";
/// The bones that are drawn.
pub const BONES: [(&str, &str); 16] = [
    ("pelvis", "neck"),
    ("neck", "head"),
    ("neck", "l_shoulder"),
    ("l_shoulder", "l_elbow"),
    ("l_elbow", "l_wrist"),
    ("neck", "r_shoulder"),
    ("r_shoulder", "r_elbow"),
    ("r_elbow", "r_wrist"),
    ("pelvis", "l_hip"),
    ("l_hip", "l_knee"),
    ("l_knee", "l_ankle"),
    ("l_ankle", "l_toe"),
    ("pelvis", "r_hip"),
    ("r_hip", "r_knee"),
    ("r_knee", "r_ankle"),
    ("r_ankle", "r_toe"),
];

/// The run in `folder`.
pub fn body_run(mut folder: RunFolder, pictures: &mut Pictures) -> Run {
    let report = folder.json("run.json").unwrap_or_default();
    let mut run =
        Run { name: folder.path().display().to_string(), kind: "Body in point clouds".to_owned(), ..Run::default() };
    if !report.is_null() {
        folder.check_version("run.json", &report, u64::from(REPORT_VERSION));
        tell_what_was_run(&mut run, &report);
        tell_what_was_left_out(&mut folder, &report);
    }
    if let Some(track) = folder.table("track.csv", "Joints, angles and the filter's state of each frame") {
        let truth = truth(&mut folder, &report);
        let error = truth.as_ref().map(|truth| joint_errors(&track, truth)).filter(|error| !error.rows.is_empty());
        let rate_hz = report["rate_hz"].as_f64();
        run.plots = body_plots(&track, error.as_ref(), rate_hz);
        run.player = Some(Player {
            frames: track.distinct("frame"),
            table: Some(track.name.clone()),
            rate_hz,
            figures: [("x", "from the front"), ("z", "from the person's right side")]
                .map(|view| figure(&track, truth.is_some(), view))
                .to_vec(),
            shown: [
                "frame",
                "points",
                "effective_sample_size",
                "log_evidence",
                "head_observed",
                "l_wrist_observed",
                "r_wrist_observed",
                "l_wrist_ambiguous",
                "r_wrist_ambiguous",
                "l_ankle_ambiguous",
                "r_ankle_ambiguous",
            ]
            .map(str::to_owned)
            .to_vec(),
            ..Player::default()
        });
        run.tables.push(track);
        run.tables.extend(error);
        run.tables.extend(truth);
    }
    if folder.has("particles.csv") {
        folder.notice(
            Level::Note,
            "particles.csv, every particle of every frame, is too much for a page; it is in the folder",
        );
    }
    super::other::add_picture(&mut run, &folder, "contact_sheet.png", pictures);
    for field in ["options", "body"] {
        if !report[field].is_null() {
            run.tables.push(options_table(field, &report[field]));
        }
    }
    run.notices = folder.into_notices();
    run
}

fn tell_what_was_run(run: &mut Run, report: &Value) {
    run.highlights
        .push(Fact::new("Frames", format!("{} of {}", text(&report["frames_finished"]), text(&report["frames"]))));
    let centimetres = |field: &str| Some(format!("{:.2} cm", 100.0 * report[field].as_f64()?));
    run.highlights.extend(centimetres("error_m").map(|value| Fact::new("Error on the skin", value)));
    run.highlights.extend(centimetres("joint_error_m").map(|value| Fact::new("Error at the joints", value)));
    let lost = report["lost_joint_share"].as_f64().map(|share| format!("{:.1} %", 100.0 * share));
    run.highlights.extend(lost.map(|value| Fact::new("Frames with a joint over 10 cm off", value)));
    let step = report["seconds_per_step"].as_f64().map(|seconds| format!("{:.1} ms", 1000.0 * seconds));
    run.highlights.extend(step.map(|value| Fact::new("One step", value)));
    let share = report["effective_share"].as_f64().map(|share| format!("{:.0} %", 100.0 * share));
    run.highlights.extend(share.map(|value| Fact::new("Effective particles", value)));
    run.facts = facts_of(report, &[("sinew_version", "Version"), ("seed", "Seed"), ("rate_hz", "Frame rate, Hz")]);
    run.facts.extend(facts_of(&report["options"], &[("model", "Motion model"), ("particles", "Particles")]));
    let inputs =
        [("clouds", "Clouds"), ("skeleton", "Person"), ("init", "First pose"), ("stick", "Stick"), ("truth", "Truth")];
    run.facts.extend(facts_of(&report["inputs"], &inputs));
    run.facts.extend(number(&report["frames_per_second"], 0, "frames/s").map(|speed| Fact::new("Speed", speed)));
}

fn tell_what_was_left_out(folder: &mut RunFolder, report: &Value) {
    if report["complete"].as_bool() == Some(false) {
        let (finished, frames) = (text(&report["frames_finished"]), text(&report["frames"]));
        folder.notice(Level::Missing, format!("the run ended after {finished} of {frames} frames"));
    }
    let skipped = report["skipped"].as_array().into_iter().flatten();
    let items: Vec<String> = skipped
        .map(|one| format!("frame {}, {}: {}", text(&one["frame"]), text(&one["file"]), text(&one["reason"])))
        .collect();
    let what = format!("{} clouds could not be read; their frames are predictions", items.len());
    folder.notice_of(Level::Skipped, what, items);
    let points = &report["points"];
    let counts = [
        (&report["frames_missing"], "frame numbers have no file and no row"),
        (&points["frames_without_points"], "frames have no points; they are predictions"),
        (&points["skipped"], "points were not finite, at the camera, or too far away"),
        (&points["over_cap"], "points were left out of clouds that had too many"),
        (&report["degenerate_frames"], "frames in which no particle fitted"),
    ];
    for (count, what) in counts {
        if let Some(count) = count.as_u64().filter(|count| *count > 0) {
            folder.notice(Level::Warning, format!("{count} {what}"));
        }
    }
    for warning in report["warnings"].as_array().into_iter().flatten() {
        folder.notice(Level::Warning, text(warning));
    }
    for note in report["notes"].as_array().into_iter().flatten() {
        folder.notice(Level::Note, text(note));
    }
}

fn truth(folder: &mut RunFolder, report: &Value) -> Option<Table> {
    let recorded = report["inputs"]["truth"].as_str()?;
    let Some(path) = folder.find(recorded) else {
        folder.notice(
            Level::Note,
            format!("the truth, {recorded}, is not found from here; errors over time are left out"),
        );
        return None;
    };
    folder.table_at(&path, TRUTH_TABLE, "The truth of the simulated scene")
}

/// Distance of joints from the true ones, frame by frame: the mean over all, and ends of limbs.
fn joint_errors(track: &Table, truth: &Table) -> Table {
    const ENDS: [&str; 5] = ["head", "l_wrist", "r_wrist", "l_ankle", "r_ankle"];
    let columns: Vec<String> = ENDS.iter().map(|joint| format!("{joint}_error_m")).collect();
    let columns: Vec<&str> = ["frame", "mean_error_m"].into_iter().chain(columns.iter().map(String::as_str)).collect();
    let mut table = Table::new(ERROR_TABLE, "Distance of the joints from the true ones", &columns);
    let true_rows: std::collections::BTreeMap<&str, &Vec<String>> =
        truth.rows.iter().map(|row| (truth.cell(row, "frame"), row)).collect();
    for row in &track.rows {
        let Some(true_row) = true_rows.get(track.cell(row, "frame")) else { continue };
        let error = |joint: &str| -> Option<f64> {
            let squares = ["x", "y", "z"].map(|axis| {
                let column = format!("{joint}_{axis}_m");
                let off = track.number(row, &column)? - truth.number(true_row, &column)?;
                Some(off * off)
            });
            squares.into_iter().sum::<Option<f64>>().map(f64::sqrt)
        };
        let all: Vec<f64> = BODY_JOINT_NAMES.iter().filter_map(|joint| error(joint)).collect();
        let mean = (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64);
        let cell = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.5}"));
        let mut cells = vec![track.cell(row, "frame").to_owned(), cell(mean)];
        cells.extend(ENDS.map(|joint| cell(error(joint))));
        table.rows.push(cells);
    }
    table
}

/// The body by one axis across and the camera's y downwards; what is true lies beneath.
fn figure(track: &Table, has_truth: bool, (axis, from_where): (&str, &str)) -> Figure {
    let tables = if has_truth { vec![(TRUTH_TABLE, true)] } else { vec![] };
    let mut bones = Vec::new();
    for (table, truth) in tables.into_iter().chain([(track.name.as_str(), false)]) {
        for (from, to) in BONES {
            let [from_columns, to_columns] =
                [from, to].map(|joint| [format!("{joint}_{axis}_m"), format!("{joint}_y_m")]);
            let colour = Colour::of_side(to);
            bones.push(Bone {
                table: table.to_owned(),
                only: Vec::new(),
                from: from_columns,
                to: to_columns,
                colour,
                truth,
            });
        }
    }
    let truth = if has_truth { ", the truth dotted" } else { "" };
    Figure { title: format!("The body {from_where}{truth}"), y_down: true, bones, ..Figure::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_over_the_joints_that_both_have() {
        let table = |text: &str| Table::parse("t", "", text.as_bytes()).0;
        let columns = "frame,head_x_m,head_y_m,head_z_m,l_wrist_x_m,l_wrist_y_m,l_wrist_z_m\n";
        let track = table(&format!("{columns}3,0,0,0,0,0,2\n4,0,0,0,0,0,0\n"));
        let truth = table(&format!("{columns}3,0.3,0.4,0,0,0,1\n"));
        let expected = "frame,mean_error_m,head_error_m,l_wrist_error_m,r_wrist_error_m,l_ankle_error_m,r_ankle_error_m\n\
            3,0.75000,0.50000,1.00000,,,\n";
        assert_eq!(joint_errors(&track, &truth).to_csv(), expected);
    }
}
