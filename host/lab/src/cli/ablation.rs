//! `sinew-lab ablation`: the phase-coupled filter without each of its parts.

use crate::cyclic::protocol::pooled;
use crate::cyclic::{LongRun, Protocol, TestCycle, long_runs, rate_of, test_cycles};
use crate::tables::markdown::{Rows, named, table};
use anyhow::{Result, ensure};
use clap::Args;
use serde_json::json;
use sinew::cli::console::Console;
use sinew::cyclic::model_file::MODEL_VALUE;
use sinew::cyclic::tracking::{FilterName, TrackingOptions};
use sinew::cyclic::{CutList, CyclicModel};
use sinew_core::cyclic::coupled::ablation::{Part, switch_off};
use std::path::PathBuf;

/// What a cell of the table holds.
const LEGEND: &str =
    "each cell: error of the angles in degrees; truth inside the 90 % band, error of the cadence, lost runs, in %";

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
    let material = Material::read(args)?;
    let whole = material.scores(args, None)?;
    let parts = Part::ALL.into_iter().map(|part| Ok((part, material.scores(args, Some(part))?)));
    let parts = parts.collect::<Result<Vec<_>>>()?;
    let mut rows: Rows = vec![named("", whole.iter().map(|score| format!("sigma {}", score.sigma_deg)))];
    rows.push(named("all parts", whole.iter().map(cell)));
    rows.extend(parts.iter().map(|(part, scores)| named(format!("without `{part:?}`"), scores.iter().map(cell))));
    let without: serde_json::Map<_, _> =
        parts.iter().map(|(part, scores)| (format!("{part:?}"), json!(scores))).collect();
    console.answer(&format!("{LEGEND}\n\n{}", table(&rows)), &json!({ "all": whole, "without": without }))
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

/// What every row of the table is measured on.
struct Material {
    list: CutList,
    cycles: Vec<TestCycle>,
    model: CyclicModel,
    rate_hz: f64,
}

impl Material {
    fn read(args: &AblationArgs) -> Result<Self> {
        let list = CutList::read(&args.cuts)?;
        let (cycles, rate_hz) = (test_cycles(&list)?, rate_of(&list, None)?);
        Ok(Self { list, cycles, model: CyclicModel::from_option(&args.model)?, rate_hz })
    }

    /// The filter without `off`, at each noise.
    fn scores(&self, args: &AblationArgs, off: Option<Part>) -> Result<Vec<Score>> {
        switch_off(off);
        let scores = args.sigma_deg.iter().map(|sigma| self.score(*sigma, args.seeds)).collect();
        switch_off(None);
        scores
    }

    fn score(&self, sigma_deg: f64, seeds: u64) -> Result<Score> {
        let options = TrackingOptions {
            sigma_rad: sigma_deg.to_radians(),
            initial_cycle_position: Some(0.0),
            rate_hz: Some(self.rate_hz),
            ..TrackingOptions::default()
        };
        let errors = pooled(&self.cycles, &self.model, Protocol::Noisy, &options, seeds)?;
        let mut runs = Vec::new();
        for seed in 1..=seeds {
            let coupled = [FilterName::Coupled];
            runs.extend(long_runs(&self.list, &self.model, self.rate_hz, &coupled, (sigma_deg, seed))?);
        }
        let [cadence_error, lost] = LongRun::cadence_error_and_lost(&runs);
        Ok(Score { sigma_deg, error_deg: errors.all_deg(), inside_90: errors.inside_90().0, cadence_error, lost })
    }
}
