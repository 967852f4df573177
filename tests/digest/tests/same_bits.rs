//! Every target gives the digests of `expected.txt`.
//!
//! After a wanted change of a tracker: `SINEW_REGENERATE=1 cargo test --release -p sinew-digest`.

use sinew_digest::{FRAMES, Line, Subject};
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

const WASM: &str = "wasm32-unknown-unknown";
const CORTEX_M4F: &str = "thumbv7em-none-eabihf";

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(mut digest: impl FnMut(Subject) -> u64) -> String {
    Subject::ALL.map(|subject| format!("{}\n", Line { subject, digest: digest(subject) })).concat()
}

/// The digests that every target has to give: those of this build where the file is being written
/// anew.
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

/// An example's file for `target`: the one that the environment's `variable` names, or `file` built
/// now in release; `None` without a compiler for it.
fn example(example: &str, target: &str, variable: Option<&str>, file: &str) -> Option<PathBuf> {
    if let Some(path) = variable.and_then(env::var_os) {
        return Some(path.into());
    }
    if !has_target(target) {
        return None;
    }
    // TARGET/PROFILE/deps/TEST
    let test = env::current_exe().unwrap();
    let target_folder = test.ancestors().nth(3).unwrap();
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(package())
        .args(["build", "--quiet", "--release", "--example", example, "--target", target, "--target-dir"])
        .arg(target_folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(target_folder.join(target).join("release/examples").join(file))
}

/// What a program that has to succeed printed.
fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{:?}: {out}{err}", output.status);
    out.into_owned()
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
    let Some(module) = example("digest_module", WASM, Some("SINEW_DIGEST_MODULE"), "digest_module.wasm") else {
        return leave_out("the compiler lacks wasm32-unknown-unknown: `rustup target add wasm32-unknown-unknown`");
    };
    let counts = [FRAMES, Subject::ALL.len() as u32].map(|number| number.to_string());
    let script = package().join("tests/run_module.mjs");
    let numbers = printed(Command::new("node").arg(script).arg(module).args(counts));
    let mut numbers = numbers.lines().map(|line| u64::from_str_radix(line, 16).unwrap());
    assert_eq!(text(|_| numbers.next().unwrap()), expected());
}

/// What an emulated `machine` prints of the program for `target`.
fn emulated(machine: &str, target: &str, variable: Option<&str>) -> Option<String> {
    if !found("qemu-system-arm") {
        leave_out("qemu-system-arm is missing; install it to run firmware");
        return None;
    }
    let Some(image) = example("bare", target, variable, "bare") else {
        leave_out(&format!("the compiler lacks {target}: `rustup target add {target}`"));
        return None;
    };
    // A fault locks the processor up, which ends the emulator with a failure.
    let mut emulator = Command::new("qemu-system-arm");
    emulator.args(["-machine", machine, "-nographic", "-monitor", "none", "-serial", "null"]);
    emulator.args(["-semihosting-config", "enable=on,target=native", "-kernel"]).arg(image);
    Some(printed(&mut emulator))
}

#[test]
fn an_emulated_cortex_m4f_gives_the_expected_digests() {
    let Some(digests) = emulated("mps2-an386", CORTEX_M4F, Some("SINEW_DIGEST_IMAGE")) else { return };
    assert_eq!(digests, expected());
}

/// A Cortex-M33 with an FPU, one without, and code for a Cortex-M0, which has neither FPU nor a
/// division.
#[test]
fn other_emulated_processors_give_the_expected_digests() {
    if env::var_os("SINEW_ALL_TARGETS").is_none() {
        eprintln!("left out: other processors, some minutes: SINEW_ALL_TARGETS=1 runs them");
        return;
    }
    for (machine, target) in [
        ("mps2-an505", "thumbv8m.main-none-eabihf"),
        ("mps2-an386", "thumbv7em-none-eabi"),
        ("mps2-an385", "thumbv6m-none-eabi"),
    ] {
        let Some(digests) = emulated(machine, target, None) else { continue };
        assert_eq!(digests, expected(), "{target}");
    }
}

#[test]
fn every_frame_counts() {
    for subject in Subject::ALL {
        let digests = [20, 21, 22].map(|frames| subject.digest(frames).unwrap());
        assert!(digests[0] != digests[1] && digests[1] != digests[2], "{subject:?}");
    }
}
