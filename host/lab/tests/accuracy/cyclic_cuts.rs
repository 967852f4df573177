//! `sinew cut` on real walkers and runners: cuts stay at one phase of the motion, measured by cues
//! that cutting does not use. Runs in release where `../shared/data` is at hand, and says so where
//! not.

use crate::shared_data;

use sinew::cyclic::AngleTable;
use sinew::cyclic::cuts::Cut;
use sinew::cyclic::cutting::{CuttingOptions, cycles};
use sinew::cyclic::recording::{RecordingOptions, angles};
use std::path::{Path, PathBuf};

/// Largest standard deviation of a cue's phase within a recording, cycles, the middle one of six
/// cues.
const SPREAD: f64 = 0.02;
/// Largest distance of the cue's earliest and latest phase.
const RANGE: f64 = 0.06;
/// Largest distance of its mean in the first and the second half.
const DRIFT: f64 = 0.03;

/// All recordings of walking and running at 60 frames a second, with their names.
fn recordings(data: &Path) -> Vec<(String, AngleTable)> {
    let options = RecordingOptions { rate_hz: Some(60.0), ..RecordingOptions::default() };
    let mut all = Vec::new();
    for folder in ["cyclic-walking", "mocap/bandai", "mocap/cmu-expmap", "mocap/pymo"] {
        let mut paths: Vec<PathBuf> =
            data.join(folder).read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        for path in paths {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if folder == "cyclic-walking" {
                if name.ends_with(".csv") && !name.ends_with("cuts.csv") {
                    all.push((name, AngleTable::read(&path).unwrap()));
                }
            } else if ["_walk_", "_run_", "running", "walking", "Walk"].iter().any(|part| name.contains(part)) {
                all.push((name, angles(&path, &options).unwrap().table));
            }
        }
    }
    all
}

/// Signals whose greatest value in a cycle is a cue: each foot farthest forward, farthest back,
/// each knee most bent.
fn cues(table: &AngleTable) -> [Vec<f64>; 6] {
    let leg = |thigh: usize, value: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        let value = |row: &sinew::cyclic::AngleRow| match (row.angles_rad[thigh], row.angles_rad[thigh + 1]) {
            (Some(thigh), Some(shank)) => value(thigh, shank),
            _ => f64::NAN,
        };
        table.rows().iter().map(value).collect()
    };
    let forward = |thigh: f64, shank: f64| thigh.cos() + shank.cos();
    let back = |thigh: f64, shank: f64| -forward(thigh, shank);
    let bent = |thigh: f64, shank: f64| (shank - thigh).sin().atan2((shank - thigh).cos());
    [leg(8, &forward), leg(8, &back), leg(8, &bent), leg(11, &forward), leg(11, &back), leg(11, &bent)]
}

/// Phases of the greatest value of `cue`, one for each cut, relative to where it is on the mean.
fn phases(cue: &[f64], first_frame: u64, cuts: &[Cut]) -> Vec<f64> {
    let at = |cut: &Cut, phase: f64| {
        let frame = (cut.start_frame - first_frame) as f64 + phase * cut.duration_frames() as f64;
        cue.get(frame.round() as usize).copied().filter(|_| frame >= 0.0)
    };
    let mean = |phase: f64| cuts.iter().filter_map(|cut| at(cut, phase)).sum::<f64>();
    let usual = (0..100).map(|step| f64::from(step) / 100.0).max_by(|a, b| mean(*a).total_cmp(&mean(*b))).unwrap();
    let own = |cut: &Cut| {
        let steps = (-120..=120).map(|step| f64::from(step) / 400.0);
        let known: Vec<(f64, f64)> = steps.filter_map(|step| Some((step, at(cut, usual + step)?))).collect();
        let best = known.iter().map(|(_, value)| *value).fold(f64::MIN, f64::max);
        // Several steps fall on one frame: the middle of them.
        let places: Vec<f64> = known.iter().filter(|(_, value)| *value >= best).map(|(step, _)| *step).collect();
        (known.len() == 241).then(|| places.iter().sum::<f64>() / places.len() as f64)
    };
    cuts.iter().filter_map(own).collect()
}

fn middle(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    0.5 * (values[values.len() / 2] + values[(values.len() - 1) / 2])
}

#[test]
fn cuts_stay_at_one_phase_of_the_motion() {
    let Some(data) = shared_data::in_release("") else { return };
    let (mut recordings_seen, mut worst) = (0, [0.0_f64; 3]);
    for (name, table) in recordings(&data) {
        let cuts = cycles(&table, &name, CuttingOptions::default()).unwrap();
        assert!(cuts.windows(2).all(|pair| pair[0].end_frame == pair[1].start_frame), "{name}: {cuts:?}");
        let found = cues(&table).map(|cue| phases(&cue, table.first_frame(), &cuts));
        let found: Vec<&Vec<f64>> = found.iter().filter(|phases| phases.len() > 1).collect();
        if found.is_empty() {
            continue;
        }
        let over = |value: &dyn Fn(&[f64]) -> f64| middle(found.iter().map(|phases| value(phases)).collect());
        let mean = |phases: &[f64]| phases.iter().sum::<f64>() / phases.len() as f64;
        let spread = over(&|phases| {
            let mean = mean(phases);
            (phases.iter().map(|phase| (phase - mean).powi(2)).sum::<f64>() / phases.len() as f64).sqrt()
        });
        let extreme = |phases: &[f64], of: fn(f64, f64) -> f64| phases.iter().copied().reduce(of).unwrap();
        let range = over(&|phases| extreme(phases, f64::max) - extreme(phases, f64::min));
        let drift = over(&|phases| mean(&phases[phases.len() / 2..]) - mean(&phases[..phases.len() / 2]));
        println!("{name}: {} cycles, spread {spread:.3}, range {range:.3}, drift {drift:+.3}", cuts.len());
        assert!(spread < SPREAD && range < RANGE && drift.abs() < DRIFT, "{name}: {spread} {range} {drift}");
        recordings_seen += 1;
        worst = [worst[0].max(spread), worst[1].max(range), worst[2].max(drift.abs())];
    }
    println!("worst of {recordings_seen}: spread {:.3}, range {:.3}, drift {:.3}", worst[0], worst[1], worst[2]);
    assert!(recordings_seen >= 33 && worst[0] > 0.005, "{recordings_seen} recordings, {worst:?}");
}
