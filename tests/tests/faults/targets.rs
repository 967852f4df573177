//! Outputs that are no regular files.

use sinew_tests::sinew_command;
use std::fs;
use std::io::Read;
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
        command.current_dir(folder.path()).args(["track", "cyclic", table, "--model", "walking", "--out", out]);
        let output = command.stdin(input).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(folder.path().join(out)).unwrap()
    };
    let table = fs::File::open(folder.path().join("walk.csv")).unwrap();
    assert!(track("-", "a.csv", table.into()) == track("walk.csv", "b.csv", Stdio::null()));
}

#[test]
fn a_socket_is_refused_before_anything_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let _socket = std::os::unix::net::UnixListener::bind(folder.path().join("socket")).unwrap();
    let output = run(&folder, "socket");
    assert_eq!(output.status.code(), Some(73));
    assert!(String::from_utf8_lossy(&output.stderr).contains("neither a file nor a FIFO"));
}
