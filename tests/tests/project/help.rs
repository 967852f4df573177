//! What `--help` says: it fits a screen, and its examples run.

use clap::Command;
use sinew_tests::{command_tree, sinew_command};
use std::collections::BTreeSet;

/// The words of every command below `sinew`, groups too: `[["demo"], ["track"], ["track", "arm"],
/// ...]`, and of `sinew` itself.
fn commands() -> Vec<Vec<String>> {
    fn walk(command: &Command, words: &[String], found: &mut Vec<Vec<String>>) {
        found.push(words.to_vec());
        for below in command.get_subcommands().filter(|below| below.get_name() != "help") {
            walk(below, &[words, &[below.get_name().to_owned()]].concat(), found);
        }
    }
    let mut found = Vec::new();
    walk(&command_tree(), &[], &mut found);
    found
}

/// What the command itself prints.
fn help(words: &[String]) -> String {
    let output = sinew_command().args(words).arg("--help").output().unwrap();
    assert!(output.status.success(), "{words:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The lines below `Examples:`.
fn examples(help: &str) -> Vec<&str> {
    let lines = help.lines().skip_while(|line| *line != "Examples:").skip(1);
    lines.take_while(|line| !line.is_empty()).collect()
}

#[test]
fn the_list_of_commands_fits_a_screen() {
    let text = help(&[]);
    assert!(text.lines().count() <= 40, "{} lines:\n{text}", text.lines().count());
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(commands().len() > 25, "{:?}", commands());
}

#[test]
fn every_command_has_an_example_of_itself_that_fits_a_line() {
    for words in commands() {
        let text = help(&words);
        let own = format!("  sinew {}", words.join(" "));
        let lines = examples(&text);
        assert!(lines.iter().any(|line| line.starts_with(own.trim_end())), "`{own}` is no example in:\n{text}");
        assert!(lines.iter().all(|line| line.len() <= 80), "{text}");
    }
}

#[test]
#[cfg(unix)]
fn every_example_runs_in_an_empty_folder() {
    let program = sinew_command().get_program().to_owned();
    let folder = std::path::Path::new(&program).parent().unwrap().to_owned();
    let path = std::env::join_paths(
        std::iter::once(folder).chain(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default())),
    );
    let path = path.unwrap();
    let mut ran = BTreeSet::new();
    for words in commands() {
        let script = examples(&help(&words)).join("\n");
        if !ran.insert(script.clone()) {
            continue;
        }
        let root = tempfile::tempdir().unwrap();
        let mut shell = std::process::Command::new("sh");
        let output = shell.args(["-e", "-c", &script]).current_dir(root.path()).env("PATH", &path).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "sinew {}:\n{script}\n{message}", words.join(" "));
        assert!(std::fs::read_dir(root.path()).unwrap().count() > 0, "sinew {} made nothing", words.join(" "));
    }
}
