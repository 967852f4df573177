//! `sinew evaluate body`

use super::until_signal;
use crate::body::hidden_arm::{self, HiddenArm};
use crate::body::trial::{SeenMotion, TrialResult, trial};
use crate::body::{BodyReport, BodyResult, Measured, MotionChoice, figures::figures, motions::ReadMotion, prediction};
use anyhow::{Result, ensure};
use clap::Args;
use image::RgbImage;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::json;
use sinew::body::BodyPart;
use sinew::body::run::tuning_file;
use sinew::body::tracking::stream_options::{check_modes, check_part};
use sinew::body::tracking::{BodyModelKind, BodyTuning, MAX_BODY_PARTICLES};
use sinew::cli::console::Console;
use sinew::output::OutputDir;
use sinew::registry::{MOTION, choice};
use sinew::resume::{Begun, Cells, Stop};
use sinew::stereo::{Hidden, SceneErrors, StereoOptions};
use std::path::PathBuf;

/// Options of `sinew evaluate body`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew evaluate body --motion pelvic-lift --models guided --particles 20 \\
      --trials 1 --out body")]
pub struct EvaluateBodyArgs {
    /// Motions: files, parts of files, or built-in ones.
    #[arg(long, value_name = "FILE", num_args = 1.., required = true, help = format!(
        "Motions: {} files, FILE@START-END for a part in seconds, or stick-wave and pelvic-lift, which are built in",
        choice(MOTION)
    ))]
    pub motion: Vec<MotionChoice>,
    /// Skeleton of the .amc files that have none in their folder.
    #[arg(long, value_name = "FILE.asf")]
    pub skeleton: Option<PathBuf>,
    /// Take motions with fewer frames than their headers promise.
    #[arg(long)]
    pub partial: bool,
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
    /// Turn the persons of motion files to their left, degrees: at 90 the trunk is before the left
    /// arm.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true)]
    pub heading: f32,
    /// Leave out the points on a limb (l_arm, r_arm, l_leg, r_leg) from one frame to another, both
    /// included; may be repeated.
    #[arg(long, value_name = "LIMB:FIRST-LAST")]
    pub hide: Vec<Hidden>,
    /// A hard scene: radii, lengths and first pose with errors, false matches, background, motion
    /// blur, as `sinew simulate stereo --hard`.
    #[arg(long)]
    pub hard: bool,
    /// Also hide the points of the left and the right arm in turns, for this many frames at a time,
    /// and report how they are found again.
    #[arg(long, value_name = "FRAMES")]
    pub hide_arms: Option<usize>,
    /// Numbers of the models, as `sinew track body --config` reads them [default: the shipped
    /// ones].
    #[arg(long, value_name = "FILE.toml")]
    pub config: Option<PathBuf>,
    /// Folder for report.json, table.csv and figures.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Go on with the evaluation in --out that a signal ended; the other options have to be the
    /// same.
    #[arg(long)]
    pub resume: bool,
}

/// Tracks every motion with every model and count, and writes what came out.
///
/// # Errors
/// A motion or configuration that cannot be read, an output that cannot be written, or
/// [`sinew::resume::Interrupted`].
pub fn run(args: &EvaluateBodyArgs, console: &Console) -> Result<()> {
    until_signal(console, |stop| run_until(args, console, stop))
}

/// As [`run`], ended by `stop` in the place of a signal.
///
/// # Errors
/// As [`run`].
pub fn run_until(args: &EvaluateBodyArgs, console: &Console, stop: Stop<'_>) -> Result<()> {
    check(args)?;
    let tuning = args.config.as_deref().map_or_else(|| Ok(BodyTuning::default()), tuning_file::load)?;
    let output = OutputDir::create(&args.out)?;
    let cells = Cells::keep(&output, &begun(args, &tuning)?, args.resume, stop)?;
    let (report, prediction_figures) = evaluate(args, tuning, &cells, console)?;
    output.write("report.json", |writer| Ok(serde_json::to_writer_pretty(writer, &report)?))?;
    output.write("table.csv", |writer| Ok(writer.write_all(report.to_csv().as_bytes())?))?;
    for (name, picture) in figures(&report)?.into_iter().chain(prediction_figures) {
        output.write_png(&name, &picture)?;
    }
    cells.end()?;
    let text = format!("{}report, table and figures: {}\n", report.to_text(), args.out.display());
    console.answer(&text, &json!({ "out": args.out, "report": report }))
}

