//! The command `sinew`.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match sinew::cli::run(&sinew::cli::Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
