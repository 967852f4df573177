//! `sinew evaluate arm`

use super::until_signal;
use crate::clips::{builtin, recorded};
use crate::experiments::{self, Recovery, Row, STACK_BYTES};
use crate::observed::{FrontEnd, ObservedScene, Reading, observe_all};
use anyhow::{Result, ensure};
use clap::Args;
use serde::Serialize;
use serde_json::json;
use sinew::cli::console::Console;
use sinew::cli::skin_args::SkinArgs;
use sinew::cli::variant_arg::variant_parser;
use sinew::config::Config;
use sinew::draw::plot::{Curve, bars_plot, curves_plot};
use sinew::output::OutputDir;
use sinew::resume::{Begun, Cells, Stop, text_crc32};
use sinew::scene::SceneOptions;
use sinew::skin::{SkinModel, model_file};
use sinew_core::tracker::arm::Variant;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Options of `sinew evaluate arm`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew evaluate arm --clips 1 --seeds 1 --frames 110 --particles 20 --out arm")]
pub struct EvaluateArmArgs {
    /// Folder of recorded motions; without it built-in reaches drive the scenes.
    #[arg(long, value_name = "DIR")]
    pub mocap: Option<PathBuf>,
    /// Maximum number of clips that are used.
    #[arg(long, default_value_t = 10)]
    pub clips: usize,
    /// Scenes of each clip: seeds 1 and on.
    #[arg(long, default_value_t = 10)]
    pub seeds: u64,
    /// Frames of each scene; those from 101 on are scored.
    #[arg(long, default_value_t = 250)]
    pub frames: usize,
    /// Numbers of particles.
    #[arg(long, value_delimiter = ',', default_value = "10,25,50,100,250,1000,5000")]
    pub particles: Vec<usize>,
    /// Variants of the tracker.
    #[arg(long, value_delimiter = ',', value_parser = variant_parser(),
        default_values = Variant::ALL.map(|variant| variant.traits().name))]
    pub variants: Vec<Variant>,
    /// Skin model.
    #[command(flatten)]
    pub skin: SkinArgs,
    /// Folder for the tables and plots.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Go on with the evaluation in --out that a signal ended; the other options have to be the
    /// same.
    #[arg(long)]
    pub resume: bool,
}

/// What `DIR/arm.json` holds.
#[derive(Debug, Serialize)]
struct Report {
    format: &'static str,
    version: u32,
    sinew_version: &'static str,
    frames: usize,
    scenes: Vec<(String, u64)>,
    variants: Vec<Row>,
    options: Vec<Row>,
    as_printed: Vec<Row>,
    recovery: Recovery,
}

/// Renders the scenes, tracks them with everything that is compared, and writes tables and plots.
///
/// # Errors
/// A clip that is missing, an option out of range, an output that cannot be written, or
/// [`sinew::resume::Interrupted`].
pub fn run(args: &EvaluateArmArgs, console: &Console) -> Result<()> {
    until_signal(console, |stop| run_until(args, console, stop))
}

/// As [`run`], ended by `stop` in the place of a signal.
///
/// # Errors
/// As [`run`].
pub fn run_until(args: &EvaluateArmArgs, console: &Console, stop: Stop<'_>) -> Result<()> {
    ensure!(args.seeds > 0 && args.clips > 0, "--seeds and --clips must be greater than zero");
    ensure!(args.frames > 105, "--frames must be greater than 105; those from 101 on are scored, not {}", args.frames);
    ensure!(args.skin.calibrate.is_none(), "--calibrate has no use here: every scene has a skin of its own");
    let skin = args.skin.load()?;
    let begun = begun(args, &skin)?;
    let output = OutputDir::create(&args.out)?;
    let cells = Cells::keep(&output, &begun, args.resume, stop)?;
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES).build()?;
    let report = console.busy("rendering and tracking", || pool.install(|| measure(args, &skin, &cells)))?;
    output.write("arm.json", |writer| Ok(serde_json::to_writer_pretty(writer, &report)?))?;
    output.write("arm.csv", |writer| Ok(writer.write_all(table(&report).as_bytes())?))?;
    let curve = |unit: fn(&Row) -> [f64; 3]| curves(&report.variants, unit);
    let metres = curve(|row| [row.error_m.lower, row.error_m.median, row.error_m.upper]);
    output.write_png("error_3d.png", &curves_plot("3D hand error", "particles", "error, m", true, &metres)?)?;
    let pixels = curve(|row| [row.error_px.lower, row.error_px.median, row.error_px.upper]);
    output.write_png("error_2d.png", &curves_plot("2D hand error", "particles", "error, px", true, &pixels)?)?;
    let bars: Vec<(String, f64)> = report.options.iter().map(|row| (row.name.clone(), row.error_m.median)).collect();
    output.write_png("options.png", &bars_plot("Each option's own effect", "3D hand error, m", &bars)?)?;
    cells.end()?;
    let text = format!("{}tables and plots: {}\n", summary(&report), args.out.display());
    console.answer(&text, &json!({ "out": args.out, "report": report }))
}

