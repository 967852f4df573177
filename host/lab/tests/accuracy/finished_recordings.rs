//! How near a finished recording comes to the truth, beside what anyone can do with keypoints: take
//! them as they are, or filter them. Runs in release where `../shared/data` is at hand, and says so
//! where not.

use crate::shared_data;

use sinew::cyclic::anatomy::of_pose;
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::export::trc::{joint_positions, standard_lengths_m};
use sinew::cyclic::own_cycle::{finish, noise};
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::tracking::{Tracked, TrackingOptions, track};
use sinew::cyclic::turns::wrapped;
use sinew::cyclic::{AngleTable, CyclicModel};
use sinew::signal::{FilterOptions, filtered_angles};
use sinew_core::random::Stream;
use sinew_core::skeleton::stick_figure::HUMAN;

/// What is read off the person, and what they are called in the book.
const WALKS: [(&str, &str); 2] =
    [("pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh", "pymo"), ("bandai/dataset-2_walk_normal_001.bvh", "bandai")];
/// Frames per second of the recordings, as of a usual camera.
const RATE_HZ: f64 = 30.0;
/// Height of the person in the picture, pixels.
const HEIGHT_PX: f64 = 420.0;
/// Standard deviation of the keypoints' noise, pixels, and the error of hips and knees in degrees
/// (root mean square) of `pymo`: raw, Butterworth, finished.
const NOISE: [(f64, [f64; 3]); 4] =
    [(0.0, [0.00, 0.57, 0.05]), (1.0, [1.19, 0.92, 0.90]), (3.0, [3.58, 2.21, 2.08]), (6.0, [7.18, 4.36, 3.64])];
/// Gaps in seconds, and the error of knees and elbows in them of both walks, mean over the
/// seeds: bridged by splines and Butterworth, finished.
const GAPS: [(f64, [[f64; 2]; 2]); 2] = [(0.3, [[9.42, 6.22], [7.73, 3.92]]), (1.0, [[46.49, 9.42], [30.35, 5.69]])];
/// Share of the forearms and shins in gaps inside their 90 % band.
const INSIDE_GAPS: [f64; 2] = [0.83, 0.97];
/// Seeds of the noise of the recordings with gaps, and of the others.
const GAPS_SEEDS: std::ops::RangeInclusive<u64> = 1..=8;
const SEED: u64 = 3;
/// Noise of the recordings with gaps, pixels.
const GAPS_NOISE_PX: f64 = 2.0;
/// Noise of the keypoints, pixels, and the share of all angles inside their 90 % band of each walk.
const BAND_NOISES_PX: [f64; 3] = [1.0, 3.0, 6.0];
const INSIDE: [[f64; 3]; 2] = [[0.92, 0.90, 0.88], [0.92, 0.92, 0.89]];
/// Gaps before this are not looked at: the person's own cycle is not known yet, seconds.
const SETTLED_S: f64 = 4.0;
/// Relative room of these numbers.
const ROOM: f64 = 0.05;
/// What is finished is nowhere worse than the better of the others by more.
const WORSE: f64 = 1.1;
/// Hips and knees, and knees and elbows, among the anatomical angles.
const HIPS_AND_KNEES: [usize; 4] = [3, 4, 7, 8];
const KNEES_AND_ELBOWS: [usize; 4] = [2, 4, 6, 8];
/// Forearms and shins among the angles of the figure.
const GAPPED: [usize; 4] = [3, 6, 9, 12];

type Poses = Vec<[Option<f64>; ANGLES]>;

fn truth(walk: &str) -> Option<Poses> {
    let path = shared_data::in_release("mocap")?.join(walk);
    let options = RecordingOptions { rate_hz: Some(RATE_HZ), ..RecordingOptions::default() };
    Some(angles(&path, &options).unwrap().table.rows().iter().map(|row| row.angles_rad).collect())
}

/// Angles between joints that are off by normal noise.
fn measured(truth: &Poses, noise_px: f64, seed: u64) -> Poses {
    let lengths_px = standard_lengths_m(HEIGHT_PX);
    let pose = |(frame, pose): (u64, &[Option<f64>; ANGLES])| {
        let mut stream = Stream::new(seed, frame, 0);
        let joints = joint_positions(Some([0.0; 2]), &lengths_px, pose)
            .map(|joint| joint.map(|place| place.map(|value| value + noise_px * f64::from(stream.normal()))));
        std::array::from_fn(|angle| {
            let [x, y] = joints[angle + 1]?;
            let [from_x, from_y] = joints[HUMAN.joints()[angle + 1].parent.map_or(0, usize::from)]?;
            Some((y - from_y).atan2(x - from_x))
        })
    };
    (0..).zip(truth).map(pose).collect()
}

fn butterworth(poses: &Poses) -> Poses {
    let options = FilterOptions { gap_limit_s: 10.0, ..FilterOptions::default() };
    let mut smooth = vec![[None; ANGLES]; poses.len()];
    for angle in 0..ANGLES {
        let series: Vec<Option<f64>> = poses.iter().map(|pose| pose[angle]).collect();
        let filtered = filtered_angles(&series, RATE_HZ, &options).unwrap();
        smooth.iter_mut().zip(filtered).for_each(|(pose, value)| pose[angle] = value);
    }
    smooth
}

fn tracked(poses: &Poses) -> Tracked {
    let table = AngleTable::from_angles(0, poses).unwrap().at_rate(Some(RATE_HZ));
    let model = CyclicModel::from_option("walking").unwrap();
    let options = TrackingOptions { rate_hz: Some(RATE_HZ), ..TrackingOptions::default() };
    let options = noise::with_noise_of(&table, options);
    finish(&table, &model, track(&table, &model, &options).unwrap(), &options, None).unwrap()
}

