//! What is lost of runners who are near, and why (`docs/measurements_runners.md`). Runs in release
//! where `../shared/data` is at hand, and says so where not.

use crate::body_clips::RUNNERS as UNSEEN;
use crate::shared_data;
use rayon::prelude::*;
use sinew::body::tracking::ambiguity::LOST_JOINT_M;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew::body::{BodyJoints, fit_pose};
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::full_body::{PELVIS, full_body};
use sinew_lab::body::MotionChoice;
use sinew_lab::body::runners::{Seeds, runs};
use sinew_lab::body::trial::{NEAR_M, SeenMotion};
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

/// Shares of the near frames of each unseen runner that lose a joint where the true pose is
/// expected.
const LOST_FROM_THE_TRUTH: [[f64; 2]; 3] = [[0.12, 0.28], [0.0, 0.03], [0.0, 0.06]];

/// Near frames that lose a joint where the frame's true pose is expected, which no tracker has.
fn lost_from_the_truth(seen: &SeenMotion) -> Vec<bool> {
    let skeleton = full_body(&seen.measures).unwrap();
    let is_near = |joints_m: &BodyJoints| joints_m[PELVIS].is_some_and(|pelvis_m| pelvis_m.norm() < NEAR_M);
    let near = seen.joints_m.iter().zip(&seen.clouds_m).skip(1).filter(|(joints_m, _)| is_near(joints_m));
    let is_lost = |(joints_m, points_m): (&BodyJoints, &Vec<Vec3>)| {
        let who = (&seen.measures, fit_pose(&skeleton, joints_m, None).angles);
        let tuning = BodyTuning::default();
        let mut filter = BodyFilter::of_part(seen.part, BodyModelKind::Guided, tuning, who, PARTICLES, 1).unwrap();
        let blocks = filter.blocks(&mut points_m.clone());
        let ends_m = filter.step(&blocks, 1.0 / seen.rate_hz, StickSight::Unseen).ends_m;
        let mut joints = ends_m.iter().zip(joints_m);
        joints.any(|(end_m, true_m)| true_m.is_some_and(|true_m| (end_m - true_m).norm() > LOST_JOINT_M))
    };
    near.map(is_lost).collect()
}

#[test]
fn some_joints_are_lost_even_where_the_true_pose_is_expected() {
    let Some(recordings) = shared_data::in_long_form("mocap") else { return };
    for (runner, [least, most]) in UNSEEN.into_iter().zip(LOST_FROM_THE_TRUTH) {
        let motion: MotionChoice = format!("{}/{runner}", recordings.display()).parse().unwrap();
        let of_cloud = |cloud| lost_from_the_truth(&motion.seen(None, cloud).unwrap());
        let lost: Vec<bool> = (1..=SEEDS.clouds).into_par_iter().flat_map_iter(of_cloud).collect();
        let share = lost.iter().filter(|is_lost| **is_lost).count() as f64 / lost.len() as f64;
        println!("{runner}: {share:.3} of {} near frames", lost.len());
        assert!((least..=most).contains(&share), "{runner}: {share}");
    }
}

/// Mean joint error of whole clips and of near frames, metres, over the runners on which nothing
/// was chosen.
#[test]
fn unseen_runners_are_followed() {
    let Some(recordings) = shared_data::in_long_form("mocap") else { return };
    let (mut whole, mut near) = (Vec::new(), Vec::new());
    for runner in UNSEEN {
        let motion: MotionChoice = format!("{}/{runner}", recordings.display()).parse().unwrap();
        let (read, guided) = (motion.read(None).unwrap(), (BodyModelKind::Guided, PARTICLES));
        let seeds = Seeds { clouds: 3, trackers: 2 };
        let (trials, _) = runs(&read, guided, &BodyTuning::default(), (seeds, 4)).unwrap();
        whole.extend(trials.iter().map(|trial| trial.joint_error_m));
        near.extend(trials.iter().filter_map(|trial| trial.near).map(|near| near.joint_error_m));
    }
    let mean_cm = |errors_m: &[f64]| 100.0 * errors_m.iter().sum::<f64>() / errors_m.len() as f64;
    let [whole, near] = [&whole, &near].map(|errors_m| mean_cm(errors_m));
    println!("joints, cm: whole clips {whole:.2}, near {near:.2}");
    assert!((4.0..=8.0).contains(&whole) && (2.0..=4.0).contains(&near), "{whole} {near}");
}
