//! Motions that are not the model's: most of their rows are flagged, and the band widens. Runs in
//! release where `../shared/data` is at hand, and says so where not.

use crate::shared_data;
use sinew::cyclic::CyclicModel;
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::tracking::{Tracked, TrackingOptions, track};
use sinew_lab::cyclic::other_sources::WALKS;
use sinew_lab::cyclic::protocol::measurements;
use sinew_lab::cyclic::{Errors, Protocol};

/// Motions of which the model of walking knows nothing.
const OTHERS: [&str; 2] = ["cmu-expmap/train_basketball_signal_3.txt", "cmu-expmap/train_directing_traffic_1.txt"];
/// Runners of another source, by the model of walking, with the least share of the truth inside the
/// 90 % band at each noise. The first second, in which nothing is known of the runner, is included.
const RUNNERS: [(&str, [f64; 3]); 3] = [
    ("bandai/dataset-2_run_active_001.bvh", [0.88, 0.80, 0.75]),
    ("bandai/dataset-2_run_active_002.bvh", [0.89, 0.84, 0.73]),
    ("bandai/dataset-2_run_exhausted_001.bvh", [0.89, 0.87, 0.73]),
];
/// Noise, degrees.
const SIGMAS_DEG: [f64; 3] = [1.5, 6.0, 29.0];

/// Seeds of the noise of the runners.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=5;

/// A recording tracked by the model of walking, with what is inside the 90 % band.
fn tracked(file: &str, sigma_deg: f64, seed: u64) -> Option<(Tracked, f64)> {
    let path = shared_data::in_release("mocap")?.join(file);
    let options = RecordingOptions { rate_hz: Some(60.0), ..RecordingOptions::default() };
    let truth = angles(&path, &options).unwrap().table;
    let options =
        TrackingOptions { sigma_rad: sigma_deg.to_radians(), rate_hz: Some(60.0), ..TrackingOptions::default() };
    let seen = measurements(&truth, Protocol::Noisy, options.sigma_rad, seed);
    let tracked = track(&seen, &CyclicModel::from_option("walking").unwrap(), &options).unwrap();
    let (inside, _) = Errors::of(&tracked, &truth).inside_90();
    Some((tracked, inside))
}

/// Share of the rows with `misfit`.
fn misfit_share(file: &str, sigma_deg: f64) -> Option<f64> {
    let (tracked, inside) = tracked(file, sigma_deg, 1)?;
    let misfits = tracked.frames.iter().filter(|frame| frame.estimate.misfit).count();
    let share = misfits as f64 / tracked.frames.len() as f64;
    println!("{file}, sigma {sigma_deg}: {:.0} % flagged, {:.0} % inside", 100.0 * share, 100.0 * inside);
    Some(share)
}

#[test]
fn another_motion_is_flagged() {
    for file in OTHERS {
        // With more noise the filter goes elsewhere again and again, and starts anew each time.
        for sigma_deg in &SIGMAS_DEG[..2] {
            let Some(share) = misfit_share(file, *sigma_deg) else { return };
            assert!((0.5..1.0).contains(&share), "{file}: {share}");
        }
    }
}

/// Shares inside the 90 % band and, from the second second on, with `misfit`: means over the seeds.
fn runner_shares(file: &str, sigma_deg: f64) -> Option<[f64; 2]> {
    let mut sums = [0.0; 2];
    for seed in SEEDS {
        let (tracked, inside) = tracked(file, sigma_deg, seed)?;
        let later = tracked.frames.iter().skip(60);
        let flagged = later.clone().filter(|frame| frame.estimate.misfit).count() as f64 / later.count() as f64;
        sums = [sums[0] + inside, sums[1] + flagged];
    }
    Some(sums.map(|sum| sum / SEEDS.count() as f64))
}

#[test]
fn the_band_of_a_runner_widens() {
    let mut found = Vec::new();
    for (file, least) in RUNNERS {
        for (sigma_deg, least) in SIGMAS_DEG.into_iter().zip(least) {
            let Some([inside, flagged]) = runner_shares(file, sigma_deg) else { return };
            println!("{file}, sigma {sigma_deg}: {inside:.3} inside, from the second second on {flagged:.2} flagged");
            found.push((file, sigma_deg, inside, least));
        }
    }
    for (file, sigma_deg, inside, least) in found {
        assert!((least..0.97).contains(&inside), "{file}, sigma {sigma_deg}: {inside}");
    }
}

#[test]
fn walks_of_other_sources_are_seldom_flagged() {
    for sigma_deg in SIGMAS_DEG {
        let shares: Option<Vec<f64>> = WALKS.iter().map(|file| misfit_share(file, sigma_deg)).collect();
        let Some(shares) = shares else { return };
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        assert!(mean < 0.15, "sigma {sigma_deg}: {shares:?}");
    }
}
