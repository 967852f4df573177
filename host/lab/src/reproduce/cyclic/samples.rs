//! Table 2, figures 5a and 5b: the particle filter.

use super::common::{by_skip, other_motion, walkers};
use crate::cyclic::Protocol;
use crate::cyclic::baselines::{Baseline, error_deg};
use crate::cyclic::experiments::{Cell, Setting};
use crate::reproduce::page::{Row, Section};
use crate::reproduce::plot::{Plot, Series};
use crate::reproduce::{Made, compared, of_trend, printed};
use anyhow::Result;
use sinew::cyclic::tracking::{FilterName, StartName};

/// Measurement noise of table 2, degrees.
const SIGMA_DEG: f64 = 29.0;

/// Adds table 2, with the filters without samples beside it; `acceleration_std` is the number of
/// the filter of constant velocity.
///
/// # Errors
/// A run that fails.
pub fn table_2(setting: &Setting<'_>, (samples, acceleration_std): (&[usize], f64), made: &mut Made) -> Result<()> {
    let cells = setting.particle_table(samples)?;
    let falls = cells.is_sorted_by(|fewer, more| fewer.error_deg >= more.error_deg);
    let mut rows: Vec<Row> = cells
        .iter()
        .zip(printed::CYCLIC_TABLE_2_DEG[0])
        .map(|(cell, paper)| {
            let (paper, ours, difference) = compared(paper, cell.error_deg, 2);
            let ours = format!("{ours} +- {:.2}", cell.seed_std_deg);
            Row { what: format!("{} samples, test set 1", cell.particles.unwrap_or(0)), paper, ours, difference }
        })
        .collect();
    rows.push(Row {
        what: "trend".into(),
        paper: "the error falls with the number of samples".into(),
        ours: if falls { "in each step" } else { "not in each step" }.into(),
        difference: of_trend(falls),
    });
    let mut table = vec![["", "degrees"].map(String::from).to_vec()];
    for filter in [FilterName::Paper, FilterName::Coupled] {
        let cell = setting.skipping(filter, SIGMA_DEG, 1)?;
        table.push(vec![format!("filter `{}`, no samples", filter.name()), format!("{:.2}", cell.error_deg)]);
    }
    for baseline in Baseline::ALL {
        let error = error_deg(setting, baseline, (Protocol::ExactMean, SIGMA_DEG, 1), acceleration_std);
        table.push(vec![format!("baseline: {}", baseline.name()), format!("{error:.2}")]);
    }
    made.page.sections.push(Section {
        id: "table-2",
        title: "Table 2: error against the number of samples at sigma 29 degrees".into(),
        material: format!("{} +- is one standard deviation over seeds.", walkers(setting)),
        rows,
        reason: other_motion(setting),
        table,
        pictures: vec!["table_2.svg".into()],
    });
    let paper = |name: &str, values: [f64; 6]| Series {
        name: name.into(),
        points: printed::CYCLIC_SAMPLES.into_iter().zip(values).map(|(x, y)| (x as f64, y, 0.0)).collect(),
    };
    let [one, two] = printed::CYCLIC_TABLE_2_DEG;
    let ours = cells.iter().map(|cell| (cell.particles.unwrap_or(0) as f64, cell.error_deg, cell.seed_std_deg));
    made.plots.push((
        "table_2.svg".into(),
        Plot {
            title: "Table 2: error against the number of samples, sigma 29 degrees".into(),
            x_label: "samples (logarithmic)".into(),
            y_label: "mean absolute error, degrees".into(),
            log_x: true,
            bars: "one standard deviation over seeds".into(),
            series: vec![
                paper("paper's test set 1", one),
                paper("paper's test set 2", two),
                Series { name: "ours".into(), points: ours.collect() },
            ],
            ..Plot::default()
        },
    ));
    Ok(())
}

