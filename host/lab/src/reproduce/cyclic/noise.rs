//! Table 1 and figure 4a: error against measurement noise.

use super::common::{other_motion, walkers};
use crate::cyclic::baselines;
use crate::cyclic::experiments::{Cell, Setting};
use crate::cyclic::{Protocol, TestCycle};
use crate::reproduce::page::{Row, Section};
use crate::reproduce::plot::{Plot, Series};
use crate::reproduce::{Made, compared, of_trend, printed};
use anyhow::Result;
use sinew::cyclic::angle_table::COLUMNS;
use sinew::cyclic::tracking::FilterName;

/// Head of the table; noises are in degrees.
const HEAD: [&str; 8] = ["filter", "protocol", "sigma 1", "sigma 3", "sigma 6", "sigma 29", "sigma 57", "sigma 115"];
/// Filters of the table.
const FILTERS: [FilterName; 3] = [FilterName::Paper, FilterName::PaperCut, FilterName::Coupled];
/// How far labels by hand may scatter, degrees: 2 and 5 pixels at both ends of a part of 50.
const LABELS_DEG: [f64; 2] = [3.0, 8.0];
/// Angles of upper arms and forearms.
const ARMS: [usize; 4] = [2, 3, 5, 6];
/// Angles of thighs and shanks.
const LEGS: [usize; 4] = [8, 9, 11, 12];

/// Adds table 1; answers the one number of the filter of constant velocity, tuned on `training`.
///
/// # Errors
/// A run that fails.
pub fn table_1(setting: &Setting<'_>, training: &[TestCycle], made: &mut Made) -> Result<f64> {
    let cells = setting.noise_table()?;
    let paper = printed::CYCLIC_TABLE_1_DEG[0];
    let of = |filter: FilterName, protocol: Protocol| {
        cells.iter().filter(move |c| c.filter == filter && c.protocol == protocol)
    };
    let rows = of(FilterName::Paper, Protocol::ExactMean).zip(paper).map(|(cell, paper)| {
        let (paper, ours, difference) = compared(paper, cell.error_deg, 2);
        let what = format!("sigma {} degrees, test set 1, filter `paper`", cell.sigma_deg.round());
        Row { what, paper, ours: format!("{ours} +- {:.2}", cell.cycle_std_deg), difference }
    });
    let text = |cell: &Cell| format!("{:.2} +- {:.2}", cell.error_deg, cell.cycle_std_deg);
    let named = |name: &str, protocol: Protocol, cells: &mut dyn Iterator<Item = &Cell>| -> Vec<String> {
        [name.to_owned(), protocol.name().to_owned()].into_iter().chain(cells.map(text)).collect()
    };
    let mut table = vec![HEAD.map(String::from).to_vec()];
    for protocol in [Protocol::ExactMean, Protocol::Noisy] {
        for filter in FILTERS {
            table.push(named(filter.name(), protocol, &mut of(filter, protocol)));
        }
        let worded = setting.worded(protocol)?;
        table.push(named("paper, covariance by k^2 as worded", protocol, &mut worded.iter()));
    }
    let mut labelled = Vec::new();
    for label_deg in LABELS_DEG {
        let cells = by_labels(setting, label_deg)?;
        let name = format!("paper, truth that scatters by {label_deg} degrees");
        table.push(named(&name, Protocol::ExactMean, &mut cells.iter()));
        labelled = cells;
    }
    let acceleration_std = baselines::tuned_acceleration_std(&Setting { cycles: training, seeds: 1, ..*setting });
    table.extend(baselines::rows(setting, acceleration_std)?);
    made.plots.push(("table_1.svg".into(), plot(&cells, &labelled)));
    made.page.sections.push(Section {
        id: "table-1",
        title: "Table 1: error against measurement noise".into(),
        material: format!("{} +- is one standard deviation over cycles.", walkers(setting)),
        rows: rows.collect(),
        reason: reason(setting, &labelled),
        table,
        pictures: vec!["table_1.svg".into()],
    });
    Ok(acceleration_std)
}

/// The paper's test sets, our filters, and `paper` with labels that scatter.
fn plot(cells: &[Cell], labelled: &[Cell]) -> Plot {
    let mut plot = Plot {
        title: "Table 1: error against the noise that the filter assumes (exact-mean)".into(),
        x_label: "sigma, degrees (logarithmic)".into(),
        y_label: "mean absolute error, degrees".into(),
        log_x: true,
        bars: "one standard deviation over test cycles".into(),
        ..Plot::default()
    };
    for (name, values) in ["paper's test set 1", "paper's test set 2"].into_iter().zip(printed::CYCLIC_TABLE_1_DEG) {
        let points = printed::CYCLIC_SIGMAS_DEG.into_iter().zip(values).map(|(x, y)| (x, y, 0.0)).collect();
        plot.series.push(Series { name: name.into(), points });
    }
    let point = |c: &Cell| (c.sigma_deg, c.error_deg, c.cycle_std_deg);
    for filter in FILTERS {
        let shown = cells.iter().filter(|c| c.filter == filter && c.protocol == Protocol::ExactMean);
        plot.series.push(Series { name: format!("ours, {}", filter.name()), points: shown.map(point).collect() });
    }
    let name = format!("ours, paper, labels +- {}", LABELS_DEG[LABELS_DEG.len() - 1]);
    plot.series.push(Series { name, points: labelled.iter().map(point).collect() });
    plot
}

