//! `sinew batch` as a user types it: many recordings, each once, whatever happens in between.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew_tests::sinew_command;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn sinew(folder: &Path, words: &str) -> Command {
    let mut command = Command::from_std(sinew_command());
    command.current_dir(folder).args(words.split(' '));
    command
}

/// Walks of different people in `in`.
fn walks(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for seed in 1..=count {
        let words = format!("simulate cyclic --model walking --cycles 4 --seed {seed} --out in/w{seed:03}.csv");
        sinew(folder.path(), &words).assert().success();
    }
    folder
}

/// The rows of a table by their id, as columns by name.
fn rows(path: &Path) -> BTreeMap<String, BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().clone();
    let row = |record: csv::StringRecord| {
        let cells = header.iter().zip(&record).map(|(name, cell)| (name.to_owned(), cell.to_owned()));
        (record[0].to_owned(), cells.collect())
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// Every table of estimates by the key of its recording.
fn estimates(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let folders = fs::read_dir(out.join("results")).unwrap().map(|entry| entry.unwrap().path());
    folders.map(|folder| (folder.file_name().unwrap().into(), fs::read(folder.join("estimate.csv")).unwrap())).collect()
}

#[test]
fn a_recording_is_tracked_once_and_a_broken_one_stops_no_other() {
    let folder = walks(3);
    let root = folder.path();
    fs::write(root.join("in/broken.csv"), "no table\n").unwrap();
    fs::copy(root.join("in/w001.csv"), root.join("in/twin.csv")).unwrap();
    sinew(root, "batch in --out runs").assert().code(65).stdout(contains("5 recordings: 4 with a result, 0 of these"));
    let status = rows(&root.join("runs/status.csv"));
    assert_eq!((status["broken"]["status"].as_str(), status["broken"]["class"].as_str()), ("error", "data"));
    assert!(status["broken"]["message"].contains("broken.csv"), "{status:?}");
    assert_eq!(status["twin"]["key"], status["w001"]["key"]);
    assert_eq!(rows(&root.join("runs/summary.csv")).len(), 4);

    // What the command alone makes of it.
    sinew(root, "track cyclic in/w001.csv --model walking --out alone.csv").assert().success();
    let result = root.join("runs/results").join(&status["w001"]["key"]);
    assert!(fs::read(root.join("alone.csv")).unwrap() == fs::read(result.join("estimate.csv")).unwrap());

    let before = fs::metadata(result.join("estimate.csv")).unwrap().modified().unwrap();
    sinew(root, "batch in --out runs").assert().code(65).stdout(contains("4 with a result, 4 of these from before"));
    assert_eq!(fs::metadata(result.join("estimate.csv")).unwrap().modified().unwrap(), before);
    fs::copy(root.join("in/w002.csv"), root.join("in/broken.csv")).unwrap();
    sinew(root, "batch in --out runs").assert().success().stdout(contains("5 with a result"));
    // Another option touches what it concerns.
    sinew(root, "batch in --out runs --set sigma-deg=4").assert().success().stdout(contains("0 of these from before"));
}

/// Keypoints without times beside an angle table and notes: each gets what it is for.
#[test]
fn a_mixed_folder_is_tracked_with_one_option_for_keypoints() {
    let folder = walks(1);
    let root = folder.path();
    sinew(root, "simulate keypoints --out timed.csv").assert().success();
    let mut timed = csv::Reader::from_path(root.join("timed.csv")).unwrap();
    let time = timed.headers().unwrap().iter().position(|name| name == "time_s").unwrap();
    let without_time = |row: &csv::StringRecord| {
        let cells = row.iter().enumerate().filter(|(column, _)| *column != time).map(|(_, cell)| cell);
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    let header = without_time(timed.headers().unwrap());
    let rows_of_it = timed.records().map(|row| without_time(&row.unwrap())).collect::<String>();
    fs::write(root.join("in/anna.csv"), header + &rows_of_it).unwrap();
    fs::write(root.join("in/notes.txt"), "Anna, in shoes\n").unwrap();
    sinew(root, "batch in --out runs --set input-rate=30")
        .assert()
        .success()
        .stdout(contains("2 recordings: 2 with a result"))
        .stderr(
            contains("skipped 1 of the folder's files").and(contains("--set input-rate: left out for 1 recording")),
        );
    fs::write(root.join("list.csv"), "id,input\nnotes,in/notes.txt\n").unwrap();
    sinew(root, "batch list.csv --out named").assert().code(65).stdout(contains("1 failed"));
}

#[test]
fn a_list_has_options_and_errors_of_its_own() {
    let folder = walks(2);
    let root = folder.path();
    let list = "id,input,kind,model,online\nanna,in/w001.csv,cyclic,walking,true\nbert,in/w002.csv,,running,\n\
        carl,in/gone.csv,,,\ndora,in/w001.csv,dance,,\n";
    fs::write(root.join("list.csv"), list).unwrap();
    sinew(root, "batch list.csv --out runs").assert().code(65).stderr(contains("2 of 4 recordings have no result"));
    let status = rows(&root.join("runs/status.csv"));
    assert_eq!(status["carl"]["class"], "no-input", "{status:?}");
    assert!(status["dora"]["message"].contains("kind `dance` is none of recording, cyclic"), "{status:?}");
    assert_eq!([&status["anna"]["status"], &status["bert"]["status"]], ["ok", "ok"]);
    fs::write(root.join("list.csv"), "id,input\na,1\na,2\n").unwrap();
    sinew(root, "batch list.csv --out other")
        .assert()
        .code(65)
        .stderr(contains("list.csv:3: has the id `a` of line 2"));
    assert!(!root.join("other").exists());
    sinew(root, "batch in --out runs --shard 3/2").assert().code(64).stderr(contains("I from 1 to N"));
    let unknown = sinew(root, "batch in --out strange --set modle=walking").assert().code(65);
    let _ = unknown.stdout(contains("2 failed"));
    let status = rows(&root.join("strange/status.csv"));
    assert!(status["w001"]["message"].contains("the nearest is `model`"), "{status:?}");
}

/// What another program gives and takes: a list by standard input, rows and progress as JSON.
#[test]
fn a_list_from_standard_input_is_answered_as_json() {
    let folder = walks(2);
    let root = folder.path();
    let list = "{\"id\":\"a\",\"input\":\"w001.csv\"}\n{\"id\":\"b\",\"input\":\"gone.csv\"}\n";
    let words = "batch - --folder in --out runs --rows rows.jsonl --progress --json";
    let done =
        sinew(root, words).write_stdin(list).assert().code(65).stderr(contains("\"done\":2,\"left_s\":0.0,\"of\":2"));
    let answer: serde_json::Value = serde_json::from_slice(&done.get_output().stdout).unwrap();
    assert_eq!((answer["good"].as_u64(), answer["failed"].as_u64()), (Some(1), Some(1)));
    let text = fs::read_to_string(root.join("rows.jsonl")).unwrap();
    let lines: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines[0]["key"].as_str(), Some(rows(&root.join("runs/status.csv"))["a"]["key"].as_str()));
    assert_eq!(lines[1]["ended"]["failure"]["class"], "no-input");
    sinew(root, "batch - --folder in --out runs").write_stdin("id,input\na,w001.csv\n").assert().success();
    sinew(root, "batch - --out runs")
        .write_stdin("id\na\n")
        .assert()
        .code(65)
        .stderr(contains("standard input:2: needs an `input`"));
    sinew(root, "batch list.parquet --out runs").assert().code(65).stderr(contains("reads no Parquet"));
}

#[test]
fn shards_make_together_what_one_run_makes() {
    let folder = walks(5);
    let root = folder.path();
    for shard in ["1/2", "2/2"] {
        sinew(root, &format!("batch in --out parts --shard {shard} --jobs 1")).assert().success();
    }
    assert_eq!(rows(&root.join("parts/status_1_of_2.csv")).len(), 3);
    sinew(root, "batch in --out parts").assert().success().stdout(contains("5 of these from before"));
    sinew(root, "batch in --out whole --jobs 3").assert().success();
    assert!(estimates(&root.join("parts")) == estimates(&root.join("whole")));
    assert_eq!(fs::read(root.join("parts/summary.csv")).unwrap(), fs::read(root.join("whole/summary.csv")).unwrap());
}

/// After a signal and after a kill: what was finished is there, nothing half made is, and the same
/// command goes on to the same bytes.
#[cfg(unix)]
#[test]
fn an_ended_batch_goes_on_to_the_same_bytes() {
    let folder = walks(24);
    let root = folder.path();
    sinew(root, "batch in --out whole").assert().success();
    for signal in ["TERM", "KILL"] {
        let out = root.join(signal);
        let mut run = sinew_command();
        run.current_dir(root).args(["batch", "in", "--jobs", "1", "--out", signal, "--quiet"]);
        let mut child = run.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        let count = || fs::read_dir(out.join("results")).map_or(0, Iterator::count);
        while count() < 2 && begun.elapsed() < Duration::from_secs(30) {
            std::thread::sleep(Duration::from_millis(5));
        }
        let killed = std::process::Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
        assert!(killed.unwrap().success());
        let status = child.wait().unwrap();
        if signal == "TERM" && count() < 24 {
            assert_eq!(status.code(), Some(143));
            let open = rows(&out.join("status.csv")).values().filter(|row| row["status"] == "open").count();
            assert_eq!(open, 24 - count());
        }
        assert!(estimates(&out).len() >= 2, "{signal}");
        sinew(root, &format!("batch in --out {signal}")).assert().success();
        assert!(estimates(&out) == estimates(&root.join("whole")), "{signal}");
        assert!(!out.join("unfinished").exists(), "{signal}");
    }
}
