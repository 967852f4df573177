//! Outputs that are no regular files.

use sinew_tests::sinew_command;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::fs::symlink;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const SIMULATE: &str = "simulate cyclic --model walking --cycles 2 --out";

fn run(folder: &TempDir, out: &str) -> Output {
    sinew_command().current_dir(folder.path()).args(SIMULATE.split(' ')).arg(out).output().unwrap()
}

#[test]
fn a_link_keeps_pointing_and_a_fifo_is_written_through() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert!(run(&folder, "plain.csv").status.success());
    let plain = fs::read(path("plain.csv")).unwrap();
    symlink("target.csv", path("link.csv")).unwrap();
    assert!(run(&folder, "link.csv").status.success());
    assert!(fs::symlink_metadata(path("link.csv")).unwrap().is_symlink());
    assert!(fs::read(path("target.csv")).unwrap() == plain);

    assert!(Command::new("mkfifo").arg(path("fifo")).status().unwrap().success());
    let reader = std::thread::spawn({
        let fifo = path("fifo");
        move || {
            let mut bytes = Vec::new();
            fs::File::open(fifo).unwrap().read_to_end(&mut bytes).unwrap();
            bytes
        }
    });
    assert!(run(&folder, "fifo").status.success());
    assert!(reader.join().unwrap() == plain);
}

#[test]
fn a_dash_is_standard_output_and_nothing_else_is_on_it() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(&folder, "plain.csv").status.success());
    let output = run(&folder, "-");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout == fs::read(folder.path().join("plain.csv")).unwrap());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_table_comes_on_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(&folder, "walk.csv").status.success());
    let track = |table: &str, out: &str, input: Stdio| {
        let mut command = sinew_command();
        command
            .current_dir(folder.path())
            .args(["track", "cyclic", table, "--model", "walking", "--online", "--out", out]);
        let output = command.stdin(input).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(folder.path().join(out)).unwrap()
    };
    let table = fs::File::open(folder.path().join("walk.csv")).unwrap();
    assert!(track("-", "a.csv", table.into()) == track("walk.csv", "b.csv", Stdio::null()));
}

#[test]
fn rows_are_answered_as_they_come() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(&folder, "walk.csv").status.success());
    let walk = fs::read_to_string(folder.path().join("walk.csv")).unwrap();
    let (first, rest) = walk.split_at(walk.match_indices('\n').nth(20).unwrap().0 + 1);
    let mut command = sinew_command();
    command.args(["track", "cyclic", "-", "--model", "walking", "--out", "-", "--quiet"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let (mut input, mut output) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()).lines());
    input.write_all(first.as_bytes()).unwrap();
    input.flush().unwrap();
    // The header and all rows so far, while the input is still open.
    let early: Vec<String> = output.by_ref().take(21).map(Result::unwrap).collect();
    assert!(early[20].starts_with("19,"), "{}", early[20]);
    input.write_all(rest.as_bytes()).unwrap();
    drop(input);
    assert_eq!(output.count(), walk.lines().count() - 21);
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_long_table_takes_little_memory() {
    let folder = tempfile::tempdir().unwrap();
    let simulate = "simulate cyclic --model walking --cycles 4000 --out walk.csv";
    assert!(sinew_command().current_dir(folder.path()).args(simulate.split(' ')).output().unwrap().status.success());
    // 35 MB of text. Addresses are limited, of which a run takes more than of memory.
    let mut command = Command::new("sh");
    command.current_dir(folder.path()).args(["-c", "ulimit -v 50000; exec \"$0\" \"$@\""]);
    command.arg(sinew_command().get_program());
    let output = command.args("track cyclic walk.csv --model walking --out est.csv".split(' ')).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_reader_that_has_gone_away_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    assert!(
        sinew_command()
            .current_dir(folder.path())
            .args("simulate cyclic --model walking --cycles 300 --out walk.csv".split(' '))
            .output()
            .unwrap()
            .status
            .success()
    );
    for words in
        ["track cyclic walk.csv --model walking --out -", "simulate cyclic --model walking --cycles 300 --out -"]
    {
        let mut command = sinew_command();
        let child =
            command.current_dir(folder.path()).args(words.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = child.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{words}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn a_socket_is_refused_before_anything_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let _socket = std::os::unix::net::UnixListener::bind(folder.path().join("socket")).unwrap();
    let output = run(&folder, "socket");
    assert_eq!(output.status.code(), Some(73));
    assert!(String::from_utf8_lossy(&output.stderr).contains("neither a file nor a FIFO"));
}
