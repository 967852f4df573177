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
    track(&["--rate", "50", "--sigma-deg", "3.7", "--update-every", "2", "--initial-cycle-velocity", "0.02"]);
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

    track(&["--filter", "paper"]);
    let refusal = format!("{:#}", sinew(&["record", &path("report"), "--out", &path("walk.rec")]).unwrap_err());
    assert!(refusal.contains("--filter coupled"), "{refusal}");
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (name, out) = (folder.path().to_string_lossy().into_owned(), folder.path().join("x.rec"));
    let refusal = format!("{:#}", sinew(&["record", &name, "--out", &out.to_string_lossy()]).unwrap_err());
    assert!(refusal.contains("holds no run"), "{refusal}");
    assert!(!out.exists());
}
