//! The way that docs/coach.md goes: a table of keypoints in pixels, angles, cadence, joints in
//! pixels again.

use crate::cyclic_walk::walk;
use assert_cmd::Command;
use sinew::cyclic::export::trc::{joint_positions, standard_lengths_m};
use sinew_core::skeleton::stick_figure::HUMAN;
use sinew_tests::{sinew_command, workspace_root};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

fn sinew(folder: &Path, arguments: &[&str]) {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(arguments).assert().success();
}

/// Joints of a walker who is 400 px high, at 30 frames a second and 50 cycles a minute; hips unseen
/// now and then.
fn keypoints(frames: u64, faces_left: bool) -> String {
    let names: Vec<&str> = std::iter::once("hip_center").chain(HUMAN.angle_names()).collect();
    let mut text = "frame".to_owned();
    names.iter().for_each(|name| write!(text, ",{name}_x_px,{name}_y_px").unwrap());
    text.push('\n');
    let lengths = standard_lengths_m(400.0);
    for row in walk(frames, 50.0 / 60.0 / 30.0).rows() {
        let root = [100.0 + 10.0 * row.frame as f64, 300.0];
        let joints = joint_positions(Some(root), &lengths, &row.angles_rad);
        write!(text, "{}", row.frame).unwrap();
        for (index, joint) in HUMAN.joints().iter().enumerate() {
            let hidden = index == 0 && row.frame % 7 == 3;
            // Seen from the other side the picture is mirrored and the limbs change places.
            let [x, y] = joints[if faces_left { usize::from(joint.mirror) } else { index }].unwrap();
            let x = if faces_left { 4000.0 - x } else { x };
            if hidden { text.push_str(",,") } else { write!(text, ",{x:.3},{y:.3}").unwrap() }
        }
        text.push('\n');
    }
    text
}

/// Column of a table; an empty cell is `None`.
fn column(path: &Path, name: &str) -> Vec<Option<f64>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let index = reader.headers().unwrap().iter().position(|header| header == name).unwrap();
    reader.records().map(|record| record.unwrap()[index].parse().ok()).collect()
}

#[test]
fn keypoints_become_cadence_and_joints_whichever_way_the_person_faces() {
    let root = tempfile::tempdir().unwrap();
    for (name, faces_left) in [("right", false), ("left", true)] {
        let points = root.path().join(format!("{name}_points.csv"));
        fs::write(&points, keypoints(260, faces_left)).unwrap();
        let (table, report) = (format!("{name}.csv"), format!("{name}_run"));
        sinew(root.path(), &["angles", points.to_str().unwrap(), "--input-rate", "30", "--out", &table]);
        let estimate = format!("{name}_estimate.csv");
        let track = ["track", "cyclic", &table, "--model", "walking", "--rate", "30", "--sigma-deg", "2"];
        sinew(root.path(), &[&track[..], &["--out", &estimate, "--report", &report, "--height", "1.8"]].concat());
        let folder = root.path().join(report);
        let json: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap();
        let cadence = json["cadence_per_min"].as_f64().unwrap();
        assert!((cadence - 50.0).abs() < 1.0, "{name}: {cadence}");
        for joint in ["l_ankle", "r_wrist", "neck"] {
            for axis in ["x", "y"] {
                let name = format!("{joint}_{axis}_px");
                let (truth, found) = (column(&points, &name), column(&folder.join("joints_px.csv"), &name));
                let errors: Vec<f64> =
                    truth[30..].iter().zip(&found[30..]).map(|(t, f)| (t.unwrap() - f.unwrap()).abs()).collect();
                let mean = errors.iter().sum::<f64>() / errors.len() as f64;
                assert!(mean < 6.0, "{name}, left {faces_left}: {mean} px");
            }
        }
    }
}

/// The keypoints in `text` with the last frame first, and without the points of some names.
fn changed(text: &str, is_reversed: bool, left_out: &str) -> String {
    let table: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let rows = 1..table.len();
    let cell = |row: usize, column: usize| {
        let is_point = !["frame", "time_s"].contains(&table[0][column]);
        let from = if is_reversed && is_point && row > 0 { table.len() - row } else { row };
        if row > 0 && !left_out.is_empty() && table[0][column].starts_with(left_out) { "" } else { table[from][column] }
    };
    let line = |row: usize| (0..table[0].len()).map(|column| cell(row, column)).collect::<Vec<_>>().join(",") + "\n";
    std::iter::once(0).chain(rows).map(line).collect()
}

