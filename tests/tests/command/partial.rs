//! `--partial`: a motion with fewer frames than its header promises is refused by every command
//! that reads one, or taken with a note in what the command writes.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;

fn sinew(root: &Path, words: &str) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(root).args(words.split_whitespace());
    command
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// A folder with a tracked scene, and `short.bvh`, the track with seven frames too few; what is
/// said of it.
fn short_motion() -> (tempfile::TempDir, String) {
    let root = tempfile::tempdir().unwrap();
    let path = root.path();
    sinew(path, "simulate stereo --motion pelvic-lift --rate 3 --points 200 --out scene").assert().success();
    sinew(path, "track body scene --particles 10 --out run").assert().success();
    let bvh = fs::read_to_string(path.join("run/track.bvh")).unwrap();
    let (before, after) = bvh.split_once("Frames:").unwrap();
    let (count, rows) = after.split_once('\n').unwrap();
    let frames: usize = count.trim().parse().unwrap();
    let promised = frames + 7;
    fs::write(path.join("short.bvh"), format!("{before}Frames: {promised}\n{rows}")).unwrap();
    (root, format!("{frames} of the {promised} frames"))
}

#[test]
fn a_motion_that_ends_early_is_refused_or_noted() {
    let (root, short) = short_motion();
    let root = root.path();
    let has_note = |notes: &Value| notes.as_array().unwrap().iter().any(|note| note.as_str().unwrap().contains(&short));
    for words in [
        "simulate stereo --motion short.bvh --rate 3 --points 200 --out seen",
        "track body scene --skeleton short.bvh --particles 10 --out measured",
        "evaluate body --motion short.bvh --models guided --particles 10 --trials 1 --out evaluated",
        "angles short.bvh --out angles.csv",
    ] {
        let remedy = contains(short.as_str()).and(contains("--partial"));
        sinew(root, words).assert().code(65).stderr(remedy);
        sinew(root, &format!("{words} --partial")).assert().success().stderr(contains(short.as_str()));
    }
    assert!(has_note(&json(&root.join("seen/run.json"))["notes"]));
    assert!(has_note(&json(&root.join("measured/run.json"))["notes"]));
    assert!(has_note(&json(&root.join("evaluated/report.json"))["notes"]));

    // The note of a scene goes on to the runs over it and their pages.
    sinew(root, "track body seen --particles 10 --out tracked").assert().success().stderr(contains(short.as_str()));
    assert!(has_note(&json(&root.join("tracked/run.json"))["notes"]));
    sinew(root, "report tracked --out page.html").assert().success();
    assert!(fs::read_to_string(root.join("page.html")).unwrap().contains(&short));
    assert!(json(&root.join("scene/run.json"))["notes"].is_null());
}
