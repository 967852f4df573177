//! `sinew track cyclic` with several models, as a user types it: which motion is it?

use assert_cmd::Command;
use predicates::str::contains;
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::{AngleRow, AngleTable};
use sinew_core::random::Stream;
use sinew_lab::cyclic::Protocol;
use sinew_lab::cyclic::protocol::measurements;
use sinew_tests::{shared_data, sinew_command};
use std::f64::consts::TAU;
use std::fs;
use std::ops::Range;
use std::path::Path;

const BANK: [&str; 6] = ["--model", "walking", "--model", "running", "--model", "arm-circles"];
/// Frames of a slow walker's cycle.
const CYCLE_FRAMES: usize = 72;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder);
    command
}

/// The angles of a recording at 60 frames a second, some frames of them, with noise of six degrees,
/// as `noisy.csv`.
fn write_noisy(folder: &Path, recording: &Path, skeleton: Option<&Path>, frames: Range<u64>) {
    let mut command = sinew(folder);
    command.arg("angles").arg(recording).args(["--rate", "60", "--out", "angles.csv"]);
    if let Some(skeleton) = skeleton {
        command.arg("--skeleton").arg(skeleton);
    }
    command.assert().success();
    let rows = AngleTable::read(&folder.join("angles.csv")).unwrap().rows().to_vec();
    write_noisy_rows(folder, rows.into_iter().filter(|row| frames.contains(&row.frame)).collect());
}

fn write_noisy_rows(folder: &Path, mut rows: Vec<AngleRow>) {
    rows.iter_mut().for_each(|row| row.extra.clear());
    let truth = AngleTable::new(rows, Vec::new()).unwrap().at_rate(Some(60.0));
    measurements(&truth, Protocol::Noisy, 6.0_f64.to_radians(), 1).write(&folder.join("noisy.csv")).unwrap();
}

/// Name and probability of the motion in each frame of `noisy.csv`.
fn motions(folder: &Path, bank: &[&str]) -> Vec<(String, f64)> {
    sinew(folder).args(["track", "cyclic", "noisy.csv", "--out", "est.csv"]).args(bank).assert().success();
    let mut reader = csv::Reader::from_path(folder.join("est.csv")).unwrap();
    let headers: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(headers[headers.len() - 2..], ["motion", "motion_probability"]);
    let last = headers.len() - 2;
    reader.records().map(|row| row.unwrap()).map(|row| (row[last].to_owned(), row[last + 1].parse().unwrap())).collect()
}

fn share(motions: &[(String, f64)], name: &str) -> f64 {
    motions.iter().filter(|(other, _)| other == name).count() as f64 / motions.len() as f64
}

#[test]
fn walkers_and_runners_that_no_model_knows_are_named() {
    let (Some(mocap), Some(tables)) = (shared_data("mocap"), shared_data("cyclic-walking")) else { return };
    let root = tempfile::tempdir().unwrap();
    let mut counts = [(0.0, 0.0); 2];
    let tables = TABLES.map(|file| (tables.join(file), "walking"));
    for (path, name) in CLIPS.map(|(file, name)| (mocap.join(file), name)).into_iter().chain(tables) {
        if path.extension().is_some_and(|extension| extension == "csv") {
            write_noisy_rows(root.path(), AngleTable::read(&path).unwrap().rows().to_vec());
        } else {
            write_noisy(root.path(), &path, None, 0..10_000);
        }
        let file = path.file_name().unwrap().display();
        let motions = motions(root.path(), &BANK);
        assert!(motions.iter().all(|(_, probability)| (0.0..=1.0).contains(probability)));
        let after_a_cycle = &motions[CYCLE_FRAMES..];
        let right = share(after_a_cycle, name);
        println!("{file}: {name} in {right:.3} of {} frames", after_a_cycle.len());
        assert!(right + share(after_a_cycle, "none") > 0.98, "{file}: another motion was named");
        assert!(right > 0.7, "{file}: {right}");
        let (sum, count) = &mut counts[usize::from(name == "running")];
        *sum += right * after_a_cycle.len() as f64;
        *count += after_a_cycle.len() as f64;
    }
    for (right, frames) in counts {
        assert!(right >= 0.9 * frames, "{right} of {frames} frames");
    }
}

