//! `sinew track arm --side both` where no face is known: which hand is whose.

use sinew_tests::{sinew_command, table_rows};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// From this distance on a row is at another place than the hand, pixels of 640.
const OFF_PX: f32 = 60.0;
/// Most of the rows that say `tracking` are at their hand.
const MOST_OFF_SHARE: f32 = 0.06;
/// Rows that say `tracking`.
const LEAST_SURE_SHARE: f32 = 0.6;

fn place(row: &BTreeMap<String, String>) -> [f32; 2] {
    ["hand_u_px", "hand_v_px"].map(|axis| row[axis].parse().unwrap())
}

/// Rows of a run, those that say `tracking`, and those of them that are off.
fn counts(folder: &Path) -> [usize; 3] {
    let truth: HashMap<_, _> = table_rows(&folder.join("scene/truth.csv"))
        .iter()
        .map(|row| ((row["frame"].clone(), row["side"].clone()), place(row)))
        .collect();
    let rows = table_rows(&folder.join("run/track.csv"));
    let sure: Vec<_> = rows.iter().filter(|row| row["status"] == "tracking").collect();
    let is_off = |row: &&&BTreeMap<String, String>| {
        let ([u_px, v_px], own) = (place(row), truth[&(row["frame"].clone(), row["side"].clone())]);
        (u_px - own[0]).hypot(v_px - own[1]) > OFF_PX
    };
    [rows.len(), sure.len(), sure.iter().filter(is_off).count()]
}

#[test]
fn hands_keep_their_sides() {
    let mut all = [0; 3];
    for seed in ["3", "6", "8", "9"] {
        let root = tempfile::tempdir().unwrap();
        let simulate = ["simulate", "arm", "--motion", "builtin", "--side", "both", "--seed", seed, "--out", "scene"];
        let track = ["track", "arm", "scene/frames", "--config", "scene/camera.toml", "--side", "both", "--out", "run"];
        for words in [&simulate[..], &track] {
            assert!(sinew_command().current_dir(root.path()).args(words).output().unwrap().status.success());
        }
        for (sum, count) in all.iter_mut().zip(counts(root.path())) {
            *sum += count;
        }
    }
    let [rows, sure, off] = all;
    println!("{off} of {sure} sure rows of {rows} are off");
    assert!(off as f32 <= MOST_OFF_SHARE * sure as f32, "{off} of {sure}");
    assert!(sure as f32 >= LEAST_SURE_SHARE * rows as f32, "{sure} of {rows}");
}
