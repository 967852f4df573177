//! Recordings as a coach gives them, from the file to cadence and ranges, by the two commands of
//! `docs/coach.md` with default settings.

use serde_json::Value;
use sinew_tests::{shared_data, sinew_command};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Runs the command, which has to end well; what it prints on standard error.
fn sinew(folder: &Path, words: &[&str]) -> String {
    let output = sinew_command().current_dir(folder).args(words).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{words:?}: {message}");
    message
}

/// What `summary.json` says of the angle table `table`.
fn tracked(folder: &Path, table: &str, more: &[&str]) -> Value {
    let words = ["-q", "track", "cyclic", table, "--model", "walking", "--out", "e.csv", "--report", "run"];
    sinew(folder, &[&words[..], more].concat());
    serde_json::from_str(&fs::read_to_string(folder.join("run/summary.json")).unwrap()).unwrap()
}

/// The same for a recording, with what `sinew angles` says.
fn reported(recording: &Path, more: &[&str]) -> (TempDir, Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let words = ["angles", recording.to_str().unwrap(), "--out", "walk.csv"];
    let message = sinew(folder.path(), &[&words[..], more].concat());
    let summary = tracked(folder.path(), "walk.csv", &[]);
    (folder, summary, message)
}

fn number(summary: &Value, name: &str) -> f64 {
    summary[name].as_f64().unwrap_or_else(|| panic!("{name} is {}", summary[name]))
}

/// Left, right range of an angle, degrees, and their index, percent.
fn symmetry(summary: &Value, angle: &str) -> [f64; 3] {
    let joints = summary["symmetry"].as_array().unwrap();
    let joint = joints.iter().find(|joint| joint["angle"] == angle).unwrap();
    ["left_range_deg", "right_range_deg", "symmetry_index_percent"].map(|name| joint[name].as_f64().unwrap())
}

/// Nine cycles of a walker in the files of eight detectors.
#[test]
fn a_walk_in_the_files_of_any_detector_has_its_cadence_and_ranges() {
    let Some(cases) = shared_data("cases") else { return };
    let rate = ["--input-rate", "30"];
    let size = ["--input-rate", "30", "--image-size", "1920,1080"];
    let files: [(&str, &[&str]); 9] = [
        ("dlc.csv", &rate),
        ("frame_float.csv", &rate),
        ("semicolon.csv", &rate),
        ("mmpose_list.json", &rate),
        ("mediapipe_confidence.csv", &rate),
        ("mediapipe_visibility.csv", &rate),
        ("mediapipe_norm.csv", &size),
        ("y_up.csv", &rate),
        ("timestamp_vfr.csv", &[]),
    ];
    for (name, more) in files {
        let (_, summary, _) = reported(&cases.join("keypoints").join(name), more);
        // By the separation of the ankles; 59.6 over all frames, the first of which are slower.
        let cadence = number(&summary, "cadence_per_min");
        assert!((59.6 * 0.985..=61.0 * 1.015).contains(&cadence), "{name}: {cadence}");
        let frames = number(&summary, "frames");
        assert!(number(&summary, "outliers") <= 0.02 * frames, "{name}: {}", summary["outliers"]);
        let [left, right, index] = symmetry(&summary, "hip_flexion");
        assert!((left - 61.5).abs() < 3.0 && (right - 61.5).abs() < 3.0 && index.abs() < 5.0, "{name}: {left} {right}");
        let [left, right, _] = symmetry(&summary, "knee_flexion");
        assert!((left - 68.7).abs() < 6.0 && (right - 68.7).abs() < 6.0, "{name}: {left} {right}");
        assert_eq!(summary["doubts"].as_array().unwrap().len(), 0, "{name}: {}", summary["doubts"]);
    }
}

/// Three seconds, of which the detector exchanged the legs in a quarter of the frames.
#[test]
fn exchanged_sides_are_mended_and_counted() {
    let Some(cases) = shared_data("cases") else { return };
    let of = |name: &str| reported(&cases.join("keypoints").join(name), &["--input-rate", "30"]);
    let ((_, base, quiet), (_, swapped, message)) = (of("base"), of("lr_swap"));
    assert!(!quiet.contains("exchanged") && message.contains("exchanged by the detector"), "{message}");
    assert!(message.contains("mended in 24 of 90 frames"), "{message}");
    for angle in ["hip_flexion", "knee_flexion"] {
        let [one, other] = [&base, &swapped].map(|summary| symmetry(summary, angle)[2]);
        assert!((one - other).abs() < 1.0, "{angle}: {one} {other}");
    }
}