/// Tables of people who are not in the training of `walking`.
const TABLES: [&str; 6] = ["02_01.csv", "02_02.csv", "06_01.csv", "35_08.csv", "35_28.csv", "38_01.csv"];
const CLIPS: [(&str, &str); 9] = [
    ("bandai/dataset-1_walk_feminine_001.bvh", "walking"),
    ("bandai/dataset-1_walk_happy_001.bvh", "walking"),
    ("bandai/dataset-1_walk_tired_001.bvh", "walking"),
    ("bandai/dataset-2_walk_elderly_001.bvh", "walking"),
    ("bandai/dataset-2_walk_normal_001.bvh", "walking"),
    ("cmu-expmap/train_walking_3.txt", "walking"),
    ("bandai/dataset-2_run_active_001.bvh", "running"),
    ("bandai/dataset-2_run_active_002.bvh", "running"),
    ("bandai/dataset-2_run_exhausted_001.bvh", "running"),
];

/// One recording's circles, from the first one on, by a model of the other's.
#[test]
fn arm_circles_are_named_by_the_model_of_another_recording() {
    let Some(mocap) = shared_data("mocap") else { return };
    let root = tempfile::tempdir().unwrap();
    let skeleton = mocap.join("cmu-walk/35/35.asf");
    let own = ["--model", "walking", "--model", "running", "--model", "circles.json"];
    let cuts =
        ["13_29.csv,639,694\n13_29.csv,694,752\n13_29.csv,752,821\n", "13_31.csv,1031,1074\n13_31.csv,1074,1124\n"];
    for (trained, cuts, tracked, frames) in
        [("13_29", cuts[0], "13_31", 1031..1124), ("13_31", cuts[1], "13_29", 639..821)]
    {
        let recording = |trial: &str| mocap.join(format!("cmu-exercise/{trial}.amc"));
        let table = format!("{trained}.csv");
        let mut angles = sinew(root.path());
        angles.arg("angles").arg(recording(trained)).arg("--skeleton").arg(&skeleton);
        angles.args(["--rate", "60", "--out", &table]).assert().success();
        fs::write(root.path().join("cuts.csv"), format!("file,start_frame,end_frame\n{cuts}")).unwrap();
        sinew(root.path()).args(["train", "cyclic", "--cuts", "cuts.csv", "--out", "circles.json"]).assert().success();
        write_noisy(root.path(), &recording(tracked), Some(&skeleton), frames);
        let right = share(&motions(root.path(), &own)[55..], "circles.json");
        println!("{tracked}: circles in {right:.3}");
        assert!(right >= 0.7, "{tracked}: {right}");
    }
}

/// Exercises and gestures: recording, and its frames at 60 a second. Jumping jacks are not among
/// them: from the side their arms circle.
const OTHERS: [(&str, Range<u64>); 18] = [
    ("cmu-exercise/13_29.amc", 234..606),
    ("cmu-exercise/13_29.amc", 960..1350),
    ("cmu-exercise/13_29.amc", 1350..1902),
    ("cmu-exercise/13_29.amc", 1902..2296),
    ("cmu-exercise/13_30.amc", 108..402),
    ("cmu-exercise/13_30.amc", 402..708),
    ("cmu-exercise/13_30.amc", 708..966),
    ("cmu-exercise/13_30.amc", 966..1233),
    ("cmu-exercise/13_31.amc", 198..492),
    ("cmu-exercise/13_31.amc", 492..696),
    ("cmu-expmap/train_basketball_signal_3.txt", 0..1600),
    ("cmu-expmap/train_directing_traffic_1.txt", 0..1500),
    ("cmu-expmap/train_jumping_1.txt", 0..200),
    ("bandai/dataset-2_wave-both-hands_normal_001.bvh", 0..400),
    ("bandai/dataset-2_wave-both-hands_normal_002.bvh", 0..400),
    ("bandai/dataset-2_wave-right-hand_normal_001.bvh", 0..400),
    ("bandai/dataset-2_wave-right-hand_normal_002.bvh", 0..400),
    ("bandai/dataset-2_raise-up-left-hand_normal_001.bvh", 0..110),
];