impl EvaluateBodyArgs {
    /// The scene of one seed, whose `hidden` limbs have no points.
    fn scene(&self, seed: u64, hidden: Vec<Hidden>) -> StereoOptions {
        let errors = if self.hard { SceneErrors::HARD } else { SceneErrors::default() };
        StereoOptions { seed, part: self.body, hidden, errors, ..StereoOptions::default() }
    }
}

/// Refuses numbers out of range by their option's name.
fn check(args: &EvaluateBodyArgs) -> Result<()> {
    ensure!(args.trials > 0, "--trials must be greater than zero");
    for &count in &args.particles {
        ensure!(
            (1..=MAX_BODY_PARTICLES).contains(&count),
            "--particles must be whole numbers from 1 to {MAX_BODY_PARTICLES}, not {count}"
        );
    }
    for &model in &args.models {
        check_part(args.body, model)?;
        for &count in &args.particles {
            check_modes(model, count)?;
        }
    }
    ensure!(args.heading.is_finite(), "--heading has to be finite");
    ensure!(args.hide_arms != Some(0), "--hide-arms must be greater than zero");
    Ok(())
}

/// What the cells depend on, beside the motions.
fn begun(args: &EvaluateBodyArgs, tuning: &BodyTuning) -> Result<Begun> {
    let models: Vec<&str> = args.models.iter().map(|model| model.name()).collect();
    let options = json!({
        "motion": args.motion.iter().map(MotionChoice::name).collect::<Vec<_>>(),
        "skeleton": args.skeleton,
        "body": args.body.name(),
        "models": models,
        "particles": args.particles,
        "trials": args.trials,
        "heading": args.heading,
        "partial": args.partial,
        "hide": args.hide,
        "hide_arms": args.hide_arms,
        "hard": args.hard,
        "config": tuning,
    });
    Ok(Begun::new("evaluate body", &options, &[])?)
}

/// All cells, and the figures of what models predict.
fn evaluate(
    args: &EvaluateBodyArgs,
    tuning: BodyTuning,
    cells: &Cells<'_>,
    console: &Console,
) -> Result<(BodyReport, Vec<(String, RgbImage)>)> {
    let rounds = 1 + usize::from(args.hide_arms.is_some());
    let count = args.motion.len() * args.models.len() * args.particles.len() * rounds;
    let progress = console.bar(count as u64 * args.trials, "{pos}/{len} trials {wide_bar} {eta}")?;
    let (mut results, mut predicted, mut hidden_arms, mut notes) = (Vec::new(), None, Vec::new(), Vec::new());
    for motion in &args.motion {
        let read = motion.read_turned(args.skeleton.as_deref(), args.heading.to_radians(), args.partial)?;
        notes.extend(read.note().inspect(|note| progress.suspend(|| console.note(note))));
        let seeds = (1..=args.trials).into_par_iter();
        let seen: Vec<SeenMotion> = seeds
            .map(|seed| {
                cells
                    .go_on()
                    .map_err(anyhow::Error::from)
                    .and_then(|()| read.seen_as(args.scene(seed, args.hide.clone())))
            })
            .collect::<Result<_>>()?;
        let of_truth: Vec<f64> = seen.iter().map(SeenMotion::smoothness_m).collect();
        let truth = (motion.name(), Measured::of(&of_truth).mean);
        if predicted.is_none() {
            predicted = seen.first().map(|seen| prediction::predict(seen, &tuning)).transpose()?;
        }
        for &model in &args.models {
            for &particles in &args.particles {
                results.push(cell(&truth, &seen, (model, particles), (&tuning, cells), &progress)?);
            }
        }
        if let Some(length) = args.hide_arms {
            hidden_arms.extend(hide_arms(args, (&motion.name(), &read), length, (&tuning, cells), &progress)?);
        }
    }
    progress.finish_and_clear();
    let (predictions, prediction_figures) = predicted.unzip();
    let mut report = BodyReport {
        format: "sinew-evaluate-body",
        version: 1,
        sinew_version: env!("CARGO_PKG_VERSION"),
        trials: args.trials,
        notes,
        threads: rayon::current_num_threads(),
        tuning,
        results,
        angular_equals_end_effector_250: None,
        predictions,
        hidden_arm_summaries: hidden_arm::summaries(&hidden_arms),
        hidden_arms,
    };
    let wanted_m = report.mean_error_m(BodyModelKind::EndEffector, 250);
    report.angular_equals_end_effector_250 =
        wanted_m.and_then(|wanted_m| report.particles_for(BodyModelKind::Angular, wanted_m));
    Ok((report, prediction_figures.unwrap_or_default()))
}

