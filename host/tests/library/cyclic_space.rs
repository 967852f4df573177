//! Two angles a joint on real walks in space (ASF/AMC). Runs where `../shared/data` is at hand, and
//! says so where not.

use sinew::cyclic::angle_table::{ANGLES, SPACE_ANGLES};
use sinew::cyclic::projection::View;
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::tracking::{FilterName, TrackingOptions, table, track};
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::cyclic::{AngleTable, Cut, CutList, CyclicModel, model_file};
use sinew_core::random::Stream;
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};

/// Standard deviation of the noise on each angle.
const SIGMA_DEG: f64 = 6.0;
/// Filter, looking back or not, mean absolute error in degrees in the plane and out of it.
const ERRORS_DEG: [(FilterName, bool, [f64; 2]); 5] = [
    (FilterName::Paper, false, [2.59, 1.85]),
    (FilterName::Paper, true, [1.53, 1.05]),
    (FilterName::PaperCut, false, [2.75, 1.99]),
    (FilterName::Coupled, false, [2.07, 1.66]),
    (FilterName::Coupled, true, [1.37, 1.13]),
];
/// The same of `coupled` on a walk of another source (BVH, 30 frames a second made 60), looking
/// back or not.
const BVH_DEG: [(bool, [f64; 2]); 2] = [(false, [2.29, 1.39]), (true, [1.68, 1.05])];
/// Relative room of these numbers.
const ROOM: f64 = 0.05;

/// The cut list of `name` with its walks as tables of two angles a joint in `folder`.
fn cuts(data: &Path, folder: &Path, name: &str) -> CutList {
    let list = CutList::read(&data.join("cyclic-walking").join(name)).unwrap();
    for cut in list.cuts() {
        let stem = cut.file.trim_end_matches(".csv");
        let motion = data.join(format!("mocap/cmu-walk/{}/{stem}.amc", &stem[..2]));
        let options = RecordingOptions { rate_hz: Some(60.0), view: View::Space, ..RecordingOptions::default() };
        let table = angles(&motion, &options).unwrap().table;
        assert_eq!(table.angle_count(), SPACE_ANGLES);
        table.write(&folder.join(&cut.file)).unwrap();
    }
    let path = folder.join(name);
    fs::copy(list.path(), &path).unwrap();
    CutList::read(&path).unwrap()
}

/// The rows of a cut.
fn part(table: &AngleTable, frames: std::ops::Range<u64>) -> AngleTable {
    let inside: Vec<usize> = (0..table.rows().len()).filter(|row| frames.contains(&table.rows()[*row].frame)).collect();
    let rows = inside.iter().map(|row| table.rows()[*row].clone()).collect();
    let side = inside.iter().map(|row| table.side_rad().unwrap()[*row]).collect();
    AngleTable::new(rows, Vec::new()).unwrap().with_side(side).unwrap()
}

/// The same with noise on all angles after the first row.
fn noisy(truth: &AngleTable, seed: u64) -> AngleTable {
    let mut rows = truth.rows().to_vec();
    let mut side = truth.side_rad().unwrap().to_vec();
    for (index, (row, side)) in rows.iter_mut().zip(&mut side).enumerate().skip(1) {
        let mut stream = Stream::new(seed, index as u64, 0);
        for angle in row.angles_rad.iter_mut().chain(side) {
            let noise = SIGMA_DEG.to_radians() * f64::from(stream.normal());
            *angle = angle.map(|angle| angle + noise);
        }
    }
    AngleTable::new(rows, Vec::new()).unwrap().with_side(side).unwrap()
}

