//! Whole walks whose noise is as large as `coupled` assumes, smaller, or as large but slow: errors
//! and bands. Runs in release where `../shared/data` is at hand, and says so where not.

use crate::shared_data;

use crate::walk_cuts::list;
use sinew::cyclic::tracking::{TrackingOptions, track};
use sinew::cyclic::{AngleTable, CyclicModel};
use sinew_core::random::Stream;
use sinew_lab::cyclic::Errors;
use sinew_lab::cyclic::other_sources::WALKS;
use std::ops::Range;

/// Standard deviation that the filter assumes, degrees.
const ASSUMED_DEG: f64 = 6.0;

/// Noise that there is.
struct Noise {
    std_deg: f64,
    /// Correlation from frame to frame.
    correlation: f64,
    /// Mean absolute error of the estimate over all angles, degrees.
    error_deg: Range<f64>,
    /// Share of the truth inside the 90 % band.
    inside_90: Range<f64>,
}

const CASES: [Noise; 5] = [
    Noise { std_deg: 6.0, correlation: 0.0, error_deg: 2.2..2.8, inside_90: 0.83..0.95 },
    Noise { std_deg: 3.0, correlation: 0.0, error_deg: 1.3..1.8, inside_90: 0.9..1.0 },
    Noise { std_deg: 1.5, correlation: 0.0, error_deg: 0.9..1.3, inside_90: 0.9..1.0 },
    Noise { std_deg: 3.0, correlation: 0.95, error_deg: 2.0..2.6, inside_90: 0.85..1.0 },
    Noise { std_deg: 6.0, correlation: 0.95, error_deg: 4.0..4.8, inside_90: 0.6..0.9 },
];

/// The angles with noise whose every frame keeps a part of the last.
fn with_noise(truth: &AngleTable, noise: &Noise, seed: u64) -> AngleTable {
    let mut rows = truth.rows().to_vec();
    let (kept, new) = (noise.correlation, (1.0 - noise.correlation * noise.correlation).sqrt());
    let mut off = [0.0; 13];
    for (index, row) in rows.iter_mut().enumerate() {
        let mut stream = Stream::new(seed, index as u64, 0);
        for (off, angle) in off.iter_mut().zip(&mut row.angles_rad) {
            let drawn = f64::from(stream.normal());
            *off = if index == 0 { drawn } else { kept * *off + new * drawn };
            *angle = angle.map(|angle| angle + noise.std_deg.to_radians() * *off);
        }
    }
    AngleTable::new(rows, truth.extra_columns().to_vec()).unwrap()
}

#[test]
fn smaller_noise_than_assumed_gives_smaller_errors_and_slow_noise_keeps_its_bands() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let cuts = list(&data, folder.path(), &WALKS);
    let mut paths: Vec<_> = cuts.cuts().iter().map(|cut| cuts.table_path(cut)).collect();
    paths.dedup();
    let walks: Vec<AngleTable> = paths.iter().map(|path| AngleTable::read(path).unwrap()).collect();
    let model = CyclicModel::from_option("walking").unwrap();
    let options = TrackingOptions { sigma_rad: ASSUMED_DEG.to_radians(), ..TrackingOptions::default() };
    for noise in &CASES {
        let mut errors = Errors::default();
        for (seed, walk) in walks.iter().enumerate() {
            let tracked = track(&with_noise(walk, noise, seed as u64), &model, &options).unwrap();
            errors.merge(&Errors::of(&tracked, walk));
        }
        let (error_deg, inside_90) = (errors.all_deg(), errors.inside_90().0);
        println!(
            "assumed {ASSUMED_DEG}, noise {} with correlation {}: {error_deg:.2} degrees, {:.1} % inside",
            noise.std_deg,
            noise.correlation,
            100.0 * inside_90
        );
        assert!(noise.error_deg.contains(&error_deg), "noise {}: {error_deg}", noise.std_deg);
        assert!(noise.inside_90.contains(&inside_90), "noise {}: {inside_90}", noise.std_deg);
    }
}
