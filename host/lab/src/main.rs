//! The command `sinew-lab`.

use clap::Parser;
use sinew::cli::{exit_code, exit_code_of_usage};
use sinew_lab::cli::{Cli, run};
use std::process::ExitCode;

fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => exit_code(run(&cli), &cli.console),
        Err(error) => exit_code_of_usage(&error),
    }
}
