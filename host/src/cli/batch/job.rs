//! What is done with one recording: command lines of `sinew` itself.

use super::content;
use super::manifest::Row;
use crate::cli::Cli;
use crate::cyclic::CyclicError;
use crate::cyclic::angle_table::AngleRows;
use crate::error::{Result, bail, ensure};
use clap::{ArgAction, CommandFactory, Parser};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// What can be done with a recording: its name, and the commands with the output of each.
const KINDS: [(&str, &[(&str, &str)]); 5] = [
    ("recording", &[("angles", "angles.csv"), ("track cyclic", "estimate.csv")]),
    ("cyclic", &[("track cyclic", "estimate.csv")]),
    ("angles", &[("angles", "angles.csv")]),
    ("arm", &[("track arm", "run")]),
    ("body", &[("track body", "run")]),
];
/// Options that are the batch's own.
const NOT_GIVEN: [&str; 6] = ["out", "resume", "quiet", "json", "help", "checkpoint"];
/// The model of a cyclic motion where none is named.
const DEFAULT_MODEL: &str = "walking";

/// One recording with what is done with it.
#[derive(Debug, Clone)]
pub struct Job {
    /// Content of everything that decides the result.
    pub key: String,
    input: PathBuf,
    kind: usize,
    options: BTreeMap<String, String>,
    /// Names of defaults that are for recordings of other kinds.
    pub left_out: Vec<String>,
}

impl Job {
    /// What `row` asks for.
    ///
    /// # Errors
    /// An unknown kind or option, an input that cannot be read.
    pub fn of(row: &Row) -> Result<Self> {
        let kind = match &row.kind {
            Some(name) => KINDS.iter().position(|(known, _)| known == name),
            None => Some(usize::from(AngleRows::open(&row.input).is_ok())),
        };
        let Some(kind) = kind else {
            let known: Vec<&str> = KINDS.iter().map(|(name, _)| *name).collect();
            bail!("kind `{}` is none of {}", row.kind.as_deref().unwrap_or_default(), known.join(", "));
        };
        let mut hash = Sha256::new();
        hash.update(format!("sinew {}\0{}\0", env!("CARGO_PKG_VERSION"), KINDS[kind].0));
        let mut options = row.options.clone();
        let mut left_out = Vec::new();
        for (name, value) in row.defaults.iter().filter(|(name, _)| !row.options.contains_key(*name)) {
            // An option of no kind is refused below.
            if is_of(kind, name) || !(0..KINDS.len()).any(|kind| is_of(kind, name)) {
                options.insert(name.clone(), value.clone());
            } else {
                left_out.push(name.clone());
            }
        }
        if KINDS[kind].1.iter().any(|(command, _)| *command == "track cyclic") {
            options.entry("model".to_owned()).or_insert_with(|| DEFAULT_MODEL.to_owned());
        }
        for (name, value) in &mut options {
            check_option(kind, name)?;
            hash.update(format!("{name}\0{value}\0"));
            // Beside the list, or as `--set` names it.
            let mut named = row.folders.iter().map(|folder| folder.join(&value));
            if let Some(file) = named.find(|file| file.is_file()) {
                hash.update(content::of(&file)?);
                hash.update(content::of_skeleton_beside(&file)?);
                *value = file.to_string_lossy().into_owned();
            }
        }
        hash.update(content::ending(&row.input));
        hash.update(content::of(&row.input)?);
        if !options.contains_key("skeleton") {
            hash.update(content::of_skeleton_beside(&row.input)?);
        }
        if KINDS[kind].1[0].0 == "track cyclic" {
            hash.update(content::of_about_beside(&row.input)?);
        }
        Ok(Self { key: format!("{:x}", hash.finalize()), input: row.input.clone(), kind, options, left_out })
    }

