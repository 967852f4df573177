//! The cadence of short windows of walks that nothing was trained or chosen on. Runs in release
//! where `../shared/data` is at hand, and says so where not.

use crate::shared_data;

use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::own_cycle::{finish, noise};
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::tracking::{Summary, TrackingOptions, track};
use sinew::cyclic::{AngleTable, CyclicModel};

const WALKS: [&str; 5] = [
    "pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh",
    "bandai/dataset-2_walk_normal_001.bvh",
    "bandai/dataset-2_walk_normal_002.bvh",
    "bandai/dataset-2_walk_elderly_001.bvh",
    "bandai/dataset-2_walk_elderly_002.bvh",
];
const RATE_HZ: f64 = 30.0;
/// A window begins every half second; a walk that is shorter is its own window.
const STEP_FRAMES: usize = 15;
/// Seconds of a window, and the mean error of its cadence in percent: of all walks, of the worst.
const WINDOWS: [(f64, [f64; 2]); 3] = [(3.0, [0.26, 0.43]), (5.0, [0.17, 0.40]), (9.0, [0.10, 0.62])];
/// Room of these numbers, and what none of the walks may pass, percent.
const ROOM_PERCENT: f64 = 0.02;
const LIMIT_PERCENT: f64 = 1.0;
/// Trunk, arms and legs among the angles: lines from side to side have no direction in a side view.
const LIMBS: [usize; 9] = [0, 2, 3, 5, 6, 8, 9, 11, 12];

type Pose = [Option<f64>; ANGLES];

fn cadence(poses: &[Pose]) -> Option<f64> {
    let table = AngleTable::from_angles(0, poses).unwrap().at_rate(Some(RATE_HZ));
    let model = CyclicModel::from_option("walking").unwrap();
    let options = TrackingOptions { rate_hz: Some(RATE_HZ), ..TrackingOptions::default() };
    let options = noise::with_noise_of(&table, options);
    Summary::of(&finish(&table, &model, track(&table, &model, &options).unwrap(), &options, None).unwrap())
        .cadence_per_min
}

/// Cycles per minute after which the window is most like itself, by no model. They follow from the
/// lag of 0.7 to 1.6 s with the least mean difference of directions.
fn most_alike(poses: &[Pose]) -> f64 {
    let directions: Vec<Vec<f64>> = poses
        .iter()
        .map(|pose| LIMBS.iter().flat_map(|limb| [pose[*limb].unwrap().cos(), pose[*limb].unwrap().sin()]).collect())
        .collect();
    let difference = |lag: f64| {
        let count = poses.len() - lag.ceil() as usize;
        let sum: f64 = (0..count).map(|frame| squared(&directions, frame, frame as f64 + lag)).sum();
        sum / count as f64
    };
    let lags = (0..).map(|k| 0.7 * RATE_HZ + 0.05 * f64::from(k)).take_while(|lag| *lag < 1.6 * RATE_HZ);
    60.0 * RATE_HZ / lags.min_by(|a, b| difference(*a).total_cmp(&difference(*b))).unwrap()
}

/// Squared difference between a frame and a place between two frames.
fn squared(directions: &[Vec<f64>], frame: usize, place: f64) -> f64 {
    let (index, share) = (place.floor() as usize, place.fract());
    let next = &directions[(index + 1).min(directions.len() - 1)];
    let values = directions[index].iter().zip(next).map(|(a, b)| a + share * (b - a));
    directions[frame].iter().zip(values).map(|(one, other)| (one - other).powi(2)).sum()
}

#[test]
fn cadence_is_within_a_hundredth_of_the_windows_own() {
    for (window_s, stated_percent) in WINDOWS {
        let (mut all_percent, mut worst_percent) = (Vec::new(), 0.0_f64);
        for walk in WALKS {
            let Some(folder) = shared_data::in_release("mocap") else { return };
            let options = RecordingOptions { rate_hz: Some(RATE_HZ), ..RecordingOptions::default() };
            let table = angles(&folder.join(walk), &options).unwrap().table;
            let poses: Vec<Pose> = table.rows().iter().map(|row| row.angles_rad).collect();
            let length = ((window_s * RATE_HZ) as usize).min(poses.len());
            let windows = poses.windows(length).step_by(STEP_FRAMES);
            let off_percent = |window| Some(100.0 * (cadence(window)? / most_alike(window) - 1.0).abs());
            let found: Vec<f64> = windows.filter_map(off_percent).collect();
            let mean_percent = found.iter().sum::<f64>() / found.len() as f64;
            println!("{window_s} s of {walk}: {mean_percent:.2} % off in {} windows", found.len());
            assert!(mean_percent <= LIMIT_PERCENT, "{walk}, {window_s} s: {mean_percent} %");
            worst_percent = worst_percent.max(mean_percent);
            all_percent.extend(found);
        }
        let mean_percent = all_percent.iter().sum::<f64>() / all_percent.len() as f64;
        println!("{window_s} s: {mean_percent:.2} % off in {} windows", all_percent.len());
        for (found, stated) in [mean_percent, worst_percent].into_iter().zip(stated_percent) {
            assert!((found - stated).abs() <= ROOM_PERCENT, "{window_s} s: {found} instead of {stated} %");
        }
    }
}
