//! `sinew track cyclic` as a user types it.

use crate::cyclic_walk::walk;
use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::export::trc::MARKERS;
use sinew::cyclic::{AngleRow, AngleTable};
use sinew_lab::cyclic::Protocol;
use sinew_lab::cyclic::protocol::measurements;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(["track", "cyclic"]);
    command
}

fn track(folder: &Path, table: &str, out: &str, more: &[&str]) {
    sinew(folder).args([table, "--model", "walking", "--out", out]).args(more).assert().success();
}

/// A column of an estimate by its name.
fn column(path: &Path, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let index = reader.headers().unwrap().iter().position(|header| header == name).unwrap();
    reader.records().map(|record| record.unwrap()[index].parse().unwrap()).collect()
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_walk_gives_its_cadence_one_row_an_input_row_and_the_same_bytes_again() {
    let root = tempfile::tempdir().unwrap();
    walk(480, 1.0 / 66.0).write(&root.path().join("walk.csv")).unwrap();
    for out in ["est.csv", "deep/er/est.csv"] {
        let mut command = sinew(root.path());
        command.args(["walk.csv", "--model", "walking", "--out", out]);
        command.assert().success().stdout(contains("480 frames, 7.98 s").and(contains("wrote")));
    }
    let path = root.path().join("est.csv");
    assert_eq!(fs::read(&path).unwrap(), fs::read(root.path().join("deep/er/est.csv")).unwrap());
    assert_eq!(column(&path, "frame"), (0..480).map(f64::from).collect::<Vec<_>>());
    let cycles = column(&path, "cycles")[479];
    assert!((cycles - 479.0 / 66.0).abs() < 0.1, "{cycles}");
    let cadence = column(&path, "cadence_per_min");
    assert!(cadence[200..].iter().all(|cadence| (cadence - 3600.0 / 66.0).abs() < 4.0), "{cadence:?}");
    assert!(column(&path, "cycle_position").iter().all(|position| (0.0..1.0).contains(position)));
    assert!(column(&path, "l_knee_std_rad")[1..].iter().all(|std| *std > 0.0 && *std < 0.5));
    assert!(AngleTable::read(&path).is_ok(), "an estimate is an angle table");
}

/// Half the rate with half the frames is the same motion.
#[test]
fn the_rate_scales_cadence_and_velocity() {
    let root = tempfile::tempdir().unwrap();
    walk(200, 2.0 / 64.0).at_rate(Some(30.0)).write(&root.path().join("slow.csv")).unwrap();
    track(root.path(), "slow.csv", "est.csv", &["--rate", "30"]);
    let path = root.path().join("est.csv");
    let (cadence, velocity) = (column(&path, "cadence_per_min"), column(&path, "cycle_velocity_per_frame"));
    let truth = 30.0 * 60.0 * 2.0 / 64.0;
    assert!((cadence[199] - truth).abs() < 0.08 * truth, "{}", cadence[199]);
    assert!((velocity[199] * 1800.0 - cadence[199]).abs() < 0.01);
    let cycles = column(&path, "cycles")[199];
    assert!((cycles - 199.0 / 32.0).abs() < 0.1, "{cycles}");
}

#[test]
fn skipped_frames_and_missing_cells_are_missing_measurements() {
    let root = tempfile::tempdir().unwrap();
    let whole = walk(400, 1.0 / 62.0);
    let rows = whole.rows().iter().filter(|row| row.frame % 5 != 3).cloned();
    let rows = rows.map(|mut row| {
        if row.frame > 0 && row.frame % 2 == 0 {
            row.angles_rad[9] = None;
        }
        if (100..120).contains(&row.frame) {
            row.angles_rad = [None; ANGLES];
        }
        row
    });
    let table = AngleTable::new(rows.collect(), Vec::new()).unwrap().at_rate(Some(60.0));
    table.write(&root.path().join("gaps.csv")).unwrap();
    track(root.path(), "gaps.csv", "est.csv", &["--online"]);
    let path = root.path().join("est.csv");
    let frames = column(&path, "frame");
    assert_eq!(frames.len(), 320);
    assert!(frames.iter().all(|frame| frame % 5.0 != 3.0));
    let std = column(&path, "l_hip_std_rad");
    let at = |frame: f64| frames.iter().position(|other| *other == frame).unwrap();
    assert!(std[at(117.0)] > 1.2 * std[at(97.0)], "{} after a gap, {} before", std[at(117.0)], std[at(97.0)]);
    assert!(column(&path, "log_likelihood")[at(110.0)] == 0.0, "a row without a measurement has no likelihood");
    let cycles = *column(&path, "cycles").last().unwrap();
    assert!((cycles - 399.0 / 62.0).abs() < 0.1, "{cycles}");
}

/// The rows that are not used do not matter at all.
#[test]
fn only_every_kth_measurement_is_used() {
    let root = tempfile::tempdir().unwrap();
    let whole = walk(90, 1.0 / 60.0);
    let thin = whole.rows().iter().map(|row| AngleRow {
        angles_rad: if row.frame % 8 == 0 { row.angles_rad } else { [None; ANGLES] },
        ..row.clone()
    });
    let thin = AngleTable::new(thin.collect(), Vec::new()).unwrap().at_rate(Some(60.0));
    whole.write(&root.path().join("whole.csv")).unwrap();
    thin.write(&root.path().join("thin.csv")).unwrap();
    track(root.path(), "whole.csv", "every.csv", &["--update-every", "8"]);
    let at: Vec<String> = (0..90).step_by(8).map(|frame| frame.to_string()).collect();
    track(root.path(), "whole.csv", "at.csv", &["--update-at", &at.join(",")]);
    track(root.path(), "thin.csv", "thin_est.csv", &[]);
    track(root.path(), "whole.csv", "all.csv", &[]);
    let [every, at, thin, all] =
        ["every.csv", "at.csv", "thin_est.csv", "all.csv"].map(|name| fs::read(root.path().join(name)).unwrap());
    assert!(every == thin && every == at && every != all);
}

/// What docs/sigma.md advises: the sigma with the greatest likelihood is that of the noise.
#[test]
fn the_likelihood_is_greatest_at_the_noise_that_is_there() {
    let root = tempfile::tempdir().unwrap();
    let noisy = measurements(&walk(300, 1.0 / 62.0), Protocol::Noisy, 6.0_f64.to_radians(), 5);
    noisy.write(&root.path().join("noisy.csv")).unwrap();
    let likelihoods = ["2", "6", "18"].map(|sigma| {
        track(root.path(), "noisy.csv", "est.csv", &["--sigma-deg", sigma]);
        column(&root.path().join("est.csv"), "log_likelihood").iter().sum::<f64>()
    });
    assert!(likelihoods[1] > likelihoods[0] && likelihoods[1] > likelihoods[2], "{likelihoods:?}");
}

#[test]
fn options_out_of_range_are_refused_by_name_before_anything_is_written() {
    let root = tempfile::tempdir().unwrap();
    walk(30, 1.0 / 60.0).write(&root.path().join("walk.csv")).unwrap();
    let refused = |more: &[&str], message: &str| {
        let mut command = sinew(root.path());
        command.args(["walk.csv", "--model", "walking", "--out", "est.csv"]).args(more);
        command.assert().failure().stderr(contains(message));
        assert_eq!(files(root.path()), ["walk.csv"], "{more:?}");
    };
    refused(&["--sigma-deg", "0"], "`sigma` has to be greater than zero");
    refused(&["--sigma-deg=-6"], "`sigma` has to be greater than zero");
    refused(&["--sigma-deg", "NaN"], "`sigma` has to be greater than zero");
    refused(&["--sigma-deg", "inf"], "`sigma` has to be greater than zero");
    refused(&["--rate", "0"], "`rate` has to be greater than zero");
    refused(&["--rate", "0.01"], "say 60 frames a second");
    refused(&["--update-every", "0"], "`update-every` has to be at least 1");
    refused(&["--initial-cycle-position", "1"], "`initial-cycle-position` has to lie in [0, 1)");
    refused(&["--initial-cycle-velocity", "0.7"], "`initial-cycle-velocity` has to lie within");
    refused(&["--height", "17"], "`height` has to lie from 0.3 to 3 metres");
    refused(&["--update-every", "2", "--update-at", "3"], "cannot be used with");
}

#[test]
fn broken_tables_are_refused_with_file_line_and_rule() {
    let root = tempfile::tempdir().unwrap();
    let good = walk(20, 1.0 / 60.0).to_csv().unwrap();
    let lines: Vec<&str> = good.lines().collect();
    // Line 12 is frame 10.
    let with = |line: String| {
        let mut lines: Vec<String> = lines.iter().map(ToString::to_string).collect();
        lines[11] = line;
        lines.join("\n")
    };
    let cell = |index: usize, value: &str| {
        let mut cells: Vec<&str> = lines[11].split(',').collect();
        cells[index] = value;
        with(cells.join(","))
    };
    let refused = |text: &str, messages: &[&str]| {
        fs::write(root.path().join("bad.csv"), text).unwrap();
        let mut command = sinew(root.path());
        let mut run = command.args(["bad.csv", "--model", "walking", "--out", "est.csv"]).assert().code(65);
        for message in messages {
            run = run.stderr(contains(*message));
        }
        assert_eq!(files(root.path()), ["bad.csv"], "{messages:?}");
    };
    refused(&cell(3, "NaN"), &["bad.csv:12", "`l_elbow_rad` is `NaN`, but has to be finite"]);
    refused(&cell(13, "-inf"), &["bad.csv:12", "`r_ankle_rad` is `-inf`"]);
    refused(&cell(1, "1e999"), &["bad.csv:12", "`neck_rad`"]);
    refused(&cell(1, "left"), &["bad.csv:12", "`neck_rad`"]);
    refused(&with("10,0.1,0.2".into()), &["bad.csv:12", "15 columns as the header has, found 3"]);
    refused(&with(format!("{},1.0", lines[11])), &["bad.csv:12", "found 16"]);
    refused(&cell(0, "9"), &["bad.csv:12", "frame 9 follows frame 9"]);
    refused(&cell(0, "4"), &["bad.csv:12", "frame 4 follows frame 9"]);
    refused(&cell(0, "-4"), &["bad.csv:12", "`frame`"]);
    refused("", &["bad.csv:1", "the table is empty"]);
    refused(&format!("{}\n", lines[0]), &["bad.csv:2", "the table is empty"]);
    refused("a,b\n1,2\n", &["bad.csv:1", "column 1 has to be `frame`"]);
}

#[test]
fn what_is_no_model_or_no_table_is_refused_with_its_name() {
    let root = tempfile::tempdir().unwrap();
    walk(20, 1.0 / 60.0).write(&root.path().join("walk.csv")).unwrap();
    let shipped = fs::read_to_string(sinew_tests::workspace_root().join("host/models/walking.json")).unwrap();
    let changed = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut value: serde_json::Value = serde_json::from_str(&shipped).unwrap();
        change(&mut value);
        fs::write(root.path().join("m.json"), value.to_string()).unwrap();
    };
    let refused = |table: &str, model: &str, messages: &[&str]| {
        let mut command = sinew(root.path());
        let mut run = command.args([table, "--model", model, "--out", "est.csv"]).assert().code(sinew_tests::REFUSED);
        for message in messages {
            run = run.stderr(contains(*message));
        }
        assert!(!root.path().join("est.csv").exists());
    };
    changed(&|value| value["version"] = 7.into());
    refused("walk.csv", "m.json", &["m.json", "`version` is 7, but this program reads version 1"]);
    changed(&|value| value["acceleration_covariance"][7][1] = 1.0.into());
    refused("walk.csv", "m.json", &["m.json", "cycle position 7", "positive semi-definite"]);
    changed(&|value| value["acceleration_covariance"][0][0] = (-0.01).into());
    refused("walk.csv", "m.json", &["cycle position 0", "positive semi-definite"]);
    fs::write(root.path().join("m.json"), "{").unwrap();
    refused("walk.csv", "m.json", &["m.json", "not JSON", "sinew train cyclic"]);
    refused("walk.csv", "wlaking", &["--model wlaking", "walking, running"]);
    refused("gone.csv", "walking", &["gone.csv` cannot be read"]);
}