    /// The command lines that put the result into `folder`.
    ///
    /// # Errors
    /// An option has a value that it cannot have.
    pub fn command_lines(&self, folder: &Path) -> Result<Vec<Cli>> {
        let mut input = self.input.clone();
        let mut lines = Vec::new();
        for (words, output) in KINDS[self.kind].1 {
            let output = folder.join(output);
            let mut line: Vec<String> = std::iter::once("sinew").chain(words.split(' ')).map(str::to_owned).collect();
            line.push(input.to_string_lossy().into_owned());
            line.extend(["--out".to_owned(), output.to_string_lossy().into_owned()]);
            for (name, value) in &self.options {
                let Some(takes_value) = FLAGS[words].get(name) else { continue };
                match (name.as_str(), *takes_value) {
                    ("report", _) if is_yes(value) => {
                        line.push(format!("--report={}", folder.join("report").display()));
                    }
                    ("report", _) => (),
                    (_, true) => line.push(format!("--{name}={value}")),
                    (_, false) if is_yes(value) => line.push(format!("--{name}")),
                    (_, false) => (),
                }
            }
            let parsed = Cli::try_parse_from(&line);
            lines.push(parsed.map_err(|error| crate::error::Error::Option(first_line(&error.to_string())))?);
            input = output;
        }
        Ok(lines)
    }

    /// Checks what the command before the last answered: angles without a rate cannot be tracked.
    ///
    /// # Errors
    /// Names the input and the option that gives its rate.
    pub fn check_rate(&self, answer: &Value) -> Result<()> {
        if answer["rate_hz"].is_null() && !self.options.contains_key("rate") {
            let rule = "does not say how many frames a second it has; give --set input-rate=30 with your number, \
                or a column `input-rate`";
            return Err(CyclicError::unusable(&self.input, rule).into());
        }
        Ok(())
    }
}

/// A cell of an option that is on or off.
fn is_yes(value: &str) -> bool {
    matches!(value.to_ascii_lowercase().as_str(), "true" | "yes" | "1")
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned()
}

/// The options of each command, and whether they take a value.
static FLAGS: LazyLock<BTreeMap<&str, BTreeMap<String, bool>>> = LazyLock::new(|| {
    let mut all = BTreeMap::new();
    for words in KINDS.iter().flat_map(|(_, commands)| commands.iter().map(|(words, _)| *words)) {
        let mut command = Cli::command();
        for word in words.split(' ') {
            command = command.find_subcommand(word).cloned().unwrap_or_default();
        }
        let takes_value = |arg: &clap::Arg| matches!(arg.get_action(), ArgAction::Set | ArgAction::Append);
        let flags = command.get_arguments().filter_map(|arg| Some((arg.get_long()?.to_owned(), takes_value(arg))));
        all.insert(words, flags.collect());
    }
    all
});

/// Whether recordings of a kind have an option.
fn is_of(kind: usize, name: &str) -> bool {
    KINDS[kind].1.iter().any(|(words, _)| FLAGS[words].contains_key(name))
}