fn finished(poses: &Poses) -> Poses {
    tracked(poses).frames.iter().map(|frame| frame.angles_rad.map(Some)).collect()
}

/// Share of the angles at the place `is_looked_at` (frame, angle) that lie inside their 90 % band.
fn inside_90(tracked: &Tracked, truth: &Poses, is_looked_at: impl Fn(usize, usize) -> bool) -> f64 {
    /// Half the width of a normal density that holds 90 %, standard deviations.
    const HALF_WIDTH_STDS: f64 = 1.645;
    let places = (0..truth.len()).flat_map(|frame| (0..ANGLES).map(move |angle| (frame, angle)));
    let is_inside: Vec<bool> = places
        .filter(|&(frame, angle)| is_looked_at(frame, angle))
        .map(|(frame, angle)| {
            let row = &tracked.frames[frame];
            let std_rad = f64::from(row.estimate.angle_variance_rad2[angle]).sqrt();
            wrapped(row.angles_rad[angle] - truth[frame][angle].unwrap()).abs() < HALF_WIDTH_STDS * std_rad
        })
        .collect();
    is_inside.iter().filter(|inside| **inside).count() as f64 / is_inside.len() as f64
}

/// Root mean square error of flexion angles over the frames that `is_looked_at`, degrees.
fn error_deg(found: &Poses, truth: &Poses, joints: [usize; 4], is_looked_at: impl Fn(usize) -> bool) -> f64 {
    let of_frame = |frame: &usize| {
        let (found, truth) = (of_pose(&found[*frame]), of_pose(&truth[*frame]));
        joints.map(|joint| wrapped((found[joint].unwrap() - truth[joint].unwrap()).to_radians()).to_degrees())
    };
    let errors: Vec<f64> =
        (0..truth.len()).filter(|frame| is_looked_at(*frame)).flat_map(|frame| of_frame(&frame)).collect();
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

fn holds(found: &[f64], stated: &[f64], what: &str) {
    println!("{what}: {found:.2?}");
    for (found, stated) in found.iter().zip(stated) {
        assert!((found - stated).abs() <= ROOM * stated + 0.005, "{what}: {found} instead of {stated}");
    }
}

#[test]
fn what_was_measured_is_not_made_worse() {
    for (walk, name) in WALKS {
        let Some(truth) = truth(walk) else { return };
        for (noise_px, stated) in NOISE {
            let raw = measured(&truth, noise_px, SEED);
            let found = [raw.clone(), butterworth(&raw), finished(&raw)]
                .map(|poses| error_deg(&poses, &truth, HIPS_AND_KNEES, |_| true));
            if name == "pymo" {
                holds(&found, &stated, &format!("{noise_px} px"));
            }
            let best = found[0].min(found[1]).max(0.5);
            assert!(found[2] <= WORSE * best, "{name}, {noise_px} px: {found:?}");
        }
    }
}

#[test]
fn bands_hold_what_they_say() {
    for ((walk, name), stated) in WALKS.into_iter().zip(INSIDE) {
        let Some(truth) = truth(walk) else { return };
        let found =
            BAND_NOISES_PX.map(|noise_px| inside_90(&tracked(&measured(&truth, noise_px, SEED)), &truth, |_, _| true));
        holds(&found, &stated, &format!("{name}, inside the 90 % band"));
    }
}

/// Error of knees and elbows in gaps bridged by splines and Butterworth, finished, degrees, and the
/// share of forearms and shins inside their band there.
fn in_gaps(truth: &Poses, gap_s: f64, seed: u64) -> [f64; 3] {
    let length = (gap_s * RATE_HZ) as usize;
    let step = ((gap_s + 0.9) * RATE_HZ) as usize;
    let first = (1.2 * RATE_HZ) as usize;
    let is_missing = |frame: usize| frame >= first && (frame - first) % step < length;
    let mut poses = measured(truth, GAPS_NOISE_PX, seed);
    for (frame, pose) in poses.iter_mut().enumerate().filter(|(frame, _)| is_missing(*frame)) {
        // The last frames stay, so that lines have an end.
        if frame + 5 < truth.len() {
            GAPPED.iter().for_each(|angle| pose[*angle] = None);
        }
    }
    let settled = (SETTLED_S * RATE_HZ) as usize;
    let is_looked_at = |frame: usize| frame >= settled && is_missing(frame);
    let run = tracked(&poses);
    let found = [butterworth(&poses), run.frames.iter().map(|frame| frame.angles_rad.map(Some)).collect()]
        .map(|poses| error_deg(&poses, truth, KNEES_AND_ELBOWS, is_looked_at));
    let inside = inside_90(&run, truth, |frame, angle| is_looked_at(frame) && GAPPED.contains(&angle));
    [found[0], found[1], inside]
}

#[test]
fn gaps_are_filled_from_the_persons_own_cycle() {
    for (gap_s, stated) in GAPS {
        for ((walk, name), stated) in WALKS.into_iter().zip(stated) {
            let Some(truth) = truth(walk) else { return };
            let (mut found, mut inside) = ([0.0; 2], 0.0);
            for seed in GAPS_SEEDS {
                let [butterworth, finished, within] = in_gaps(&truth, gap_s, seed);
                let share = 1.0 / GAPS_SEEDS.count() as f64;
                found = [found[0] + share * butterworth, found[1] + share * finished];
                inside += share * within;
            }
            holds(&found, &stated, &format!("{name}, gaps of {gap_s} s"));
            println!("{name}, gaps of {gap_s} s: {inside:.2} inside the 90 % band");
            assert!((INSIDE_GAPS[0]..=INSIDE_GAPS[1]).contains(&inside), "{inside}");
        }
    }
}
