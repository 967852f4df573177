//! The command `sinew`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(sinew::cli::run_words(std::env::args_os()))
}
