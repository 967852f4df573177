//! `--quiet` and `--json` of every command, and what only a terminal gets to see.

use image::{Rgb, RgbImage};
use sinew_tests::{command_tree, sinew_command};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Output;

/// A command of every kind, in an order in which each finds what it needs, with a key of its JSON.
const COMMANDS: [(&str, &str); 28] = [
    ("simulate arm --motion builtin --frames 12 --side both --out scene", "frames"),
    ("track arm scene/frames --config scene/camera.toml --out run --overlay", "run"),
    ("track arm --print-config", "tracker"),
    ("record run --out arm.stream", "bytes"),
    ("segment scene/frames --out masks", "masks"),
    ("blobs scene/frames", "0"),
    ("blobs scene/frames --out blobs.csv", "blobs"),
    ("train skin --images scene/frames --masks masks --out skin.json", "trained_on"),
    ("evaluate skin --images scene/frames --masks masks --skin skin.json --out skin", "rows"),
    ("evaluate hands scene/frames --boxes boxes.csv --seeds 1 --out hands", "whole"),
    ("evaluate arm --clips 1 --seeds 1 --frames 106 --particles 10 --variants pik --out arm", "report"),
    ("simulate stereo --motion pelvic-lift --points 100 --out points", "frames"),
    ("track body points --particles 5 --out body", "run"),
    ("track body --print-config", "angular"),
    ("evaluate body --motion pelvic-lift --models guided --particles 5 --trials 1 --out eb", "report"),
    ("simulate cyclic --model walking --out walk.csv", "cycles"),
    ("simulate keypoints --out recordings/points.csv", "image_size_px"),
    ("batch recordings --out batch", "good"),
    ("cut walk.csv --out cuts.csv", "tables"),
    ("train cyclic --cuts cuts.csv --out walk.json", "trained_on"),
    ("track cyclic walk.csv --model walk.json --out est.csv --report report", "summary"),
    ("evaluate cyclic --seeds 1 --particles none --out ec", "report"),
    ("angles report/joints.trc --rate 60 --out back.csv", "missing_share"),
    ("export walking --out walking.bin", "bytes"),
    ("report run hands skin --out run.html", "runs"),
    ("doctor scene/frames scene/camera.toml run", "0"),
    ("completions bash", "script"),
    ("man --out man1", "pages"),
];

fn sinew(folder: &Path, words: &str) -> Output {
    sinew_command().current_dir(folder).args(words.split_whitespace()).output().unwrap()
}

/// A folder with what no command makes: boxes of hands.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("boxes.csv"), "frame,x,y,w,h\n9,280,300,90,90\n").unwrap();
    folder
}

#[test]
fn every_command_prints_one_json_value_and_nothing_beside_it() {
    let root = folder();
    for (words, key) in COMMANDS {
        let output = sinew(root.path(), &format!("{words} --json --quiet"));
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && message.is_empty(), "{words}: {message}");
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(text.lines().count(), 1, "{words}: {text}");
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let found = key.parse::<usize>().map_or_else(|_| json.get(key), |index| json.get(index));
        assert!(found.is_some(), "{words}: no `{key}` in {text}");
    }
    let tried: BTreeSet<String> = COMMANDS.iter().map(|(words, _)| command_of(words)).collect();
    assert_eq!(tried.len(), leaves().len() - 1, "all but demo are tried: {:?}", leaves());
}

/// The first words of a command line that name the command.
fn command_of(words: &str) -> String {
    let known = leaves();
    known.into_iter().find(|name| words.starts_with(&format!("{name} "))).unwrap_or_else(|| panic!("{words}"))
}

/// Every command that does something.
fn leaves() -> Vec<String> {
    fn walk(command: &clap::Command, name: &str, found: &mut Vec<String>) {
        let below: Vec<_> = command.get_subcommands().filter(|below| below.get_name() != "help").collect();
        if below.is_empty() {
            found.push(name.trim().to_owned());
        }
        below.into_iter().for_each(|below| walk(below, &format!("{name} {}", below.get_name()), found));
    }
    let mut found = Vec::new();
    walk(&command_tree(), "", &mut found);
    found
}

#[test]
fn the_demo_prints_json_too() {
    let root = folder();
    let output = sinew(root.path(), "demo --out run --json");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["error"]["median_error_m"].as_f64().unwrap() > 0.0 && json["run"]["frames"] == 120, "{json}");
}

#[test]
fn quiet_silences_notes_and_not_errors() {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir(root.path().join("in")).unwrap();
    RgbImage::from_pixel(32, 24, Rgb([90, 120, 200])).save(root.path().join("in/0.png")).unwrap();
    fs::write(root.path().join("in/1.png"), "no image").unwrap();
    for words in ["segment in --out masks", "blobs in", "track arm in --out run"] {
        let stderr = |more: &str| {
            let output = sinew(root.path(), &format!("{words} {more}"));
            assert!(output.status.success() && !output.stdout.is_empty(), "{words}");
            String::from_utf8(output.stderr).unwrap()
        };
        assert!(stderr("").contains("1.png"), "{words}");
        assert_eq!(stderr("--quiet"), "", "{words}");
    }
    let output = sinew(root.path(), "track arm nowhere --out run --quiet --json");
    assert!(output.status.code() == Some(66) && output.stdout.is_empty());
    let error: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!((&error["error"]["kind"], &error["error"]["exit_status"]), (&"no-input".into(), &66.into()));
    assert!(error["error"]["message"].as_str().unwrap().contains("nowhere"));
}

/// What a command prints on a terminal, both streams together, by util-linux' `script`.
#[cfg(target_os = "linux")]
fn on_a_terminal(folder: &Path, words: &str, environment: &[(&str, &str)]) -> String {
    let program = sinew_command().get_program().to_string_lossy().into_owned();
    let mut script = std::process::Command::new("script");
    script.args(["--quiet", "--return", "--command", &format!("{program} {words}"), "/dev/null"]).current_dir(folder);
    script.env("TERM", "xterm").env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").env_remove("CI");
    let output = script.envs(environment.iter().copied()).stdin(std::process::Stdio::null()).output().unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
#[cfg(target_os = "linux")]
fn colour_and_progress_bars_are_for_terminals() {
    let root = folder();
    let simulated = sinew(root.path(), "simulate arm --motion builtin --frames 12 --out scene");
    assert!(simulated.status.success());
    let track = "track arm scene/frames --out run";
    let bar = "of 12, ";
    let shown = on_a_terminal(root.path(), track, &[]);
    assert!(shown.contains(bar), "{shown}");
    assert!(!on_a_terminal(root.path(), &format!("{track} --quiet"), &[]).contains(bar));
    assert!(String::from_utf8_lossy(&sinew(root.path(), track).stderr).is_empty());

    let escape = '\u{1b}';
    assert!(on_a_terminal(root.path(), "--help", &[]).contains(escape));
    assert!(!on_a_terminal(root.path(), "--help", &[("NO_COLOR", "1")]).contains(escape));
    let output = sinew(root.path(), "--help");
    assert!(!String::from_utf8_lossy(&output.stdout).contains(escape));
    let wrong = sinew(root.path(), "trakc");
    let message = String::from_utf8_lossy(&wrong.stderr);
    assert!(!message.contains(escape) && message.contains("track"), "{message}");
}