#[test]
fn other_exercises_and_gestures_are_none() {
    let Some(mocap) = shared_data("mocap") else { return };
    let root = tempfile::tempdir().unwrap();
    let skeleton = mocap.join("cmu-walk/35/35.asf");
    let (mut none, mut on_foot, mut all) = (0.0, 0.0, 0.0);
    for (file, frames) in OTHERS {
        let skeleton = file.ends_with(".amc").then_some(skeleton.as_path());
        write_noisy(root.path(), &mocap.join(file), skeleton, frames.clone());
        let motions = &motions(root.path(), &BANK)[CYCLE_FRAMES..];
        let right = share(motions, "none");
        println!("{file}, frames {frames:?}: none in {right:.3} of {}", motions.len());
        none += right * motions.len() as f64;
        on_foot += (share(motions, "walking") + share(motions, "running")) * motions.len() as f64;
        all += motions.len() as f64;
    }
    println!("none in {:.3}, walking or running in {:.3} of {all} frames", none / all, on_foot / all);
    assert!(none > 0.9 * all, "{none} of {all} frames are none");
    assert!(on_foot < 0.02 * all, "{on_foot} of {all} frames are named walking or running");
}

#[test]
fn random_angles_are_none_and_the_estimate_stays_whole() {
    let root = tempfile::tempdir().unwrap();
    let mut stream = Stream::new(8, 0, 0);
    let mut row = || std::array::from_fn(|_| Some(TAU * f64::from(stream.uniform()) - TAU / 2.0));
    let rows: Vec<[Option<f64>; ANGLES]> = (0..200).map(|_| row()).collect();
    AngleTable::from_angles(0, &rows).unwrap().at_rate(Some(60.0)).write(&root.path().join("noisy.csv")).unwrap();
    let motions = motions(root.path(), &BANK);
    assert_eq!(motions.len(), 200);
    assert!(share(&motions, "none") >= 0.99, "{}", share(&motions, "none"));
    assert!(motions[100..].iter().all(|(_, probability)| *probability > 0.99));
    assert!(AngleTable::read(&root.path().join("est.csv")).is_ok(), "an estimate is an angle table");
    let mut again = sinew(root.path());
    again.args(["track", "cyclic", "noisy.csv", "--out", "est.csv", "--report", "run"]).args(BANK);
    again
        .assert()
        .success()
        .stdout(contains("motion: walking in 0, running in 0, arm-circles in 0, none in 200 frames"))
        .stdout(contains("doubt: no frame shows one of the motions walking, running, arm-circles"));
    let json = fs::read_to_string(root.path().join("run/summary.json")).unwrap();
    assert!(json.contains("walking, running, arm-circles"));
    let summary: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((summary["cycles"].as_f64(), summary["cadence_per_min"].as_f64()), (Some(0.0), None));
    let mut strict = sinew(root.path());
    strict.args(["track", "cyclic", "noisy.csv", "--out", "est.csv", "--strict"]).args(BANK);
    strict.assert().code(65).stderr(contains("no frame shows"));
}

/// The columns of a single model do not depend on the bank; a bank of a model with itself gives
/// what that model gives.
#[test]
fn one_model_has_no_motion_and_unlike_models_are_refused() {
    let root = tempfile::tempdir().unwrap();
    let walking = sinew_tests::workspace_root().join("host/models/walking.json");
    let rows: Vec<[Option<f64>; ANGLES]> =
        (0..90).map(|frame| [Some(0.3 * (TAU * f64::from(frame) / 64.0).sin()); ANGLES]).collect();
    AngleTable::from_angles(0, &rows).unwrap().at_rate(Some(60.0)).write(&root.path().join("noisy.csv")).unwrap();
    let track = |models: &[&str]| {
        let mut command = sinew(root.path());
        command.args(["track", "cyclic", "noisy.csv", "--online", "--out", "est.csv"]);
        for model in models {
            command.args(["--model", model]);
        }
        command.assert()
    };
    track(&["walking"]).success();
    let alone = fs::read_to_string(root.path().join("est.csv")).unwrap();
    assert!(!alone.contains("motion"));
    track(&["walking", walking.to_str().unwrap()]).success();
    let twice = fs::read_to_string(root.path().join("est.csv")).unwrap();
    assert_eq!(alone.lines().count(), twice.lines().count());
    for (alone, twice) in alone.lines().zip(twice.lines()) {
        assert!(twice.starts_with(alone), "{alone}\n{twice}");
    }
    let other = fs::read_to_string(&walking).unwrap();
    let mut other: serde_json::Value = serde_json::from_str(&other).unwrap();
    other["rate_hz"] = 50.0.into();
    fs::write(root.path().join("slow.json"), other.to_string()).unwrap();
    track(&["walking", "slow.json"]).code(65).stderr(contains("of 60 and 50 frames a second"));
    track(&["walking", "wlaking"]).code(65).stderr(contains("--model wlaking"));
    track(&[]).code(64).stderr(contains("--model"));
}
