//! The command tree: one file per subcommand, each with its `...Args` and a `run`.
//!
//! To add a subcommand, write `cli/NAME.rs` with `pub struct NameArgs` (`clap::Args`) and
//! `pub fn run(args: &NameArgs, console: &Console) -> anyhow::Result<()>`, then add a variant and
//! an arm here.

pub mod angles;
pub mod batch;
pub mod blobs;
pub mod checkpoint_args;
pub mod completions;
pub mod console;
pub mod cut;
pub mod demo;
pub mod doctor;
pub mod evaluate;
pub mod export;
mod filter_args;
pub mod image_run;
pub mod record;
pub mod report;
mod scene_args;
pub mod scene_error_args;
pub mod segment;
pub mod signals;
pub mod simulate;
pub mod simulate_cyclic;
pub mod simulate_keypoints;
pub mod simulate_stereo;
pub mod skin_args;
pub mod stdout;
pub mod track;
pub mod track_arm;
pub mod track_body;
pub mod track_cyclic;
pub mod train;
pub mod train_cyclic;
pub mod train_skin;
pub mod variant_arg;
pub mod viewer_args;

use crate::error::{Error as LibraryError, ErrorKind};
use crate::resume::Interrupted;
use clap::{Parser, Subcommand};
use console::{Console, printable};
use serde_json::json;
use std::ffi::OsString;
use std::io::Write;

/// Estimates how a human body moves, from a camera.
#[derive(Debug, Parser)]
#[command(name = "sinew", version, about, arg_required_else_help = true, subcommand_required = true)]
#[command(after_help = "Examples:\n  sinew demo --out run\n  sinew report run --out run.html")]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// How results are printed.
    #[command(flatten)]
    pub console: Console,
}

/// The subcommands of `sinew`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene with known truth, track it, and print the error.
    Demo(demo::DemoArgs),
    /// Track a person: in video frames, point clouds, or angle tables.
    #[command(
        subcommand,
        after_help = "Examples:
  sinew simulate arm --motion builtin --frames 30 --out scene
  sinew track arm scene/frames --config scene/camera.toml --out run"
    )]
    Track(track::Track),
    /// Make one page about a run or several: frames, plots, tables.
    Report(report::ReportArgs),
    /// Turn a motion in space or 2D keypoints into an angle table.
    Angles(angles::AnglesArgs),
    /// Track a list of recordings, each once.
    Batch(batch::BatchArgs),
    /// Find the cycles in angle tables.
    Cut(cut::CutArgs),
    /// Make scenes with known truth, for whatever can be tracked.
    Simulate(simulate::SimulateArgs),
    /// Write what a tracker was given as a stream for firmware.
    Record(record::RecordArgs),
    /// Write a motion model as firmware reads it.
    Export(export::ExportArgs),
    /// Write the skin mask of each image.
    Segment(segment::SegmentArgs),
    /// Write features and hand likelihood of each blob.
    Blobs(blobs::BlobsArgs),
    /// Train a model.
    #[command(
        subcommand,
        after_help = "Examples:
  sinew simulate cyclic --model walking --out walk.csv
  sinew cut walk.csv --out cuts.csv
  sinew train cyclic --cuts cuts.csv --out my_walk.json"
    )]
    Train(train::Train),
    /// Measure how well something works.
    Evaluate(evaluate::EvaluateArgs),
    /// Tell what is wrong with a folder, a configuration, a model.
    Doctor(doctor::DoctorArgs),
    /// Print a shell's completions of this command.
    Completions(completions::CompletionsArgs),
    /// Write manual pages.
    Man(completions::ManArgs),
}

/// Runs the command line `words`, of which the first is the program's name, and returns the exit
/// status.
pub fn run_words(words: impl IntoIterator<Item = OsString>) -> u8 {
    let status = match Cli::try_parse_from(words) {
        Ok(cli) => exit_status(run(&cli), &cli.console),
        Err(error) => exit_status_of_usage(&error),
    };
    // A process that is no Rust program does not do it at its end.
    let _ = std::io::stdout().flush();
    status
}

/// Runs one parsed command line.
///
/// # Errors
/// Whatever the subcommand refuses, with the file or option, the rule it broke, and the remedy.
pub fn run(cli: &Cli) -> anyhow::Result<()> {
    let console = &cli.console;
    match &cli.command {
        Command::Demo(args) => demo::run(args, console),
        Command::Track(track) => track::run(track, console),
        Command::Angles(args) => angles::run(args, console),
        Command::Report(args) => report::run(args, console),
        Command::Batch(args) => batch::run(args, console),
        Command::Cut(args) => cut::run(args, console),
        Command::Simulate(args) => simulate::run(args, console),
        Command::Record(args) => record::run(args, console),
        Command::Export(args) => export::run(args, console),
        Command::Segment(args) => segment::run(args, console),
        Command::Blobs(args) => blobs::run(args, console),
        Command::Train(train) => train::run(train, console),
        Command::Evaluate(args) => evaluate::run(args, console),
        Command::Doctor(args) => doctor::run(args, console),
        Command::Completions(args) => completions::completions(args, console),
        Command::Man(args) => completions::man(args, console),
    }
}

/// How far a command came that a signal ended; none if it failed otherwise.
#[must_use]
pub fn interrupted(error: &anyhow::Error) -> Option<&Interrupted> {
    error.downcast_ref::<Interrupted>().or_else(|| error.downcast_ref::<LibraryError>()?.interrupted())
}

/// The exit status of what has ended: an error is printed on standard error, and with `--json` as
/// one line of JSON.
pub fn exit_status(ended: anyhow::Result<()>, console: &Console) -> u8 {
    let Err(error) = ended else { return 0 };
    let kind = kind_of(&error);
    let status = if kind == ErrorKind::Interrupted { signals::interrupted_status() } else { kind.exit_status() };
    let text = format!("{error:#}");
    if console.json {
        let json = json!({ "error": { "kind": kind.name(), "exit_status": status, "message": text } });
        eprintln!("{json}");
    } else if kind == ErrorKind::Interrupted {
        eprintln!("{}", printable(&text));
    } else {
        eprintln!("error: {}", printable(&text));
    }
    status
}

/// An error about an input: the texts of `anyhow` count as errors about an option.
pub fn data_error(text: impl Into<String>) -> anyhow::Error {
    LibraryError::Invalid(text.into()).into()
}

/// What went wrong. The command's own checks are of its options.
pub fn kind_of(error: &anyhow::Error) -> ErrorKind {
    if interrupted(error).is_some() {
        return ErrorKind::Interrupted;
    }
    error.chain().find_map(ErrorKind::of).unwrap_or(ErrorKind::Usage)
}

/// The exit status of a command line that cannot be parsed; `--help` and `--version` are none.
pub fn exit_status_of_usage(error: &clap::Error) -> u8 {
    // A closed standard output is no reason to fail.
    let _ = error.print();
    if error.use_stderr() { ErrorKind::Usage.exit_status() } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::Cli;
    use clap::CommandFactory;

    #[test]
    fn the_command_tree_is_consistent() {
        Cli::command().debug_assert();
    }
}
