//! `sinew-firmware-run`: what `cargo run` calls in the folder `firmware-sim`, and what runs all
//! images.

use anyhow::{Context, Result, ensure};
use clap::{Parser, Subcommand};
use sinew_firmware_run::budget::Budget;
use sinew_firmware_run::emulator::Machine;
use sinew_firmware_run::run::{Told, run};
use sinew_firmware_run::{build, expected, inputs};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Runs firmware images in an emulator, decodes what they log and compares what they answer.
#[derive(Debug, Parser)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run one image; the environment variable SINEW_MACHINE chooses m4 or m7.
    Image {
        /// ELF file; its name is the image's.
        path: PathBuf,
    },
    /// Write the recorded input of one image.
    Input {
        /// The image.
        name: String,
        /// File to write.
        #[arg(long)]
        out: PathBuf,
    },
    /// Measure every image and write the table in docs/firmware.md, or compare with it.
    Budget {
        /// Compare; a cell that grew by more than 5 % is an error.
        #[arg(long)]
        check: bool,
        /// Take the images that are there and build none.
        #[arg(long)]
        no_build: bool,
    },
    /// Run every image that has an expected output, on both machines.
    All {
        /// Take the images that are there and build none.
        #[arg(long)]
        no_build: bool,
    },
}

fn main() -> ExitCode {
    match answer(&Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn answer(command: &Command) -> Result<()> {
    match command {
        Command::Image { path } => {
            let ended = run(path, Machine::from_environment()?)?;
            show(&ended);
            println!("{}: as expected", path.display());
            Ok(())
        }
        Command::Input { name, out } => {
            let input = inputs::of_image(name)?.with_context(|| format!("`{name}` reads no input"))?;
            fs::write(out, input).with_context(|| format!("`{}` cannot be written", out.display()))
        }
        Command::Budget { check, no_build } => budget(*check, *no_build),
        Command::All { no_build } => all(*no_build),
    }
}

fn all(no_build: bool) -> Result<()> {
    if !no_build {
        build::images(&[])?;
    }
    let images = expected::all()?;
    ensure!(!images.is_empty(), "no image has an expected output");
    for (name, _) in images {
        for machine in Machine::ALL {
            let path: &Path = &build::image_path(&name);
            run(path, machine).with_context(|| format!("{name} on {}", machine.qemu_name()))?;
            println!("{name} on {}: as expected", machine.qemu_name());
        }
    }
    Ok(())
}

fn budget(check: bool, no_build: bool) -> Result<()> {
    if !no_build {
        build::images(&[])?;
    }
    let budget = Budget::measure()?;
    print!("{}", budget.to_markdown());
    if check {
        println!("{}", budget.check()?);
        return Ok(());
    }
    budget.write()
}

fn show(ended: &Told) {
    print!("{}", ended.printed);
    ended.log.iter().for_each(|line| println!("{line}"));
    for (part, cost) in &ended.costs {
        let mean = cost.total as f64 / f64::from(cost.frames.max(1));
        println!("{}: mean {mean:.0}, worst {} of {}", part.name(), cost.worst, cost.frames);
    }
}
