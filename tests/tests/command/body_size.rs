//! `sinew track body --size`: who is seen where no file says it.

use serde_json::Value;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;
use std::process::Output;
use std::sync::OnceLock;
use tempfile::TempDir;

/// Frames that are kept.
const FRAMES: usize = 30;

/// Two seconds of someone who moves both arms, thicker and thinner by 15 % than `body.json` says.
fn scene() -> &'static Path {
    static SCENE: OnceLock<TempDir> = OnceLock::new();
    SCENE.get_or_init(made).path()
}

fn made() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let words = ["-q", "simulate", "stereo", "--motion", "stick-wave"];
    let errors = ["--radius-error", "0.15", "--length-error", "0.05", "--points", "1000", "--out"];
    let status = sinew_command().args(words).args(errors).arg(folder.path()).output().unwrap().status;
    assert!(status.success());
    for point_cloud in fs::read_dir(folder.path().join("points")).unwrap() {
        let path = point_cloud.unwrap().path();
        if path.file_stem().unwrap().to_str().unwrap().parse::<usize>().unwrap() >= FRAMES {
            fs::remove_file(path).unwrap();
        }
    }
    folder
}

fn track(out: &Path, words: &[&str]) -> Output {
    let command = ["track", "body", "--particles", "20", "--out"];
    sinew_command().args(command).arg(out).arg(scene()).args(words).output().unwrap()
}

fn report(out: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(out.join("run.json")).unwrap()).unwrap()
}

#[test]
fn a_size_that_is_estimated_is_said_and_can_be_given_again() {
    let folder = tempfile::tempdir().unwrap();
    let (given, estimated) = (folder.path().join("given"), folder.path().join("estimated"));
    assert!(track(&given, &[]).status.success());
    let output = track(&estimated, &["--size", "estimated"]);
    assert!(output.status.success());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("lengths and radii are estimated from 30 frames: 1."), "{said}");
    let [given, found] = [&given, &estimated].map(|out| report(out));
    assert_ne!(given["body"], found["body"]);
    let error = |report: &Value| report["joint_error_m"].as_f64().unwrap();
    assert!(error(&found) < error(&given), "{} {}", error(&found), error(&given));

    // The body of the report, given as a file, has the same rows.
    let body = folder.path().join("who.json");
    fs::write(&body, serde_json::to_vec(&found["body"]).unwrap()).unwrap();
    let again = folder.path().join("again");
    assert!(track(&again, &["--skeleton", body.to_str().unwrap()]).status.success());
    let rows = |out: &Path| fs::read(out.join("track.csv")).unwrap();
    assert!(rows(&again) == rows(&estimated), "the estimated body and its file differ");
}

#[test]
fn who_is_not_named_is_estimated_and_a_height_can_be_kept() {
    let folder = tempfile::tempdir().unwrap();
    let said = |name: &str, words: &[&str]| {
        let output = track(&folder.path().join(name), words);
        assert!(output.status.success());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(said("estimated", &["--height", "1.7"]).contains("lengths and radii are estimated"));
    assert!(!said("kept", &["--height", "1.7", "--size", "given"]).contains("estimated"));
}

#[test]
fn a_radius_that_no_body_has_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(scene().join("body.json")).unwrap();
    let mut body: Value = serde_json::from_str(&text).unwrap();
    for (joint, radius_m, wanted) in [("neck", -0.1, "radius at `neck`"), ("tail", 0.1, "`tail`")] {
        body["radii_m"][joint] = radius_m.into();
        let path = folder.path().join("who.json");
        fs::write(&path, body.to_string()).unwrap();
        let output = track(&folder.path().join("out"), &["--skeleton", path.to_str().unwrap()]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(wanted), "{said}");
        body["radii_m"]["neck"] = 0.1.into();
    }
}
