//! On an emulated Cortex-M4F: an interrupt uses a tracker in the middle of its calls, and all
//! objects work on a task's small stack, whose end is watched.

use sinew_c_interface::{expect_success, has_target, has_tool, static_library, workspace_root};
use std::process::Command;

const TARGET: &str = "thumbv7em-none-eabihf";
/// The last line is the control: calls go deeper than a stack of 2 KiB, and the canaries show it.
const EXPECTED: &str = "\
results differ: 0, wrong answers: 0
busy: often, refused as late: yes
on a stack of its own: done
canaries below 9216 bytes: alive
canaries below 2048 bytes: dead
";

#[test]
fn an_interrupt_finds_a_tracker_busy_and_a_small_stack_suffices() {
    let tools = ["arm-none-eabi-gcc", "qemu-system-arm", "timeout"];
    if !(tools.into_iter().all(has_tool) && has_target(TARGET)) {
        return;
    }
    let library = static_library("sinew-core", Some(TARGET), "3", "c-api,walking-model,prove-no-panic");
    let (folder, scratch) = (workspace_root().join("tests/c_interface"), tempfile::tempdir().unwrap());
    let program = scratch.path().join("program");
    let mut command = Command::new("arm-none-eabi-gcc");
    command.args(["-std=gnu11", "-O2", "-Wall", "-Wextra", "-Werror", "-ffunction-sections", "-ffp-contract=off"]);
    command.args(["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "--specs=rdimon.specs"]);
    command.args(["-nostartfiles", "-Wl,--gc-sections", "-T"]).arg(folder.join("examples/mps2.ld"));
    command.arg("-I").arg(workspace_root().join("core/include"));
    command.args([folder.join("examples/start.c"), folder.join("interrupts/program.c"), library]);
    expect_success(command.arg("-o").arg(&program));
    let mut emulator = Command::new("timeout");
    emulator.args(["120", "qemu-system-arm", "-machine", "mps2-an386", "-nographic", "-monitor", "none"]);
    // The same time passes for each instruction, so that interrupts come at the same places.
    emulator.args(["-icount", "shift=6,align=off,sleep=off", "-serial", "none"]);
    emulator.args(["-semihosting-config", "enable=on,target=native", "-kernel"]).arg(&program);
    let output = expect_success(&mut emulator);
    eprintln!("{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout).replace("\r\n", "\n"), EXPECTED);
}
