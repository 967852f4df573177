//! `sinew track cyclic --resume`: a run that was broken off and taken up again writes what an
//! unbroken one writes.

use clap::Parser;
use sinew::cli::{Cli, Command, track::Track, track_cyclic::run_until};
use sinew_tests::{files_below, sinew_command};
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use tempfile::TempDir;

/// Rows of the table.
const ROWS: usize = 90;

struct Walker {
    root: TempDir,
}

impl Walker {
    /// A person who walks, unseen in the first two rows, with frames that are left out.
    fn new() -> Self {
        let walker = Self { root: tempfile::tempdir().unwrap() };
        let mut command = sinew_command();
        command.args(["simulate", "cyclic", "--model", "walking", "--quiet", "--out"]);
        assert!(command.arg(walker.path("all.csv")).output().unwrap().status.success());
        let text = fs::read_to_string(walker.path("all.csv")).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines.drain(41..=43);
        assert!(lines.len() > ROWS);
        lines.truncate(1 + ROWS);
        for line in &mut lines[1..3] {
            let empty = ",".repeat(line.matches(',').count());
            *line = line.split(',').next().unwrap().to_owned() + &empty;
        }
        fs::write(walker.path("walk.csv"), lines.join("\n") + "\n").unwrap();
        walker
    }

    fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    /// Words of a command that writes into the folder `out`.
    fn words(&self, out: &str, more: &[&str]) -> Vec<String> {
        let path = |name: &str| self.path(name).display().to_string();
        let mut words = ["track", "cyclic", "--quiet"].map(str::to_owned).to_vec();
        words.extend([path("walk.csv"), "--out".to_owned(), path(&format!("{out}/est.csv"))]);
        words.extend(more.iter().map(|word| (*word).to_owned()));
        words
    }

    /// Whether the command ended well, and its standard error.
    fn command(&self, out: &str, more: &[&str]) -> (bool, String) {
        let output = sinew_command().args(self.words(out, more)).output().unwrap();
        (output.status.success(), String::from_utf8(output.stderr).unwrap())
    }

    /// Ends a run after the row with which `finished` rows are answered.
    fn break_off(&self, out: &str, more: &[&str], finished: usize) {
        let words = self.words(out, more);
        let cli = Cli::try_parse_from(std::iter::once("sinew").chain(words.iter().map(String::as_str))).unwrap();
        let Command::Track(Track::Cyclic(args)) = &cli.command else { panic!("{:?}", cli.command) };
        // Nothing is answered but the rows up to the first one with an angle.
        let stop = AtomicBool::new(finished == 3);
        let ended = run_until(args, &cli.console, &stop, &mut |rows| {
            if rows == finished {
                stop.store(true, Ordering::Relaxed);
            }
        });
        let error = ended.unwrap_err();
        let interrupted = sinew::cli::interrupted(&error).unwrap();
        assert_eq!((interrupted.finished, interrupted.all, interrupted.unit), (finished, Some(ROWS), "rows"));
        assert!(self.path(out).join("est_resume.json").exists());
        assert_eq!(self.rows(out), finished);
    }

    /// Rows of the estimates.
    fn rows(&self, out: &str) -> usize {
        fs::read_to_string(self.path(out).join("est.csv")).unwrap().lines().count() - 1
    }

    /// Breaks runs off after so many rows, takes them up, and expects what an unbroken run writes.
    fn resumes(&self, more: &[&str], breaks: &[&[usize]]) {
        let (good, message) = self.command("whole", more);
        assert!(good, "{more:?}: {message}");
        let whole = files_below(&self.path("whole"), &[]);
        for places in breaks {
            self.break_off("broken", more, places[0]);
            for &place in &places[1..] {
                self.break_off("broken", &[more, &["--resume"]].concat(), place);
            }
            let (good, message) = self.command("broken", &[more, &["--resume"]].concat());
            assert!(good && message.is_empty(), "{more:?}, {places:?}: {message}");
            let resumed = files_below(&self.path("broken"), &[]);
            assert_eq!(resumed.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "{more:?}, {places:?}");
            for (name, bytes) in &whole {
                assert!(resumed[name] == *bytes, "{more:?}, {places:?}: {name} differs");
            }
            fs::remove_dir_all(self.path("broken")).unwrap();
        }
        fs::remove_dir_all(self.path("whole")).unwrap();
    }
}