fn check_option(kind: usize, name: &str) -> Result<()> {
    let (kind_name, commands) = KINDS[kind];
    ensure!(!NOT_GIVEN.contains(&name), "`{name}` is the batch's own; remove the column");
    if is_of(kind, name) {
        return Ok(());
    }
    let known = commands.iter().flat_map(|(words, _)| FLAGS[words].keys());
    let similar = known.map(|flag| (strsim::jaro(flag, name), flag)).max_by(|a, b| a.0.total_cmp(&b.0));
    let nearest = similar.map_or_else(String::new, |(_, flag)| format!("; the nearest is `{flag}`"));
    bail!("a `{kind_name}` has no option `{name}`{nearest}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(folder: &Path, options: &[(&str, &str)]) -> Row {
        let input = folder.join("walk.csv");
        std::fs::write(&input, "l_knee_x,l_knee_y\n1,2\n").unwrap();
        let options = options.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        let (folders, defaults) = ([folder.to_path_buf(), PathBuf::new()], BTreeMap::new());
        Row { line: 2, id: "a".into(), input, folders, kind: None, options, defaults }
    }

    #[test]
    fn a_default_is_for_the_kinds_that_have_it() {
        let folder = tempfile::tempdir().unwrap();
        let of = |kind: &str, own: &[(&str, &str)], name: &str| {
            let mut row = Row { kind: Some(kind.to_owned()), ..row(folder.path(), own) };
            row.set(&[(name.to_owned(), "30".to_owned())]);
            Job::of(&row).map(|job| (job.options.get(name).cloned(), job.left_out)).map_err(|error| error.to_string())
        };
        let thirty = || Some("30".to_owned());
        assert_eq!(of("recording", &[], "input-rate"), Ok((thirty(), vec![])));
        assert_eq!(of("cyclic", &[], "input-rate"), Ok((None, vec!["input-rate".to_owned()])));
        assert_eq!(of("recording", &[("input-rate", "60")], "input-rate"), Ok((Some("60".to_owned()), vec![])));
        for (name, rule) in [("input-rat", "nearest is `"), ("out", "batch's own")] {
            assert!(of("cyclic", &[], name).is_err_and(|error| error.contains(rule)), "{name}");
        }
        assert!(of("cyclic", &[("input-rate", "30")], "model").unwrap_err().contains("no option `input-rate`"));
    }

    #[test]
    fn options_go_to_the_commands_that_have_them() {
        let folder = tempfile::tempdir().unwrap();
        let job = Job::of(&row(folder.path(), &[("input-rate", "30"), ("online", "true"), ("strict", "no")])).unwrap();
        let lines = job.command_lines(Path::new("out")).unwrap();
        assert_eq!(lines.len(), 2);
        assert!(matches!(&lines[0].command, crate::cli::Command::Angles(args) if args.input_rate == Some(30.0)));
        let message = Job::of(&row(folder.path(), &[("modle", "walking")])).unwrap_err().to_string();
        assert!(message.contains("no option `modle`; the nearest is `model`"), "{message}");
        assert!(Job::of(&row(folder.path(), &[("out", "x")])).unwrap_err().to_string().contains("batch's own"));
        let wrong = Job::of(&row(folder.path(), &[("input-rate", "fast")])).unwrap();
        assert!(wrong.command_lines(Path::new("out")).unwrap_err().to_string().contains("fast"));
    }

    #[test]
    fn angles_without_a_rate_are_refused_by_the_name_of_the_input() {
        let folder = tempfile::tempdir().unwrap();
        let checked = |options: &[(&str, &str)], answer: Value| {
            let job = Job::of(&row(folder.path(), options)).unwrap();
            job.check_rate(&answer).map_err(|error| error.to_string())
        };
        let message = checked(&[], serde_json::json!({ "rate_hz": null })).unwrap_err();
        assert!(message.contains("walk.csv") && message.contains("--set input-rate=30"), "{message}");
        assert_eq!(checked(&[], serde_json::json!({ "rate_hz": 30.0 })), Ok(()));
        assert_eq!(checked(&[("rate", "30")], serde_json::json!({ "rate_hz": null })), Ok(()));
    }

    #[test]
    fn a_key_is_that_of_contents_and_options() {
        let folder = tempfile::tempdir().unwrap();
        let key = |options: &[(&str, &str)]| Job::of(&row(folder.path(), options)).unwrap().key;
        assert_eq!(key(&[]), key(&[]));
        assert_ne!(key(&[]), key(&[("input-rate", "30")]));
        std::fs::write(folder.path().join("m.json"), "1").unwrap();
        let with_model = key(&[("model", "m.json")]);
        std::fs::write(folder.path().join("m.json"), "2").unwrap();
        assert_ne!(with_model, key(&[("model", "m.json")]));
    }

    #[test]
    fn a_key_is_that_of_the_ending_and_of_what_is_read_beside() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        let key = |name: &str, kind: &str, options: &[(&str, &str)]| {
            let row = row(folder.path(), options);
            let row = Row { input: folder.path().join(name), kind: Some(kind.to_owned()), ..row };
            Job::of(&row).unwrap().key
        };
        for name in ["a.csv", "b.CSV", "a.txt", "m.amc"] {
            put(name, "1\n");
        }
        let all = || {
            let skeleton = [("skeleton", "given.asf")];
            [
                key("a.csv", "cyclic", &[]),
                key("a.csv", "angles", &[]),
                key("m.amc", "angles", &[]),
                key("m.amc", "angles", &skeleton),
                key("a.csv", "body", &[("skeleton", "m.amc")]),
            ]
        };
        assert_eq!(key("a.csv", "angles", &[]), key("b.CSV", "angles", &[]));
        assert_ne!(key("a.csv", "angles", &[]), key("a.txt", "angles", &[]));
        let mut before = all();
        for (name, text, are_other) in [
            ("a.about.json", "1", [true, false, false, false, false]),
            ("a.about.json", "2", [true, false, false, false, false]),
            ("02.asf", "1", [false, false, true, false, true]),
            ("02.asf", "2", [false, false, true, false, true]),
        ] {
            put(name, text);
            let now = all();
            assert_eq!(std::array::from_fn(|index| now[index] != before[index]), are_other, "{name} {text}");
            before = now;
        }
    }
}