/// Before the run: nothing is read, nothing else written.
#[test]
fn an_output_that_cannot_be_written_is_refused_first() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("file"), "").unwrap();
    fs::create_dir(root.path().join("folder")).unwrap();
    for (out, message) in [("folder", "is a folder"), ("file/est.csv", "is a file")] {
        let mut command = sinew(root.path());
        command.args(["gone.csv", "--model", "walking", "--out", out]).assert().code(73).stderr(contains(message));
    }
    let mut command = sinew(root.path());
    command.args(["gone.csv", "--model", "walking", "--out", "est.csv", "--report", "file"]);
    command.assert().code(73).stderr(contains("`file` is a file"));
    assert_eq!(files(root.path()), ["file", "folder"]);
}

#[test]
fn the_report_holds_what_a_coach_reads() {
    let root = tempfile::tempdir().unwrap();
    walk(420, 1.0 / 60.0).write(&root.path().join("walk.csv")).unwrap();
    track(root.path(), "walk.csv", "est.csv", &["--report", "out/run", "--seed", "9", "--sigma-deg", "4"]);
    let folder = root.path().join("out/run");
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("summary.json")).unwrap()).unwrap();
    assert_eq!((json["seed"].as_u64(), json["frames"].as_u64()), (Some(9), Some(420)));
    assert!((json["options"]["sigma_deg"].as_f64().unwrap() - 4.0).abs() < 1.0e-9);
    assert!((json["cadence_per_min"].as_f64().unwrap() - 60.0).abs() < 1.5, "{}", json["cadence_per_min"]);
    let count = json["repetitions"].as_array().unwrap().len();
    assert!((5..=6).contains(&count), "{count}");
    let starts = json["cycle_starts_s"].as_array().unwrap();
    assert_eq!(starts.len(), count + 1);
    let rows = |name: &str| fs::read_to_string(folder.join(name)).unwrap().lines().count();
    assert_eq!((rows("repetitions.csv"), rows("curves.csv"), rows("symmetry.csv")), (count + 1, 102, 5));
    assert_eq!((rows("anatomical.csv"), rows("angles.mot")), (421, 427));
    let trc = fs::read_to_string(folder.join("joints.trc")).unwrap();
    assert!(!folder.join("joints_px.csv").exists(), "this table has no pixels");
    assert!(MARKERS.iter().all(|marker| trc.contains(marker)) && trc.lines().count() == 426);
    for hip in json["symmetry"].as_array().unwrap().iter().filter(|joint| joint["angle"] == "hip_flexion") {
        let lag = hip["right_lag_cycles"].as_f64().unwrap();
        assert!((lag - 0.5).abs() < 0.06, "legs of a walker take turns: {lag}");
    }
    let pictures: Vec<String> = files(&folder).into_iter().filter(|name| name.ends_with(".png")).collect();
    assert_eq!(pictures.len(), 14, "{pictures:?}");
    for name in pictures {
        let picture = image::open(folder.join(&name)).unwrap().into_rgb8();
        let inked = picture.pixels().filter(|pixel| pixel.0 != [255; 3]).count();
        assert!(picture.width() > 600 && inked > 2000, "{name}: {inked} pixels");
    }
}

/// A recording of less than a cycle has no repetition, and says so with empty tables instead of
/// failing.
#[test]
fn a_short_recording_has_a_report_without_cycles() {
    let root = tempfile::tempdir().unwrap();
    walk(3, 1.0 / 60.0).write(&root.path().join("short.csv")).unwrap();
    track(root.path(), "short.csv", "est.csv", &["--report", "run"]);
    let text = fs::read_to_string(root.path().join("run/repetitions.csv")).unwrap();
    assert_eq!(text.lines().count(), 1);
    assert!(!root.path().join("run/curves_knee_flexion.png").exists());
    walk(1, 1.0 / 60.0).write(&root.path().join("one.csv")).unwrap();
    track(root.path(), "one.csv", "one_est.csv", &["--rate", "60", "--report", "one"]);
    assert_eq!(column(&root.path().join("one_est.csv"), "frame"), [0.0]);
}