/// What the cells depend on, beside the scenes.
fn begun(args: &EvaluateArmArgs, skin: &SkinModel) -> Result<Begun> {
    let variants: Vec<&str> = args.variants.iter().map(|variant| variant.traits().name).collect();
    let options = json!({
        "mocap": args.mocap,
        "clips": args.clips,
        "seeds": args.seeds,
        "frames": args.frames,
        "particles": args.particles,
        "variants": variants,
        "skin": args.skin.skin,
    });
    let begun = Begun::new("evaluate arm", &options, &[])?;
    Ok(begun.reading("the skin model", text_crc32(&model_file::to_json(skin)?)))
}

fn measure(args: &EvaluateArmArgs, skin: &SkinModel, cells: &Cells<'_>) -> Result<Report> {
    let mut clips = match &args.mocap {
        Some(folder) => recorded(folder)?,
        None => builtin(args.clips as u64),
    };
    clips.truncate(args.clips);
    let seeds: Vec<u64> = (1..=args.seeds).collect();
    let (base, printed_base) = (Config::default(), experiments::printed_base());
    let front_end = FrontEnd { config: &base, skin, reading: Reading::OverTime };
    let options = SceneOptions { frames: args.frames, ..SceneOptions::default() };
    let scenes: Vec<ObservedScene> = observe_all(&clips, &seeds, &options, &front_end, cells)?;
    let printed = FrontEnd { config: &printed_base, skin, reading: Reading::Alone };
    let as_seen = observe_all(&clips, &seeds, &options, &printed, cells)?;
    let as_printed = experiments::printed(&as_seen, cells)?;
    drop(as_seen);
    let mut effects = experiments::options(&scenes, Variant::Pik, cells)?;
    effects.extend(experiments::options(&scenes, Variant::Corrected, cells)?);
    Ok(Report {
        format: "sinew-evaluate-arm",
        version: 1,
        sinew_version: env!("CARGO_PKG_VERSION"),
        frames: args.frames,
        scenes: scenes.iter().map(|scene| (scene.clip.clone(), scene.seed)).collect(),
        variants: experiments::variants(&scenes, &args.variants, &args.particles, cells)?,
        options: effects,
        as_printed,
        recovery: experiments::recovery(&clips, &seeds, &front_end, cells)?,
    })
}

/// One line a tracker and scene.
fn table(report: &Report) -> String {
    let mut text = String::from("tracker,particles,clip,seed,error_m,error_px\n");
    for row in report.variants.iter().chain(&report.options).chain(&report.as_printed) {
        for ((clip, seed), (metres, pixels)) in report.scenes.iter().zip(&row.runs) {
            text.push_str(&format!("{},{},{clip},{seed},{metres:.5},{pixels:.3}\n", row.name, row.particles));
        }
    }
    text
}

/// A curve over particles for each variant; `values` gives lower quartile, median, upper quartile.
fn curves(rows: &[Row], values: fn(&Row) -> [f64; 3]) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for row in rows {
        let [low, middle, high] = values(row);
        let at = match curves.iter().position(|curve| curve.name == row.name) {
            Some(at) => at,
            None => {
                let name = row.name.clone();
                curves.push(Curve {
                    name,
                    points: Vec::new(),
                    low: Some(Vec::new()),
                    high: Some(Vec::new()),
                    ..Curve::default()
                });
                curves.len() - 1
            }
        };
        let curve = &mut curves[at];
        curve.points.push((row.particles as f64, middle));
        curve.low.get_or_insert_default().push(low);
        curve.high.get_or_insert_default().push(high);
    }
    curves
}

/// The rows for a person.
fn summary(report: &Report) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut add = |heading: &str, rows: &[Row]| {
        let _ = writeln!(text, "{heading}");
        for row in rows {
            let (m, px) = (&row.error_m, &row.error_px);
            let _ = writeln!(
                text,
                "{:<36} {:>5}   {:.3} ({:.3}-{:.3}) m   {:>6.1} ({:.1}-{:.1}) px",
                row.name, row.particles, m.median, m.lower, m.upper, px.median, px.lower, px.upper
            );
        }
    };
    let scenes = report.scenes.len();
    add(&format!("{scenes} scenes; median over runs (quartiles) of a run's mean hand error"), &report.variants);
    add("each option's own effect:", &report.options);
    add("as the arm paper prints them:", &report.as_printed);
    let pik = report.variants.iter().find(|row| row.name == "pik" && row.particles == 50);
    if let Some(pik) = pik {
        let mut bootstrap = report.variants.iter().filter(|row| row.name == "bootstrap");
        let _ = match bootstrap.find(|row| row.error_m.median <= pik.error_m.median) {
            Some(row) => writeln!(text, "bootstrap equals pik with 50 at {} particles", row.particles),
            None => writeln!(text, "bootstrap equals pik with 50 at none of these counts"),
        };
    }
    let _ = writeln!(
        text,
        "recovered within {} frames of the return: {:.0} % without a false blob, {:.0} % with one ({} runs each)",
        experiments::RECOVERY_FRAMES,
        100.0 * report.recovery.without_false_blob,
        100.0 * report.recovery.with_false_blob,
        report.recovery.runs
    );
    text
}
