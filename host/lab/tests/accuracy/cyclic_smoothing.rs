//! What looking back gains on real walkers. Runs where `../shared/data` is at hand, and says so
//! where not.

use sinew::cyclic::tracking::{FilterName, TrackingOptions, track};
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::cyclic::{AngleTable, CutList, CyclicModel};
use sinew_lab::cyclic::protocol::measurements;
use sinew_lab::cyclic::protocol::pooled;
use sinew_lab::cyclic::{Protocol, TestCycle, test_cycles};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/cyclic-walking");
    if !folder.is_dir() {
        eprintln!("skipped: the walkers of ../shared/data are not beside the project");
        return None;
    }
    Some(folder)
}

fn walkers() -> Option<(CyclicModel, Vec<TestCycle>)> {
    let folder = data()?;
    let list = CutList::read(&folder.join("train_cuts.csv")).unwrap();
    let model = train(&list, TrainingOptions { rate_hz: Some(60.0), ..TrainingOptions::default() }).unwrap();
    Some((model, test_cycles(&CutList::read(&folder.join("test_cuts.csv")).unwrap()).unwrap()))
}

/// Mean absolute error over 13 angles in degrees at sigma 6 and 29 (noisy): the filter's, and
/// looking back.
const NOISY_DEG: [(FilterName, [[f64; 2]; 2]); 3] = [
    (FilterName::Paper, [[2.59, 1.52], [7.73, 4.67]]),
    (FilterName::PaperCut, [[2.75, 1.96], [7.54, 5.18]]),
    (FilterName::Coupled, [[2.09, 1.39], [4.84, 3.81]]),
];
/// Relative room of these numbers.
const ROOM: f64 = 0.04;
/// Share of the truth inside the smoothed 90 % band of `coupled`, both sigmas.
const BAND: [f64; 2] = [0.90, 0.97];
/// Largest share of angles whose smoothed variance is above the filter's, `coupled`: where the
/// smoothed position lies at a steeper place of the cycle. The others have none.
const WIDER_SHARE: f64 = 0.01;
/// Error within a second without measurement as a share of the filter's, and its bounds.
const GAP_SHARE: [(FilterName, [f64; 2]); 2] = [(FilterName::Coupled, [0.3, 0.9]), (FilterName::Paper, [0.05, 0.6])];

fn options(filter: FilterName, sigma_deg: f64, smooth: bool) -> TrackingOptions {
    TrackingOptions {
        filter,
        sigma_rad: sigma_deg.to_radians(),
        initial_cycle_position: Some(0.0),
        rate_hz: Some(60.0),
        smooth,
        ..TrackingOptions::default()
    }
}

#[test]
fn looking_back_halves_the_error_as_the_book_says() {
    let Some((model, cycles)) = walkers() else { return };
    for (filter, rows) in NOISY_DEG {
        for (wanted, sigma_deg) in rows.into_iter().zip([6.0, 29.0]) {
            let errors = [false, true].map(|smooth| {
                pooled(&cycles, &model, Protocol::Noisy, &options(filter, sigma_deg, smooth), 20).unwrap()
            });
            for (errors, wanted) in errors.iter().zip(wanted) {
                let found = errors.all_deg();
                println!("{filter:?} sigma {sigma_deg}: {found:.3}, inside the band {:.3}", errors.inside_90().0);
                assert!((found / wanted - 1.0).abs() < ROOM, "{filter:?} sigma {sigma_deg}: {found} beside {wanted}");
            }
            if filter == FilterName::Coupled {
                let inside = errors[1].inside_90().0;
                assert!((BAND[0]..BAND[1]).contains(&inside), "{inside}");
            }
        }
    }
}

#[test]
fn later_frames_only_make_surer() {
    let Some((model, cycles)) = walkers() else { return };
    for filter in [FilterName::Paper, FilterName::PaperCut, FilterName::Coupled] {
        let (mut wider, mut all, mut sums) = (0.0, 0.0, [0.0; 2]);
        for (index, cycle) in cycles.iter().enumerate() {
            let noisy = measurements(&cycle.truth, Protocol::Noisy, 6.0_f64.to_radians(), index as u64);
            let [forward, back] =
                [false, true].map(|smooth| track(&noisy, &model, &options(filter, 6.0, smooth)).unwrap());
            for (f, b) in forward.frames.iter().zip(&back.frames).skip(1) {
                assert!(b.estimate.cycle_position_variance <= 1.000_1 * f.estimate.cycle_position_variance);
                for (f, b) in f.estimate.angle_variance_rad2.iter().zip(b.estimate.angle_variance_rad2) {
                    wider += f64::from(u8::from(b > 1.000_1 * f));
                    all += 1.0;
                    sums = [sums[0] + f64::from(*f), sums[1] + f64::from(b)];
                }
            }
        }
        let most = if filter == FilterName::Coupled { WIDER_SHARE } else { 0.0 };
        println!("{filter:?}: {} of the angles wider, mean variance times {:.3}", wider / all, sums[1] / sums[0]);
        assert!(wider / all <= most, "{filter:?}: {}", wider / all);
        assert!(sums[1] < 0.8 * sums[0], "{filter:?}: {sums:?}");
    }
}

/// The whole recordings of the test's people that are long enough, a second taken out of their
/// middle.
#[test]
fn a_second_without_measurement_is_bridged_better_from_both_sides() {
    let (Some((model, cycles)), Some(folder)) = (walkers(), data()) else { return };
    let mut sums = [[0.0; 2]; 2];
    let mut count = 0.0;
    for cycle in &cycles {
        let truth = AngleTable::read(&folder.join(cycle.name.split(':').next().unwrap())).unwrap();
        if truth.rows().len() < 200 {
            continue;
        }
        for seed in 0..5 {
            let noisy = measurements(&truth, Protocol::Noisy, 6.0_f64.to_radians(), seed);
            let mut rows = noisy.rows().to_vec();
            for row in &mut rows[80..140] {
                row.angles_rad.fill(None);
            }
            let gap = AngleTable::new(rows, Vec::new()).unwrap();
            for (sums, (filter, _)) in sums.iter_mut().zip(GAP_SHARE) {
                for (sum, smooth) in sums.iter_mut().zip([false, true]) {
                    let options = TrackingOptions { initial_cycle_position: None, ..options(filter, 6.0, smooth) };
                    let run = track(&gap, &model, &options).unwrap();
                    for (frame, row) in run.frames[80..140].iter().zip(&truth.rows()[80..140]) {
                        for (found, truth) in frame.angles_rad.iter().zip(row.angles_rad) {
                            let off = found - truth.unwrap();
                            *sum += (off - TAU * (off / TAU).round()).abs().to_degrees();
                        }
                    }
                }
            }
            count += 60.0 * 13.0;
        }
    }
    assert!(count > 0.0);
    for ((filter, [low, high]), [forward, back]) in GAP_SHARE.into_iter().zip(sums) {
        println!("{filter:?} in the gap: {:.2} degrees, looking back {:.2}", forward / count, back / count);
        assert!((low..high).contains(&(back / forward)), "{filter:?}: {}", back / forward);
    }
}
