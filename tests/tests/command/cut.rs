//! `sinew cut` as a user types it.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew::cyclic::CutList;
use sinew_core::random::Stream;
use sinew_tests::{shared_data, sinew_command};
use std::fs;
use std::path::Path;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).arg("cut");
    command
}

/// Every hand-made cut has a cycle at the same place whose length is the same to two frames, of
/// about 67.
#[test]
fn recorded_walks_are_cut_as_by_hand() {
    let Some(folder) = shared_data("cyclic-walking") else { return };
    let root = tempfile::tempdir().unwrap();
    let mut count = 0;
    for list in ["train_cuts.csv", "test_cuts.csv"] {
        for wanted in CutList::read(&folder.join(list)).unwrap().cuts() {
            sinew(root.path())
                .arg(folder.join(&wanted.file))
                .args(["--rate", "60", "--out", "c.csv"])
                .assert()
                .success();
            let made = CutList::read(&root.path().join("c.csv")).unwrap();
            let near = made.cuts().iter().min_by_key(|cut| cut.start_frame.abs_diff(wanted.start_frame)).unwrap();
            assert!(near.duration_frames().abs_diff(wanted.duration_frames()) <= 2, "{near:?} is not {wanted:?}");
            assert!(
                near.start_frame.abs_diff(wanted.start_frame) * 10 < wanted.duration_frames(),
                "{near:?}, {wanted:?}"
            );
            assert!(Path::new(&near.file).is_absolute());
            count += 1;
        }
    }
    assert_eq!(count, 23);
}

/// Cycles of a long walk follow one another without a break, and their number is that of the steps
/// counted by eye.
#[test]
fn long_walks_are_cut_without_a_break() {
    let Some(data) = shared_data("mocap") else { return };
    let root = tempfile::tempdir().unwrap();
    for (file, cycles) in [
        ("bandai/dataset-2_walk_elderly_001.bvh", 11..=13),
        ("bandai/dataset-2_walk_normal_001.bvh", 6..=8),
        ("pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", 8..=9),
    ] {
        let mut angles = Command::from_std(sinew_command());
        angles.current_dir(root.path()).arg("angles").arg(data.join(file)).args(["--rate", "60", "--out", "t.csv"]);
        angles.assert().success();
        sinew(root.path()).args(["t.csv", "--out", "c.csv"]).assert().success().stdout(contains("cycles of"));
        let list = CutList::read(&root.path().join("c.csv")).unwrap();
        let cuts = list.cuts();
        assert!(cycles.contains(&cuts.len()), "{file}: {} cycles", cuts.len());
        assert!(cuts.windows(2).all(|pair| pair[0].end_frame == pair[1].start_frame), "{file}: {cuts:?}");
        assert_eq!(cuts[0].file, "t.csv");
    }
}

/// Places of a squat from the side: forward and down, pixels. Hips and shoulders are four wide.
fn squatting(depth: f64, side: f64) -> [(&'static str, [f64; 2]); 6] {
    let [shank, thigh, trunk] = [-0.5, 1.6, 0.7].map(|most: f64| most * depth);
    let up = |[x, y]: [f64; 2], length: f64, lean: f64| [x + length * lean.sin(), y - length * lean.cos()];
    let ankle = [400.0 + 3.0 * side, 500.0];
    let knee = up(ankle, 85.0, -shank);
    let hip = up(knee, 85.0, -thigh);
    let shoulder = up([hip[0] - side, hip[1]], 100.0, trunk);
    let elbow = up(shoulder, 60.0, 2.4);
    let wrist = up(elbow, 50.0, 1.2);
    [("ankle", ankle), ("knee", knee), ("hip", hip), ("shoulder", shoulder), ("elbow", elbow), ("wrist", wrist)]
}

/// Keypoints with three pixels of noise of a person who squats every three seconds and rests
/// between two squats.
#[test]
fn a_squat_from_the_side_is_cut() {
    let root = tempfile::tempdir().unwrap();
    let sides = [("l", 2.0), ("r", -2.0)];
    let mut text = "frame".to_owned();
    for (side, (joint, _)) in sides.iter().flat_map(|(side, _)| squatting(0.0, 0.0).map(|joint| (side, joint))) {
        text.push_str(&format!(",{side}_{joint}_x_px,{side}_{joint}_y_px"));
    }
    for frame in 0..630_u64 {
        let phase = (frame % 90) as f64 / 90.0;
        let depth = if phase < 0.3 { 0.0 } else { 0.5 - 0.5 * (std::f64::consts::TAU * (phase - 0.3) / 0.7).cos() };
        text.push_str(&format!("\n{frame}"));
        let places = sides.iter().flat_map(|(_, side)| squatting(depth, *side)).flat_map(|(_, place)| place);
        for (number, place) in (0..).zip(places) {
            text.push_str(&format!(",{:.2}", place + 3.0 * f64::from(Stream::new(frame, 0, number).normal())));
        }
    }
    fs::write(root.path().join("squat.csv"), text + "\n").unwrap();
    let mut angles = Command::from_std(sinew_command());
    angles.current_dir(root.path()).args(["angles", "squat.csv", "--input-rate", "30", "--out", "t.csv"]);
    angles.assert().success();
    sinew(root.path()).args(["t.csv", "--out", "c.csv"]).assert().success();
    let list = CutList::read(&root.path().join("c.csv")).unwrap();
    let is_squat = list.cuts().iter().all(|cut| cut.duration_frames().abs_diff(90) <= 4);
    assert!(list.cuts().len() >= 5 && is_squat, "{:?}", list.cuts());
}

#[test]
fn what_has_no_cycle_is_refused_with_the_reason() {
    let root = tempfile::tempdir().unwrap();
    let header = sinew::cyclic::angle_table::COLUMNS.join(",");
    let still: String = (0..200).map(|frame| format!("{frame}{}\n", ",1.5".repeat(13))).collect();
    fs::write(root.path().join("still.csv"), format!("{header}\n{still}")).unwrap();
    fs::write(root.path().join("empty.csv"), format!("{header}\n")).unwrap();
    let refused = |arguments: &[&str], status: i32, message: &str| {
        sinew(root.path()).args(arguments).args(["--out", "c.csv"]).assert().code(status).stderr(contains(message));
        assert!(!root.path().join("c.csv").exists());
    };
    refused(&["still.csv"], 65, "does not say how many frames a second it has; give --rate HZ");
    refused(&["still.csv", "--rate", "60"], 65, "no cycle in `still.csv`: no angle moves");
    refused(&["still.csv", "still.csv", "--rate", "60"], 65, "no table has a cycle");
    refused(&["empty.csv"], 65, "empty.csv:2: the table is empty");
    refused(&["still.csv", "--rate", "0"], 64, "`rate` has to be greater than zero");
    refused(
        &["still.csv", "--rate", "60", "--shortest", "3", "--longest", "2"],
        64,
        "`shortest cycle` has to be above zero and below",
    );
    let mut command = sinew(root.path());
    command.args(["still.csv"]).assert().code(64).stderr(contains("--out").and(contains("required")));
}
