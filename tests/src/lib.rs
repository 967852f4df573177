//! Instruments that the tests of this package share.

use clap::{CommandFactory, Parser};
pub mod imports;

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::SystemTime;

/// Exit statuses of a command that refuses an option or an input.
pub const REFUSED: &[i32] = &[64, 65, 66];

/// Whether a test that takes long is left out, as `.ci/run` does in its short form; says so aloud.
#[must_use]
pub fn leaves_out_long_tests() -> bool {
    let is_short = env::var_os("SINEW_SHORT_TESTS").is_some();
    if is_short {
        eprintln!("left out: takes long, and SINEW_SHORT_TESTS is set");
    }
    is_short
}

/// The command `sinew` of this workspace, freshly built in the profile of the running test.
///
/// `CARGO_BIN_EXE_sinew` is set for the tests of the package that owns the binary only, and `cargo
/// test` does not build binaries of other packages. So the target folder is taken from the path of
/// the running test. Cargo is asked once a process to bring the binary up to date, which is quick
/// if it is. Where `cargo test` was given a `--config`, `SINEW_CARGO_CONFIG` has to name it, too.
///
/// # Panics
/// If the binary cannot be built.
#[must_use]
pub fn sinew_command() -> Command {
    static BINARY: OnceLock<PathBuf> = OnceLock::new();
    Command::new(BINARY.get_or_init(build_sinew))
}

fn build_sinew() -> PathBuf {
    let test = env::current_exe().expect("the running test has a path");
    // TARGET/PROFILE/deps/TEST
    let profile_folder = test.ancestors().nth(2).expect("a test lies in TARGET/PROFILE/deps");
    let target_folder = profile_folder.parent().expect("a profile folder lies in the target folder");
    let profile = match profile_folder.file_name().and_then(|name| name.to_str()) {
        Some("debug") | None => "dev",
        Some(profile) => profile,
    };
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let config = env::var("SINEW_CARGO_CONFIG").ok();
    let output = Command::new(cargo)
        .args(config.iter().flat_map(|config| ["--config", config]))
        .current_dir(workspace_root())
        .args([
            "build",
            "--quiet",
            "--workspace",
            "--bin",
            "sinew",
            "--bin",
            "sinew-lab",
            // A test among the targets makes cargo choose the features of `cargo test --workspace`,
            // so that the library is not compiled once more.
            "--test",
            "project",
            "--profile",
            profile,
            "--target-dir",
        ])
        .arg(target_folder)
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "sinew cannot be built: {}", String::from_utf8_lossy(&output.stderr));
    profile_folder.join(format!("sinew{}", env::consts::EXE_SUFFIX))
}

/// All commands of `sinew`, with those below `evaluate`, which the program `sinew-lab` has.
#[must_use]
pub fn command_tree() -> clap::Command {
    let lab = sinew_lab::cli::Cli::command();
    let evaluate = lab.find_subcommand("evaluate").expect("the lab evaluates").clone();
    sinew::cli::Cli::command().mut_subcommand("evaluate", |_| evaluate)
}

/// Reads a command line as `sinew` or, where it begins with `evaluate`, as `sinew-lab` does;
/// `words` begin after the program.
///
/// # Errors
/// What clap says of words that are not understood.
pub fn parse<'a>(words: impl IntoIterator<Item = &'a str>) -> Result<(), clap::Error> {
    let words: Vec<&str> = std::iter::once("sinew").chain(words).collect();
    if words.get(1) == Some(&"evaluate") {
        return sinew_lab::cli::Cli::try_parse_from(words).map(drop);
    }
    sinew::cli::Cli::try_parse_from(words).map(drop)
}

/// Every file below `folder`, by its path from there; the numbers in `run.json` that `times` names
/// are left out, which differ from run to run.
///
/// # Panics
/// If something cannot be read, or `run.json` has no such number.
#[must_use]
pub fn files_below(folder: &Path, times: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![(String::new(), folder.to_path_buf())];
    while let Some((prefix, folder)) = folders.pop() {
        for entry in fs::read_dir(folder).expect("the folder can be read") {
            let path = entry.expect("the folder can be read").path();
            let name = format!("{prefix}{}", path.file_name().unwrap_or_default().to_string_lossy());
            if path.is_dir() {
                folders.push((format!("{name}/"), path));
            } else {
                files.insert(name, fs::read(path).expect("the file can be read"));
            }
        }
    }
    if let Some(bytes) = files.get_mut("run.json") {
        let mut report: serde_json::Value = serde_json::from_slice(bytes).expect("run.json is JSON");
        for name in times {
            assert!(report[*name].take().as_f64().is_some_and(|time| time > 0.0), "run.json has no {name}");
        }
        *bytes = report.to_string().into_bytes();
    }
    files
}

/// Root folder of the workspace.
#[must_use]
pub fn workspace_root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().unwrap_or(package)
}

/// A folder or file of the development data beside the workspace; `None`, with a line that says so,
/// where it is not there.
#[must_use]
pub fn shared_data(path: &str) -> Option<PathBuf> {
    let from = env::var_os("SINEW_SHARED_DATA").map_or_else(|| workspace_root().join("../shared/data"), PathBuf::from);
    let full = from.join(path);
    if full.exists() {
        return Some(full);
    }
    eprintln!("skipped: the development data `{path}` is not there (looked in {})", from.display());
    None
}

/// When a file was last changed.
///
/// # Panics
/// If there is no such file.
#[must_use]
pub fn modified(file: &Path) -> SystemTime {
    fs::metadata(file).and_then(|facts| facts.modified()).unwrap()
}

/// Gives a file the time of its last change.
///
/// # Panics
/// If that cannot be done.
pub fn set_modified(file: &Path, at: SystemTime) {
    let file = fs::File::options().write(true).open(file).unwrap();
    file.set_times(fs::FileTimes::new().set_modified(at)).unwrap();
}

/// Rows of a table, by the names of its columns.
#[must_use]
pub fn table_rows(table: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(table).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}
