//! `sinew simulate arm` as a user types it.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;

fn simulate(out: &Path, words: &[&str]) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.args(["simulate", "arm", "--motion", "builtin", "--out"]).arg(out).args(words);
    command
}

#[test]
fn a_simulated_folder_is_an_input_of_track_arm() {
    let root = tempfile::tempdir().unwrap();
    let (scene, out) = (root.path().join("scene"), root.path().join("out"));
    simulate(&scene, &["--frames", "3", "--side", "both"]).assert().success().stdout(contains("3 frames"));
    let mut track = Command::from_std(sinew_command());
    track.args(["track", "arm", "--side", "both"]).arg(scene.join("frames")).arg("--out").arg(&out);
    track.arg("--config").arg(scene.join("camera.toml")).assert().success();
    let lines = |file: &Path| fs::read_to_string(file).unwrap().lines().count();
    assert_eq!((lines(&scene.join("truth.csv")), lines(&out.join("track.csv"))), (7, 7));
}

#[test]
fn the_same_seed_gives_the_same_frames() {
    let root = tempfile::tempdir().unwrap();
    let read = |name: &str, seed: &str, threads: &str| {
        let out = root.path().join(name);
        simulate(&out, &["--frames", "2", "--seed", seed]).env("RAYON_NUM_THREADS", threads).assert().success();
        ["frames/frame_0001.png", "truth.csv", "camera.toml"].map(|file| fs::read(out.join(file)).unwrap())
    };
    let first = read("a", "1", "1");
    assert!(first == read("b", "1", "2"));
    assert!(first[0] != read("c", "2", "1")[0]);
}

#[test]
fn bad_options_are_refused_with_a_remedy() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("scene");
    for (words, part) in [
        (["--frames", "0"], "`frames`"),
        (["--hidden", "2"], "`hidden_fraction`"),
        (["--away", "9,4"], "`away`"),
        (["--side", "middle"], "middle"),
    ] {
        let output = simulate(&out, &words).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && message.contains(part), "{words:?}: {message}");
        assert!(!out.exists(), "{words:?} left a folder");
    }
    simulate(&out, &["--frames", "1"]).assert().success();
    let message = contains("already holds files").and(contains("--force"));
    simulate(&out, &["--frames", "1"]).assert().code(64).stderr(message);
}
