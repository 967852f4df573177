//! The tracks of small rendered scenes, of arms and of a whole body, compared with committed files
//! to the last digit.
//!
//! Results are the same in every build, so there is no tolerance. After a change that is meant to
//! change tracks, run `SINEW_REGENERATE=1 cargo test -p sinew-tests --test command golden_track`,
//! look at the difference, and commit it.

use assert_cmd::Command;
use sinew::motion::reach::random_reaches;
use sinew::output::OutputDir;
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew_tests::{sinew_command, workspace_root};
use std::fs;
use std::path::Path;

/// Renders 20 frames, tracks them, and compares the table with `tests/golden/NAME.csv`.
fn compare(name: &str, words: &[&str]) {
    let root = tempfile::tempdir().unwrap();
    let folder = OutputDir::create(&root.path().join("scene")).unwrap();
    let options =
        SceneOptions { width_px: 160, height_px: 120, frames: 20, sides: Sides::Both, ..SceneOptions::default() };
    let motion = random_reaches(3, options.frames_per_second, options.frames).unwrap();
    Scene::new(&motion, &options).unwrap().write_folder(&folder).unwrap();
    let out = root.path().join("out");
    let mut command = Command::from_std(sinew_command());
    command.args(["track", "arm"]).arg(folder.join("frames")).arg("--config").arg(folder.join("camera.toml"));
    command.arg("--out").arg(&out).args(["--seed", "5"]).args(words).assert().success();
    compare_table(name, &out.join("track.csv"));
}

/// Compares a table with `tests/golden/NAME.csv`.
fn compare_table(name: &str, table: &Path) {
    let found = fs::read_to_string(table).unwrap();
    let golden = workspace_root().join("tests/golden").join(format!("{name}.csv"));
    if std::env::var_os("SINEW_REGENERATE").is_some_and(|value| value == "1") {
        fs::write(&golden, &found).unwrap();
        return;
    }
    let expected = fs::read_to_string(&golden).unwrap();
    for (line, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        assert_eq!(found, expected, "line {} of {}; see this file's head", line + 1, golden.display());
    }
    assert_eq!(found.lines().count(), expected.lines().count());
}

#[test]
fn the_right_arm() {
    compare("right", &[]);
}

#[test]
fn both_arms() {
    compare("both", &["--side", "both"]);
}

#[test]
fn the_paper_s_tracker() {
    compare("corrected", &["--variant", "corrected"]);
}

/// Simulates a built-in motion with few points, tracks its first frames by the numbers of
/// `tests/golden/body.toml`, which tuning leaves alone, and compares the table with
/// `tests/golden/NAME.csv`.
fn compare_body(name: &str, motion: &str, words: &[&str]) {
    let root = tempfile::tempdir().unwrap();
    let scene = root.path().join("scene");
    let mut simulate = Command::from_std(sinew_command());
    simulate.args(["simulate", "stereo", "--motion", motion, "--points", "250", "--seed", "3", "--out"]);
    simulate.arg(&scene).assert().success();
    for frame in BODY_FRAMES.. {
        if fs::remove_file(scene.join(format!("points/{frame:06}.ply"))).is_err() {
            break;
        }
    }
    let out = root.path().join("out");
    let mut command = Command::from_std(sinew_command());
    command.args(["track", "body"]).arg(&scene).arg("--out").arg(&out).args(["--seed", "5"]).args(words);
    command.arg("--config").arg(workspace_root().join("tests/golden/body.toml")).assert().success();
    compare_table(name, &out.join("track.csv"));
}

/// Frames of a body's golden track.
const BODY_FRAMES: usize = 10;

#[test]
fn a_guided_body() {
    compare_body("body_guided", "pelvic-lift", &["--model", "guided", "--particles", "12"]);
}

#[test]
fn a_body_by_goals_with_a_stick() {
    compare_body("body_stick", "stick-wave", &["--model", "stick", "--particles", "40"]);
}

#[test]
fn a_body_by_angles() {
    compare_body("body_angular", "stick-wave", &["--model", "angular", "--particles", "40"]);
}
