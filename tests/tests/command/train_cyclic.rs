//! `sinew train cyclic` as a user types it.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew::cyclic::{CyclicModel, angle_table, model_file};
use sinew_tests::{shared_data, sinew_command};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

fn sinew(folder: &Path) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(["train", "cyclic"]);
    command
}

/// 200 frames in which every angle swings with a period of 60 frames; one cell can be given.
fn table(amplitude: f64, change: Option<(usize, usize, &str)>) -> String {
    let mut text = angle_table::COLUMNS.join(",") + "\n";
    for frame in 0..200 {
        let mut cells = vec![frame.to_string()];
        cells.extend((0..13).map(|i| format!("{:.6}", amplitude * (TAU * (frame + i) as f64 / 60.0).sin())));
        if let Some((row, column, cell)) = change
            && row == frame
        {
            cells[column] = cell.to_owned();
        }
        writeln!(text, "{}", cells.join(",")).unwrap();
    }
    text
}

fn write_input(folder: &Path) {
    fs::create_dir_all(folder.join("tables")).unwrap();
    fs::write(folder.join("tables/a.csv"), table(0.4, None)).unwrap();
    fs::write(folder.join("tables/b.csv"), table(0.6, None)).unwrap();
    fs::write(folder.join("cuts.csv"), "file,start_frame,end_frame\ntables/a.csv,10,70\ntables/b.csv,20,80\n").unwrap();
}

#[test]
fn two_cycles_train_a_model_and_the_same_one_each_time() {
    let root = tempfile::tempdir().unwrap();
    write_input(root.path());
    for out in ["m.json", "deep/er/m.json"] {
        let mut command = sinew(root.path());
        command
            .args(["--cuts", "cuts.csv", "--length", "50", "--rate", "30", "--out", out])
            .assert()
            .success()
            .stdout(contains("50 positions from 2 cycles of 2 tables").and(contains("30.0 cycles per minute")));
    }
    let model = fs::read(root.path().join("m.json")).unwrap();
    assert_eq!(model, fs::read(root.path().join("deep/er/m.json")).unwrap());
    let model = CyclicModel::from_option(root.path().join("m.json").to_str().unwrap()).unwrap();
    assert_eq!((model.view().position_count(), model.view().rate_hz()), (50, 30.0));
}

#[test]
fn bad_input_is_refused_with_file_line_and_rule() {
    let root = tempfile::tempdir().unwrap();
    write_input(root.path());
    let refused = |what: &str, tables: &str, cuts: &str, messages: &[&str]| {
        fs::write(root.path().join("tables/c.csv"), tables).unwrap();
        fs::write(root.path().join("c.csv"), format!("file,start_frame,end_frame\n{cuts}")).unwrap();
        let mut command = sinew(root.path());
        let mut run = command.args(["--cuts", "c.csv", "--out", "m.json"]).assert().code(sinew_tests::REFUSED);
        for message in messages {
            run = run.stderr(contains(*message));
        }
        assert!(!root.path().join("m.json").exists(), "{what}");
    };
    let both = "tables/a.csv,10,70\ntables/c.csv,10,70\n";
    let row = |line: &str| table(0.4, None).lines().take(10).collect::<Vec<_>>().join("\n") + "\n" + line + "\n";
    refused(
        "NaN",
        &table(0.4, Some((20, 3, "NaN"))),
        both,
        &["c.csv:22", "`l_elbow_rad` is `NaN`, but has to be finite"],
    );
    refused("inf", &table(0.4, Some((20, 13, "-inf"))), both, &["c.csv:22", "`r_ankle_rad` is `-inf`"]);
    refused("short row", &row("9,1,2"), both, &["c.csv:11", "14 columns as the header has, found 3"]);
    refused("long row", &row("9,1,2,3,4,5,6,7,8,9,10,11,12,13,14"), both, &["c.csv:11", "found 15"]);
    refused("frame back", &table(0.4, Some((20, 0, "5"))), both, &["c.csv:22", "frame 5 follows frame 19"]);
    refused("header only", &(angle_table::COLUMNS.join(",") + "\n"), both, &["c.csv:2", "the table is empty"]);
    refused("nothing", "", both, &["c.csv:1", "the table is empty"]);
    refused("other header", "a,b\n1,2\n", both, &["c.csv:1", "column 1 has to be `frame`, found `a`"]);
    let gone: String =
        table(0.4, None).lines().filter(|line| !line.starts_with("3")).fold(String::new(), |t, l| t + l + "\n");
    refused("a gap", &gone, both, &["c.csv:3", "`neck_rad` is missing between the frames 29 and 40"]);
    let good = table(0.4, None);
    refused("one cycle", &good, "tables/a.csv,10,70\n", &["c.csv:2", "one training cycle only", "covariance"]);
    refused(
        "outside",
        &good,
        "tables/a.csv,10,70\ntables/a.csv,150,201\n",
        &["c.csv:3", "a.csv`", "150 to 201", "frames 0 to 199"],
    );
    refused("backwards", &good, "tables/a.csv,70,10\n", &["c.csv:2", "`end_frame` 10 has to lie after"]);
    refused("no table", &good, "tables/d.csv,10,70\n", &["d.csv` cannot be read"]);
    refused("no cut", &good, "", &["c.csv:1", "the list is empty"]);
    let option = |option: [&str; 2], message: &'static str| {
        let mut command = sinew(root.path());
        command
            .args(["--cuts", "cuts.csv", "--out", "m.json"])
            .args(option)
            .assert()
            .code(64)
            .stderr(contains(message));
    };
    option(["--rate", "0"], "`rate` has to be greater than zero, not 0");
    option(["--rate", "NaN"], "`rate` has to be greater than zero");
    option(["--length", "5"], "`length` has to lie from 10 to 1000, not 5");
}

