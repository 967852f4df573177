//! `sinew evaluate ...`: starts the program `sinew-lab`, which lies beside this one.

use super::console::Console;
use anyhow::{Context, Result, bail};
use clap::Args;
use std::env;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{self, Command};

/// Options of `sinew evaluate`: `sinew-lab` reads them.
#[derive(Debug, Args)]
#[command(
    disable_help_flag = true,
    after_help = "Examples:
  sinew evaluate cyclic --model walking --seeds 1 --particles none --out cyclic"
)]
pub struct EvaluateArgs {
    /// What to evaluate, with its options: arm, body, cyclic, hands or skin.
    #[arg(value_name = "ARGS", trailing_var_arg = true, allow_hyphen_values = true)]
    pub words: Vec<OsString>,
}

/// Hands all words on to `sinew-lab`, and ends as it ends.
///
/// # Errors
/// If there is no such program beside this one, or it cannot be started.
pub fn run(args: &EvaluateArgs, console: &Console) -> Result<()> {
    let mut lab = Command::new(lab()?);
    lab.arg("evaluate").args(console.flags()).args(&args.words);
    let status =
        end_as(lab).context("`sinew-lab` cannot be started; build it anew: `cargo build --release -p sinew-lab`")?;
    // Without a code where a signal ended it.
    process::exit(status.code().unwrap_or(1))
}

/// Path of the program beside this one.
fn lab() -> Result<PathBuf> {
    let own = env::current_exe().context("the folder of `sinew` is not known; give the path of the program")?;
    let lab = own.with_file_name(format!("sinew-lab{}", env::consts::EXE_SUFFIX));
    if !lab.is_file() {
        bail!(
            "`sinew evaluate` needs the program `{}`, which is not there; \
             make it in the repository: `cargo build --release -p sinew-lab`",
            lab.display()
        );
    }
    Ok(lab)
}

/// Becomes the other program, so that signals reach it and its status is the own one. Returns only
/// where that fails.
#[cfg(unix)]
fn end_as(mut command: Command) -> std::io::Result<process::ExitStatus> {
    use std::os::unix::process::CommandExt;
    Err(command.exec())
}

/// Waits for the other program.
#[cfg(not(unix))]
fn end_as(mut command: Command) -> std::io::Result<process::ExitStatus> {
    command.status()
}
