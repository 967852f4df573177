//! The track of a small rendered scene, compared with committed files to the last digit.
//!
//! Results are the same in every build, so there is no tolerance. After a change that is meant to change tracks, run
//! `SINEW_REGENERATE=1 cargo test -p sinew-tests --test golden_track`, look at the difference, and commit it.

use assert_cmd::Command;
use sinew::motion::reach::random_reaches;
use sinew::output::OutputDir;
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew_tests::{sinew_command, workspace_root};
use std::fs;

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
    let found = fs::read_to_string(out.join("track.csv")).unwrap();
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
