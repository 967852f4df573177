//! `sinew evaluate ...`, and what only this program has

#[cfg(feature = "ablation")]
pub mod ablation;
pub mod arm;
pub mod body;
pub mod cyclic;
pub mod hands;
pub mod reproduce;
pub mod skin;
pub mod tables;
pub mod tune_pik;

use arm::EvaluateArmArgs;
use body::EvaluateBodyArgs;
use clap::{Parser, Subcommand};
use cyclic::EvaluateCyclicArgs;
use hands::EvaluateHandsArgs;
use reproduce::ReproduceArgs;
use sinew::cli::console::Console;
use sinew::cli::signals::stop_flag;
use sinew::output::OutputDir;
use sinew::resume::{Begun, Cells, Stop};
use skin::EvaluateSkinArgs;
use std::sync::atomic::Ordering;
use tables::TablesArgs;
use tune_pik::TunePikArgs;

/// What `sinew evaluate ARGS...` starts, as `sinew-lab evaluate ARGS...`: its help names the
/// former.
#[derive(Debug, Parser)]
#[command(name = "sinew-lab", bin_name = "sinew", version, arg_required_else_help = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// How results are printed.
    #[command(flatten)]
    pub console: Console,
}

/// The commands of `sinew-lab`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Measure how well something works.
    #[command(
        subcommand,
        after_help = "Examples:
  sinew evaluate cyclic --model walking --seeds 1 --particles none --out cyclic"
    )]
    Evaluate(Evaluate),
    /// Print what each part of the phase-coupled filter is worth.
    #[cfg(feature = "ablation")]
    #[command(override_usage = "sinew-lab ablation [OPTIONS] --cuts <CUTS.csv>")]
    Ablation(ablation::AblationArgs),
    /// Write or check the tables of the book.
    #[command(override_usage = "sinew-lab tables [OPTIONS] [NAME]...")]
    Tables(TablesArgs),
    /// Make every table and figure of a paper, theirs beside ours.
    #[command(override_usage = "sinew-lab reproduce <PAPER> --data <DIR> --out <DIR> [--quick]")]
    Reproduce(ReproduceArgs),
    /// Search the numbers that the PIK paper leaves open, in the same way for goals and angles.
    #[command(override_usage = "sinew-lab tune-pik [OPTIONS]")]
    TunePik(TunePikArgs),
}

/// What can be evaluated.
#[derive(Debug, Subcommand)]
pub enum Evaluate {
    /// Compare the trackers on rendered scenes with known truth.
    Arm(EvaluateArmArgs),
    /// Make the PIK paper's comparison of motion models on real motion before a simulated stereo
    /// camera.
    Body(EvaluateBodyArgs),
    /// Make the cyclic paper's tables and figures on cut cycles with known angles.
    Cyclic(EvaluateCyclicArgs),
    /// Track both hands on real frames and compare with reference boxes.
    Hands(EvaluateHandsArgs),
    /// Score a skin model on images with masks.
    Skin(EvaluateSkinArgs),
}

/// Runs one parsed command line.
///
/// # Errors
/// As the chosen evaluation.
pub fn run(cli: &Cli) -> anyhow::Result<()> {
    let console = &cli.console;
    match &cli.command {
        Command::Evaluate(Evaluate::Arm(args)) => arm::run(args, console),
        Command::Evaluate(Evaluate::Body(args)) => body::run(args, console),
        Command::Evaluate(Evaluate::Cyclic(args)) => cyclic::run(args, console),
        Command::Evaluate(Evaluate::Hands(args)) => hands::run(args, console),
        Command::Evaluate(Evaluate::Skin(args)) => skin::run(args, console),
        #[cfg(feature = "ablation")]
        Command::Ablation(args) => ablation::run(args, console),
        Command::Tables(args) => tables::run(args, console),
        Command::Reproduce(args) => reproduce::run(args, console),
        Command::TunePik(args) => tune_pik::run(args, console),
    }
}

/// Does `work`, which a signal ends between two cells; the console then says that it can be
/// resumed.
fn until_signal(console: &Console, work: impl FnOnce(Stop<'_>) -> anyhow::Result<()>) -> anyhow::Result<()> {
    let flag = stop_flag()?;
    console.resumable(work(&|| flag.load(Ordering::Relaxed)))
}

/// The cells of an evaluation whose `--out` may be left out; without it none is kept.
fn cells_in<'a>(output: Option<&OutputDir>, begun: &Begun, resume: bool, stop: Stop<'a>) -> anyhow::Result<Cells<'a>> {
    Ok(match output {
        Some(output) => Cells::keep(output, begun, resume, stop)?,
        None => Cells::not_kept(),
    })
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
