//! What `sinew track cyclic` shows of a finished recording: looking back, overlays, animations.

use crate::cyclic_walk::walk;
use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew::cyclic::{AngleRow, AngleTable};
use sinew_lab::cyclic::Protocol;
use sinew_lab::cyclic::protocol::measurements;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;

fn sinew(folder: &Path, table: &str, out: &str, more: &[&str]) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(["track", "cyclic", table, "--model", "walking", "--out", out]).args(more);
    command
}

/// A column of an estimate by its name.
fn column(path: &Path, name: &str) -> Vec<String> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let index = reader.headers().unwrap().iter().position(|header| header == name).unwrap();
    reader.records().map(|record| record.unwrap()[index].to_owned()).collect()
}

#[test]
fn looking_back_replaces_angles_and_bands_and_keeps_likelihood_and_flags() {
    let root = tempfile::tempdir().unwrap();
    let truth = walk(200, 1.0 / 63.0);
    measurements(&truth, Protocol::Noisy, 0.1, 7).write(&root.path().join("noisy.csv")).unwrap();
    sinew(root.path(), "noisy.csv", "forward.csv", &[]).assert().success();
    sinew(root.path(), "noisy.csv", "back.csv", &["--smooth", "--report", "run"]).assert().success();
    let [forward, back] = ["forward.csv", "back.csv"].map(|name| root.path().join(name));
    for name in ["frame", "log_likelihood", "outlier"] {
        assert_eq!(column(&forward, name), column(&back, name), "{name}");
    }
    for name in ["cycle_position", "cycle_velocity_per_frame", "cadence_per_min", "l_knee_std_rad", "l_knee_rad"] {
        assert_ne!(column(&forward, name), column(&back, name), "{name}");
    }
    let error = |path: &Path| -> f64 {
        let table = AngleTable::read(path).unwrap();
        let both = table.rows().iter().zip(truth.rows());
        let of_row = both.map(|(found, truth)| (found.angles_rad[8].unwrap() - truth.angles_rad[8].unwrap()).abs());
        of_row.sum()
    };
    assert!(error(&back) < 0.8 * error(&forward), "{} beside {}", error(&back), error(&forward));
    let summary = fs::read_to_string(root.path().join("run/summary.json")).unwrap();
    assert!(summary.contains("\"smooth\": true"));
}

#[test]
fn a_cloud_of_particles_is_not_looked_back_over() {
    let root = tempfile::tempdir().unwrap();
    walk(20, 1.0 / 63.0).write(&root.path().join("walk.csv")).unwrap();
    let mut command = sinew(root.path(), "walk.csv", "est.csv", &["--smooth", "--filter", "particle"]);
    command.assert().code(64).stderr(contains("`smooth` needs a filter").and(contains("--filter coupled")));
    assert!(!root.path().join("est.csv").exists());
}

/// The walk as a table of keypoints: hips at (100 + f, 90) pixels, trunk 60.
fn keypoints(frames: u64) -> AngleTable {
    let columns = ["hip_center_u_px", "hip_center_v_px", "neck_length_px", "facing"].map(str::to_owned);
    let whole = walk(frames, 1.0 / 63.0);
    let rows = whole.rows().iter().map(|row| AngleRow {
        extra: vec![(100 + row.frame).to_string(), "90".into(), "60".into(), "right".into()],
        ..row.clone()
    });
    AngleTable::new(rows.collect(), columns.to_vec()).unwrap().at_rate(Some(60.0))
}

#[test]
fn overlays_and_an_animation_lie_beside_the_estimates() {
    let root = tempfile::tempdir().unwrap();
    keypoints(12).write(&root.path().join("walk.csv")).unwrap();
    let frames = root.path().join("frames");
    fs::create_dir(&frames).unwrap();
    for index in 0..10 {
        image::RgbImage::new(240, 200).save(frames.join(format!("frame_{index}.png"))).unwrap();
    }
    let more = ["--overlay", "frames", "--animation", "walk.gif"];
    let run = sinew(root.path(), "walk.csv", "est.csv", &more).assert().success();
    run.stdout(contains("overlay: 10 pictures in est_overlay").and(contains("animation: walk.gif")))
        .stderr(contains("2 rows have no image"));
    let drawn = image::open(root.path().join("est_overlay/frame_9.png")).unwrap().into_rgb8();
    assert!(drawn.pixels().filter(|pixel| pixel.0 != [0; 3]).count() > 500);
    assert!(fs::read(root.path().join("walk.gif")).unwrap().starts_with(b"GIF89a"));
    assert_eq!(column(&root.path().join("est.csv"), "frame").len(), 12);
}

#[test]
fn views_that_cannot_be_made_are_refused_before_the_run() {
    let root = tempfile::tempdir().unwrap();
    walk(12, 1.0 / 63.0).write(&root.path().join("walk.csv")).unwrap();
    fs::create_dir(root.path().join("empty")).unwrap();
    fs::create_dir(root.path().join("frames")).unwrap();
    image::RgbImage::new(40, 40).save(root.path().join("frames/0.png")).unwrap();
    let refused = |more: &[&str], message: &str| {
        sinew(root.path(), "walk.csv", "est.csv", more).assert().code(sinew_tests::REFUSED).stderr(contains(message));
        assert!(!root.path().join("est.csv").exists() && !root.path().join("est_overlay").exists(), "{more:?}");
    };
    refused(&["--overlay", "gone"], "no such folder");
    refused(&["--overlay", "empty"], "is empty");
    refused(&["--overlay", "frames"], "`overlay` needs a table with the place of the person");
    refused(&["--animation", "walk.mp4"], "`animation` has to end in .gif");
    refused(&["--animation", "empty"], "has to end in .gif");
}

/// Keypoints have no depth.
#[test]
fn two_angles_a_joint_need_a_motion_in_space() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("points.csv"), "neck_x,neck_y\n1,2\n").unwrap();
    let mut command = Command::from_std(sinew_command());
    command.current_dir(root.path()).args(["angles", "points.csv", "--view", "space", "--out", "t.csv"]);
    command.assert().code(64).stderr(contains("`--view space` needs a motion in space"));
}
