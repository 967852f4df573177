//! The kinds of runs that are broken.

use sinew_tests::{files_below, sinew_command};
use std::collections::BTreeMap;
use std::path::PathBuf;
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
    /// What `--out` names in the folder of the results; nothing where it is that folder.
    table: &'static str,
    /// How the state is saved often.
    often: &'static [&'static str],
    /// What is in the folder of results until the run has reached its end.
    unfinished: &'static str,
}

const OFTEN: &[&str] = &["--checkpoint", "0.02"];

impl Kind {
    /// An arm in rendered frames, with every output.
    pub fn arm() -> Self {
        Self::new(
            "simulate arm --motion builtin --frames 40 --out scene",
            "track arm scene/frames --config scene/camera.toml --side both --particles-csv --overlay --particles 200",
        )
        .with_times(&TIMES)
    }

    /// A body in clouds, with every output.
    pub fn body() -> Self {
        Self::new(
            "simulate stereo --motion stick-wave --points 300 --out scene",
            "track body scene --particles 20 --particles-csv --pictures",
        )
        .with_times(&BODY_TIMES)
    }

    /// Rows that are written as they are read.
    pub fn rows() -> Self {
        let track = "track cyclic walk.csv --model walking --online";
        Self::new("simulate cyclic --model walking --cycles 800 --out walk.csv", track).with_table()
    }

    /// Rows that are kept until the end.
    pub fn motions() -> Self {
        let track = "track cyclic walk.csv --model walking --model running --filter particle --particles 50";
        Self::new("simulate cyclic --model walking --cycles 20 --out walk.csv", track).with_table()
    }

    /// Cells of an evaluation.
    pub fn evaluation() -> Self {
        let evaluate = "evaluate cyclic --model running --seeds 1 --particles none";
        let kind = Self::new("simulate cyclic --model walking --cycles 2 --out unused.csv", evaluate);
        Self { often: &[], unfinished: "unfinished", ..kind }
    }

    fn with_times(self, times: &'static [&'static str]) -> Self {
        Self { times, ..self }
    }

    fn with_table(self) -> Self {
        Self { table: "/est.csv", unfinished: "est_resume.json", ..self }
    }

    fn new(simulate: &str, words: &'static str) -> Self {
        let root = tempfile::tempdir().unwrap();
        let made = sinew_command().current_dir(root.path()).args(simulate.split(' ')).output().unwrap();
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        Self { root, words, times: &[], table: "", often: OFTEN, unfinished: "resume.json" }
    }

    /// A path in the folder in which the command runs.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    /// The command line as words, with `--out` and more.
    pub fn words(&self, out: &str, more: &[&str]) -> Vec<String> {
        let words = self.words.split(' ').chain(["--quiet", "--out"]).map(str::to_owned);
        let out = format!("{out}{}", self.table);
        words.chain([out]).chain(more.iter().map(|word| (*word).to_owned())).collect()
    }

    /// The command.
    pub fn command(&self, out: &str, more: &[&str]) -> Command {
        let mut command = sinew_command();
        command.current_dir(self.root.path()).args(self.words(out, more));
        command
    }

    /// The option that saves the state often.
    pub const fn often(&self) -> &'static [&'static str] {
        self.often
    }

    /// Whether a run in `out` was begun and has not reached its end.
    pub fn is_unfinished(&self, out: &str) -> bool {
        self.path(out).join(self.unfinished).exists()
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
