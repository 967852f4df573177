//! Position in the cycle, cadence and number of cycles over whole recordings of people that no
//! model was trained on, by the phase-coupled filter. Runs in release where `../shared/data` is at
//! hand, and says so where not.

use crate::shared_data;

use crate::walk_cuts::list;
use sinew::cyclic::CyclicModel;
use sinew::cyclic::tracking::FilterName;
use sinew::resume::Cells;
use sinew_lab::cyclic::experiments::SIGMAS_DEG;
use sinew_lab::cyclic::other_sources::WALKS;
use sinew_lab::cyclic::{Cell, LONG_RUN_SIGMA_DEG, Protocol, Setting, long_runs, test_cycles};

/// Largest relative error of the mean cadence from the third cycle on.
const CADENCE: f64 = 0.02;
/// Largest difference of the cycles counted and those that there were.
const COUNT: f64 = 0.3;
/// Root mean square and greatest error of the position over eight or more cycles.
const PHASE: [f64; 2] = [0.05, 0.15];
/// The same over fewer, where what a person's cycle is said to begin with weighs more.
const SHORT_PHASE: [f64; 2] = [0.08, 0.15];
/// Seeds of the noise (6 degrees).
const SEEDS: [u64; 3] = [1, 2, 3];

fn holds(model: &str, files: &[&str]) {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let list = list(&data, folder.path(), files);
    let model = CyclicModel::from_option(model).unwrap();
    for seed in SEEDS {
        let runs = long_runs(&list, &model, 60.0, &[FilterName::Coupled], (LONG_RUN_SIGMA_DEG, seed)).unwrap();
        assert_eq!(runs.len(), files.len());
        for run in runs {
            let (name, counted) = (&run.name, run.counted_cycles - run.cycles);
            println!(
                "{name} seed {seed}: {:.2} cycles, counted {counted:+.2}, cadence {:+.2} %, phase {:.3} ({:.3} about its mean), {:.3} at most",
                run.cycles,
                100.0 * run.cadence_error,
                run.phase_rms,
                run.phase_spread,
                run.phase_max
            );
            assert!(run.cadence_error.abs() < CADENCE, "{name} seed {seed}: cadence off by {}", run.cadence_error);
            assert!(counted.abs() < COUNT, "{name} seed {seed}: cycles counted {counted:+}");
            let [rms, most] = if run.cycles > 7.5 { PHASE } else { SHORT_PHASE };
            assert!(run.phase_rms < rms && run.phase_max < most, "{name} seed {seed}: phase {}", run.phase_rms);
            assert!(run.phase_spread <= run.phase_rms && run.phase_spread > 0.001);
        }
    }
}

/// Share of the truth inside `coupled`'s 90 % band, over all angles and sigmas, and for each angle.
const BAND: [f64; 2] = [0.85, 0.95];
/// The lowest are the lines from hip to hip, which other sources place elsewhere.
const BAND_EACH: [f64; 2] = [0.7, 0.99];
/// Largest error of `coupled` as a share of the better of `paper` and `paper-cut` at each sigma.
const SHARES: [(Protocol, [f64; 6]); 2] =
    [(Protocol::Noisy, [1.0, 1.0, 1.0, 0.9, 0.9, 0.75]), (Protocol::ExactMean, [1.0; 6])];

#[test]
fn walkers_of_another_source_are_followed_with_bands_that_hold() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let cycles = test_cycles(&list(&data, folder.path(), &WALKS)).unwrap();
    let model = CyclicModel::from_option("walking").unwrap();
    let cells = Setting { cycles: &cycles, model: &model, rate_hz: 60.0, seeds: 5, cells: &Cells::not_kept() }
        .noise_table()
        .unwrap();
    let of = |protocol, filter| -> Vec<&Cell> {
        cells.iter().filter(|cell| cell.filter == filter && cell.protocol == protocol).collect()
    };
    for (protocol, shares) in SHARES {
        let [paper, cut, coupled] =
            [FilterName::Paper, FilterName::PaperCut, FilterName::Coupled].map(|filter| of(protocol, filter));
        for i in 0..SIGMAS_DEG.len() {
            let (sigma, error_deg) = (SIGMAS_DEG[i], coupled[i].error_deg);
            let share = error_deg / paper[i].error_deg.min(cut[i].error_deg);
            println!("{protocol:?}, sigma {sigma}: {error_deg:.2} degrees, share {share:.3}");
            assert!(share > 0.2 && share <= shares[i], "{protocol:?}, sigma {sigma}: share {share}");
        }
    }
    let coupled = of(Protocol::Noisy, FilterName::Coupled);
    let mean =
        |value: &dyn Fn(&Cell) -> f64| coupled.iter().map(|cell| value(cell)).sum::<f64>() / coupled.len() as f64;
    let pooled = mean(&|cell| cell.inside_90);
    let each: Vec<f64> = (0..13).map(|angle| mean(&|cell| cell.each_inside_90[angle])).collect();
    println!("inside the 90 % band: {pooled:.3}, each {each:.3?}");
    assert!((BAND[0]..BAND[1]).contains(&pooled), "{pooled}");
    assert!(each.iter().all(|share| (BAND_EACH[0]..BAND_EACH[1]).contains(share)), "{each:?}");
}

#[test]
fn walkers_keep_phase_cadence_and_count() {
    holds("walking", &WALKS);
}

#[test]
fn a_runner_keeps_phase_cadence_and_count() {
    holds("running", &["bandai/dataset-2_run_exhausted_001.bvh"]);
}
