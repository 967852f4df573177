//! `sinew evaluate body` as a user types it.

use assert_cmd::Command;
use predicates::str::contains;
use serde_json::Value;
use sinew_tests::sinew_command;
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
fn what_cannot_be_evaluated_is_named() {
    let root = tempfile::tempdir().unwrap();
    for (arguments, message) in [
        (["--motion", "nowhere.bvh", "--particles", "10"], "nowhere.bvh"),
        (["--motion", "pelvic-lift@7-2", "--particles", "10"], "START-END"),
        (["--motion", "pelvic-lift", "--particles", "0"], "--particles must be whole numbers from 1 to 16384"),
        (["--motion", "pelvic-lift", "--trials", "0"], "--trials must be greater than zero"),
    ] {
        let mut command = sinew(root.path());
        command.args(arguments).args(["--out", "out"]).assert().failure().stderr(contains(message));
    }
}