#[test]
fn every_filter_goes_on_wherever_it_was_broken_off() {
    let walker = Walker::new();
    // At the first row with an angle, after it, at the gap, twice, and before the last.
    let breaks: [&[usize]; 5] = [&[3], &[4], &[40], &[20, 60], &[ROWS - 1]];
    for filter in ["coupled", "paper", "paper-cut", "particle"] {
        let options = ["--model", "walking", "--filter", filter, "--particles", "700"];
        walker.resumes(&[&options[..], &["--online"]].concat(), &breaks);
        walker.resumes(&options, &[&[40]]);
    }
}

#[test]
fn a_start_without_a_position_and_with_few_measurements_goes_on() {
    let walker = Walker::new();
    walker.resumes(&["--model", "walking", "--online", "--init", "uniform", "--update-every", "3"], &[&[50]]);
    let random = ["--model", "walking", "--filter", "particle", "--particles", "1500", "--init", "random"];
    walker.resumes(&random, &[&[30]]);
}

#[test]
fn estimates_by_the_whole_recording_and_of_several_motions_resume() {
    let walker = Walker::new();
    for filter in ["coupled", "paper"] {
        walker.resumes(&["--model", "walking", "--smooth", "--filter", filter], &[&[3], &[45, 70]]);
    }
    walker.resumes(&["--model", "running", "--model", "walking"], &[&[10, 50]]);
}

#[test]
fn a_report_is_that_of_an_unbroken_run() {
    let walker = Walker::new();
    let (whole, broken) = (walker.path("report"), walker.path("report"));
    let report = whole.display().to_string();
    let more = ["--model", "walking", "--report", &report];
    assert!(walker.command("whole", &more).0);
    let files = files_below(&whole, &[]);
    assert!(files.len() > 8, "{:?}", files.keys());
    fs::remove_dir_all(&whole).unwrap();
    walker.break_off("broken", &more, 44);
    assert_eq!(fs::read_dir(&broken).unwrap().count(), 0, "a report is of a whole run");
    assert!(walker.command("broken", &[&more[..], &["--resume"]].concat()).0);
    assert!(files_below(&broken, &[]) == files);
}

#[test]
fn a_run_begun_otherwise_is_refused_by_what_differs() {
    let walker = Walker::new();
    let (model, anew) = (["--model", "walking"], "leave --resume out");
    let refused = |more: &[&str], parts: &[&str]| {
        let (good, message) = walker.command("run", &[more, &["--resume"]].concat());
        assert!(!good && parts.iter().all(|part| message.contains(part)), "{more:?}: {message}");
    };
    refused(&model, &["holds no unfinished run", "est_resume.json", anew]);
    walker.break_off("run", &model, 33);
    let estimates = fs::read(walker.path("run/est.csv")).unwrap();
    refused(&["--model", "running"], &["model = [\"walking\"], not [\"running\"]", anew]);
    refused(&["--model", "walking", "--sigma-deg", "3"], &["sigma_deg = null, not 3.0", anew]);
    refused(&["--model", "walking", "--smooth"], &["smooth = false, not true", anew]);
    refused(&["--model", "walking", "--filter", "particle"], &["filter = \"coupled\", not \"particle\"", anew]);
    let table = fs::read_to_string(walker.path("walk.csv")).unwrap();
    fs::write(walker.path("walk.csv"), table.clone() + "\n").unwrap();
    refused(&model, &["walk.csv` is not as it was when the run was begun", anew]);
    fs::write(walker.path("walk.csv"), table).unwrap();
    let state = walker.path("run/est_resume.json");
    let kept = fs::read_to_string(&state).unwrap();
    fs::write(&state, kept.replace("\"sinew_version\": \"", "\"sinew_version\": \"0.0.")).unwrap();
    refused(&model, &["written by sinew 0.0.", anew]);
    fs::write(&state, kept.replace("\"finished\": 33", "\"finished\": 34")).unwrap();
    refused(&model, &["does not fit its number of rows", anew]);
    fs::write(&state, kept).unwrap();
    assert!(fs::read(walker.path("run/est.csv")).unwrap() == estimates);
    // What is made of the estimates may differ.
    let animation = walker.path("walk.gif").display().to_string();
    let (good, message) = walker.command("run", &["--model", "walking", "--animation", &animation, "--resume"]);
    assert!(good, "{message}");
    assert!(walker.path("walk.gif").exists() && !state.exists() && walker.rows("run") == ROWS);
}