/// Adds figures 5a, with the numbers of samples `sparse`, and 5b.
///
/// # Errors
/// A run that fails.
pub fn figures_5(setting: &Setting<'_>, (sparse, samples): (&[usize], &[usize]), made: &mut Made) -> Result<()> {
    let bars = "one standard deviation over seeds".to_owned();
    let skipped = setting.sparse_particles(sparse)?;
    let y_label = "mean absolute error, degrees".to_owned();
    made.plots.push((
        "figure_5a.svg".into(),
        Plot {
            title: "Figure 5a: fewer measurements, samples, sigma 29 degrees".into(),
            x_label: "frames a measurement".into(),
            y_label: y_label.clone(),
            bars: bars.clone(),
            series: by_skip(skipped.iter()),
            ..Plot::default()
        },
    ));
    let starts = setting.starts(samples)?;
    let named = |start: StartName, name: &str| Series {
        name: name.into(),
        points: starts
            .iter()
            .filter(|cell| cell.start == start)
            .map(|cell| (cell.particles.unwrap_or(0) as f64, cell.late_error_deg, cell.late_seed_std_deg))
            .collect(),
    };
    let series = [(StartName::Standard, "standard"), (StartName::Uniform, "uniform"), (StartName::Random, "random")];
    made.plots.push((
        "figure_5b.svg".into(),
        Plot {
            title: "Figure 5b: three ways to start, from the fifth frame on, sigma 29 degrees".into(),
            x_label: "samples (logarithmic)".into(),
            y_label,
            log_x: true,
            bars,
            series: series.map(|(start, name)| named(start, name)).to_vec(),
            ..Plot::default()
        },
    ));
    made.page.sections.push(Section {
        id: "figures-5",
        title: "Figures 5a and 5b: samples with fewer measurements, and three ways to start".into(),
        material: walkers(setting),
        rows: [trend_5a(&skipped), trend_5b(&starts)].into_iter().flatten().collect(),
        reason: other_motion(setting),
        pictures: vec!["figure_5a.svg".into(), "figure_5b.svg".into()],
        ..Section::default()
    });
    Ok(())
}

/// Whether the first gap costs less than half of what the longest one costs, with the fewest
/// samples.
fn trend_5a(skipped: &[Cell]) -> Option<Row> {
    let curve = by_skip(skipped.iter()).into_iter().next()?;
    let [every, short, long] = [curve.points.first()?, curve.points.get(1)?, curve.points.last()?];
    Some(Row {
        what: format!("5a, {}", curve.name),
        paper: "short gaps cost little, long ones much; drawn, not printed".into(),
        ours: format!(
            "a measurement every {:.0}, {:.0}, {:.0} frames: {:.1}, {:.1}, {:.1} degrees",
            every.0, short.0, long.0, every.1, short.1, long.1
        ),
        difference: of_trend(short.1 - every.1 < 0.5 * (long.1 - every.1)),
    })
}

/// Whether starts uniform over the cycle end nearer to standard ones than to random ones, and
/// random ones have the greatest error, with the most samples.
fn trend_5b(starts: &[Cell]) -> Option<Row> {
    let last = |start: StartName| starts.iter().rfind(|cell| cell.start == start);
    let [standard, uniform, random] = [last(StartName::Standard)?, last(StartName::Uniform)?, last(StartName::Random)?];
    let [s, u, r] = [standard, uniform, random].map(|cell| cell.late_error_deg);
    Some(Row {
        what: format!("5b, {} samples, from the fifth frame on", standard.particles.unwrap_or(0)),
        paper: "random starts fail; starts uniform over the cycle are almost as good as standard ones".into(),
        ours: format!(
            "standard {s:.1} +- {:.1}, uniform {u:.1} +- {:.1}, random {r:.1} +- {:.1} degrees",
            standard.late_seed_std_deg, uniform.late_seed_std_deg, random.late_seed_std_deg
        ),
        difference: of_trend(r > u && r > s && (u - s).abs() < (r - u).abs()),
    })
}
