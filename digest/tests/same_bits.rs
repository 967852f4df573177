//! Every target gives the digests of `expected.txt`.
//!
//! After a wanted change of a tracker: `SINEW_REGENERATE=1 cargo test --release -p sinew-digest`.

use sinew_digest::{FRAMES, Line, Subject};
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

const WASM: &str = "wasm32-unknown-unknown";

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(mut digest: impl FnMut(Subject) -> u64) -> String {
    Subject::ALL.map(|subject| format!("{}\n", Line { subject, digest: digest(subject) })).concat()
}

/// The digests that every target has to give: those of this build where the file is being written anew.
fn expected() -> String {
    if regenerates() { here() } else { std::fs::read_to_string(package().join("expected.txt")).unwrap() }
}

fn regenerates() -> bool {
    env::var_os("SINEW_REGENERATE").is_some()
}

/// The digests of this build.
fn here() -> String {
    text(|subject| subject.digest(FRAMES).unwrap())
}

/// Says what is left out for want of a tool; a failure where CI has to have it.
fn leave_out(what: &str) {
    assert!(env::var("CI").as_deref() != Ok("true"), "{what}");
    eprintln!("left out: {what}");
}

fn found(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Whether the compiler has a library for `target`.
fn has_target(target: &str) -> bool {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).args(["--print", "target-libdir", "--target", target]).output().unwrap();
    output.status.success() && Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir()
}

/// The module that `SINEW_DIGEST_MODULE` names, or one that is built now in release; `None` without a compiler for it.
fn module() -> Option<PathBuf> {
    if let Some(module) = env::var_os("SINEW_DIGEST_MODULE") {
        return Some(module.into());
    }
    if !has_target(WASM) {
        return None;
    }
    // TARGET/PROFILE/deps/TEST
    let test = env::current_exe().unwrap();
    let target_folder = test.ancestors().nth(3).unwrap();
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(package())
        .args(["build", "--quiet", "--release", "--example", "digest_module", "--target", WASM, "--target-dir"])
        .arg(target_folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(target_folder.join(WASM).join("release/examples/digest_module.wasm"))
}

#[test]
fn this_build_gives_the_expected_digests() {
    if regenerates() {
        std::fs::write(package().join("expected.txt"), here()).unwrap();
    }
    assert_eq!(here(), expected());
}

#[test]
fn web_assembly_gives_the_expected_digests() {
    if !found("node") {
        return leave_out("node is missing; install it to run WebAssembly");
    }
    let Some(module) = module() else {
        return leave_out("the compiler lacks wasm32-unknown-unknown: `rustup target add wasm32-unknown-unknown`");
    };
    let output = Command::new("node")
        .arg(package().join("tests/run_module.mjs"))
        .arg(module)
        .args([FRAMES, Subject::ALL.len() as u32].map(|number| number.to_string()))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = String::from_utf8(output.stdout).unwrap();
    let mut numbers = numbers.lines().map(|line| u64::from_str_radix(line, 16).unwrap());
    assert_eq!(text(|_| numbers.next().unwrap()), expected());
}

#[test]
fn every_frame_counts() {
    for subject in Subject::ALL {
        let digests = [20, 21, 22].map(|frames| subject.digest(frames).unwrap());
        assert!(digests[0] != digests[1] && digests[1] != digests[2], "{subject:?}");
    }
}
