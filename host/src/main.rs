//! The command `sinew`.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    sinew::cli::exit_code(sinew::cli::run(&sinew::cli::Cli::parse()))
}
