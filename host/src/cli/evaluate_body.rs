//! `sinew evaluate body`

use crate::body::BodyPart;
use crate::body::run::{inputs::check_part, tuning_file};
use crate::body::tracking::{BodyModelKind, BodyTuning, MAX_BODY_PARTICLES};
use crate::evaluate::body::trial::{SeenMotion, TrialResult, trial};
use crate::evaluate::body::{BodyReport, BodyResult, Measured, MotionChoice, figures::figures, prediction};
use crate::output::OutputDir;
use anyhow::{Result, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::path::PathBuf;

/// Options of `sinew evaluate body`.
#[derive(Debug, Args)]
pub struct EvaluateBodyArgs {
    /// Motions: .bvh, .amc, .txt (exponential maps), .trc or .c3d files, FILE@START-END for a part in seconds, or stick-wave and
    /// pelvic-lift, which are built in.
    #[arg(long, value_name = "FILE", num_args = 1.., required = true)]
    pub motion: Vec<MotionChoice>,
    /// Skeleton of the .amc files that have none in their folder.
    #[arg(long, value_name = "FILE.asf")]
    pub skeleton: Option<PathBuf>,
    /// How much of the body the camera sees and the models track.
    #[arg(long, value_enum, default_value_t = BodyPart::Whole)]
    pub body: BodyPart,
    /// Models to compare.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "end-effector,angular,guided")]
    pub models: Vec<BodyModelKind>,
    /// Numbers of particles.
    #[arg(long, value_delimiter = ',', default_value = "50,100,250,500,1000,2500")]
    pub particles: Vec<usize>,
    /// Trials of each cell, with seeds 1, 2, ... for camera and tracker.
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub trials: u64,
    /// Numbers of the models, as `sinew track body --config` reads them [default: the shipped ones].
    #[arg(long, value_name = "FILE.toml")]
    pub config: Option<PathBuf>,
    /// Folder for report.json, table.csv and figures.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Tracks every motion with every model and count, and writes what came out.
///
/// # Errors
/// A motion or configuration that cannot be read, an output that cannot be written.
pub fn run(args: &EvaluateBodyArgs) -> Result<()> {
    ensure!(args.trials > 0, "--trials must be greater than zero");
    for &count in &args.particles {
        ensure!(
            (1..=MAX_BODY_PARTICLES).contains(&count),
            "--particles must be whole numbers from 1 to {MAX_BODY_PARTICLES}, not {count}"
        );
    }
    for &model in &args.models {
        check_part(args.body, model)?;
    }
    let tuning = args.config.as_deref().map_or_else(|| Ok(BodyTuning::default()), tuning_file::load)?;
    let output = OutputDir::create(&args.out)?;
    let cells = args.motion.len() * args.models.len() * args.particles.len();
    let progress = ProgressBar::new(cells as u64 * args.trials);
    progress.set_style(ProgressStyle::with_template("{pos}/{len} trials {wide_bar} {eta}")?);
    let (mut results, mut predicted) = (Vec::new(), None);
    for motion in &args.motion {
        let read = motion.read(args.skeleton.as_deref())?;
        let seeds = (1..=args.trials).into_par_iter();
        let seen: Vec<SeenMotion> = seeds.map(|seed| read.seen(args.body, seed)).collect::<Result<_>>()?;
        let of_truth: Vec<f64> = seen.iter().map(SeenMotion::smoothness_m).collect();
        let truth = (motion.name(), Measured::of(&of_truth).mean);
        if predicted.is_none() {
            predicted = seen.first().map(|seen| prediction::predict(seen, &tuning)).transpose()?;
        }
        for &model in &args.models {
            for &particles in &args.particles {
                results.push(cell(&truth, &seen, model, &tuning, particles, &progress)?);
            }
        }
    }
    progress.finish_and_clear();
    let (predictions, prediction_figures) = predicted.unzip();
    let mut report = BodyReport {
        format: "sinew-evaluate-body",
        version: 1,
        sinew_version: env!("CARGO_PKG_VERSION"),
        trials: args.trials,
        threads: rayon::current_num_threads(),
        tuning,
        results,
        angular_equals_end_effector_250: None,
        predictions,
    };
    let wanted_m = report.mean_error_m(BodyModelKind::EndEffector, 250);
    report.angular_equals_end_effector_250 =
        wanted_m.and_then(|wanted_m| report.particles_for(BodyModelKind::Angular, wanted_m));
    output.write("report.json", |writer| Ok(serde_json::to_writer_pretty(writer, &report)?))?;
    output.write("table.csv", |writer| Ok(writer.write_all(report.to_csv().as_bytes())?))?;
    for (name, picture) in figures(&report)?.into_iter().chain(prediction_figures.unwrap_or_default()) {
        output.write_png(&name, &picture)?;
    }
    let text = format!("{}report, table and figures: {}\n", report.to_text(), args.out.display());
    super::stdout::write_all(text.as_bytes())
}

/// All trials of one cell, one after the other: a step takes all threads. The motion comes by its name and its own smoothness, metres.
fn cell(
    (name, truth_smoothness_m): &(String, f64),
    seen: &[SeenMotion],
    model: BodyModelKind,
    tuning: &BodyTuning,
    particles: usize,
    progress: &ProgressBar,
) -> Result<BodyResult> {
    let mut trials: Vec<TrialResult> = Vec::with_capacity(seen.len());
    for (seed, motion) in (1..).zip(seen) {
        trials.push(trial(motion, model, tuning, particles, seed)?.0);
        progress.inc(1);
    }
    let of = |value: fn(&TrialResult) -> f64| Measured::of(&trials.iter().map(value).collect::<Vec<_>>());
    Ok(BodyResult {
        motion: name.clone(),
        model,
        particles,
        error_m: of(|trial| trial.error_m),
        joint_error_m: of(|trial| trial.joint_error_m),
        smoothness_m: of(|trial| trial.smoothness_m),
        truth_smoothness_m: *truth_smoothness_m,
        seconds_per_frame: of(|trial| trial.seconds_per_frame).mean,
        effective_share: of(|trial| trial.effective_share).mean,
    })
}