#[test]
fn who_walks_backward_or_shows_one_leg_has_events() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    sinew(root, &["simulate", "keypoints", "--seconds", "8", "--out", "k.csv"]);
    let text = fs::read_to_string(root.join("k.csv")).unwrap();
    for (is_reversed, left_out, direction) in
        [(false, "", "forward"), (true, "", "backward"), (false, "r_", "forward"), (true, "r_", "backward")]
    {
        fs::write(root.join("k.csv"), changed(&text, is_reversed, left_out)).unwrap();
        sinew(root, &["angles", "k.csv", "--out", "a.csv"]);
        sinew(root, &["track", "cyclic", "a.csv", "--model", "walking", "--out", "e.csv", "--report", "run"]);
        let summary: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(root.join("run/summary.json")).unwrap()).unwrap();
        let gait = &summary["gait"];
        let stance = gait["left"]["stance_share"]["mean"].as_f64().unwrap();
        assert!(gait["direction"] == direction && (0.5..0.7).contains(&stance), "{left_out} {gait}");
        assert_eq!(gait["is_running"], false);
        let is_noted = summary["notes"].to_string().contains("the right leg is not seen in any stride");
        assert_eq!(is_noted, left_out == "r_", "{}", summary["notes"]);
        let is_doubted = summary["doubts"].to_string().contains("the feet go backward");
        assert_eq!(is_doubted, is_reversed, "{}", summary["doubts"]);
    }
}

/// The commands of the page, without `sinew`.
fn commands(page: &str) -> Vec<Vec<&str>> {
    page.lines().filter_map(|line| line.strip_prefix("    sinew ")).map(|line| line.split(' ').collect()).collect()
}

/// Files that the page's table of the run names; `*` stands for one name or several.
fn named_files(page: &str) -> Vec<&str> {
    let cells = page.lines().filter_map(|line| line.strip_prefix("| `")?.split_once(" |"));
    cells.flat_map(|(names, _)| names.split('`')).filter(|name| name.contains('.')).collect()
}

#[test]
fn the_commands_of_the_page_run_one_after_the_other() {
    let page = fs::read_to_string(workspace_root().join("docs/coach.md")).unwrap();
    let root = tempfile::tempdir().unwrap();
    let mut count = 0;
    for words in commands(&page) {
        // The page takes another recording of the reader's there.
        if words[..2] == ["cut", "stroke.csv"] {
            for name in ["stroke.csv", "new.csv"] {
                fs::copy(root.path().join("walk.csv"), root.path().join(name)).unwrap();
            }
        }
        sinew(root.path(), &words);
        count += 1;
        if words[..3] == ["track", "cyclic", "walk.csv"] {
            check_run(root.path(), &page);
        }
    }
    assert!(count >= 6, "{count}");
}

/// The run has the files of the page and the cadence of the person who was made up.
fn check_run(folder: &Path, page: &str) {
    let files: Vec<String> = fs::read_dir(folder.join("run"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let named = named_files(page);
    assert!(named.len() > 15, "{named:?}");
    for name in named {
        let (begin, end) = name.split_once('*').unwrap_or((name, ""));
        assert!(files.iter().any(|file| file.starts_with(begin) && file.ends_with(end)), "{name} of {files:?}");
    }
    let again = ["simulate", "keypoints", "--out", "again.csv", "--json"];
    let output = sinew_command().current_dir(folder).args(again).output().unwrap();
    let truth: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("run/summary.json")).unwrap()).unwrap();
    let [truth, found] = [&truth, &summary].map(|json| json["cadence_per_min"].as_f64().unwrap());
    assert!((found / truth - 1.0).abs() < 0.01, "{found} instead of {truth} a minute");
    assert!(summary["doubts"].as_array().is_some_and(Vec::is_empty), "{}", summary["doubts"]);
}