fn error_deg(
    model: &CyclicModel,
    truths: &[AngleTable],
    filter: FilterName,
    smooth: bool,
    position: Option<f64>,
) -> [f64; 2] {
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    let options = TrackingOptions {
        filter,
        smooth,
        sigma_rad: SIGMA_DEG.to_radians(),
        initial_cycle_position: position,
        rate_hz: Some(60.0),
        ..TrackingOptions::default()
    };
    let distance = |a: f64, b: f64| (a - b - TAU * ((a - b) / TAU).round()).abs().to_degrees();
    for (index, truth) in truths.iter().enumerate() {
        for seed in 0..5 {
            let run = track(&noisy(truth, 100 * seed + index as u64), model, &options).unwrap();
            for (row, frame) in run.frames.iter().enumerate().skip(1) {
                let side = frame.side.as_ref().unwrap();
                for angle in 0..ANGLES {
                    sums[0] += distance(frame.angles_rad[angle], truth.row_angle_rad(row, angle).unwrap());
                    sums[1] += distance(side.angles_rad[angle], truth.row_angle_rad(row, ANGLES + angle).unwrap());
                    count += 1.0;
                }
            }
        }
    }
    sums.map(|sum| sum / count)
}

fn data() -> Option<PathBuf> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    if !data.join("mocap/cmu-walk").is_dir() {
        eprintln!("skipped: the walks of ../shared/data are not beside the project");
        return None;
    }
    Some(data)
}

#[test]
fn walks_in_space_are_tracked_with_two_angles_a_joint() {
    let Some(data) = data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = train(
        &cuts(&data, folder.path(), "train_cuts.csv"),
        TrainingOptions { rate_hz: Some(60.0), ..TrainingOptions::default() },
    )
    .unwrap();
    assert_eq!(model.view().angle_count(), SPACE_ANGLES);
    let path = folder.path().join("model.json");
    fs::write(&path, model_file::to_json(&model).unwrap()).unwrap();
    assert_eq!(model_file::read(&path).unwrap(), model);
    let list = cuts(&data, folder.path(), "test_cuts.csv");
    let cut = |cut: &Cut| part(&AngleTable::read(&list.table_path(cut)).unwrap(), cut.start_frame..cut.end_frame);
    let truths: Vec<AngleTable> = list.cuts().iter().map(cut).collect();
    let mut misses = Vec::new();
    for (filter, smooth, wanted) in ERRORS_DEG {
        let found = error_deg(&model, &truths, filter, smooth, Some(0.0));
        println!("{filter:?} smooth {smooth}: {:.2} degrees in the plane, {:.2} out of it", found[0], found[1]);
        if (0..2).any(|i| (found[i] / wanted[i] - 1.0).abs() > ROOM) {
            misses.push((filter, smooth, found));
        }
    }
    assert!(misses.is_empty(), "{misses:?}");
    let run = track(&truths[0], &model, &TrackingOptions { smooth: true, ..TrackingOptions::default() }).unwrap();
    let text = table::to_csv(&run, None).unwrap();
    let again = AngleTable::parse(&text, Path::new("est.csv")).unwrap();
    assert_eq!((again.angle_count(), again.rows().len()), (SPACE_ANGLES, truths[0].rows().len()));
    let flat = AngleTable::new(truths[0].rows().to_vec(), Vec::new()).unwrap();
    let message = track(&flat, &model, &TrackingOptions::default()).unwrap_err().to_string();
    assert!(message.contains("two angles a joint") && message.contains("--view space"), "{message}");
}

/// Another source, another rate, all of a recording of several cycles: the model of the AMC walks
/// follows a BVH walk.
#[test]
fn a_walk_of_another_source_is_followed_in_space() {
    let Some(data) = data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = train(
        &cuts(&data, folder.path(), "train_cuts.csv"),
        TrainingOptions { rate_hz: Some(60.0), ..TrainingOptions::default() },
    )
    .unwrap();
    let options = RecordingOptions { rate_hz: Some(60.0), view: View::Space, ..RecordingOptions::default() };
    let walk = angles(&data.join("mocap/bandai/dataset-2_walk_normal_001.bvh"), &options).unwrap().table;
    let mut misses = Vec::new();
    for (smooth, wanted) in BVH_DEG {
        let found = error_deg(&model, std::slice::from_ref(&walk), FilterName::Coupled, smooth, None);
        println!("BVH, coupled, smooth {smooth}: {:.2} degrees in the plane, {:.2} out of it", found[0], found[1]);
        if (0..2).any(|i| (found[i] / wanted[i] - 1.0).abs() > ROOM) {
            misses.push((smooth, found));
        }
    }
    assert!(misses.is_empty(), "{misses:?}");
}
