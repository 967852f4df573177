//! `sinew evaluate cyclic`

use super::until_signal;
use crate::cyclic::experiments::FILTERS;
use crate::cyclic::rate::DEFAULT_RATE_HZ;
use crate::cyclic::{
    CyclicReport, LONG_RUN_SIGMA_DEG, LongRun, Setting, figures::figures, long_runs, rate_of, synthetic, test_cycles,
};
use anyhow::{Result, ensure};
use clap::Args;
use serde_json::json;
use sinew::cli::console::Console;
use sinew::cyclic::model_file::MODEL_VALUE;
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::cyclic::{CutList, CyclicModel};
use sinew::output::OutputDir;
use sinew::resume::{Begun, Cells, Stop, text_crc32};
use std::path::PathBuf;

/// Options of `sinew evaluate cyclic`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew evaluate cyclic --model running --seeds 1 --particles none --out cyclic")]
pub struct EvaluateCyclicArgs {
    /// Cut list of the cycles to train on; without it the model of --model is used.
    #[arg(long, value_name = "CUTS.csv", conflicts_with = "model")]
    pub train: Option<PathBuf>,
    /// Model that is tested: a shipped one, or a file of `sinew train cyclic`.
    #[arg(long, value_name = MODEL_VALUE, default_value = "walking")]
    pub model: String,
    /// Cut list of the cycles to test on [default: synthetic cycles drawn from the model, which
    /// only show that it runs].
    #[arg(long, value_name = "CUTS.csv")]
    pub test: Option<PathBuf>,
    /// Cut list of cycles that follow each other: how well the position in the cycle holds without
    /// a break.
    #[arg(long, value_name = "CUTS.csv")]
    pub long: Option<PathBuf>,
    /// Frames per second of the tables [default: what they say, or 60].
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Repetitions where noise or particles are drawn.
    #[arg(long, default_value_t = 5)]
    pub seeds: u64,
    /// Numbers of particles of table 2 and figure 5b; "none" leaves the particle filter out.
    #[arg(long, value_delimiter = ',', default_value = "500,1000,5000,10000,20000,50000,100000")]
    pub particles: Vec<String>,
    /// Folder for the tables and plots.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Go on with the evaluation in --out that a signal ended; the other options have to be the
    /// same.
    #[arg(long)]
    pub resume: bool,
}

/// Particles of figure 5a, as in the paper.
const SPARSE_PARTICLES: [usize; 2] = [10_000, 50_000];

/// Measures all tables and figures and writes them.
///
/// # Errors
/// A list, table or model that cannot be read, an output that cannot be written, or
/// [`sinew::resume::Interrupted`].
pub fn run(args: &EvaluateCyclicArgs, console: &Console) -> Result<()> {
    until_signal(console, |stop| run_until(args, console, stop))
}

/// As [`run`], ended by `stop` in the place of a signal.
///
/// # Errors
/// As [`run`].
pub fn run_until(args: &EvaluateCyclicArgs, console: &Console, stop: Stop<'_>) -> Result<()> {
    ensure!(args.seeds > 0, "--seeds must be greater than zero");
    if let Some(rate) = args.rate {
        ensure!(rate > 0.0 && rate.is_finite(), "--rate must be greater than zero, not {rate}");
    }
    let particles = particles(&args.particles)?;
    let output = OutputDir::create(&args.out)?;
    let (model, name) = model(args)?;
    let (cycles, rate_hz) = match &args.test {
        Some(path) => {
            let list = CutList::read(path)?;
            (test_cycles(&list)?, rate_of(&list, args.rate)?)
        }
        None => {
            let rate_hz = args.rate.unwrap_or(DEFAULT_RATE_HZ);
            (synthetic::cycles(&model, rate_hz)?, rate_hz)
        }
    };
    let cells = Cells::keep(&output, &begun(args, &model)?, args.resume, stop)?;
    let setting = Setting { cycles: &cycles, model: &model, rate_hz, seeds: args.seeds, cells: &cells };
    let sparse_particles: Vec<usize> = if particles.is_empty() { Vec::new() } else { SPARSE_PARTICLES.to_vec() };
    let measure = || {
        Ok(CyclicReport {
            format: "sinew-evaluate-cyclic",
            version: 1,
            sinew_version: env!("CARGO_PKG_VERSION"),
            model: name,
            test: args.test.as_ref().map_or_else(|| "synthetic".to_owned(), |path| path.display().to_string()),
            cycles: cycles.len(),
            frames: cycles.iter().map(|cycle| cycle.truth.rows().len()).sum(),
            seeds: args.seeds,
            noise: setting.noise_table()?,
            smoothed: setting.smoothed()?,
            particles: setting.particle_table(&particles)?,
            sparse: setting.sparse_measurements()?,
            sparse_particles: setting.sparse_particles(&sparse_particles)?,
            starts: setting.starts(&particles)?,
            long_runs: long(args, &model)?,
        })
    };
    let report = console.busy("tracking", measure)?;
    output.write("cyclic.json", |writer| Ok(serde_json::to_writer_pretty(writer, &report)?))?;
    output.write("cyclic.csv", |writer| Ok(writer.write_all(report.to_csv().as_bytes())?))?;
    for (name, picture) in figures(&setting, &report)? {
        output.write_png(&name, &picture)?;
    }
    cells.end()?;
    let text = format!("{}tables and plots: {}\n", report.to_text(), args.out.display());
    console.answer(&text, &json!({ "out": args.out, "report": report }))
}

/// The model that is tested, and what it is called.
fn model(args: &EvaluateCyclicArgs) -> Result<(CyclicModel, String)> {
    let Some(path) = &args.train else { return Ok((CyclicModel::from_option(&args.model)?, args.model.clone())) };
    let list = CutList::read(path)?;
    let options = TrainingOptions { rate_hz: Some(rate_of(&list, args.rate)?), ..TrainingOptions::default() };
    Ok((train(&list, options)?, format!("trained on {}", path.display())))
}

/// The recordings of --long.
fn long(args: &EvaluateCyclicArgs, model: &CyclicModel) -> Result<Vec<LongRun>> {
    let Some(path) = &args.long else { return Ok(Vec::new()) };
    let list = CutList::read(path)?;
    let rate_hz = rate_of(&list, args.rate)?;
    long_runs(&list, model, rate_hz, &FILTERS, (LONG_RUN_SIGMA_DEG, 1))
}

/// What the cells depend on, beside the cycles.
fn begun(args: &EvaluateCyclicArgs, model: &CyclicModel) -> Result<Begun> {
    let options = json!({
        "train": args.train,
        "model": args.model,
        "test": args.test,
        "long": args.long,
        "rate": args.rate,
        "seeds": args.seeds,
        "particles": args.particles,
    });
    let numbers = text_crc32(&format!("{:?}", model.numbers()));
    Ok(Begun::new("evaluate cyclic", &options, &[])?.reading("the model", numbers))
}

fn particles(list: &[String]) -> Result<Vec<usize>> {
    if let [only] = list
        && only == "none"
    {
        return Ok(Vec::new());
    }
    list.iter()
        .map(|count| match count.parse() {
            Ok(count) if count > 0 => Ok(count),
            _ => anyhow::bail!("`--particles {count}`: give whole numbers above zero with commas between, or none"),
        })
        .collect()
}
