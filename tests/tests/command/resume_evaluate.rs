//! `--resume` of the evaluations: one that was broken off and taken up again writes what an
//! unbroken one writes.

use clap::Parser;
use serde_json::Value;
use sinew::resume::{CELLS_FOLDER, Stop};
use sinew_lab::cli::{Cli, Command, Evaluate, arm, body, cyclic, hands, skin};
use sinew_tests::{files_below, sinew_command};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use tempfile::TempDir;

const ARM: &str = "evaluate arm --clips 1 --seeds 1 --frames 106 --particles 10 --variants pik";
const BODY: &str = "evaluate body --motion pelvic-lift --models guided --particles 5 --trials 2 --hide-arms 8";
const CYCLIC: &str = "evaluate cyclic --model running --seeds 1 --particles none";

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn words(&self, words: &str, out: &str) -> Vec<String> {
        let mut all: Vec<String> = words.split_whitespace().map(str::to_owned).collect();
        all.extend(["--quiet".to_owned(), "--out".to_owned(), self.path(out).display().to_string()]);
        all
    }

    /// Whether the command ended well, and its standard error.
    fn command(&self, words: &str, out: &str) -> (bool, String) {
        let output = sinew_command().args(self.words(words, out)).output().unwrap();
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    }

    /// Breaks an evaluation off before it would measure one more than `most` things; gives the
    /// number of cells that are kept.
    fn break_off(&self, words: &str, out: &str, most: usize) -> usize {
        let words = self.words(words, out);
        let cli = Cli::try_parse_from(std::iter::once("sinew").chain(words.iter().map(String::as_str))).unwrap();
        let asked = AtomicUsize::new(0);
        let stop: Stop<'_> = &|| asked.fetch_add(1, Ordering::Relaxed) >= most;
        let Command::Evaluate(evaluate) = &cli.command else { panic!("{words:?}") };
        let ended = match evaluate {
            Evaluate::Arm(args) => arm::run_until(args, &cli.console, stop),
            Evaluate::Body(args) => body::run_until(args, &cli.console, stop),
            Evaluate::Cyclic(args) => cyclic::run_until(args, &cli.console, stop),
            Evaluate::Hands(args) => hands::run_until(args, &cli.console, stop),
            Evaluate::Skin(args) => skin::run_until(args, &cli.console, stop),
        };
        assert_eq!(sinew::cli::interrupted(&ended.unwrap_err()).unwrap().unit, "cells");
        fs::read_dir(self.path(out).join(CELLS_FOLDER)).unwrap().count() - 1
    }

    /// Breaks an evaluation off twice, and expects what an unbroken one writes.
    fn resumes(&self, words: &str, breaks: [usize; 2]) {
        let resumed = format!("{words} --resume");
        let (good, message) = self.command(words, "whole");
        assert!(good, "{message}");
        let kept =
            [(words, breaks[0]), (&resumed, breaks[1])].map(|(words, most)| self.break_off(words, "broken", most));
        assert!(0 < kept[0] && kept[0] < kept[1], "{kept:?}");
        let (good, message) = self.command(&resumed, "broken");
        assert!(good, "{message}");
        let [whole, broken] = ["whole", "broken"].map(|out| measured(&self.path(out)));
        assert_eq!(broken.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
        for (name, bytes) in &whole {
            assert!(broken[name] == *bytes, "{name} differs");
        }
        let (good, message) = self.command(&resumed, "broken");
        assert!(!good && message.contains("holds no unfinished evaluation"), "{message}");
    }
}

/// Copies the first `count` files of a folder.
fn first_pictures(from: &Path, to: &Path, count: usize) -> String {
    let mut files: Vec<PathBuf> = fs::read_dir(from).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    fs::create_dir(to).unwrap();
    for file in files.iter().take(count) {
        fs::copy(file, to.join(file.file_name().unwrap())).unwrap();
    }
    to.display().to_string()
}