/// All trials of one cell, one after the other: a step takes all threads. The motion comes by its
/// name and its own smoothness, metres.
fn cell(
    (name, truth_smoothness_m): &(String, f64),
    seen: &[SeenMotion],
    (model, particles): (BodyModelKind, usize),
    (tuning, cells): (&BodyTuning, &Cells<'_>),
    progress: &ProgressBar,
) -> Result<BodyResult> {
    let mut trials: Vec<TrialResult> = Vec::with_capacity(seen.len());
    for (seed, motion) in (1..).zip(seen) {
        let key = json!(["trial", name, motion.key(), model.name(), particles, seed]);
        trials.push(cells.cell(&key, || trial(motion, model, tuning, particles, seed).map(|trial| trial.0))?);
        progress.inc(1);
    }
    let of = |value: fn(&TrialResult) -> f64| Measured::of(&trials.iter().map(value).collect::<Vec<_>>());
    let recorded: Option<Vec<f64>> = trials.iter().map(|trial| trial.recorded_error_m).collect();
    Ok(BodyResult {
        motion: name.clone(),
        model,
        particles,
        error_m: of(|trial| trial.error_m),
        recorded_error_m: recorded.map(|errors| Measured::of(&errors)),
        recorded_floor_m: seen.first().map(SeenMotion::recorded_floor_m).transpose()?.flatten(),
        joint_error_m: of(|trial| trial.joint_error_m),
        lost_joint_share: of(|trial| trial.lost_joint_share),
        smoothness_m: of(|trial| trial.smoothness_m),
        error_before_deadband_m: of(|trial| trial.before_deadband.error_m),
        joint_error_before_deadband_m: of(|trial| trial.before_deadband.joint_error_m),
        lost_joint_share_before_deadband: of(|trial| trial.before_deadband.lost_joint_share),
        smoothness_before_deadband_m: of(|trial| trial.before_deadband.smoothness_m),
        truth_smoothness_m: *truth_smoothness_m,
        seconds_per_frame: of(|trial| trial.seconds_per_frame).mean,
        effective_share: of(|trial| trial.effective_share).mean,
    })
}

/// One track of each seed, model and count in which arms are hidden for `length` frames at a time.
fn hide_arms(
    args: &EvaluateBodyArgs,
    (name, motion): (&str, &ReadMotion),
    length: usize,
    (tuning, cells): (&BodyTuning, &Cells<'_>),
    progress: &ProgressBar,
) -> Result<Vec<HiddenArm>> {
    let mut arms = Vec::new();
    let frames = motion.seen(args.body, 1)?.clouds_m.len();
    for seed in 1..=args.trials {
        let windows = hidden_arm::windows(frames, length, seed);
        let seen = motion.seen_as(args.scene(seed, windows.clone()))?;
        for &model in &args.models {
            for &particles in &args.particles {
                arms.extend(hidden_arm::follow(name, (&seen, &windows), (model, particles), (tuning, cells), seed)?);
                progress.inc(1);
            }
        }
    }
    Ok(arms)
}
