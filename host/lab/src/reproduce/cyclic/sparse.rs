//! Figure 4b: fewer measurements.

use super::common::{by_skip, other_motion, walkers};
use crate::cyclic::Protocol;
use crate::cyclic::baselines::{Baseline, error_deg};
use crate::cyclic::experiments::{Cell, SKIPS, Setting};
use crate::reproduce::page::{Row, Section};
use crate::reproduce::plot::{Plot, Series};
use crate::reproduce::{Made, compared, printed};
use anyhow::Result;
use sinew::cyclic::tracking::FilterName;

/// Frames a measurement of the number that the paper prints: two of three frames are skipped.
const PRINTED_SKIP: u64 = 3;
/// Measurement noise of figure 4b by its caption, degrees.
const CAPTION_SIGMA_DEG: f64 = 29.0;
/// The same by the text of section 3.2, degrees.
const TEXT_SIGMA_DEG: f64 = 6.0;

/// Adds figure 4b; `acceleration_std` is the number of the filter of constant velocity.
///
/// # Errors
/// A run that fails.
pub fn figure_4b(setting: &Setting<'_>, acceleration_std: f64, made: &mut Made) -> Result<()> {
    let sparse = setting.sparse_measurements()?;
    let exact = || sparse.iter().filter(|cell| cell.protocol == Protocol::ExactMean);
    let mut series = by_skip(exact());
    for baseline in Baseline::ALL {
        let error =
            |every| error_deg(setting, baseline, (Protocol::ExactMean, CAPTION_SIGMA_DEG, every), acceleration_std);
        let points = SKIPS.into_iter().map(|every| (every as f64, error(every), 0.0)).collect();
        series.push(Series { name: baseline.name().into(), points });
    }
    let mut rows = Vec::new();
    let caption = exact().find(|cell| cell.filter == FilterName::Paper && cell.updates == "every 3").cloned();
    let text = setting.skipping(FilterName::Paper, TEXT_SIGMA_DEG, PRINTED_SKIP)?;
    for (cell, place) in [(caption, "caption"), (Some(text), "text")] {
        let Some(cell) = cell else { continue };
        let (paper, ours, difference) = compared(printed::CYCLIC_SKIP_2_DEG, cell.error_deg, 2);
        let ours = format!("{ours} +- {:.2}", cell.cycle_std_deg);
        let what = format!("two of three frames skipped, sigma {:.0} as in the {place}", cell.sigma_deg);
        rows.push(Row { what, paper, ours, difference });
    }
    for cell in exact().filter(|cell| cell.updates.starts_with("two")) {
        rows.push(Row {
            what: format!("two updates a cycle, sigma 6, `{}`", cell.filter.name()),
            paper: "an error that rises considerably; drawn, not printed".into(),
            ours: format!("{:.2} +- {:.2} degrees", cell.error_deg, cell.cycle_std_deg),
            difference: "no number to compare".into(),
        });
    }
    made.page.sections.push(Section {
        id: "figure-4b",
        title: "Figure 4b: fewer measurements, and two updates a cycle".into(),
        material: format!(
            "{} Exact-mean; +- is one standard deviation over cycles. The two updates are a quarter and three quarters \
             through the cycle; the paper's are where the arms point straight out of the water.",
            walkers(setting)
        ),
        rows,
        reason: format!("{} The paper's caption has sigma 29, its text sigma 6.", other_motion(setting)),
        table: table(&series, &exact().cloned().collect::<Vec<_>>()),
        pictures: vec!["figure_4b.svg".into()],
    });
    made.plots.push((
        "figure_4b.svg".into(),
        Plot {
            title: "Figure 4b: fewer measurements, sigma 29 degrees (exact-mean)".into(),
            x_label: "frames a measurement".into(),
            y_label: "mean absolute error, degrees".into(),
            bars: "one standard deviation over test cycles".into(),
            series,
            ..Plot::default()
        },
    ));
    Ok(())
}

/// Errors by filter, a column for each number of frames a measurement, then two updates a cycle.
fn table(series: &[Series], exact: &[Cell]) -> Vec<Vec<String>> {
    let mut head = vec!["filter".to_owned()];
    head.extend(SKIPS.map(|skip| skip.to_string()));
    head.push("two a cycle, sigma 6".into());
    let mut table = vec![head];
    for Series { name, points } in series {
        let text = |&(_, error, std): &(f64, f64, f64)| {
            if std > 0.0 { format!("{error:.2} +- {std:.2}") } else { format!("{error:.2}") }
        };
        let mut row: Vec<String> = std::iter::once(name.clone()).chain(points.iter().map(text)).collect();
        let two = exact.iter().find(|cell| cell.filter.name() == name && cell.updates.starts_with("two"));
        row.push(two.map_or_else(String::new, |cell| format!("{:.2} +- {:.2}", cell.error_deg, cell.cycle_std_deg)));
        table.push(row);
    }
    table
}
