//! Walks that begin in the middle of a recording: somebody stands, waves or squats before. Is the
//! walk found, and how soon? Runs in release where `../shared/data` is at hand, and says so where
//! not.

use crate::shared_data;

use crate::walks::WALKS;
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::tracking::{TrackingOptions, track};
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};
use sinew_lab::cyclic::Protocol;
use sinew_lab::cyclic::protocol::measurements;
use std::ops::Range;
use std::path::Path;

/// Noise, degrees, with the greatest share of frames off in the second second of walking, and from
/// then on.
const BOUNDS: [(f64, f64, f64); 3] = [(1.5, 0.04, 0.02), (6.0, 0.04, 0.02), (29.0, 0.16, 0.06)];
const SEEDS: [u64; 2] = [1, 2];
/// Error of the position beyond which a frame is off, cycles.
const OFF: f64 = 0.15;
/// Frames of a walk: five seconds from the half second on.
const WALK: Range<usize> = 30..330;
/// Frames of the second second.
const SECOND_SECOND: Range<usize> = 60..120;
/// Recordings of something else: file, its skeleton, frames at 60 a second.
const OTHERS: [(&str, Option<&str>, Range<usize>); 3] = [
    ("cmu-exercise/13_30.amc", Some("cmu-walk/35/35.asf"), 708..828),
    ("bandai/dataset-2_wave-right-hand_normal_001.bvh", None, 60..180),
    ("cmu-exercise/13_31.amc", Some("cmu-walk/35/35.asf"), 1000..1031),
];
/// Frames for which somebody stands before walking.
const STANDING: [usize; 2] = [20, 90];

fn rows(data: &Path, file: &str, skeleton: Option<&str>, frames: Range<usize>) -> Vec<AngleRow> {
    let skeleton = skeleton.map(|skeleton| data.join(skeleton));
    let options = RecordingOptions { rate_hz: Some(60.0), skeleton, ..RecordingOptions::default() };
    let rows = angles(&data.join(file), &options).unwrap().table.rows().to_vec();
    rows.into_iter().take(frames.end).skip(frames.start).collect()
}

/// Cycle position in each row of `rows`, numbered anew, with noise.
fn positions(model: &CyclicModel, rows: Vec<AngleRow>, noise: Option<(f64, u64)>) -> Vec<f64> {
    let numbered = rows.into_iter().zip(0..).map(|(row, frame)| AngleRow { frame, extra: Vec::new(), ..row });
    let truth = AngleTable::new(numbered.collect(), Vec::new()).unwrap();
    let (sigma_deg, seed) = noise.unwrap_or((1.0, 1));
    let table = match noise {
        Some(_) => measurements(&truth, Protocol::Noisy, sigma_deg.to_radians(), seed),
        None => truth,
    };
    let options = TrackingOptions { sigma_rad: sigma_deg.to_radians(), ..TrackingOptions::default() };
    let run = track(&table, model, &options).unwrap();
    run.frames.iter().map(|frame| f64::from(frame.estimate.cycle_position)).collect()
}

#[test]
fn walks_are_found_after_standing_waving_and_squatting() {
    let Some(data) = shared_data::in_release("mocap") else { return };
    let model = CyclicModel::from_option("walking").unwrap();
    let others = OTHERS.map(|(file, skeleton, frames)| rows(&data, file, skeleton, frames));
    let mut off = vec![(0_usize, 0_usize, 0_usize, 0_usize); BOUNDS.len()];
    for file in WALKS {
        let walk = rows(&data, file, None, WALK);
        let wanted = positions(&model, walk.clone(), None);
        let standing = STANDING.map(|frames| vec![walk[0].clone(); frames]);
        for before in standing.iter().chain(&others) {
            let whole: Vec<AngleRow> = before.iter().chain(&walk).cloned().collect();
            for ((sigma_deg, ..), off) in BOUNDS.iter().zip(&mut off) {
                for seed in SEEDS {
                    let found = positions(&model, whole.clone(), Some((*sigma_deg, seed)));
                    for (frame, (found, wanted)) in found[before.len()..].iter().zip(&wanted).enumerate() {
                        let way = found - wanted;
                        let is_off = usize::from((way - way.round()).abs() > OFF);
                        if SECOND_SECOND.contains(&frame) {
                            (off.0, off.1) = (off.0 + is_off, off.1 + 1);
                        } else if frame >= SECOND_SECOND.end {
                            (off.2, off.3) = (off.2 + is_off, off.3 + 1);
                        }
                    }
                }
            }
        }
    }
    for ((sigma_deg, most_soon, most_later), (soon, soon_of, later, later_of)) in BOUNDS.into_iter().zip(off) {
        let (soon, later) = (soon as f64 / soon_of as f64, later as f64 / later_of as f64);
        println!("sigma {sigma_deg}: {soon:.3} off in the second second, {later:.3} from then on");
        assert!(soon < most_soon && later < most_later, "sigma {sigma_deg}: {soon}, {later}");
    }
}