/// What is wrong with a recording is in the result, and with `--strict` an error.
#[test]
fn a_camera_that_pans_is_a_doubt_in_every_place() {
    let Some(cases) = shared_data("cases") else { return };
    let (folder, summary, message) = reported(&cases.join("keypoints/pan"), &["--input-rate", "30"]);
    assert!(message.contains("doubt: ") && message.contains("pans"), "{message}");
    assert!(summary["doubts"][0].as_str().unwrap().contains("pans"), "{}", summary["doubts"]);
    assert!(number(&summary, "cadence_per_min") > 50.0);
    let words = "track cyclic walk.csv --model walking --out e.csv --strict";
    let output = sinew_command().current_dir(folder.path()).args(words.split(' ')).output().unwrap();
    assert_eq!(output.status.code(), Some(65));
    assert!(folder.path().join("e.csv").exists(), "the estimates are there all the same");
}

/// Cadence is over the time in which the person was seen: by the ankles' separation 61.6 a minute
/// from frame 90 on.
#[test]
fn nobody_in_view_is_no_time_that_counts() {
    let Some(cases) = shared_data("cases") else { return };
    let folder = tempfile::tempdir().unwrap();
    fs::copy(cases.join("tables/leadgap.csv"), folder.path().join("walk.csv")).unwrap();
    let summary = tracked(folder.path(), "walk.csv", &["--rate", "30"]);
    let cadence = number(&summary, "cadence_per_min");
    assert!((cadence / 61.6 - 1.0).abs() < 0.015, "{cadence}");
    assert!((number(&summary, "seen_s") - 5.83).abs() < 0.01);
    let estimates = fs::read_to_string(folder.path().join("e.csv")).unwrap();
    let cells: Vec<&str> = estimates.lines().nth(50).unwrap().split(',').collect();
    assert_eq!((cells[0], cells[1], cells[14]), ("49", "", ""), "nothing is said of a frame without anybody");
}

/// Markers with force plates: 52.5 strides a minute.
#[test]
fn markers_have_the_cadence_of_the_force_plates() {
    let Some(cases) = shared_data("cases") else { return };
    for name in ["trc/base.trc", "c3d/base_mm.c3d", "c3d/vicon_empty_tail.c3d", "c3d/events.c3d"] {
        let (_, summary, _) = reported(&cases.join(name), &[]);
        let cadence = number(&summary, "cadence_per_min");
        assert!((cadence / 52.5 - 1.0).abs() < 0.01, "{name}: {cadence}");
    }
}

/// A walker who faces left: left is their own left.
#[test]
fn sides_are_the_persons_own_and_the_page_says_how_they_faced() {
    let Some(cases) = shared_data("cases") else { return };
    let (folder, summary, message) = reported(&cases.join("tables/woman_lead.csv"), &["--input-rate", "30"]);
    assert!(message.contains("the person faces left"), "{message}");
    assert_eq!(summary["recording"]["facing"], "left");
    let cadence = number(&summary, "cadence_per_min");
    assert!((cadence / 50.0 - 1.0).abs() < 0.04, "{cadence}");
    sinew(folder.path(), &["-q", "report", "run", "--out", "run.html"]);
    let page = fs::read_to_string(folder.path().join("run.html")).unwrap();
    assert!(page.contains("the person faces left"));
}

/// A table without times needs a rate; a rate that contradicts its times is refused.
#[test]
fn a_rate_is_known_once_and_not_contradicted() {
    let folder = tempfile::tempdir().unwrap();
    sinew(folder.path(), &["simulate", "cyclic", "--model", "walking", "--rate", "30", "--out", "walk.csv"]);
    let refused = |words: &str, message: &str| {
        let output = sinew_command().current_dir(folder.path()).args(words.split(' ')).output().unwrap();
        let found = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && found.contains(message), "{found}");
    };
    refused("track cyclic walk.csv --model walking --rate 60 --out e.csv", "say 30 frames a second");
    let text = fs::read_to_string(folder.path().join("walk.csv")).unwrap();
    let bare: Vec<&str> = text.lines().map(|line| line.rsplit_once(',').unwrap().0).collect();
    fs::write(folder.path().join("bare.csv"), bare.join("\n")).unwrap();
    refused("track cyclic bare.csv --model walking --out e.csv", "give --rate HZ");
    refused("track cyclic bare.csv --model walking --online --out e.csv", "give --rate HZ");
    for table in ["walk.csv", "bare.csv"] {
        let words = ["-q", "track", "cyclic", table, "--model", "walking", "--rate", "30", "--out", "e.csv"];
        sinew(folder.path(), &words);
    }
}