/// All files, without times: those of a report, the last column of a body's table and the plot of
/// them.
fn measured(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = files_below(out, &[]);
    files.remove("figure_15_time.png");
    for (name, bytes) in &mut files {
        if name.ends_with(".json") {
            let mut report: Value = serde_json::from_slice(bytes).unwrap();
            for cell in report["results"].as_array_mut().into_iter().flatten() {
                assert!(cell["seconds_per_frame"].take().as_f64().unwrap() > 0.0);
            }
            *bytes = report.to_string().into_bytes();
        } else if name == "table.csv" {
            let mut table = csv::Reader::from_reader(bytes.as_slice());
            let headings = table.headers().unwrap().clone();
            let rows = table.records().map(|row| {
                let row = row.unwrap();
                let timeless = headings.iter().zip(&row).filter(|(heading, _)| !heading.starts_with("seconds"));
                timeless.map(|(_, cell)| cell.to_owned()).collect::<Vec<_>>().join(",")
            });
            *bytes = rows.collect::<Vec<_>>().join("\n").into_bytes();
        }
    }
    files
}

#[test]
fn an_evaluation_of_arms_goes_on() {
    Folder::new().resumes(ARM, [5, 9]);
}

#[test]
fn an_evaluation_of_bodies_goes_on() {
    Folder::new().resumes(BODY, [3, 4]);
}

#[test]
fn an_evaluation_of_cycles_goes_on() {
    Folder::new().resumes(CYCLIC, [20, 60]);
}

#[test]
fn evaluations_of_pictures_go_on() {
    let folder = Folder::new();
    let [scene, boxes, masks] = ["scene", "boxes.csv", "masks"].map(|name| folder.path(name).display().to_string());
    let (good, message) = folder.command("simulate arm --motion builtin --frames 31 --side both", "scene");
    assert!(good, "{message}");
    let (good, message) = folder.command(&format!("segment {scene}/frames"), "masks");
    assert!(good, "{message}");
    fs::write(&boxes, "frame,x,y,w,h\n9,280,300,90,90\n").unwrap();
    folder.resumes(&format!("evaluate hands {scene}/frames --boxes {boxes} --seeds 3"), [1, 2]);
    // Models are trained again for each fold, which takes a second a picture.
    let few = first_pictures(&Path::new(&scene).join("frames"), &folder.path("few"), 8);
    for (images, more) in
        [(format!("{scene}/frames"), ""), (format!("{scene}/frames"), " --face"), (few, " --cross-validate 4")]
    {
        for out in ["whole", "broken"] {
            fs::remove_dir_all(folder.path(out)).unwrap();
        }
        folder.resumes(&format!("evaluate skin --images {images} --masks {masks}{more}"), [1, 1]);
    }
}

#[test]
fn an_evaluation_begun_otherwise_is_refused_by_what_differs() {
    let folder = Folder::new();
    let refused = |words: &str, parts: &[&str]| {
        let (good, message) = folder.command(&format!("{words} --resume"), "run");
        assert!(!good && parts.iter().all(|part| message.contains(part)), "{words}: {message}");
        assert!(message.contains("leave --resume out to begin anew"), "{message}");
    };
    refused(CYCLIC, &["holds no unfinished evaluation", "begun.json"]);
    let kept = folder.break_off(CYCLIC, "run", 3);
    refused(&CYCLIC.replace("--seeds 1", "--seeds 3"), &["begun with seeds = 1, not 3"]);
    refused(&CYCLIC.replace("running", "walking"), &["begun with model = \"running\", not \"walking\""]);
    refused(BODY, &["left by `sinew evaluate cyclic`, not by `sinew evaluate body`"]);
    assert_eq!(fs::read_dir(folder.path("run").join(CELLS_FOLDER)).unwrap().count() - 1, kept);
    assert_eq!(folder.break_off(CYCLIC, "run", 0), 0, "without --resume it begins anew");
}
