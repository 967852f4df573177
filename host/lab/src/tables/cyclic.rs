//! The cyclic filters on walkers that were not trained on.

use super::markdown::{Rows, line, named};
use crate::cyclic::experiments::{Cell, FILTERS, SIGMAS_DEG};
use crate::cyclic::protocol::pooled;
use crate::cyclic::{Protocol, Setting, TestCycle, test_cycles};
use anyhow::Result;
use sinew::cyclic::tracking::TrackingOptions;
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::cyclic::{CutList, CyclicModel};
use sinew::resume::Cells;
use std::path::Path;

/// Frames per second of the tables.
const RATE_HZ: f64 = 60.0;
/// Repetitions of the table of errors.
const ERROR_SEEDS: u64 = 60;
/// Repetitions of the table of smoothed errors.
const SMOOTHING_SEEDS: u64 = 20;
/// The cyclic paper's own errors at [`SIGMAS_DEG`], degrees: its table 1.
const PAPERS_OWN: [&str; 6] = ["2.81", "4.40", "5.32", "8.09", "9.52", "11.12"];

/// The model of three people and the cycles of four others.
fn walkers(recordings: &Path) -> Result<(CyclicModel, Vec<TestCycle>)> {
    let list = |name| CutList::read(&recordings.join("cyclic-walking").join(name));
    let model =
        train(&list("train_cuts.csv")?, TrainingOptions { rate_hz: Some(RATE_HZ), ..TrainingOptions::default() })?;
    Ok((model, test_cycles(&list("test_cuts.csv")?)?))
}

pub fn errors(recordings: &Path) -> Result<Rows> {
    let (model, cycles) = walkers(recordings)?;
    let cells = &Cells::not_kept();
    let setting = Setting { cycles: &cycles, model: &model, rate_hz: RATE_HZ, seeds: ERROR_SEEDS, cells };
    let measured = setting.noise_table()?;
    let mut rows = vec![
        named("sigma, degrees", SIGMAS_DEG.map(|sigma| sigma.to_string())),
        named("the paper's own", PAPERS_OWN.map(str::to_owned)),
    ];
    let error = |cell: &Cell| format!("{:.2} ({:.2})", cell.error_deg, cell.long_error_deg);
    for of_filter in measured.chunks(SIGMAS_DEG.len()) {
        let name = format!("{}: `{}`", of_filter[0].protocol.name(), of_filter[0].filter.name());
        rows.push(named(name, of_filter.iter().map(error)));
    }
    Ok(rows)
}

pub fn smoothing(recordings: &Path) -> Result<Rows> {
    let (model, cycles) = walkers(recordings)?;
    let mut rows = vec![line(["", "sigma 6: filter", "smoothed", "sigma 29: filter", "smoothed"])];
    for filter in FILTERS {
        let mut row = line([format!("`{}`", filter.name())]);
        for (sigma_deg, smooth) in [(6.0_f64, false), (6.0, true), (29.0, false), (29.0, true)] {
            let options = TrackingOptions {
                filter,
                sigma_rad: sigma_deg.to_radians(),
                initial_cycle_position: Some(0.0),
                rate_hz: Some(RATE_HZ),
                smooth,
                ..TrackingOptions::default()
            };
            let errors = pooled(&cycles, &model, Protocol::Noisy, &options, SMOOTHING_SEEDS)?;
            row.push(format!("{:.2}", errors.all_deg()));
        }
        rows.push(row);
    }
    Ok(rows)
}
