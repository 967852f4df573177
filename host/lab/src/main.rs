//! The command `sinew-lab`.

use clap::Parser;
use sinew::cli::{exit_status, exit_status_of_usage};
use sinew_lab::cli::{Cli, run};
use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(match Cli::try_parse() {
        Ok(cli) => exit_status(run(&cli), &cli.console),
        Err(error) => exit_status_of_usage(&error),
    })
}
