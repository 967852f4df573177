//! What is lost of runners who are near, and why (`docs/measurements_body.md`). Runs in release
//! where `../shared/data` is at hand, and says so where not.

use crate::shared_data;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew_lab::body::MotionChoice;
use sinew_lab::body::runners::{Seeds, runs};
use std::path::Path;

/// Tuning runners whose limbs are seen but for missing patches.
const RUNNERS: [&str; 2] = ["cmu-expmap/train_running_1.txt", "cmu-expmap/train_running_2.txt"];
const SEEDS: Seeds = Seeds { clouds: 3, trackers: 1 };
const PARTICLES: usize = 30;
/// Missing patches of the camera, with the least and the greatest share of near frames that lose a
/// joint, and the greatest share of those that lose one without a flag.
const BOUNDS: [(u32, [f64; 2], f64); 2] = [(4, [0.2, 0.45], 0.05), (0, [0.0, 0.06], 0.05)];

/// Shares of the near frames that lose a joint, and that lose one without a flag.
fn lost(recordings: &Path, patches: u32) -> [f64; 2] {
    let mut near = Vec::new();
    for runner in RUNNERS {
        let motion: MotionChoice = format!("{}/{runner}", recordings.display()).parse().unwrap();
        let read = motion.read(None).unwrap();
        let guided = (BodyModelKind::Guided, PARTICLES);
        let (trials, _) = runs(&read, guided, &BodyTuning::default(), (SEEDS, patches)).unwrap();
        near.extend(trials.iter().filter_map(|trial| trial.near));
    }
    let mean = |sum: f64| sum / near.len() as f64;
    [
        mean(near.iter().map(|near| near.lost_joint_share).sum()),
        mean(near.iter().map(|near| near.lost_unflagged_share).sum()),
    ]
}

#[test]
fn most_joints_that_near_runners_lose_lie_in_missing_patches_and_are_flagged() {
    let Some(recordings) = shared_data::in_long_form("mocap") else { return };
    for (patches, [least, most], most_unflagged) in BOUNDS {
        let [lost, unflagged] = lost(&recordings, patches);
        println!("{patches} patches: {lost:.3} of the near frames lose a joint, {unflagged:.3} without a flag");
        assert!((least..=most).contains(&lost), "{patches} patches: {lost} lost");
        assert!(unflagged <= most_unflagged, "{patches} patches: {unflagged} without a flag");
    }
}
