//! The coupled filter on walks of other sources.

use super::markdown::{Rows, line, named};
use crate::cyclic::after_something_else::{of_other_sources, off_shares};
use crate::cyclic::tempo::{TempoRuns, tempo_runs};
use crate::cyclic::{LongRun, other_sources};
use anyhow::Result;
use sinew::cyclic::CyclicModel;
use std::path::Path;

/// Noise of the tables, degrees.
const SIGMAS_DEG: [f64; 3] = [1.5, 6.0, 29.0];
/// Repetitions after something else.
const AFTER_SEEDS: [u64; 2] = [1, 2];
/// Repetitions of a tempo.
const TEMPO_SEEDS: [u64; 10] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];

fn heading() -> Vec<String> {
    line(["", "sigma 1.5 degrees", "sigma 6", "sigma 29"])
}

/// Walks at nine tempos: cadence off in percent and lost runs of each, and in the last row of all.
pub fn tempo(recordings: &Path) -> Result<Rows> {
    let walks = other_sources::walks(&recordings.join("mocap"))?;
    let model = CyclicModel::from_option("walking")?;
    let runs = SIGMAS_DEG.map(|sigma_deg| tempo_runs(&walks, &model, (sigma_deg, &TEMPO_SEEDS)));
    let runs = runs.into_iter().collect::<Result<Vec<_>>>()?;
    let mut rows = vec![heading()];
    for (index, (name, _)) in runs[0].iter().enumerate() {
        let cell = |of_tempo: &Vec<TempoRuns>| {
            let runs = &of_tempo[index].1;
            let [off, _] = LongRun::cadence_error_and_lost(runs);
            format!("{:.1}, {}", 100.0 * off, runs.iter().filter(|run| run.is_lost()).count())
        };
        rows.push(named(*name, runs.iter().map(cell)));
    }
    rows.push(named(
        "mean",
        runs.iter().map(|of_tempo| {
            let [off, lost] = LongRun::cadence_error_and_lost(of_tempo.iter().flat_map(|(_, runs)| runs));
            format!("{:.1}, {:.1} %", 100.0 * off, 100.0 * lost)
        }),
    ));
    Ok(rows)
}

/// Walks after something else: frames off in the second second, and from then on, by the filter and
/// looking back.
pub fn after(recordings: &Path) -> Result<Rows> {
    let walks = of_other_sources(&recordings.join("mocap"))?;
    let mut rows = vec![heading()];
    for (smooth, names) in [
        (false, ["second second of walking", "from then on"]),
        (true, ["second second, looking back", "from then on, looking back"]),
    ] {
        let shares = SIGMAS_DEG.map(|sigma_deg| off_shares(&walks, (sigma_deg, &AFTER_SEEDS), smooth));
        let shares = shares.into_iter().collect::<Result<Vec<_>>>()?;
        rows.extend(
            names
                .into_iter()
                .enumerate()
                .map(|(index, name)| named(name, shares.iter().map(|of| format!("{:.0} %", 100.0 * of[index])))),
        );
    }
    Ok(rows)
}
