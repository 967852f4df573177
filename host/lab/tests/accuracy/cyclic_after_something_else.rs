//! Walks that begin in the middle of a recording: somebody stands, waves, squats or gives signals
//! before. Is the walk found, and how soon? Runs in release where `../shared/data` is at hand, and
//! says so where not.

use crate::shared_data;
use crate::walks::WALKS;
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::{AngleRow, CyclicModel};
use sinew_lab::cyclic::after_something_else::OffFrames;
use sinew_lab::cyclic::stress::strangers;
use std::ops::Range;
use std::path::Path;

/// Noise, degrees, with the greatest share of frames off in the second second of walking, and from
/// then on.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.04, 0.02), (6.0, 0.04, 0.02), (29.0, 0.16, 0.06)];
/// The same for people of the training, each by a model of the others.
const STRANGERS_BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.03, 0.01), (6.0, 0.03, 0.01), (29.0, 0.16, 0.05)];
const SEEDS: [u64; 2] = [1, 2];
/// Frames of a walk: five seconds from the half second on.
const WALK: Range<usize> = 30..330;
/// A recording of something else: file, its skeleton, frames at 60 a second.
type Other = (&'static str, Option<&'static str>, Range<usize>);
const OTHERS: [Other; 3] = [
    ("cmu-exercise/13_30.amc", Some("cmu-walk/35/35.asf"), 708..828),
    ("bandai/dataset-2_wave-right-hand_normal_001.bvh", None, 60..180),
    ("cmu-exercise/13_31.amc", Some("cmu-walk/35/35.asf"), 1000..1031),
];
/// Before people of the training.
const SIGNALS: [Other; 3] = [
    ("cmu-expmap/train_directing_traffic_1.txt", None, 0..120),
    ("cmu-expmap/train_basketball_signal_3.txt", None, 0..90),
    ("cmu-expmap/train_jumping_1.txt", None, 0..120),
];
/// Frames for which somebody stands before walking.
const STANDING: [usize; 2] = [20, 90];

fn rows(data: &Path, file: &str, skeleton: Option<&str>, frames: Range<usize>) -> Vec<AngleRow> {
    let skeleton = skeleton.map(|skeleton| data.join(skeleton));
    let options = RecordingOptions { rate_hz: Some(60.0), skeleton, ..RecordingOptions::default() };
    let rows = angles(&data.join(file), &options).unwrap().table.rows().to_vec();
    rows.into_iter().take(frames.end).skip(frames.start).collect()
}

/// What comes before `walk`: standing, and each of `others`.
fn befores(walk: &[AngleRow], others: &[Vec<AngleRow>]) -> Vec<Vec<AngleRow>> {
    let standing = STANDING.iter().map(|&frames| vec![walk[0].clone(); frames]);
    standing.chain(others.iter().cloned()).collect()
}

/// Tracks every walk by its model after standing and after each of `others`; expects the bounds.
fn expect_found(walks: &[(&CyclicModel, Vec<AngleRow>)], others: &[Vec<AngleRow>], bounds: [(f64, f64, f64); 3]) {
    for (sigma_deg, most_soon, most_later) in bounds {
        let mut off = OffFrames::default();
        for (model, walk) in walks {
            off.add(model, walk, &befores(walk, others), (sigma_deg, &SEEDS)).unwrap();
        }
        let [soon, later] = off.shares();
        println!("sigma {sigma_deg}: {soon:.3} off in the second second, {later:.3} from then on");
        assert!(soon < most_soon && later < most_later, "sigma {sigma_deg}: {soon}, {later}");
    }
}

#[test]
fn walks_are_found_after_standing_waving_and_squatting() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let model = CyclicModel::from_option("walking").unwrap();
    let walks = WALKS.map(|file| (&model, rows(&data, file, None, WALK)));
    let others = OTHERS.map(|(file, skeleton, frames)| rows(&data, file, skeleton, frames));
    expect_found(&walks, &others, BOUNDS);
}

/// What the filter may be chosen by: none of these is kept for reporting.
#[test]
fn people_of_the_training_are_found_after_standing_and_signals() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let strangers = strangers(&data.join("cmu-walk")).unwrap();
    let walk = |rows: &[AngleRow]| rows.iter().take(WALK.len()).cloned().collect();
    let walks: Vec<(&CyclicModel, Vec<AngleRow>)> = strangers
        .iter()
        .flat_map(|stranger| stranger.chains.iter().map(|chain| (&stranger.model, walk(&chain.rows))))
        .collect();
    let others = SIGNALS.map(|(file, skeleton, frames)| rows(&data, file, skeleton, frames));
    expect_found(&walks, &others, STRANGERS_BOUNDS);
}
