//! `sinew demo` from end to end.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew_tests::sinew_command;
use std::fs;

#[test]
fn the_demo_renders_tracks_and_prints_the_error() {
    let root = tempfile::tempdir().unwrap();
    let demo = || {
        let mut command = Command::from_std(sinew_command());
        command.arg("demo").current_dir(root.path());
        command
    };
    let text = contains("Distance of the tracked hand").and(contains("out/demo/contact_sheet.png"));
    demo().assert().success().stdout(text.and(contains("tracked 120 of 120 frames")));
    let out = root.path().join("out/demo");
    for file in ["track.csv", "run.json", "hand.png", "contact_sheet.png", "scene/truth.csv", "scene/camera.toml"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    for folder in ["overlay", "scene/frames"] {
        assert_eq!(fs::read_dir(out.join(folder)).unwrap().count(), 120, "{folder}");
    }
    let error: serde_json::Value = serde_json::from_slice(&fs::read(out.join("error.json")).unwrap()).unwrap();
    let value = |name: &str| error[name].as_f64().unwrap();
    // Bounds of sanity, not of quality: a hand at random would be half a metre and 200 pixels off.
    assert!((0.001..0.4).contains(&value("median_error_m")), "{error}");
    assert!((0.5..100.0).contains(&value("median_error_px")), "{error}");

    let frames = |name: &str| error[name].as_u64().unwrap();
    assert!(frames("wrong_frames") <= frames("tracking_frames") && frames("tracking_frames") <= 120, "{error}");

    let track = fs::read(out.join("track.csv")).unwrap();
    demo().assert().success();
    assert!(fs::read(out.join("track.csv")).unwrap() == track, "the same seed gives the same track");
}

#[test]
fn the_demo_does_not_touch_frames_that_it_did_not_make() {
    let root = tempfile::tempdir().unwrap();
    let own = root.path().join("scene/frames/frame_0000.png");
    fs::create_dir_all(own.parent().unwrap()).unwrap();
    fs::write(&own, "mine").unwrap();
    let mut command = Command::from_std(sinew_command());
    let message = contains("did not make").and(contains("--out"));
    command.args(["demo", "--out"]).arg(root.path()).assert().code(64).stderr(message);
    assert_eq!(fs::read_to_string(&own).unwrap(), "mine");
}