/// `paper` where the truth, and with it the measurement, scatters as labels by hand do; trained
/// without.
fn by_labels(setting: &Setting<'_>, label_deg: f64) -> Result<Vec<Cell>> {
    let labelled = |(index, cycle): (usize, &TestCycle)| TestCycle {
        truth: cycle.truth.with_noise(label_deg.to_radians(), index as u64),
        ..cycle.clone()
    };
    let cycles: Vec<TestCycle> = setting.cycles.iter().enumerate().map(labelled).collect();
    Setting { cycles: &cycles, ..*setting }.of_filter(FilterName::Paper, Protocol::ExactMean)
}

fn reason(setting: &Setting<'_>, labelled: &[Cell]) -> String {
    let ends = [labelled.first(), labelled.last()].map(|cell| cell.map_or(f64::NAN, |cell| cell.error_deg));
    format!(
        "{} The paper's angles come from joints that were marked by hand. If labels scatter by {} degrees, `paper` has \
         {:.1} degrees at sigma 1 and {:.1} at sigma 115 here, and 2.8 and 11.1 there. In exact-mean the measurement \
         is the true angle, so raw measurements have no error: the protocol rewards a filter that ignores sigma.",
        other_motion(setting),
        LABELS_DEG[LABELS_DEG.len() - 1],
        ends[0],
        ends[1]
    )
}

/// Adds figure 4a.
///
/// # Errors
/// A run that fails.
pub fn figure_4a(setting: &Setting<'_>, made: &mut Made) -> Result<()> {
    let noise = setting.noise_table()?;
    let names: Vec<&str> = COLUMNS[1..].iter().map(|name| name.trim_end_matches("_rad")).collect();
    let is_wide = |cell: &&Cell| cell.protocol == Protocol::ExactMean && (cell.sigma_deg - 115.0).abs() < 0.5;
    let wide: Vec<&Cell> = noise.iter().filter(is_wide).collect();
    let first = wide.iter().find(|cell| cell.filter == FilterName::Paper).map_or([0.0; 13], |cell| cell.each_deg);
    let limbs = |angles: &[usize; 4]| angles.iter().map(|&angle| first[angle]).sum::<f64>() / 4.0;
    let mut table: Vec<Vec<String>> =
        std::iter::once("angle").chain(names.iter().copied()).map(|name| vec![name.to_owned()]).collect();
    let mut plot = Plot {
        title: "Figure 4a: error of each angle, sigma 115 degrees (exact-mean)".into(),
        x_label: "angle, named by the joint at its end".into(),
        y_label: "mean absolute error, degrees".into(),
        bars: "one standard deviation over test cycles".into(),
        x_names: names.iter().map(|name| name.replace('_', " ")).collect(),
        ..Plot::default()
    };
    for (index, cell) in wide.iter().enumerate() {
        let each = cell.each_deg.iter().zip(&cell.each_cycle_std_deg);
        table[0].push(cell.filter.name().into());
        table[1..].iter_mut().zip(each.clone()).for_each(|(row, (error, std))| {
            row.push(format!("{error:.1} +- {std:.1}"));
        });
        // Beside each other, a fifth of the way to the next name apart.
        let beside = 0.2 * (index as f64 - 1.0);
        let points = each.enumerate().map(|(angle, (error, std))| (angle as f64 + beside, *error, *std)).collect();
        plot.series.push(Series { name: cell.filter.name().into(), points });
    }
    made.plots.push(("figure_4a.svg".into(), plot));
    made.page.sections.push(Section {
        id: "figure-4a",
        title: "Figure 4a: error of each angle at sigma 115 degrees".into(),
        material: format!("{} Exact-mean; +- is one standard deviation over cycles.", walkers(setting)),
        rows: vec![Row {
            what: "trend".into(),
            paper: "legs are followed more easily than arms".into(),
            ours: format!("`paper`: legs {:.1}, arms {:.1} degrees", limbs(&LEGS), limbs(&ARMS)),
            difference: of_trend(limbs(&LEGS) < limbs(&ARMS)),
        }],
        reason: other_motion(setting),
        table,
        pictures: vec!["figure_4a.svg".into()],
    });
    Ok(())
}
