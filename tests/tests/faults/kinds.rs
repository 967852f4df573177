//! The kinds of runs that are broken.

use sinew_tests::{files_below, sinew_command};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Numbers of `run.json` that differ from run to run.
const TIMES: [&str; 1] = ["frames_per_second"];
const BODY_TIMES: [&str; 2] = ["frames_per_second", "seconds_per_step"];

/// A kind of run and its input.
pub struct Kind {
    root: TempDir,
    words: &'static str,
    times: &'static [&'static str],
}

impl Kind {
    /// An arm in rendered frames, with every output.
    pub fn arm() -> Self {
        Self::new(
            "simulate arm --motion builtin --frames 40 --out scene",
            "track arm scene/frames --config scene/camera.toml --side both --particles-csv --overlay --particles 200",
            &TIMES,
        )
    }

    /// A body in clouds, with every output.
    pub fn body() -> Self {
        Self::new(
            "simulate stereo --motion stick-wave --points 300 --out scene",
            "track body scene --particles 20 --particles-csv --pictures",
            &BODY_TIMES,
        )
    }

    fn new(simulate: &str, words: &'static str, times: &'static [&'static str]) -> Self {
        let root = tempfile::tempdir().unwrap();
        let made = sinew_command().current_dir(root.path()).args(simulate.split(' ')).output().unwrap();
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        Self { root, words, times }
    }

    /// A path in the folder in which the command runs.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    /// The command line as words, with `--out` and more.
    pub fn words(&self, out: &str, more: &[&str]) -> Vec<String> {
        let words = self.words.split(' ').chain(["--quiet", "--out", out]);
        words.chain(more.iter().copied()).map(str::to_owned).collect()
    }

    /// The command.
    pub fn command(&self, out: &str, more: &[&str]) -> Command {
        let mut command = sinew_command();
        command.current_dir(self.root.path()).args(self.words(out, more));
        command
    }

    /// The command in a shell that first runs `before`.
    pub fn shell(&self, before: &str, out: &str, more: &[&str]) -> Command {
        let mut command = Command::new("sh");
        let program = sinew_command().get_program().to_owned();
        command.current_dir(self.root.path());
        command.args(["-c", &format!("{before}; exec \"$0\" \"$@\"")]).arg(program).args(self.words(out, more));
        command
    }

    /// Runs to the end; status and standard error.
    pub fn ends(mut command: Command) -> (Option<i32>, String) {
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    }

    /// All files of a run but for times.
    pub fn files(&self, out: &str) -> BTreeMap<String, Vec<u8>> {
        files_below(&self.path(out), self.times)
    }

    /// Expects that the run in `out`, resumed, ends as the one in `whole`.
    pub fn assert_resumes(&self, out: &str, whole: &BTreeMap<String, Vec<u8>>, what: &str) {
        let (code, message) = Self::ends(self.command(out, &["--resume"]));
        assert_eq!(code, Some(0), "{what}: {message}");
        let resumed = self.files(out);
        assert_eq!(resumed.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>(), "{what}");
        for (name, bytes) in whole {
            assert!(resumed[name] == *bytes, "{what}: {name} differs");
        }
    }
}

/// Whether `folder` has a file of a run that did not end.
pub fn is_unfinished(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|entries| {
        entries.filter_map(Result::ok).any(|entry| entry.file_name().to_string_lossy() == "resume.json")
    })
}
