//! Whether joints are lost as often as the weight of the particles elsewhere says
//! (`docs/body_tracker.md`). Runs in release where `../shared/data` is at hand, and says so where
//! not.

use crate::body_clips::RUNNERS;
use crate::shared_data;
use rayon::prelude::*;
use sinew::body::tracking::ambiguity::LOST_JOINT_M;
use sinew::body::tracking::end_effectors::END_EFFECTORS;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew_core::pik::processes::stick::StickSight;
use sinew_lab::body::MotionChoice;
use sinew_lab::body::trial::SeenMotion;
use std::path::Path;

/// Other motions on which nothing was chosen.
const OTHERS: [&str; 3] =
    ["bandai/dataset-2_wave-both-hands_normal_001.bvh@0-4", "cmu-walk/02/02_01.amc", "cmu-exercise/13_29.amc@0-3.9"];
/// Clouds of the camera for each motion.
const CLOUDS: u64 = 18;
/// Particles of the guided model.
const PARTICLES: usize = 30;

/// Weights from which on a joint is counted in a row, and the smallest and largest share of lost
/// ones in it.
type Row = (f32, [f64; 2]);

const OF_RUNNERS: [Row; 4] = [(0.0, [0.001, 0.02]), (0.01, [0.02, 0.12]), (0.3, [0.18, 0.36]), (0.6, [0.58, 0.8])];
/// Few joints of these are lost.
const OF_OTHERS: [Row; 3] = [(0.0, [0.0, 0.005]), (0.01, [0.0, 0.1]), (0.3, [0.1, 0.6])];

/// Weight elsewhere of a joint, and whether it is elsewhere.
type Joint = (f32, bool);

fn joints(seen: &SeenMotion, seed: u64) -> Vec<Joint> {
    let who = (&seen.measures, seen.first_rad);
    let tuning = BodyTuning::default();
    let mut filter = BodyFilter::of_part(seen.part, BodyModelKind::Guided, tuning, who, PARTICLES, seed).unwrap();
    let mut joints = Vec::new();
    for (points_m, truth_m) in seen.clouds_m.iter().zip(&seen.joints_m).skip(1) {
        let blocks = filter.blocks(&mut points_m.clone());
        let estimate = filter.step(&blocks, 1.0 / seen.rate_hz, StickSight::Unseen);
        let ambiguous = filter.ambiguous(&estimate);
        joints.extend(END_EFFECTORS.iter().filter_map(|&bone| {
            let error_m = (estimate.ends_m[bone] - truth_m[bone]?).norm();
            Some((ambiguous[bone], error_m > LOST_JOINT_M))
        }));
    }
    joints
}

/// All joints of all clouds of `motions`.
fn of_all(folder: &Path, motions: &[&str]) -> Vec<Joint> {
    let skeleton = folder.join("cmu-walk/35/35.asf");
    let runs: Vec<(&str, u64)> =
        motions.iter().flat_map(|motion| (1..=CLOUDS).map(move |cloud| (*motion, cloud))).collect();
    let of_run = |(motion, cloud): &(&str, u64)| {
        let motion: MotionChoice = format!("{}/{motion}", folder.display()).parse().unwrap();
        joints(&motion.seen(Some(&skeleton), *cloud).unwrap(), *cloud)
    };
    runs.par_iter().flat_map_iter(of_run).collect()
}

#[test]
fn joints_are_lost_as_often_as_particles_are_elsewhere() {
    let Some(folder) = shared_data::in_long_form("mocap") else { return };
    let sets: [(&str, &[&str], &[Row]); 2] = [("runners", &RUNNERS, &OF_RUNNERS), ("others", &OTHERS, &OF_OTHERS)];
    for (name, motions, rows) in sets {
        let joints = of_all(&folder, motions);
        for (row, &(from, [least, most])) in rows.iter().enumerate() {
            let below = rows.get(row + 1).map_or(f32::INFINITY, |next| next.0);
            let inside: Vec<bool> =
                joints.iter().filter(|joint| (from..below).contains(&joint.0)).map(|joint| joint.1).collect();
            let share = inside.iter().filter(|lost| **lost).count() as f64 / inside.len().max(1) as f64;
            println!("{name}, weight elsewhere from {from}: {} joints, lost {share:.3}", inside.len());
            assert!((least..=most).contains(&share), "{name}, from {from}: {share} of {}", inside.len());
        }
    }
}