#[test]
fn an_angle_that_winds_in_some_cycles_only_is_reported() {
    let root = tempfile::tempdir().unwrap();
    write_input(root.path());
    let train = |cuts: &str| {
        fs::write(root.path().join("c.csv"), format!("file,start_frame,end_frame\n{cuts}")).unwrap();
        sinew(root.path()).args(["--cuts", "c.csv", "--rate", "60", "--out", "m.json"]).assert().success()
    };
    train("tables/a.csv,10,70\ntables/b.csv,20,80\n").stderr(predicates::str::is_empty());
    // The right wrist goes round once in 60 frames, backwards.
    let winding = table(0.4, None).lines().enumerate().fold(String::new(), |mut text, (line, row)| {
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        if line > 0 {
            cells[7] = format!("{:.6}", -TAU * (line as f64 / 60.0).fract());
        }
        writeln!(text, "{}", cells.join(",")).unwrap();
        text
    });
    fs::write(root.path().join("tables/w.csv"), winding).unwrap();
    let note = "note: `r_wrist_rad` winds unevenly: -1 turns in 1 of the cycles, 0 turns in 2 of the cycles;";
    train("tables/a.csv,10,70\ntables/b.csv,20,80\ntables/w.csv,20,80\n")
        .stderr(contains(note).and(contains("note").count(1)));
    train("tables/w.csv,10,70\ntables/w.csv,70,130\n").stderr(predicates::str::is_empty());
}

#[test]
fn help_names_every_shipped_model() {
    for command in [["track", "cyclic"], ["evaluate", "cyclic"]] {
        let mut help = Command::from_std(sinew_command());
        help.args(command).arg("--help").assert().success().stdout(contains("MODEL.json|walking|running|arm-circles"));
    }
}

/// The shipped models are what the commands make of motion capture.
#[test]
fn the_shipped_walking_is_what_the_commands_make() {
    let Some(walks) = shared_data("mocap/cmu-walk") else { return };
    let root = tempfile::tempdir().unwrap();
    let list = include_str!("../../../host/models/cuts/walking.csv");
    fs::write(root.path().join("cuts.csv"), list).unwrap();
    let tables: BTreeSet<&str> = list.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    for table in tables {
        let (subject, trial) = (&table[..2], table.strip_suffix(".csv").unwrap());
        let mut command = Command::from_std(sinew_command());
        command.current_dir(root.path()).arg("angles").arg(walks.join(format!("{subject}/{trial}.amc")));
        command.args(["--rate", "60", "--out", table]).assert().success();
    }
    let mut train = sinew(root.path());
    train.args(["--cuts", "cuts.csv", "--mirror", "--rate", "60", "--out", "m.json"]).assert().success();
    let text = fs::read_to_string(root.path().join("m.json")).unwrap();
    assert_eq!(text, model_file::to_json(&CyclicModel::from_option("walking").unwrap()).unwrap());
}

#[test]
fn the_shipped_running_is_what_the_commands_make() {
    let Some(runs) = shared_data("mocap/cmu-expmap") else { return };
    let root = tempfile::tempdir().unwrap();
    let list = include_str!("../../../host/models/cuts/running.csv");
    fs::write(root.path().join("cuts.csv"), list).unwrap();
    for number in 1..=3 {
        for (end, more) in [("", None), ("_swapped", Some("--swap-sides"))] {
            let mut command = Command::from_std(sinew_command());
            command.current_dir(root.path()).arg("angles").arg(runs.join(format!("train_running_{number}.txt")));
            command.args(["--rate", "60", "--out", &format!("running_{number}{end}.csv")]).args(more);
            command.assert().success();
        }
    }
    sinew(root.path()).args(["--cuts", "cuts.csv", "--rate", "60", "--out", "m.json"]).assert().success();
    let text = fs::read_to_string(root.path().join("m.json")).unwrap();
    assert_eq!(text, model_file::to_json(&CyclicModel::from_option("running").unwrap()).unwrap());
}

#[test]
fn the_shipped_arm_circles_are_what_the_commands_make() {
    let Some(mocap) = shared_data("mocap") else { return };
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("cuts.csv"), include_str!("../../../host/models/cuts/arm-circles.csv")).unwrap();
    for trial in ["13_29", "13_31"] {
        for (end, more) in [("", None), ("_swapped", Some("--swap-sides"))] {
            let mut command = Command::from_std(sinew_command());
            command.current_dir(root.path()).arg("angles").arg(mocap.join(format!("cmu-exercise/{trial}.amc")));
            command.arg("--skeleton").arg(mocap.join("cmu-walk/35/35.asf"));
            command.args(["--rate", "60", "--out", &format!("{trial}{end}.csv")]).args(more).assert().success();
        }
    }
    sinew(root.path()).args(["--cuts", "cuts.csv", "--rate", "60", "--out", "m.json"]).assert().success();
    let text = fs::read_to_string(root.path().join("m.json")).unwrap();
    assert_eq!(text, model_file::to_json(&CyclicModel::from_option("arm-circles").unwrap()).unwrap());
}
