//! `sinew record` writes what the tracker of a run was given.

use clap::Parser;
use sinew::cli::{Cli, run};
use sinew::cyclic::tracking::TrackingOptions;
use sinew::cyclic::{AngleTable, CyclicModel};
use sinew::record::cyclic_stream;
use std::fs;
use std::path::Path;

fn sinew(arguments: &[&str]) -> anyhow::Result<()> {
    run(&Cli::parse_from([&["sinew"], arguments].concat()))
}

fn walk(folder: &Path) -> AngleTable {
    let model = CyclicModel::from_option("walking").unwrap();
    let numbers = model.numbers();
    let poses = numbers.mean_pose_rad.chunks(13).map(|row| std::array::from_fn(|i| Some(f64::from(row[i]))));
    let rows: Vec<_> = poses.chain(numbers.mean_pose_rad.chunks(13).map(|_| [None; 13])).collect();
    let table = AngleTable::from_angles(3, &rows).unwrap();
    let path = folder.join("walk.csv");
    table.write(&path).unwrap();
    // As the file has it: rounded.
    AngleTable::read(&path).unwrap()
}

#[test]
fn a_tracked_motion_is_recorded_with_its_options() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let table = walk(folder.path());
    let track = |more: &[&str]| {
        let (csv, est, report) = (path("walk.csv"), path("est.csv"), path("report"));
        let all = ["track", "cyclic", &csv, "--model", "walking", "--out", &est, "--report", &report];
        sinew(&[&all, more].concat()).unwrap();
    };
    track(&[
        "--online",
        "--rate",
        "50",
        "--sigma-deg",
        "3.7",
        "--update-every",
        "2",
        "--initial-cycle-velocity",
        "0.02",
    ]);
    sinew(&["record", &path("report"), "--out", &path("walk.rec")]).unwrap();
    let options = TrackingOptions {
        rate_hz: Some(50.0),
        sigma_rad: 3.7_f64.to_radians(),
        updates: sinew::cyclic::tracking::Updates::Every(2),
        initial_cycle_velocity: Some(0.02),
        ..TrackingOptions::default()
    };
    let model = CyclicModel::from_option("walking").unwrap();
    let wanted = cyclic_stream(&table, &model, &options).unwrap();
    assert!(fs::read(path("walk.rec")).unwrap() == wanted, "the streams differ");

    track(&["--online", "--rate", "50", "--filter", "paper"]);
    let refusal = format!("{:#}", sinew(&["record", &path("report"), "--out", &path("walk.rec")]).unwrap_err());
    assert!(refusal.contains("--filter coupled"), "{refusal}");

    track(&["--rate", "50"]);
    let refusal = format!("{:#}", sinew(&["record", &path("report"), "--out", &path("walk.rec")]).unwrap_err());
    assert!(refusal.contains("track it with `--online`"), "{refusal}");
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (name, out) = (folder.path().to_string_lossy().into_owned(), folder.path().join("x.rec"));
    let refusal = format!("{:#}", sinew(&["record", &name, "--out", &out.to_string_lossy()]).unwrap_err());
    assert!(refusal.contains("holds no run"), "{refusal}");
    assert!(!out.exists());
}

#[test]
fn a_tracked_arm_is_recorded_as_blobs_or_as_lines() {
    use sinew_record::{ArmInput, CameraLine, CameraSetup, Kind, RecordStream};
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    sinew(&["simulate", "arm", "--motion", "builtin", "--frames", "3", "--out", &path("scene")]).unwrap();
    let config = path("scene/camera.toml");
    let track = |more: &[&str]| {
        let (frames, run) = (path("scene/frames"), path("run"));
        sinew(&[&["track", "arm", &frames, "--out", &run, "--config", &config], more].concat()).unwrap();
    };
    let kinds = |form: &str| {
        sinew(&["record", &path("run"), "--form", form, "--out", &path("x.rec")]).unwrap();
        let bytes = fs::read(path("x.rec")).unwrap();
        let mut stream = RecordStream::<_, 1024>::new(bytes.as_slice());
        let (mut kinds, mut width) = (Vec::new(), 0);
        while let Some(record) = stream.next_record() {
            let record = record.unwrap();
            kinds.push(record.kind);
            match record.kind {
                Kind::CameraSetup => assert_eq!(record.read::<CameraSetup>().unwrap().size_px, [320, 240]),
                Kind::CameraLine => width = record.read::<CameraLine>().unwrap().pixels.len(),
                Kind::ArmInput => assert!(record.read::<ArmInput>().unwrap().has_image),
                _ => {}
            }
        }
        (kinds, width)
    };
    track(&[]);
    let (tracker, _) = kinds("tracker");
    assert_eq!((tracker[0], tracker.iter().filter(|kind| **kind == Kind::ArmInput).count()), (Kind::ArmSetup, 3));
    let (camera, width) = kinds("camera");
    assert_eq!((camera.iter().filter(|kind| **kind == Kind::CameraLine).count(), width), (3 * 240, 320));
    track(&["--variant", "bootstrap"]);
    let refusal = sinew(&["record", &path("run"), "--out", &path("x.rec")]).unwrap_err();
    assert!(format!("{refusal:#}").contains("defaults of [tracker]"), "{refusal:#}");
}
