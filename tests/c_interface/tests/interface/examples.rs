//! The examples in C: on this computer with sanitizers, and on an emulated Cortex-M4F. They print
//! the same.

use sinew_c_interface::{expect_success, has_target, has_tool, leaves_out_long_builds, static_library, workspace_root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const EXAMPLES: [&str; 2] = ["walking", "camera"];
const TARGET: &str = "thumbv7em-none-eabihf";
const WARNINGS: [&str; 8] = [
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wshadow",
    "-Wconversion",
    "-Werror",
    // What a compiler makes one instruction of a product and a sum rounds differently.
    "-ffp-contract=off",
    "-O1",
];

fn folder() -> PathBuf {
    workspace_root().join("tests/c_interface/examples")
}

/// Compares what an example printed with the file beside it, or writes that file.
fn expect_output(example: &str, stdout: &[u8]) {
    let path = folder().join(format!("{example}.out"));
    let text = String::from_utf8_lossy(stdout).replace("\r\n", "\n");
    if std::env::var_os("SINEW_REGENERATE").is_some() {
        fs::write(&path, &text).unwrap();
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(text, expected, "{example}; SINEW_REGENERATE=1 cargo test -p sinew-c-interface examples");
}

fn compiler(name: &str, standard: &str) -> Command {
    let mut command = Command::new(name);
    command.arg(format!("-std={standard}")).args(WARNINGS).arg("-I").arg(workspace_root().join("core/include"));
    command
}

#[test]
fn the_examples_run_on_this_computer_under_the_sanitizers() {
    if !has_tool("gcc") {
        return;
    }
    let library = static_library("sinew-core", None, "1", "c-api,walking-model,panic-handler");
    let scratch = tempfile::tempdir().unwrap();
    for example in EXAMPLES {
        for standard in ["c99", "c11"] {
            let program = scratch.path().join(format!("{example}-{standard}"));
            let mut command = compiler("gcc", standard);
            command.args(["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]);
            command.arg(folder().join(format!("{example}.c"))).arg(&library).arg("-o").arg(&program);
            expect_success(&mut command);
            expect_output(example, &expect_success(&mut Command::new(&program)).stdout);
        }
    }
}

/// Four times as many pixels of the same pictures give the same hand until it is hidden.
#[test]
fn larger_frames_are_taken_by_a_library_for_them() {
    if leaves_out_long_builds() || !has_tool("gcc") {
        return;
    }
    let library = static_library("sinew-core", None, "1", "c-api,panic-handler,vga");
    let scratch = tempfile::tempdir().unwrap();
    let program = scratch.path().join("camera");
    let mut command = compiler("gcc", "c11");
    command.args(["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-DSINEW_VGA"]);
    expect_success(command.arg(folder().join("camera.c")).arg(&library).arg("-o").arg(&program));
    let output = String::from_utf8(expect_success(&mut Command::new(&program)).stdout).unwrap();
    let small = fs::read_to_string(folder().join("camera.out")).unwrap();
    let row = |line: &str| line.split(' ').filter_map(|field| field.parse().ok()).collect::<Vec<f32>>();
    let mut compared = 0;
    for (line, small) in output.lines().zip(small.lines()).skip(1).take(8) {
        let (large, small) = (row(line), row(small));
        let (&[.., u_px, v_px, _, _, _], &[.., small_u_px, small_v_px, _, _, _]) = (&large[..], &small[..]) else {
            panic!("{line}");
        };
        let off_px = (u_px - 2.0 * small_u_px).hypot(v_px - 2.0 * small_v_px);
        assert!(off_px < 12.0, "{line}: {off_px} pixels of 640 x 480 off");
        compared += 1;
    }
    assert_eq!(compared, 8, "{output}");
}

/// Levels at which the examples and their start are compiled for the emulator; the last flag
/// counts.
const LEVELS: [&str; 3] = ["-O0", "-O2", "-Os"];

fn link_for_the_emulator(example: &str, level: &str, library: &Path, program: &Path) {
    let mut command = compiler("arm-none-eabi-gcc", "c11");
    command.arg(level);
    command.args(["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "--specs=rdimon.specs"]);
    command.args(["-nostartfiles", "-ffunction-sections", "-Wl,--gc-sections", "-T"]).arg(folder().join("mps2.ld"));
    // `bkpt` and the registers of a call are no standard C.
    command.arg("-Wno-pedantic").arg(folder().join("start.c"));
    command.arg(folder().join(format!("{example}.c"))).arg(library).arg("-o").arg(program);
    expect_success(&mut command);
}

#[test]
fn the_examples_run_on_an_emulated_cortex_m4f() {
    let tools = ["arm-none-eabi-gcc", "qemu-system-arm", "timeout"];
    if !(tools.into_iter().all(has_tool) && has_target(TARGET)) {
        return;
    }
    // Linked with the library in which a panic would be missing at link time: the link itself is a
    // proof.
    let library = static_library("sinew-core", Some(TARGET), "3", "c-api,walking-model,prove-no-panic");
    let scratch = tempfile::tempdir().unwrap();
    for (example, level) in EXAMPLES.into_iter().flat_map(|example| LEVELS.map(|level| (example, level))) {
        let program = scratch.path().join(example);
        link_for_the_emulator(example, level, &library, &program);
        let mut emulator = Command::new("timeout");
        emulator.args(["120", "qemu-system-arm", "-machine", "mps2-an386", "-nographic", "-monitor", "none"]);
        emulator.args(["-serial", "none", "-semihosting-config", "enable=on,target=native", "-kernel"]).arg(&program);
        let output = expect_success(&mut emulator);
        eprintln!("{example} {level}: {}", String::from_utf8_lossy(&output.stderr));
        expect_output(example, &output.stdout);
    }
}
