//! `sinew-lab ablation`: the phase-coupled filter without each of its parts.

use crate::cyclic::protocol::pooled;
use crate::cyclic::{Protocol, long_runs, rate_of, test_cycles};
use crate::tables::markdown::{Rows, line, named, table};
use anyhow::{Result, ensure};
use clap::Args;
use serde_json::json;
use sinew::cli::console::Console;
use sinew::cyclic::model_file::MODEL_VALUE;
use sinew::cyclic::tracking::{FilterName, TrackingOptions};
use sinew::cyclic::{CutList, CyclicModel};
use sinew_core::cyclic::coupled::ablation::{Part, switch_off};
use std::path::PathBuf;

/// Largest error of the position beyond which a run was lost for a while, cycles.
const LOST: f64 = 0.2;

/// Options of `sinew-lab ablation`.
#[derive(Debug, Args)]
pub struct AblationArgs {
    /// Model that is tested: a shipped one, or a file of `sinew train cyclic`.
    #[arg(long, value_name = MODEL_VALUE, default_value = "walking")]
    pub model: String,
    /// Cut list of cycles that follow each other, best of recordings that nothing was chosen on.
    #[arg(long, value_name = "CUTS.csv")]
    pub cuts: PathBuf,
    /// Standard deviations of the noise, degrees.
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', default_value = "1.5,6,29,57")]
    pub sigma_deg: Vec<f64>,
    /// Repetitions of the noise.
    #[arg(long, default_value_t = 3)]
    pub seeds: u64,
}

/// What a filter comes to at one noise.
#[derive(Debug, Clone, Copy, serde::Serialize)]
struct Score {
    sigma_deg: f64,
    /// Mean absolute error of the angles of single cycles, degrees.
    error_deg: f64,
    /// Share of the truth inside the 90 % band.
    inside_90: f64,
    /// Mean absolute error of the cadence of whole recordings, relative.
    cadence_error: f64,
    /// Share of the recordings whose position was lost.
    lost: f64,
}

/// Prints a table: the whole filter, then the filter without each part.
///
/// # Errors
/// A list, table or model that cannot be read, a number that is not positive.
pub fn run(args: &AblationArgs, console: &Console) -> Result<()> {
    ensure!(args.seeds > 0, "--seeds must be greater than zero");
    ensure!(args.sigma_deg.iter().all(|sigma| *sigma > 0.0), "--sigma-deg must be greater than zero");
    let whole = scores(args, None)?;
    let parts = Part::ALL.iter().map(|part| Ok((*part, scores(args, Some(*part))?))).collect::<Result<Vec<_>>>()?;
    let mut rows: Rows = vec![named("", whole.iter().map(|score| format!("sigma {}", score.sigma_deg)))];
    rows.push(named("all parts", whole.iter().map(cell)));
    rows.extend(parts.iter().map(|(part, scores)| named(format!("without `{part:?}`"), scores.iter().map(cell))));
    let legend = line([
        "each cell: error of the angles in degrees; truth inside the 90 % band, error of the cadence, lost runs, in %",
    ]);
    let without: serde_json::Map<_, _> =
        parts.iter().map(|(part, scores)| (format!("{part:?}"), json!(scores))).collect();
    console.answer(&format!("{}\n\n{}", legend[0], table(&rows)), &json!({ "all": whole, "without": without }))
}

fn cell(score: &Score) -> String {
    format!(
        "{:.2}; {:.0}, {:.1}, {:.0}",
        score.error_deg,
        100.0 * score.inside_90,
        100.0 * score.cadence_error,
        100.0 * score.lost
    )
}

/// The filter without `off`, at each noise.
fn scores(args: &AblationArgs, off: Option<Part>) -> Result<Vec<Score>> {
    let list = CutList::read(&args.cuts)?;
    let model = CyclicModel::from_option(&args.model)?;
    switch_off(off);
    let scores = args.sigma_deg.iter().map(|sigma| score(&list, &model, *sigma, args.seeds)).collect();
    switch_off(None);
    scores
}

fn score(list: &CutList, model: &CyclicModel, sigma_deg: f64, seeds: u64) -> Result<Score> {
    let rate_hz = rate_of(list, None)?;
    let options = TrackingOptions {
        sigma_rad: sigma_deg.to_radians(),
        initial_cycle_position: Some(0.0),
        rate_hz: Some(rate_hz),
        ..TrackingOptions::default()
    };
    let errors = pooled(&test_cycles(list)?, model, Protocol::Noisy, &options, seeds)?;
    let mut runs = Vec::new();
    for seed in 1..=seeds {
        runs.extend(long_runs(list, model, rate_hz, &[FilterName::Coupled], (sigma_deg, seed))?);
    }
    let count = runs.len() as f64;
    Ok(Score {
        sigma_deg,
        error_deg: errors.all_deg(),
        inside_90: errors.inside_90().0,
        cadence_error: runs.iter().map(|run| run.cadence_error.abs()).sum::<f64>() / count,
        lost: runs.iter().filter(|run| run.phase_max > LOST).count() as f64 / count,
    })
}
