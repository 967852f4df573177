//! Figures 13 to 15 of the PIK paper: error, smoothness and time against the number of particles.

use super::report::{BodyReport, BodyResult};
use anyhow::Result;
use image::RgbImage;
use sinew::body::tracking::BodyModelKind;
use sinew::draw::plot::{Curve, curves_plot};

/// Mean and standard deviation of what is plotted.
type Value = fn(&BodyResult) -> (f64, f64);

/// Figures with their file names.
///
/// # Errors
/// Nothing to plot.
pub fn figures(report: &BodyReport) -> Result<Vec<(String, RgbImage)>> {
    let plots: [(&str, &str, &str, Value); 4] = [
        ("figure_13_error.png", "Figure 13: error (34)", "error, cm", |cell| cm(cell.error_m.mean, cell.error_m.std)),
        ("joint_error.png", "Error of the joints", "error, cm", |cell| {
            cm(cell.joint_error_m.mean, cell.joint_error_m.std)
        }),
        ("figure_14_smoothness.png", "Figure 14: smoothness (35) over the truth's own", "ratio", |cell| {
            (cell.smoothness_m.mean / cell.truth_smoothness_m, cell.smoothness_m.std / cell.truth_smoothness_m)
        }),
        ("figure_15_time.png", "Figure 15: time of a step", "milliseconds", |cell| {
            (1.0e3 * cell.seconds_per_frame, 0.0)
        }),
    ];
    let mut models: Vec<BodyModelKind> = report.results.iter().map(|cell| cell.model).collect();
    models.sort_unstable();
    models.dedup();
    plots
        .into_iter()
        .map(|(file, title, label, value)| {
            let curves: Vec<Curve> = models.iter().map(|&model| curve(report, model, value)).collect();
            let title = format!("{title}, mean over the motions");
            Ok((file.to_owned(), curves_plot(&title, "particles", label, true, &curves)?))
        })
        .collect()
}

fn cm(mean: f64, std: f64) -> (f64, f64) {
    (100.0 * mean, 100.0 * std)
}

/// Mean over the motions, with a band of one mean standard deviation.
fn curve(report: &BodyReport, model: BodyModelKind, value: Value) -> Curve {
    let (mut low, mut high) = (Vec::new(), Vec::new());
    let mut curve = Curve { name: model.name().into(), ..Curve::default() };
    for count in report.counts(model) {
        let cells = report.results.iter().filter(|cell| cell.model == model && cell.particles == count);
        let values: Vec<(f64, f64)> = cells.map(value).collect();
        let n = values.len() as f64;
        let mean = values.iter().map(|(mean, _)| mean).sum::<f64>() / n;
        let std = values.iter().map(|(_, std)| std).sum::<f64>() / n;
        curve.points.push((count as f64, mean));
        low.push(mean - std);
        high.push(mean + std);
    }
    (curve.low, curve.high) = (Some(low), Some(high));
    curve
}
