//! Whether the particles' spread is that of the error (`docs/measurements_runners.md`). Runs in
//! release where `../shared/data` is at hand, and says so where not.

use crate::body_clips::{REPORT_SET, RUNNERS};
use crate::shared_data;
use rayon::prelude::*;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew_core::math::{Mat3, Vec3};
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::full_body::{FOREARMS, SHANKS};
use sinew_lab::body::MotionChoice;
use sinew_lab::body::trial::SeenMotion;
use std::ops::RangeInclusive;
use std::path::Path;

/// The six motions of the report set, and the runners; nothing was chosen on either.
const SETS: [(&str, &[&str], RangeInclusive<f64>); 2] =
    [("report set", &REPORT_SET, 0.94..=0.98), ("runners", &RUNNERS, 0.75..=0.90)];
const CLOUDS: u64 = 3;
const PARTICLES: usize = 30;
/// Chi-square of three degrees of freedom below which 90 % lie.
const NINE_TENTHS: f32 = 6.251;

/// Whether the ellipsoid of the particles about their mean that should hold 90 % holds the truth.
fn holds(places_m: &[Vec3], weights: &[f32], truth_m: Vec3) -> bool {
    let total: f32 = weights.iter().sum();
    let weighed = || places_m.iter().zip(weights.iter().map(|weight| weight / total));
    let mean_m: Vec3 = weighed().map(|(place_m, weight)| place_m * weight).sum();
    let spread =
        |sum: Mat3, (place_m, weight): (&Vec3, f32)| sum + (place_m - mean_m) * (place_m - mean_m).transpose() * weight;
    let covariance = weighed().fold(Mat3::zeros(), spread);
    let off_m = truth_m - mean_m;
    covariance.try_inverse().is_some_and(|precision| off_m.dot(&(precision * off_m)) < NINE_TENTHS)
}

/// Each wrist and ankle in each frame.
fn ends_held(seen: &SeenMotion, seed: u64) -> Vec<bool> {
    let who = (&seen.measures, seen.first_rad);
    let tuning = BodyTuning::default();
    let mut filter = BodyFilter::of_part(seen.part, BodyModelKind::Guided, tuning, who, PARTICLES, seed).unwrap();
    let mut held = Vec::new();
    for (points_m, truth_m) in seen.clouds_m.iter().zip(&seen.joints_m).skip(1) {
        let blocks = filter.blocks(&mut points_m.clone());
        let _ = filter.step(&blocks, 1.0 / seen.rate_hz, StickSight::Unseen);
        let (particles, weights) = filter.particles();
        held.extend([FOREARMS, SHANKS].concat().into_iter().filter_map(|bone| {
            let places_m: Vec<Vec3> = particles.iter().map(|particle| particle.ends_m[bone]).collect();
            Some(holds(&places_m, weights, truth_m[bone]?))
        }));
    }
    held
}

fn of_all(folder: &Path, motions: &[&str]) -> Vec<bool> {
    let skeleton = folder.join("cmu-walk/35/35.asf");
    let runs: Vec<(&str, u64)> =
        motions.iter().flat_map(|motion| (1..=CLOUDS).map(move |cloud| (*motion, cloud))).collect();
    let of_run = |(motion, cloud): &(&str, u64)| {
        let motion: MotionChoice = format!("{}/{motion}", folder.display()).parse().unwrap();
        ends_held(&motion.seen(Some(&skeleton), *cloud).unwrap(), *cloud)
    };
    runs.par_iter().flat_map_iter(of_run).collect()
}

#[test]
fn ellipsoids_of_the_particles_hold_wrists_and_ankles() {
    let Some(folder) = shared_data::in_long_form("mocap") else { return };
    for (name, motions, wanted) in SETS {
        let held = of_all(&folder, motions);
        let share = held.iter().filter(|held| **held).count() as f64 / held.len() as f64;
        println!("{name}: ellipsoids of 90 % hold {share:.3} of {}", held.len());
        assert!(wanted.contains(&share), "{name}: {share} of {}", held.len());
    }
}
