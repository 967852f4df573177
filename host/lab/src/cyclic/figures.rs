//! What the paper's figures 3 to 5 show, as plots.

use super::Protocol;
use super::experiments::{Cell, FILTERS, SKIPS, Setting};
use super::protocol::measurements;
use super::report::CyclicReport;
use anyhow::Result;
use image::RgbImage;
use sinew::cyclic::angle_table::COLUMNS;
use sinew::cyclic::tracking::{FilterName, StartName, TrackingOptions, track};
use sinew::draw::plot::{Curve, bars_plot, curves_plot};

/// Angles of the left foot and the left hand: those that end at ankle and wrist.
const SHOWN: [(&str, &str); 2] = [("left foot", "l_ankle_rad"), ("left hand", "l_wrist_rad")];
/// Measurement noise of figure 3, degrees.
const FIGURE_3_SIGMA_DEG: f64 = 6.0;

/// Figures with their file names.
///
/// # Errors
/// A run that fails, or nothing to plot.
pub fn figures(setting: &Setting<'_>, report: &CyclicReport) -> Result<Vec<(String, RgbImage)>> {
    let mut all = Vec::new();
    for (name, column) in SHOWN {
        let angle = COLUMNS[1..].iter().position(|other| *other == column).unwrap_or_default();
        let title = format!("Figure 3: {name}, sigma 6 degrees, two cycles");
        let curves = trajectories(setting, angle, Protocol::Noisy)?;
        all.push((
            format!("figure_3_{}.png", name.replace(' ', "_")),
            curves_plot(&title, "frame", "angle, degrees", false, &curves)?,
        ));
    }
    for filter in FILTERS {
        let cell = report.noise.iter().find(|cell| {
            cell.filter == filter && cell.protocol == Protocol::ExactMean && (cell.sigma_deg - 115.0).abs() < 0.5
        });
        let Some(cell) = cell else { continue };
        let names = COLUMNS[1..].iter().map(|name| name.trim_end_matches("_rad").to_owned());
        let bars: Vec<(String, f64)> = names.zip(cell.each_deg).collect();
        let title = format!("Figure 4a: error of each angle, {}, exact-mean, sigma 115 degrees", filter.name());
        all.push((format!("figure_4a_{}.png", filter.name()), bars_plot(&title, "error, degrees", &bars)?));
    }
    let sparse = by_skip(&report.sparse);
    all.push((
        "figure_4b.png".into(),
        curves_plot(
            "Figure 4b: fewer measurements, sigma 29 degrees",
            "frames a measurement",
            "error, degrees",
            false,
            &sparse,
        )?,
    ));
    if !report.sparse_particles.is_empty() {
        let title = "Figure 5a: fewer measurements, particles, sigma 29 degrees";
        let curves = by_skip(&report.sparse_particles);
        all.push((
            "figure_5a.png".into(),
            curves_plot(title, "frames a measurement", "error, degrees", false, &curves)?,
        ));
    }
    if !report.starts.is_empty() {
        let title = "Figure 5b: three ways to start, from the fifth frame on, sigma 29 degrees";
        let curves = by_start(&report.starts);
        all.push(("figure_5b.png".into(), curves_plot(title, "particles", "error, degrees", true, &curves)?));
    }
    Ok(all)
}

/// True and estimated angle of the first two cycles, one after the other, with the 90 % band.
///
/// # Errors
/// A run that fails.
pub fn trajectories(setting: &Setting<'_>, angle: usize, protocol: Protocol) -> Result<Vec<Curve>> {
    let mut truth = Curve { name: "truth".into(), ..Curve::default() };
    let mut curves: Vec<Curve> = Vec::new();
    for (place, filter) in [FilterName::Paper, FilterName::Coupled].into_iter().enumerate() {
        let mut curve =
            Curve { name: filter.name().into(), low: Some(Vec::new()), high: Some(Vec::new()), ..Curve::default() };
        let mut start = 0.0;
        for cycle in setting.cycles.iter().take(2) {
            let options = TrackingOptions {
                filter,
                sigma_rad: FIGURE_3_SIGMA_DEG.to_radians(),
                initial_cycle_position: Some(0.0),
                rate_hz: Some(setting.rate_hz),
                ..TrackingOptions::default()
            };
            let measured = measurements(&cycle.truth, protocol, options.sigma_rad, 1);
            let tracked = track(&measured, setting.model, &options)?;
            for (frame, row) in tracked.frames.iter().zip(cycle.truth.rows()) {
                let x = start + (frame.frame - cycle.truth.first_frame()) as f64;
                let half = 1.645 * f64::from(frame.estimate.angle_variance_rad2[angle]).max(0.0).sqrt();
                let middle = frame.angles_rad[angle];
                curve.points.push((x, middle.to_degrees()));
                curve.low.as_mut().into_iter().for_each(|low| low.push((middle - half).to_degrees()));
                curve.high.as_mut().into_iter().for_each(|high| high.push((middle + half).to_degrees()));
                if place == 0 {
                    truth.points.push((x, row.angles_rad[angle].map_or(f64::NAN, f64::to_degrees)));
                }
            }
            start += (cycle.truth.end_frame() - cycle.truth.first_frame()) as f64;
        }
        curves.push(curve);
    }
    curves.push(truth);
    Ok(curves)
}

fn by_skip(cells: &[Cell]) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for cell in cells {
        let Some(skip) = cell.updates.strip_prefix("every ").and_then(|text| text.parse::<f64>().ok()) else {
            continue;
        };
        let count = cell.particles.map_or_else(String::new, |count| format!(", {count}"));
        add(&mut curves, format!("{}{count}, {}", cell.filter.name(), cell.protocol.name()), (skip, cell.error_deg));
    }
    debug_assert!(curves.iter().all(|curve| curve.points.len() == SKIPS.len()));
    curves
}

fn by_start(cells: &[Cell]) -> Vec<Curve> {
    let mut curves = Vec::new();
    for cell in cells {
        let name = match cell.start {
            StartName::Standard => "standard",
            StartName::Uniform => "uniform",
            StartName::Random => "random",
        };
        add(&mut curves, name.to_owned(), (cell.particles.unwrap_or(0) as f64, cell.late_error_deg));
    }
    curves
}

fn add(curves: &mut Vec<Curve>, name: String, point: (f64, f64)) {
    match curves.iter_mut().find(|curve| curve.name == name) {
        Some(curve) => curve.points.push(point),
        None => curves.push(Curve { name, points: vec![point], ..Curve::default() }),
    }
}
