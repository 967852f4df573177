//! The plots of a run.

use super::contents::Report;
use super::measured::measured_rad;
use crate::cyclic::AngleTable;
use crate::cyclic::anatomy::{ANATOMICAL_ANGLES, COUNT, CyclePointStatistics, PAIRS};
use crate::cyclic::angle_table::COLUMNS;
use crate::cyclic::tracking::summary::cadence_per_min;
use crate::cyclic::tracking::{Tracked, Updates};
use crate::draw::plot::{Curve, bars_plot, curves_plot};
use crate::error::Result;
use image::RgbImage;
use rayon::prelude::*;

/// Half width of a normal's 90 % band, standard deviations.
const HALF_90: f64 = 1.644_853_626_951;
/// Angles of the stick figure that share a plot.
const GROUPS: [(&str, &[usize]); 5] = [
    ("trunk and links", &[0, 1, 4, 7, 10]),
    ("left arm", &[2, 3]),
    ("right arm", &[5, 6]),
    ("left leg", &[8, 9]),
    ("right leg", &[11, 12]),
];

/// A plot that is to be drawn: its file, title, names of both axes, and curves.
struct Planned {
    file: String,
    title: String,
    axes: [&'static str; 2],
    curves: Vec<Curve>,
}

/// Every plot with its file name. Those that need cycles or measured angles that are not there are
/// left out.
///
/// # Errors
/// A plot that cannot be drawn.
pub fn plots(
    report: &Report,
    table: &AngleTable,
    tracked: &Tracked,
    updates: &Updates,
) -> Result<Vec<(String, RgbImage)>> {
    let has_points = |plot: &Planned| {
        plot.curves.iter().flat_map(|curve| &curve.points).any(|(x, y)| x.is_finite() && y.is_finite())
    };
    let draw =
        |Planned { file, title, axes: [x, y], curves }: Planned| Ok((file, curves_plot(&title, x, y, false, &curves)?));
    let over_time = planned_over_time(table, tracked, updates);
    let planned = over_time.into_iter().chain(planned_over_a_cycle(report)).filter(has_points);
    let mut all: Vec<_> = planned.collect::<Vec<_>>().into_par_iter().map(draw).collect::<Result<_>>()?;
    if let Some(bars) = ranges(report) {
        let title = "Range of motion, mean over the cycles";
        all.push(("range_of_motion.png".into(), bars_plot(title, "degrees", &bars)?));
    }
    Ok(all)
}

fn planned_over_time(table: &AngleTable, tracked: &Tracked, updates: &Updates) -> Vec<Planned> {
    let trajectories = GROUPS.into_iter().map(|(name, angles)| Planned {
        file: format!("trajectories_{}.png", name.replace(' ', "_")),
        title: format!("Angles of the stick figure, {name}: estimate, 90 % band and what was measured (dots)"),
        axes: ["time, seconds", "angle, degrees"],
        curves: angles.iter().map(|&angle| trajectory(table, tracked, updates, angle)).collect(),
    });
    let position = Planned {
        file: "cycle_position.png".into(),
        title: "Position in the cycle".into(),
        axes: ["time, seconds", "cycles"],
        curves: vec![cycle_position(tracked)],
    };
    let cadence = Planned {
        file: "cadence.png".into(),
        title: "Cadence and its 90 % band".into(),
        axes: ["time, seconds", "cycles a minute"],
        curves: vec![cadence(tracked)],
    };
    trajectories.chain([position, cadence]).collect()
}

fn planned_over_a_cycle(report: &Report) -> Vec<Planned> {
    let cycles = report.cycles.len();
    let mean = |name: &str, curves| Planned {
        file: format!("curves_{name}.png"),
        title: format!("{}: mean of {cycles} cycles and spread", name.replace('_', " ")),
        axes: ["cycle, percent", "angle, degrees"],
        curves,
    };
    let named =
        |(side, angle): (&str, usize)| Curve { name: side.to_owned(), ..cycle_curve(&report.curves.curves[angle]) };
    let portrait = Planned {
        file: "phase_portrait.png".into(),
        title: "Phase portrait".into(),
        axes: ["angle, degrees", "velocity, degrees a second"],
        curves: phase_portrait(report),
    };
    let pairs =
        PAIRS.into_iter().map(|(name, left, right)| mean(name, [("left", left), ("right", right)].map(named).into()));
    let lean = mean("trunk_lean", vec![cycle_curve(&report.curves.curves[0])]);
    std::iter::once(portrait).chain(pairs).chain([lean]).collect()
}

fn seconds(tracked: &Tracked, frame: u64) -> f64 {
    frame as f64 / tracked.rate_hz
}

/// A line with a band of `half` to each side of (x, middle, half).
fn banded(name: &str, points: impl Iterator<Item = (f64, f64, f64)>) -> Curve {
    let (mut line, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
    for (x, middle, half) in points {
        line.push((x, middle));
        low.push(middle - half);
        high.push(middle + half);
    }
    Curve { name: name.to_owned(), points: line, low: Some(low), high: Some(high), marks: Vec::new() }
}

/// The estimate with its band; what the filter saw stands beside it as dots, in the turn that is
/// nearest.
fn trajectory(table: &AngleTable, tracked: &Tracked, updates: &Updates, angle: usize) -> Curve {
    let name = COLUMNS[angle + 1].trim_end_matches("_rad");
    let points = tracked.frames.iter().map(|frame| {
        let std = f64::from(frame.estimate.angle_variance_rad2[angle]).max(0.0).sqrt();
        (seconds(tracked, frame.frame), frame.angles_rad[angle].to_degrees(), HALF_90 * std.to_degrees())
    });
    let marks = table.rows().iter().enumerate().filter_map(|(index, row)| {
        let measured = measured_rad(table, tracked, updates, index, angle)?;
        Some((seconds(tracked, row.frame), measured.to_degrees()))
    });
    let marks = marks.collect();
    Curve { marks, ..banded(name, points) }
}

/// Position in [0, 1) with a break where a cycle ends.
fn cycle_position(tracked: &Tracked) -> Curve {
    let mut curve = Curve { name: "cycle position".into(), ..Curve::default() };
    let mut before = 0.0;
    for frame in &tracked.frames {
        let (x, position) = (seconds(tracked, frame.frame), f64::from(frame.estimate.cycle_position));
        if (position - before).abs() > 0.5 {
            curve.points.push((x, f64::NAN));
        }
        curve.points.push((x, position));
        before = position;
    }
    curve
}

fn cadence(tracked: &Tracked) -> Curve {
    let points = tracked.frames.iter().enumerate().map(|(index, frame)| {
        let (mean, std) = cadence_per_min(tracked, index);
        (seconds(tracked, frame.frame), mean, HALF_90 * std)
    });
    banded("cadence", points)
}

/// Angle against its velocity (central difference), for both sides of the joint that moves most.
fn phase_portrait(report: &Report) -> Vec<Curve> {
    let extent = |angle: usize| {
        let values = || report.series.angles_deg.iter().filter_map(|pose| pose[angle]);
        values().reduce(f64::max).zip(values().reduce(f64::min)).map_or(0.0, |(high, low)| high - low)
    };
    let moves = |pair: &(&str, usize, usize)| extent(pair.1).max(extent(pair.2));
    let Some((_, left, right)) = PAIRS.into_iter().max_by(|a, b| moves(a).total_cmp(&moves(b))) else {
        return Vec::new();
    };
    [left, right].map(|angle| portrait(report, angle)).into_iter().filter(|curve| !curve.points.is_empty()).collect()
}

fn portrait(report: &Report, angle: usize) -> Curve {
    let series = &report.series;
    let mut points = Vec::new();
    for (frames, poses) in series.frames.windows(3).zip(series.angles_deg.windows(3)) {
        let [Some(before), Some(here), Some(after)] = [poses[0][angle], poses[1][angle], poses[2][angle]] else {
            continue;
        };
        let gap = frames[2] - frames[0] > 2;
        let velocity = if gap { f64::NAN } else { (after - before) * series.rate_hz / 2.0 };
        points.push((here, velocity));
    }
    Curve { name: ANATOMICAL_ANGLES[angle].replace('_', " "), points, ..Curve::default() }
}

/// Mean and one standard deviation to each side; no band where only one cycle has the angle.
fn cycle_curve(points: &[CyclePointStatistics]) -> Curve {
    let whole = points
        .iter()
        .enumerate()
        .map(|(percent, point)| (percent as f64, point.mean_deg.unwrap_or(f64::NAN), point.std_deg.unwrap_or(0.0)));
    banded("mean", whole)
}

/// Mean range of each anatomical angle; `None` without a cycle.
fn ranges(report: &Report) -> Option<Vec<(String, f64)>> {
    let mean = |angle: usize| {
        let extents: Vec<f64> =
            report.repetitions.iter().filter_map(|one| one.ranges[angle].map(|range| range.extent_deg())).collect();
        (!extents.is_empty()).then(|| extents.iter().sum::<f64>() / extents.len() as f64)
    };
    let bars: Vec<(String, f64)> = (0..COUNT)
        .filter_map(|angle| {
            Some((ANATOMICAL_ANGLES[angle].trim_end_matches("_flexion").replace('_', " "), mean(angle)?))
        })
        .collect();
    (!bars.is_empty()).then_some(bars)
}
