//! `sinew evaluate body` as a user types it.

use assert_cmd::Command;
use predicates::str::contains;
use serde_json::Value;
use sinew_tests::{shared_data, sinew_command};
use std::fs;
use std::path::Path;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(["evaluate", "body"]);
    command
}

#[test]
fn one_command_writes_report_table_and_figures() {
    let root = tempfile::tempdir().unwrap();
    let mut command = sinew(root.path());
    command.args(["--motion", "pelvic-lift", "--models", "pelvic-lift,angular", "--particles", "10,20"]);
    command.args(["--trials", "2", "--out", "out"]).assert().success().stdout(contains("mean error over the motions"));
    let out = root.path().join("out");
    let report: Value = serde_json::from_slice(&fs::read(out.join("report.json")).unwrap()).unwrap();
    let results = report["results"].as_array().unwrap();
    assert_eq!(results.len(), 4);
    for cell in results {
        assert_eq!(cell["motion"], "pelvic-lift");
        for measured in ["error_m", "joint_error_m", "smoothness_m"] {
            let mean = cell[measured]["mean"].as_f64().unwrap();
            assert!(mean > 0.0 && mean < 1.0, "{measured}: {mean}");
            assert!(cell[measured]["std"].is_number() && cell[measured]["ci95"].is_number());
        }
        let lost = cell["lost_joint_share"]["mean"].as_f64().unwrap();
        assert!((0.0..=1.0).contains(&lost), "{lost}");
        assert!(cell["truth_smoothness_m"].as_f64().unwrap() > 0.0);
        assert!(cell["seconds_per_frame"].as_f64().unwrap() > 0.0);
    }
    let table = fs::read_to_string(out.join("table.csv")).unwrap();
    assert_eq!(table.lines().count(), 5, "{table}");
    for figure in ["figure_13_error.png", "figure_14_smoothness.png", "figure_15_time.png", "joint_error.png"] {
        assert!(out.join(figure).is_file(), "{figure}");
    }
    predictions_have_spread_and_blocks(&report, &out);
}

/// Figures 2, 19 and 20 with their numbers.
fn predictions_have_spread_and_blocks(report: &Value, out: &Path) {
    for figure in ["figure_2_spread.png", "figure_19_samples.png", "figure_20_precision.png"] {
        assert!(fs::metadata(out.join(figure)).unwrap().len() > 4000, "{figure}");
    }
    let chains = &report["predictions"]["chain_spread"];
    assert_eq!((chains["poses"].as_u64(), chains["kappa"].as_f64()), (Some(100), Some(500.0)));
    let spread = |joint: &str, model: &str| {
        let joints = chains["joints"].as_array().unwrap();
        joints.iter().find(|row| row["joint"] == joint).unwrap()[model].as_f64().unwrap()
    };
    for [middle, end] in [["l_elbow", "l_wrist"], ["r_elbow", "r_wrist"], ["l_knee", "l_ankle"]] {
        assert!(spread(end, "angular_m") > 1.1 * spread(middle, "angular_m"), "{end}");
        assert!(spread(end, "end_effector_m") < spread(middle, "end_effector_m"), "{end}");
    }
    let lift = &report["predictions"]["pelvic_lift"];
    assert_eq!(lift["samples"], 10);
    let precision = |part: &str| lift["precision"][part].as_f64().unwrap();
    assert!(precision("inside") > 4.0 * precision("between"), "{lift}");
    assert_eq!(precision("apart"), 0.0);
}

#[test]
fn hidden_arms_are_counted_and_listed_one_by_one() {
    let root = tempfile::tempdir().unwrap();
    let mut command = sinew(root.path());
    command.args(["--motion", "pelvic-lift", "--models", "pelvic-lift", "--particles", "20", "--hide-arms", "40"]);
    command
        .args(["--trials", "1", "--out", "out"])
        .assert()
        .success()
        .stdout(contains("hidden arms, pelvic-lift with 20"));
    let report: Value = serde_json::from_slice(&fs::read(root.path().join("out/report.json")).unwrap()).unwrap();
    let arms = report["hidden_arms"].as_array().unwrap();
    // 198 frames: 16 before the first, 60 from one to the next, 50 from the last on.
    let starts: Vec<u64> = arms.iter().map(|arm| arm["hidden"]["frames"]["start"].as_u64().unwrap()).collect();
    assert_eq!(starts, [16, 76, 136]);
    for arm in arms {
        for number in ["error_before_m", "error_hidden_m", "spread_before_m", "spread_hidden_m"] {
            let metres = arm[number].as_f64().unwrap();
            assert!(metres > 0.0 && metres < 1.0, "{number}: {metres}");
        }
    }
    let summary = &report["hidden_arm_summaries"][0];
    assert_eq!(summary["arms"], 3);
    assert!((0.0..=1.0).contains(&summary["as_wanted"].as_f64().unwrap()));
}

/// Eq. (34) over the markers that were glued to a person.
#[test]
fn recorded_markers_of_a_c3d_are_scored() {
    let Some(take) = shared_data("mocap/hdm05/HDM_dg_06-03_03_120.c3d") else { return };
    let root = tempfile::tempdir().unwrap();
    let error_m = |words: &[&str]| {
        let mut command = sinew(root.path());
        command.arg("--motion").arg(&take).args(["--models", "guided", "--particles", "50", "--trials", "1"]);
        command.args(words).args(["--out", "out"]).assert().success().stdout(contains("recorded markers of HDM"));
        let report: Value = serde_json::from_slice(&fs::read(root.path().join("out/report.json")).unwrap()).unwrap();
        let cell = &report["results"][0];
        let floor_m = cell["recorded_floor_m"].as_f64().unwrap();
        assert!((0.028..0.036).contains(&floor_m), "the nearest pose is {floor_m} m off");
        cell["recorded_error_m"]["mean"].as_f64().unwrap()
    };
    for words in [&[][..], &["--hide", "r_arm:8-20"], &["--heading", "90"]] {
        let error_m = error_m(words);
        assert!((0.032..0.075).contains(&error_m), "{words:?}: {error_m}");
    }
}

#[test]
fn what_cannot_be_evaluated_is_named() {
    let root = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (["--motion", "nowhere.bvh", "--particles", "10"], "nowhere.bvh"),
        (["--motion", "pelvic-lift@7-2", "--particles", "10"], "START-END"),
        (["--motion", "pelvic-lift", "--particles", "0"], "--particles must be whole numbers from 1 to 16384"),
        (["--motion", "pelvic-lift", "--trials", "0"], "--trials must be greater than zero"),
        (["--motion", "pelvic-lift", "--hide-arms", "0"], "--hide-arms must be greater than zero"),
        (["--motion", "pelvic-lift", "--hide", "l_arm:5-900"], "has no frame 900 to hide; the last one is 197"),
        (["--motion", "pelvic-lift", "--heading", "90"], "--heading is for motion files"),
        (["--motion", "pelvic-lift", "--heading", "nan"], "--heading has to be finite"),
    ] {
        let mut command = sinew(root.path());
        command.args(arguments).args(["--out", "out"]).assert().failure().stderr(contains(message));
    }
}
