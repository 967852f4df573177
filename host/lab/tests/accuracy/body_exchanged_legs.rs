//! Runners who are begun with exchanged legs six metres away (`docs/measurements_runners.md`).
//! Runs in release where `../shared/data` is at hand, and says so where not.

use crate::body_clips::RUNNERS;
use crate::shared_data;
use rayon::prelude::*;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew::body::{BodyJoints, fit_pose};
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::full_body::{BODY_BONES, PELVIS, SHANKS, THIGHS, full_body};
use sinew_lab::body::MotionChoice;
use sinew_lab::body::trial::SeenMotion;
use std::ops::RangeInclusive;
use std::path::Path;

const CLOUDS: u64 = 3;
const SEEDS: u64 = 2;
const PARTICLES: usize = 30;
/// Distances of the pelvis in the frames that runs begin with, metres.
const START_M: std::ops::Range<f32> = 5.4..6.6;
/// Frames in which the sides have to be right.
const FRAMES: usize = 10;
/// First coordinates of the legs, and how many each has.
const LEGS: [usize; 2] = [20, 25];
const LEG_COORDINATES: usize = 5;
/// Share of the runs whose sides are right in the tenth frame, with the rival and without.
const RIGHT: [(f32, RangeInclusive<f64>); 2] = [(20.0, 0.9..=0.99), (1.0e6, 0.8..=0.95)];

/// Whether knees and ankles are nearer to their own places than to those of the other side.
fn sides_are_right(ends_m: &[Vec3; BODY_BONES], truth_m: &BodyJoints) -> bool {
    let off_m = |bone: usize, place: usize| truth_m[place].map_or(0.0, |truth_m| (ends_m[bone] - truth_m).norm());
    let (mut own_m, mut other_m) = (0.0, 0.0);
    for [left, right] in [THIGHS, SHANKS] {
        own_m += off_m(left, left) + off_m(right, right);
        other_m += off_m(left, right) + off_m(right, left);
    }
    own_m < other_m
}

/// Whether the sides are right in the tenth frame after `start`, from the true pose with exchanged
/// legs.
fn is_right_again(seen: &SeenMotion, start: usize, (tuning, seed): (BodyTuning, u64)) -> bool {
    let mut pose_rad = fit_pose(&full_body(&seen.measures).unwrap(), &seen.joints_m[start], None).angles;
    for angle in 0..LEG_COORDINATES {
        pose_rad.swap(LEGS[0] + angle, LEGS[1] + angle);
    }
    let who = (&seen.measures, pose_rad);
    let mut filter = BodyFilter::of_part(seen.part, BodyModelKind::Guided, tuning, who, PARTICLES, seed).unwrap();
    let frames = start + 1..=start + FRAMES;
    let steps = frames.map(|frame| {
        let blocks = filter.blocks(&mut seen.clouds_m[frame].clone());
        (frame, filter.step(&blocks, 1.0 / seen.rate_hz, StickSight::Unseen))
    });
    steps.last().is_some_and(|(frame, estimate)| sides_are_right(&estimate.ends_m, &seen.joints_m[frame]))
}

/// Each run of all runners with this cost of the rival.
fn runs(recordings: &Path, switch_cost: f32) -> Vec<bool> {
    let mut tuning = BodyTuning::default();
    tuning.rival.switch_cost = switch_cost;
    let of_cloud = |(runner, cloud): &(&str, u64)| {
        let motion: MotionChoice = format!("{}/{runner}", recordings.display()).parse().unwrap();
        let seen = motion.seen(None, *cloud).unwrap();
        let is_start = |frame: &usize| seen.joints_m[*frame][PELVIS].is_some_and(|at_m| START_M.contains(&at_m.norm()));
        let starts: Vec<usize> = (1..seen.clouds_m.len() - FRAMES).filter(is_start).collect();
        let pairs = starts.into_iter().flat_map(|start| (1..=SEEDS).map(move |seed| (start, seed)));
        pairs.map(|(start, seed)| is_right_again(&seen, start, (tuning, seed))).collect::<Vec<bool>>()
    };
    let clouds: Vec<(&str, u64)> =
        RUNNERS.iter().flat_map(|runner| (1..=CLOUDS).map(move |cloud| (*runner, cloud))).collect();
    clouds.par_iter().flat_map_iter(of_cloud).collect()
}

#[test]
fn runners_who_begin_with_exchanged_legs_are_right_after_ten_frames() {
    let Some(recordings) = shared_data::in_long_form("mocap") else { return };
    for (switch_cost, right) in RIGHT {
        let runs = runs(&recordings, switch_cost);
        let share = runs.iter().filter(|is_right| **is_right).count() as f64 / runs.len() as f64;
        println!("cost {switch_cost}: right {share:.3} of {} runs", runs.len());
        assert!(runs.len() >= 90, "{} runs", runs.len());
        assert!(right.contains(&share), "cost {switch_cost}: right {share}");
    }
}
