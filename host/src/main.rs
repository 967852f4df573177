//! The command `sinew`.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match sinew::cli::run(&sinew::cli::Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is::<sinew::resume::Interrupted>() => {
            eprintln!("{error}");
            // 128 + SIGINT, what shells expect of a program that Ctrl-C ended.
            ExitCode::from(130)
        }
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
