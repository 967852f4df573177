//! What the tests of the interface for C share: where things lie, and which tools there are.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Root folder of the workspace.
///
/// # Panics
/// Never: the package lies in the workspace.
#[must_use]
pub fn workspace_root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the package lies in the workspace")
}

/// The text of a source of the interface, with the functions of its macros written out: cbindgen
/// expands no macros.
///
/// # Panics
/// If the file cannot be read, or does not use the macros as `c_api/stateful.rs` defines them.
#[must_use]
pub fn expanded_source(path: &Path) -> String {
    let read = |path: &Path| fs::read_to_string(path).expect("the interface has this source");
    let (mut source, macros) = (read(path), read(&workspace_root().join("core/src/c_api/stateful.rs")));
    for definition in macros.split("macro_rules! ").skip(1) {
        let (name, definition) = definition.split_once(" {").expect("a macro has a name");
        let (matcher, body) = definition.split_once(") => {\n").expect("a macro has one arm");
        let body = body.split("\n    };\n").next().expect("an arm ends").replace("$crate", "crate");
        let call = format!("\n{name}!(");
        while let Some((before, after)) = source.split_once(&call) {
            let (values, after) = after.split_once(");\n").expect("a call of a macro ends");
            let names = matcher.trim_start_matches(['(', ' ', '\n']).split(',');
            let text = names.zip(values.split(',')).fold(body.clone(), |text, (name, value)| {
                let name = name.trim().split(':').next().expect("a parameter has a name");
                text.replace(name, value.trim())
            });
            source = format!("{before}\n{text}\n{after}");
        }
    }
    source
}

/// Whether `tool` runs; where it does not, says what is left out, and fails in CI, which has to
/// have all tools.
///
/// # Panics
/// With `CI=true`, if the tool is missing.
#[must_use]
pub fn has_tool(tool: &str) -> bool {
    let runs = Command::new(tool).arg("--version").output().is_ok_and(|output| output.status.success());
    if !runs {
        missing(tool);
    }
    runs
}

/// Whether libraries for the Rust `target` can be built; as [`has_tool`].
///
/// # Panics
/// With `CI=true`, if the target is missing.
#[must_use]
pub fn has_target(target: &str) -> bool {
    if builds_with_debian() {
        return true;
    }
    let sysroot = Command::new(rustc()).args(["--print", "sysroot"]).output().ok();
    let sysroot = sysroot.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default();
    let exists = Path::new(&sysroot).join("lib/rustlib").join(target).is_dir();
    if !exists {
        missing(&format!("the target {target} (`rustup target add {target}`)"));
    }
    exists
}

fn missing(what: &str) {
    assert!(std::env::var("CI").as_deref() != Ok("true"), "CI has no {what}");
    eprintln!("left out: there is no {what}");
}

/// Whether the targets come from Debian's compiler, which builds their core library from source
/// (`.ci/run` says so).
///
/// What it compiles is a little larger or smaller than what stands in tables.
#[must_use]
pub fn builds_with_debian() -> bool {
    std::env::var("SINEW_BARE_METAL").as_deref() == Ok("debian")
}

/// Whether every target and level is to be checked, which takes many builds of the library;
/// otherwise two, and one in the short form.
#[must_use]
pub fn checks_all_targets() -> bool {
    std::env::var_os("SINEW_ALL_TARGETS").is_some()
}

/// Whether only the shorter builds are wanted, as by `.ci/run` in its short form.
fn is_short_form() -> bool {
    std::env::var_os("SINEW_SHORT_TESTS").is_some()
}

/// Whether a test whose build takes long is left out; says so aloud.
#[must_use]
pub fn leaves_out_long_builds() -> bool {
    if is_short_form() {
        eprintln!("left out: takes long, and SINEW_SHORT_TESTS is set");
    }
    is_short_form()
}

/// Targets and levels that are checked where not all are; the short form checks the first.
const USUAL: [(&str, &str); 2] = [("thumbv7em-none-eabihf", "3"), ("thumbv6m-none-eabi", "s")];

/// Whether `level` is to be checked for `target`.
#[must_use]
pub fn is_checked(target: &str, level: &str) -> bool {
    let usual = if is_short_form() { &USUAL[..1] } else { &USUAL[..] };
    checks_all_targets() || usual.contains(&(target, level))
}

/// Levels that firmware is built at.
pub const LEVELS: [&str; 4] = ["2", "3", "s", "z"];

/// Cargo that builds for `target`, or for this machine: `cargo SUBCOMMAND`.
#[must_use]
pub fn cargo(subcommand: &str, target: Option<&str>) -> Command {
    let own = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let Some(target) = target else {
        let mut command = Command::new(own);
        command.arg(subcommand);
        return command;
    };
    let mut command = if builds_with_debian() {
        let mut command = Command::new("/usr/bin/cargo");
        command.env("RUSTC", "/usr/bin/rustc").env("RUSTC_BOOTSTRAP", "1");
        command.args([subcommand, "-Zbuild-std=core"]);
        command
    } else {
        let mut command = Command::new(own);
        command.arg(subcommand);
        command
    };
    command.args(["--target", target]);
    command
}

fn rustc() -> std::ffi::OsString {
    std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into())
}

/// Builds the static library of `package` as a user does, and gives its path.
///
/// `target` is a triple, or `None` for this machine; `opt_level` is `1`, `2`, `3`, `s` or `z`.
///
/// # Panics
/// If it cannot be built.
#[must_use]
pub fn static_library(package: &str, target: Option<&str>, opt_level: &str, features: &str) -> PathBuf {
    // A folder of its own: the build that runs this test holds the lock of the other one.
    let folder = target_folder().join(format!("{package}-{opt_level}-{}", features.replace(',', "-")));
    let mut command = cargo("rustc", target);
    command.current_dir(workspace_root()).args(["--quiet", "--locked", "-p", package]);
    command.args(["--profile", "firmware", "--crate-type", "staticlib", "--features", features]);
    command.env("CARGO_PROFILE_FIRMWARE_OPT_LEVEL", opt_level).env("CARGO_PROFILE_FIRMWARE_DEBUG", "0");
    command.arg("--target-dir").arg(&folder);
    expect_success(&mut command);
    folder.join(target.unwrap_or("")).join(format!("firmware/lib{}.a", package.replace('-', "_")))
}

fn target_folder() -> PathBuf {
    // TARGET/PROFILE/deps/TEST
    let test = std::env::current_exe().expect("the running test has a path");
    test.ancestors().nth(3).expect("a test lies in TARGET/PROFILE/deps").to_owned()
}

/// Runs `command`, which has to succeed, and gives its output.
///
/// # Panics
/// If it does not succeed.
pub fn expect_success(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(
        output.status.success(),
        "{command:?}: {}\n{}\n{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    output
}
