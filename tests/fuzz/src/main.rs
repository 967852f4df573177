//! `sinew-fuzz`: runs the targets on arbitrary input and prints a table.

use clap::Parser;
use sinew_fuzz::allocation::Counting;
use sinew_fuzz::campaign::{Amount, Inputs, Outcome, run};
use sinew_fuzz::execution::execute;
use sinew_fuzz::keeping::{keep, watch};
use sinew_fuzz::{Target, targets};
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Runs readers, saved states, records and trackers on arbitrary input.
///
/// Inputs that fail are written to `target/fuzz`, and the exit status is 1.
#[derive(Debug, Parser)]
struct Arguments {
    /// Targets; all without any.
    targets: Vec<String>,
    /// Seconds for each target.
    #[arg(long, default_value_t = 3.0, conflicts_with = "executions")]
    seconds: f64,
    /// Executions of each target.
    #[arg(long)]
    executions: Option<u64>,
    /// Seed of the inputs.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Writes input NUMBER of one target to `target/fuzz` and runs it alone: after an abort the
    /// file `target/fuzz/TARGET.running` has the number.
    #[arg(long, value_name = "NUMBER", conflicts_with = "executions")]
    only: Option<u64>,
    /// Runs one target on a file.
    #[arg(long, value_name = "FILE", conflicts_with = "only")]
    input: Option<PathBuf>,
    /// Prints the targets' names.
    #[arg(long)]
    list: bool,
}

fn main() -> ExitCode {
    match all(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("sinew-fuzz: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Whether nothing failed.
fn all(arguments: &Arguments) -> io::Result<bool> {
    if let Some(unknown) = arguments.targets.iter().find(|name| targets::find(name).is_none()) {
        let names: Vec<_> = targets::all().map(|target| target.name).collect();
        return Err(io::Error::other(format!("`{unknown}` is no target; these are {}", names.join(", "))));
    }
    let is_wanted =
        |target: &&Target| arguments.targets.is_empty() || arguments.targets.iter().any(|name| name == target.name);
    let chosen: Vec<&Target> = targets::all().filter(is_wanted).collect();
    if arguments.list {
        chosen.iter().for_each(|target| println!("{}", target.name));
        return Ok(true);
    }
    if arguments.only.is_some() || arguments.input.is_some() {
        return one(&chosen, arguments);
    }
    watch();
    let amount = match arguments.executions {
        Some(count) => Amount::Executions(count),
        None => Amount::Time(Duration::try_from_secs_f64(arguments.seconds).map_err(io::Error::other)?),
    };
    println!("{:<20} {:>11} {:>8} {:>11} {:>8}", "target", "executions", "crashes", "slowest ms", "peak MB");
    let (mut executions, mut crashes) = (0, 0);
    for target in chosen {
        let outcome = run(target, amount, arguments.seed)?;
        print(target, &outcome);
        executions += outcome.executions;
        crashes += outcome.crashes;
    }
    println!("{:<20} {executions:>11} {crashes:>8}", "all");
    Ok(crashes == 0)
}

fn print(target: &Target, outcome: &Outcome) {
    println!(
        "{:<20} {:>11} {:>8} {:>11.1} {:>8.1}",
        target.name,
        outcome.executions,
        outcome.crashes,
        outcome.slowest.as_secs_f64() * 1000.0,
        outcome.peak_bytes as f64 / f64::from(1 << 20)
    );
    for (failure, path) in &outcome.failures {
        println!("  {}: {failure}", path.display());
    }
}

/// One input of one target.
fn one(chosen: &[&Target], arguments: &Arguments) -> io::Result<bool> {
    let [target] = chosen else { return Err(io::Error::other("name one target")) };
    let input = match (&arguments.input, arguments.only) {
        (Some(path), _) => std::fs::read(path)?,
        (None, number) => {
            let input = Inputs::new(target, arguments.seed).input(number.unwrap_or_default());
            println!("{}", keep(target.name, &input)?.display());
            input
        }
    };
    let execution = execute(target, &input);
    let megabytes = execution.peak_bytes >> 20;
    println!("{}: {:.1} ms, {megabytes} MB", target.name, execution.time.as_secs_f64() * 1000.0);
    if let Some(failure) = &execution.failure {
        println!("{failure}");
    }
    Ok(execution.failure.is_none())
}
