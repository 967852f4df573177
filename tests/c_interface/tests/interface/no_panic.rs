//! No function of the interface can panic, nor what firmware in Rust calls each frame
//! (`rust_entry_points.rs`). The linker finds no way to a panic in the library that firmware ships.
//!
//! The library is built with `prove-no-panic`, in which a panic calls a function that is defined
//! nowhere. Each public function is linked alone and everything that it does not reach is dropped;
//! what is left must not miss that function. `SINEW_ALL_TARGETS=1` proves it for all targets and
//! levels.

use sinew_c_interface::{
    LEVELS, cargo, expanded_source, expect_success, has_target, has_tool, is_checked, static_library, workspace_root,
};
use std::fs;
use std::path::Path;
use std::process::Command;

const TARGETS: [&str; 4] =
    ["thumbv6m-none-eabi", "thumbv7em-none-eabihf", "thumbv8m.main-none-eabihf", "riscv32imc-unknown-none-elf"];
/// Packages with the features of the proof, and where their entry points stand.
const PROVED: [(&str, &str, &str); 2] = [
    ("sinew-core", "c-api,walking-model,prove-no-panic", "core/src/c_api"),
    ("sinew-record", "prove-no-panic", "core/record/src"),
];
/// What a panic would call.
const UNDEFINED: &str = "sinew_panic_is_reachable";

/// Names of the entry points that the sources in `folder` define.
fn public_functions(folder: &str) -> Vec<String> {
    let mut names = Vec::new();
    for source in fs::read_dir(workspace_root().join(folder)).unwrap() {
        let source = expanded_source(&source.unwrap().path());
        for function in source.split("pub extern \"C\" fn ").chain(source.split("pub unsafe extern \"C\" fn ")) {
            names
                .extend(function.split(['(', '<']).next().filter(|name| name.starts_with("sinew_")).map(str::to_owned));
        }
    }
    names.sort();
    names.dedup();
    names
}

/// The linker for a target, and its arguments.
fn linker(target: &str) -> &'static [&'static str] {
    if target.starts_with("riscv") { &["riscv64-unknown-elf-ld", "-melf32lriscv"] } else { &["arm-none-eabi-ld"] }
}

/// Links `function` of `library` alone; the error text if a panic can be reached.
fn reaches_a_panic(target: &str, library: &Path, function: &str, folder: &Path) -> Option<String> {
    let [linker, arguments @ ..] = linker(target) else { return None };
    let mut command = Command::new(linker);
    command.args(arguments).args(["--gc-sections", "-e", function, "-u", function]);
    let output = command.arg(library).arg("-o").arg(folder.join("linked")).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() || text.contains(UNDEFINED),
        "{function} cannot be linked for another reason:\n{text}"
    );
    assert!(!text.contains("cannot find entry symbol"), "{function} is not in the library:\n{text}");
    (!output.status.success()).then_some(text)
}

/// Functions that are not proved, and why.
fn prove(target: &str, level: &str) -> Vec<String> {
    let mut found = Vec::new();
    if !(has_tool(linker(target)[0]) && has_target(target)) {
        return found;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    for (package, features, sources) in PROVED {
        let library = static_library(package, Some(target), level, features);
        for function in public_functions(sources) {
            if let Some(text) = reaches_a_panic(target, &library, &function, folder.path()) {
                found.push(format!("{function} can panic on {target} at {level}:\n{text}"));
            }
            count += 1;
        }
    }
    assert!(count > 33, "only {count} entry points");
    found
}

#[test]
fn no_public_function_reaches_a_panic() {
    let all = TARGETS.into_iter().flat_map(|target| LEVELS.map(|level| (target, level)));
    let wanted = all.filter(|(target, level)| is_checked(target, level));
    let found: Vec<String> = wanted.flat_map(|(target, level)| prove(target, level)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

const CONTROL_MANIFEST: &str = r#"
[package]
name = "control"
edition = "2024"
[lib]
crate-type = ["staticlib"]
[profile.release]
lto = "fat"
codegen-units = 1
panic = "abort"
[workspace]
"#;

const CONTROL_SOURCE: &str = r#"
#![no_std]
unsafe extern "C" { fn sinew_panic_is_reachable() -> !; }
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! { unsafe { sinew_panic_is_reachable() } }
#[unsafe(no_mangle)]
pub extern "C" fn checked(list: &[u8; 4], index: usize) -> u8 { list.get(index).copied().unwrap_or(0) }
#[unsafe(no_mangle)]
pub extern "C" fn unchecked(list: &[u8; 4], index: usize) -> u8 { list[index] }
"#;

/// A library in which one function indexes by an unchecked number has to be distinguished from the
/// others.
#[test]
fn the_check_finds_a_function_that_can_panic() {
    const TARGET: &str = "thumbv7em-none-eabihf";
    if !(has_tool(linker(TARGET)[0]) && has_target(TARGET)) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("Cargo.toml"), CONTROL_MANIFEST).unwrap();
    fs::create_dir(folder.path().join("src")).unwrap();
    fs::write(folder.path().join("src/lib.rs"), CONTROL_SOURCE).unwrap();
    let mut command = cargo("build", Some(TARGET));
    command.current_dir(folder.path()).args(["--quiet", "--release", "--target-dir"]).arg(folder.path().join("out"));
    expect_success(&mut command);
    let library = folder.path().join("out").join(TARGET).join("release/libcontrol.a");
    assert_eq!(reaches_a_panic(TARGET, &library, "checked", folder.path()), None);
    assert!(reaches_a_panic(TARGET, &library, "unchecked", folder.path()).is_some_and(|text| text.contains(UNDEFINED)));
}
