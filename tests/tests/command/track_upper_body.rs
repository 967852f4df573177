//! `--body upper` as a user types it: a camera that sees no legs.

use assert_cmd::Command;
use predicates::str::contains;
use serde_json::Value;
use sinew_core::skeleton::full_body::BODY_JOINT_NAMES;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder);
    command
}

/// A person with a stick of whom the camera sees the upper part, in `in`.
fn scene() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let mut simulate = sinew(root.path());
    simulate.args([
        "simulate",
        "stereo",
        "--motion",
        "stick-wave",
        "--body",
        "upper",
        "--points",
        "600",
        "--out",
        "in",
    ]);
    simulate.assert().success();
    for frame in 30.. {
        if fs::remove_file(root.path().join(format!("in/points/{frame:06}.ply"))).is_err() {
            break;
        }
    }
    root
}

fn report(root: &Path, out: &str) -> Value {
    serde_json::from_slice(&fs::read(root.join(out).join("run.json")).unwrap()).unwrap()
}

fn columns(root: &Path, out: &str) -> Vec<String> {
    let table = fs::read_to_string(root.join(out).join("track.csv")).unwrap();
    table.lines().next().unwrap().split(',').map(str::to_owned).collect()
}

#[test]
fn legs_in_view_do_not_draw_an_upper_body_away() {
    let root = tempfile::tempdir().unwrap();
    let mut simulate = sinew(root.path());
    simulate.args(["simulate", "stereo", "--motion", "stick-wave", "--points", "1000", "--out", "in"]);
    simulate.assert().success();
    let mut track = sinew(root.path());
    track.args(["track", "body", "in", "--body", "upper", "--out", "run"]).assert().success();
    let error_m = report(root.path(), "run")["joint_error_m"].as_f64().unwrap();
    assert!(error_m > 0.003 && error_m < 0.03, "{error_m}");
}

#[test]
fn an_upper_body_is_tracked_where_the_scene_says_so() {
    let scene = scene();
    let root = scene.path();
    for model in ["guided", "end-effector", "angular", "stick"] {
        let mut track = sinew(root);
        track.args(["track", "body", "in", "--model", model, "--particles", "60", "--pictures", "--particles-csv"]);
        track.args(["--out", model]).assert().success();
        let report = report(root, model);
        assert_eq!(report["part"], "upper", "{model}");
        let error_m = report["joint_error_m"].as_f64().unwrap();
        assert!(error_m > 0.005 && error_m < 0.08, "{model}: {error_m}");
    }
    let columns = columns(root, "guided");
    let has = |joint: &str| columns.contains(&format!("{joint}_x_m"));
    for (bone, joint) in BODY_JOINT_NAMES.iter().enumerate() {
        assert_eq!(has(joint), bone < 9, "{joint}");
    }
    assert!(columns.iter().all(|column| !["trunk", "hip", "knee", "ankle"].iter().any(|part| column.contains(part))));
    assert!(columns.contains(&"l_elbow_flexion_rad".to_owned()) && columns.contains(&"r_wrist_observed".to_owned()));
    let bvh = fs::read_to_string(root.join("guided/track.bvh")).unwrap();
    assert!(bvh.contains("l_wrist") && !bvh.contains("l_knee"), "{bvh}");
}

#[test]
fn the_option_decides_before_the_scene_and_threads_change_no_byte() {
    let scene = scene();
    let root = scene.path();
    for (out, words) in [("one", ["--body", "upper", "--threads", "1"]), ("two", ["--body", "upper", "--threads", "2"])]
    {
        let mut track = sinew(root);
        track.args(["track", "body", "in", "--particles", "30", "--out", out]).args(words).assert().success();
    }
    let table = |out: &str| fs::read(root.join(out).join("track.csv")).unwrap();
    assert!(table("one") == table("two"));
    let mut track = sinew(root);
    track.args(["track", "body", "in", "--particles", "20", "--body", "whole", "--out", "whole"]).assert().success();
    assert!(columns(root, "whole").contains(&"l_knee_x_m".to_owned()));
}

#[test]
fn someone_without_a_first_pose_is_found() {
    let scene = scene();
    let root = scene.path();
    fs::remove_file(root.join("in/first_pose.json")).unwrap();
    let mut track = sinew(root);
    track.args(["track", "body", "in", "--particles", "60", "--out", "out"]);
    track.assert().success().stderr(contains("no first pose"));
    let error_m = report(root, "out")["joint_error_m"].as_f64().unwrap();
    assert!(error_m < 0.15, "{error_m}");
}

#[test]
fn a_model_that_needs_legs_is_refused() {
    let scene = scene();
    let message = "--model pelvic-lift holds the feet, and --body upper has none";
    for words in [
        ["track", "body", "in", "--model", "pelvic-lift", "--out", "out"],
        ["evaluate", "body", "--motion=pelvic-lift", "--models=pelvic-lift", "--body=upper", "--out", "out"],
    ] {
        sinew(scene.path()).args(words).assert().failure().stderr(contains(message));
        assert!(!scene.path().join("out").exists());
    }
}

#[test]
fn an_upper_body_is_evaluated() {
    let root = tempfile::tempdir().unwrap();
    let mut evaluate = sinew(root.path());
    evaluate.args(["evaluate", "body", "--motion", "pelvic-lift", "--models", "guided", "--particles", "20"]);
    evaluate.args(["--trials", "1", "--body", "upper", "--out", "out"]).assert().success();
    let report: Value = serde_json::from_slice(&fs::read(root.path().join("out/report.json")).unwrap()).unwrap();
    let error_m = report["results"][0]["joint_error_m"]["mean"].as_f64().unwrap();
    assert!(error_m > 0.003 && error_m < 0.15, "{error_m}");
}
