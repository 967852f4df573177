//! Position in the cycle, cadence and number of cycles over whole recordings of people that no model was trained on, by the
//! phase-coupled filter. Runs in release where `../shared/data` is at hand, and says so where not.

mod shared_data;

use sinew::cyclic::cuts::{self, Cut};
use sinew::cyclic::cutting::{CuttingOptions, cycles};
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::tracking::FilterName;
use sinew::cyclic::{CutList, CyclicModel};
use sinew::evaluate::cyclic::long_runs;
use std::path::Path;

/// Greatest relative error of the mean cadence from the third cycle on.
const CADENCE: f64 = 0.02;
/// Greatest difference of the cycles counted and those that there were.
const COUNT: f64 = 0.3;
/// Root mean square and greatest error of the position over eight or more cycles.
const PHASE: [f64; 2] = [0.05, 0.15];
/// The same over fewer, where what a person's cycle is said to begin with weighs more.
const SHORT_PHASE: [f64; 2] = [0.08, 0.15];
/// Seeds of the noise (6 degrees).
const SEEDS: [u64; 3] = [1, 2, 3];

/// A cut list of the recordings in `data` whose cycles `sinew cut` finds, at least three in each.
fn list(data: &Path, folder: &Path, files: &[&str]) -> CutList {
    let options = RecordingOptions { rate_hz: Some(60.0), ..RecordingOptions::default() };
    let mut all: Vec<Cut> = Vec::new();
    for file in files {
        let table = angles(&data.join(file), &options).unwrap().table;
        let name = file.replace('/', "_").replace(".bvh", ".csv");
        table.write(&folder.join(&name)).unwrap();
        all.extend(cycles(&table, &name, CuttingOptions::default()).unwrap());
    }
    cuts::write(&folder.join("cuts.csv"), &all).unwrap();
    CutList::read(&folder.join("cuts.csv")).unwrap()
}

fn holds(model: &str, files: &[&str]) {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let folder = tempfile::tempdir().unwrap();
    let list = list(&data, folder.path(), files);
    let model = CyclicModel::from_option(model).unwrap();
    for seed in SEEDS {
        let runs = long_runs(&list, &model, 60.0, &[FilterName::Coupled], seed).unwrap();
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

#[test]
fn walkers_keep_phase_cadence_and_count() {
    holds(
        "walking",
        &[
            "bandai/dataset-1_walk_feminine_001.bvh",
            "bandai/dataset-1_walk_happy_001.bvh",
            "bandai/dataset-1_walk_tired_001.bvh",
            "bandai/dataset-2_walk_elderly_001.bvh",
            "bandai/dataset-2_walk_elderly_002.bvh",
            "bandai/dataset-2_walk_normal_001.bvh",
            "bandai/dataset-2_walk_normal_002.bvh",
            "pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh",
        ],
    );
}

#[test]
fn a_runner_keeps_phase_cadence_and_count() {
    holds("running", &["bandai/dataset-2_run_exhausted_001.bvh"]);
}
