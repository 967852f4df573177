//! What `sinew track cyclic` shows of a finished recording: looking back, overlays, animations.

mod cyclic_walk;

use assert_cmd::Command;
use cyclic_walk::walk;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew::cyclic::AngleTable;
use sinew::evaluate::cyclic::Protocol;
use sinew::evaluate::cyclic::protocol::measurements;
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
    command.assert().code(1).stderr(contains("`smooth` needs a filter").and(contains("--filter coupled")));
    assert!(!root.path().join("est.csv").exists());
}
