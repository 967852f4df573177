//! `sinew evaluate cyclic` as a user types it.

use crate::cyclic_walk::walk;
use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(["evaluate", "cyclic"]);
    command
}

fn write_input(folder: &Path) {
    walk(130, 1.0 / 60.0).write(&folder.join("a.csv")).unwrap();
    walk(130, 1.0 / 64.0).write(&folder.join("b.csv")).unwrap();
    fs::write(folder.join("cuts.csv"), "file,start_frame,end_frame\na.csv,0,60\nb.csv,0,64\n").unwrap();
}

#[test]
fn the_tables_and_figures_come_from_one_command() {
    let root = tempfile::tempdir().unwrap();
    write_input(root.path());
    for out in ["one", "two"] {
        let mut command = sinew(root.path());
        command.args(["--test", "cuts.csv", "--seeds", "1", "--particles", "none", "--out", out]);
        command.assert().success().stdout(
            contains("2 test cycles, 124 frames").and(contains("exact-mean").and(contains("\n  --smooth").count(2))),
        );
    }
    let folder = root.path().join("one");
    for name in ["cyclic.json", "cyclic.csv"] {
        assert_eq!(fs::read(folder.join(name)).unwrap(), fs::read(root.path().join("two").join(name)).unwrap());
    }
    let mut reader = csv::Reader::from_path(folder.join("cyclic.csv")).unwrap();
    let headers = reader.headers().unwrap().clone();
    let place = |name: &str| headers.iter().position(|header| header == name).unwrap();
    let error = place("error_deg");
    let (mut cells, mut filtered, mut smoothed) = (0, 0.0, 0.0);
    for record in reader.records() {
        let record = record.unwrap();
        let error: f64 = record[error].parse().unwrap();
        assert!(error > 0.0 && error < 60.0, "{record:?}");
        if &record[place("sigma_deg")] == "1" {
            assert!(error < 1.5, "{record:?}");
        }
        if &record[place("protocol")] == "noisy" && &record[place("filter")] == "coupled" {
            filtered += if &record[0] == "table-1" { error } else { 0.0 };
            smoothed += if &record[0] == "smoothed" { error } else { 0.0 };
        }
        cells += 1;
    }
    assert!(cells >= 24, "{cells} cells");
    assert!(smoothed > 0.3 * filtered && smoothed < filtered, "looking back helps: {smoothed} beside {filtered}");
    for name in ["figure_3_left_foot.png", "figure_3_left_hand.png", "figure_4a_paper.png", "figure_4b.png"] {
        assert!(image::open(folder.join(name)).is_ok(), "{name}");
    }
}

#[test]
fn bad_input_is_refused_with_file_line_and_rule() {
    let root = tempfile::tempdir().unwrap();
    write_input(root.path());
    let refused = |cuts: &str, more: &[&str], messages: &[&str]| {
        fs::write(root.path().join("c.csv"), format!("file,start_frame,end_frame\n{cuts}")).unwrap();
        let mut command = sinew(root.path());
        let mut run = command.args(["--test", "c.csv", "--out", "out"]).args(more).assert().code(sinew_tests::REFUSED);
        for message in messages {
            run = run.stderr(contains(*message));
        }
        assert!(!root.path().join("out/cyclic.json").exists());
    };
    let good = "a.csv,0,60\n";
    refused("a.csv,0,60\nb.csv,100,131\n", &[], &["c.csv:3", "100 to 131", "b.csv", "0 to 130"]);
    refused("a.csv,60,0\n", &[], &["c.csv:2", "`end_frame` 0 has to lie after"]);
    refused("a.csv,5,6\n", &[], &["c.csv:2", "needs two frames"]);
    refused("", &[], &["c.csv:1", "the list is empty"]);
    refused("gone.csv,0,60\n", &[], &["gone.csv` cannot be read"]);
    refused(good, &["--seeds", "0"], &["--seeds must be greater than zero"]);
    refused(good, &["--rate", "NaN"], &["--rate must be greater than zero"]);
    refused(good, &["--particles", "0"], &["`--particles 0`"]);
    refused(good, &["--model", "wlaking"], &["--model wlaking", "walking, running"]);
    refused(good, &["--train", "c.csv"], &["c.csv:2", "one training cycle only"]);
    fs::write(root.path().join("file"), "").unwrap();
    let mut command = sinew(root.path());
    command.args(["--test", "gone.csv", "--out", "file"]).assert().code(73).stderr(contains("is a file"));
}
