//! `sinew evaluate hands` and `sinew evaluate arm` as a user types them.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew_tests::sinew_command;
use std::fs;
use std::path::{Path, PathBuf};

fn sinew(words: &[&str]) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.args(words);
    command
}

/// A folder of six rendered frames.
fn frames(root: &Path) -> PathBuf {
    rendered(root, "6")
}

fn rendered(root: &Path, count: &str) -> PathBuf {
    let scene = root.join("scene");
    let mut simulate = sinew(&["simulate", "arm", "--motion", "builtin", "--frames", count, "--side", "both", "--out"]);
    simulate.arg(&scene).assert().success();
    scene.join("frames")
}

fn hands(folder: &Path, boxes: &Path) -> Command {
    let mut command = sinew(&["evaluate", "hands", "--seeds", "2"]);
    command.arg(folder).arg("--boxes").arg(boxes);
    command
}

#[test]
fn hands_are_scored_and_floors_are_required() {
    let root = tempfile::tempdir().unwrap();
    let (folder, boxes, out) = (frames(root.path()), root.path().join("boxes.csv"), root.path().join("hands"));
    fs::write(&boxes, "frame,x,y,w,h\n0,0,0,640,480\n5,0,0,640,480\n").unwrap();
    hands(&folder, &boxes).arg("--out").arg(&out).assert().success().stdout(contains("(2 boxes)"));
    let report: serde_json::Value = serde_json::from_slice(&fs::read(out.join("hands.json")).unwrap()).unwrap();
    assert_eq!(report["whole"]["inside"]["median"], 1.0);
    assert_eq!(report["frames"], 6);
    assert_eq!(fs::read_to_string(out.join("hands.csv")).unwrap().lines().count(), 7);
    let mut page = sinew(&["report", "--out", root.path().join("page.html").to_str().unwrap()]);
    page.arg(&out)
        .assert()
        .success()
        .stdout(contains("(Evaluation of both hands on real frames): 0 plots").and(contains("notice").not()));
    fs::write(&boxes, "frame,x,y,w,h\n5,0,0,1,1\n").unwrap();
    hands(&folder, &boxes).assert().success();
    hands(&folder, &boxes).arg("--require").assert().code(65).stderr(contains("misses the floors"));
}

/// Boxes keep their frames where a picture is missing before them, as in `sinew track arm`.
#[test]
fn a_missing_picture_is_a_frame_of_hands() {
    let root = tempfile::tempdir().unwrap();
    let (folder, boxes, out) = (rendered(root.path(), "10"), root.path().join("boxes.csv"), root.path().join("hands"));
    let mut files: Vec<PathBuf> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    fs::remove_file(&files[4]).unwrap();
    fs::write(&boxes, "frame,x,y,w,h\n9,0,0,640,480\n").unwrap();
    hands(&folder, &boxes).arg("--out").arg(&out).assert().success().stdout(contains("(1 boxes)"));
    let report: serde_json::Value = serde_json::from_slice(&fs::read(out.join("hands.json")).unwrap()).unwrap();
    assert_eq!((&report["frames"], &report["ranking"]["hands"]), (&10.into(), &1.into()));
}

#[test]
fn bad_boxes_and_windows_are_refused() {
    let root = tempfile::tempdir().unwrap();
    let (folder, boxes) = (frames(root.path()), root.path().join("boxes.csv"));
    let refused = |part: &str, status: i32| {
        hands(&folder, &boxes).assert().code(status).stderr(contains(part).and(contains("boxes.csv")));
    };
    refused("boxes", 66);
    for (table, part) in [
        ("frame,x,y,w,h\n", "has no row"),
        ("frame,x,y\n0,1,2\n", "frame,x,y,w,h"),
        ("frame,x,y,w,h\n6,1,2,3,4\n", "frame 6"),
        ("frame,x,y,w,h\n1,1,2,0,4\n", "above zero"),
    ] {
        fs::write(&boxes, table).unwrap();
        refused(part, 65);
    }
    fs::write(&boxes, "frame,x,y,w,h\n0,1,2,3,4\n").unwrap();
    hands(&folder, &boxes).args(["--window", "900,10"]).assert().code(64).stderr(contains("larger than the frames"));
    hands(&folder, &boxes).args(["--window", "wide"]).assert().code(64).stderr(contains("440,360"));
    hands(&folder.join("none"), &boxes).assert().code(66).stderr(contains("none"));
}

#[test]
fn evaluate_arm_compares_the_trackers_on_built_in_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("arm");
    let output = sinew_command()
        .args(["evaluate", "arm", "--clips", "1", "--seeds", "1", "--frames", "110", "--particles", "20"])
        .args(["--variants", "pik,standard", "--out"])
        .arg(&out)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("recovered within 5 frames") && text.contains("as the arm paper prints them"), "{text}");
    for name in ["arm.json", "arm.csv", "error_3d.png", "error_2d.png", "options.png"] {
        assert!(out.join(name).is_file(), "{name} is missing");
    }
}

#[test]
fn evaluate_arm_refuses_what_it_cannot_score() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |args: &[&str]| {
        let out = folder.path().join("out");
        let output = sinew_command().args(["evaluate", "arm", "--out"]).arg(out).args(args).output().unwrap();
        assert!(!output.status.success());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(refused(&["--frames", "100"]).contains("--frames"));
    assert!(refused(&["--seeds", "0"]).contains("--seeds"));
    assert!(refused(&["--mocap", "no-such-folder"]).contains("no-such-folder"));
    assert!(refused(&["--variants", "magic"]).contains("magic"));
}
