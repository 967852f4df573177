//! A panic of the library calls the program's `sinew_on_panic`, and loops where there is none.
//!
//! No function of the library panics, so a library with one that does is built around it.

use sinew_c_interface::{cargo, expect_success, has_tool, leaves_out_long_builds, workspace_root};
use std::fs;
use std::path::Path;
use std::process::Command;

const SOURCE: &str = r#"
#![no_std]
use sinew_core as _;
#[unsafe(no_mangle)]
pub extern "C" fn unchecked(list: &[u8; 4], index: usize) -> u8 { list[index] }
"#;

const PROGRAM: &str = "
#include <sinew.h>
#include <stdlib.h>
extern unsigned char unchecked(const unsigned char *list, size_t index);
#ifdef HOOK
void sinew_on_panic(void) { _Exit(42); }
#endif
int main(int count, char **arguments) {
    static const unsigned char list[4] = {0};
    (void)arguments;
    return unchecked(list, (size_t)count + 8);
}
";

fn library(folder: &Path) {
    let core = workspace_root().join("core");
    let core = core.display();
    let manifest = format!(
        "[package]\nname = \"panicking\"\nedition = \"2024\"\n[lib]\ncrate-type = [\"staticlib\"]\n\
         [dependencies]\nsinew-core = {{ path = {core:?}, features = [\"c-api\", \"panic-handler\"] }}\n\
         [profile.release]\nopt-level = 1\nlto = \"fat\"\npanic = \"abort\"\n[workspace]\n",
        core = core.to_string()
    );
    fs::write(folder.join("Cargo.toml"), manifest).unwrap();
    fs::copy(workspace_root().join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
    fs::create_dir(folder.join("src")).unwrap();
    fs::write(folder.join("src/lib.rs"), SOURCE).unwrap();
    let mut command = cargo("build", None);
    command.current_dir(folder).args(["--quiet", "--release", "--offline", "--target-dir"]).arg(folder.join("out"));
    expect_success(&mut command);
}

#[test]
fn a_panic_calls_the_program_s_function() {
    if leaves_out_long_builds() || !["gcc", "timeout"].into_iter().all(has_tool) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    library(folder.path());
    let source = folder.path().join("main.c");
    fs::write(&source, PROGRAM).unwrap();
    // `timeout` says 124 where the library loops.
    for (flags, code) in [(&["-DHOOK"][..], 42), (&[], 124)] {
        let program = folder.path().join("program");
        let mut command = Command::new("gcc");
        command.args(["-Wall", "-Wextra", "-Werror"]).args(flags);
        command.arg("-I").arg(workspace_root().join("core/include")).arg(&source);
        command.arg(folder.path().join("out/release/libpanicking.a")).arg("-o").arg(&program);
        expect_success(&mut command);
        let output = Command::new("timeout").arg("2").arg(&program).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{flags:?}");
    }
}
