//! `sinew doctor`, `sinew completions`, `sinew man` as a user types them.

use sinew_tests::{sinew_command, workspace_root};
use std::fs;
use std::process::Output;

fn sinew(args: &[&str]) -> Output {
    sinew_command().args(args).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn a_valid_scene_and_its_run_have_no_problem_and_a_cut_one_has() {
    let root = tempfile::tempdir().unwrap();
    let run = root.path().join("run");
    assert!(sinew(&["demo", "--out", run.to_str().unwrap()]).status.success());
    let (frames, camera) = (run.join("scene/frames"), run.join("scene/camera.toml"));
    let paths = [run.to_str().unwrap(), frames.to_str().unwrap(), camera.to_str().unwrap()];
    let output = sinew(&["doctor", paths[0], paths[1], paths[2]]);
    let text = stdout(&output);
    assert!(output.status.success() && !text.contains("problem") && !text.contains("warning"), "{text}");
    for sentence in ["10 plots", "120 images", "one size: 120 of 640x480", "`sinew track arm --config` takes it"] {
        assert!(text.contains(sentence), "{sentence}\n{text}");
    }
    fs::remove_file(run.join("track.csv")).unwrap();
    let output = sinew(&["doctor", paths[0], "--json"]);
    assert_eq!(output.status.code(), Some(65));
    let json: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(json[0]["findings"][0]["severity"], "problem");
    assert!(json[0]["findings"][0]["text"].as_str().unwrap().starts_with("track.csv is not there"));
}

#[test]
fn a_folder_of_clouds_is_examined_with_what_lies_beside() {
    let root = tempfile::tempdir().unwrap();
    let scene = root.path().join("scene");
    let scene = scene.to_str().unwrap();
    assert!(
        sinew(&["simulate", "stereo", "--motion", "stick-wave", "--points", "100", "--out", scene]).status.success()
    );
    let text = stdout(&sinew(&["doctor", scene]));
    assert!(text.contains("300 clouds") && !text.contains("warning"), "{text}");
    fs::remove_file(root.path().join("scene/points/000007.ply")).unwrap();
    fs::remove_file(root.path().join("scene/body.json")).unwrap();
    let text = stdout(&sinew(&["doctor", scene]));
    assert!(text.contains("1 frame numbers have no cloud") && text.contains("there is no body.json"), "{text}");
}

#[test]
fn shipped_models_are_taken_and_typing_errors_are_reported() {
    let model = workspace_root().join("host/models/running.json");
    let output = sinew(&["doctor", model.to_str().unwrap()]);
    assert!(output.status.success() && stdout(&output).contains("motion model"), "{}", stdout(&output));
    let output = sinew(&["doctor", "no/such/folder"]);
    assert!(output.status.code() == Some(65) && stdout(&output).contains("no such file or folder"));
}

#[test]
fn shells_and_man_know_every_command() {
    for shell in ["bash", "zsh", "fish"] {
        let script = stdout(&sinew(&["completions", shell]));
        assert!(["report", "doctor", "evaluate"].iter().all(|name| script.contains(name)), "{shell}");
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("man1");
    assert!(sinew(&["man", "--out", out.to_str().unwrap()]).status.success());
    for name in ["sinew.1", "sinew-report.1", "sinew-track.1", "sinew-track-arm.1", "sinew-evaluate.1"] {
        let page = fs::read_to_string(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(page.contains(".TH") && page.contains("NAME"), "{name}");
    }
}
