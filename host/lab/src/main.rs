//! The command `sinew-lab`.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    sinew::cli::exit_code(sinew_lab::cli::run(&sinew_lab::cli::Cli::parse()))
}
