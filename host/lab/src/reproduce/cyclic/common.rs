//! What the sections of the cyclic page share.

use crate::cyclic::Cell;
use crate::cyclic::experiments::Setting;
use crate::reproduce::plot::Series;

/// The paper's cycles: 816 frames of 8 and 4 cycles (section 3.1).
const PAPER_FRAMES_A_CYCLE: f64 = 816.0 / 12.0;

/// What the numbers are of.
pub fn walkers(setting: &Setting<'_>) -> String {
    let frames: usize = setting.cycles.iter().map(|cycle| cycle.truth.rows().len()).sum();
    format!(
        "{} cycles, {frames} frames of walkers who were not trained on; ten training cycles. Mean absolute error over \
         13 angles, degrees. {} seeds where noise or samples are drawn.",
        setting.cycles.len(),
        setting.seeds
    )
}

/// Why the numbers are not the paper's: the cycles are as long, the angles move less.
pub fn other_motion(setting: &Setting<'_>) -> String {
    let cycles = setting.cycles;
    let frames: usize = cycles.iter().map(|cycle| cycle.truth.rows().len()).sum();
    format!(
        "The paper's swimmers are not public, and these people walk. A cycle is as long, {:.0} frames here and {:.0} \
         there. But a part turns to and fro through {:.0} degrees on the mean, and a swimmer's arm through 360.",
        frames as f64 / cycles.len() as f64,
        PAPER_FRAMES_A_CYCLE,
        mean_swing_deg(setting)
    )
}

/// Mean over cycles and angles of the way from the lowest to the highest value, degrees.
fn mean_swing_deg(setting: &Setting<'_>) -> f64 {
    let mut swings = Vec::new();
    for cycle in setting.cycles {
        let angles = cycle.truth.rows().first().map_or(0, |row| row.angles_rad.len());
        for angle in 0..angles {
            let values = || cycle.truth.rows().iter().filter_map(|row| row.angles_rad[angle]);
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            swings.push((high - low).to_degrees());
        }
    }
    swings.iter().sum::<f64>() / swings.len().max(1) as f64
}

/// Curves over the number of frames a measurement, one a filter or number of samples.
pub fn by_skip<'a>(cells: impl Iterator<Item = &'a Cell>) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    for cell in cells {
        let Some(skip) = cell.updates.strip_prefix("every ").and_then(|text| text.parse::<f64>().ok()) else {
            continue;
        };
        let name = cell.particles.map_or_else(|| cell.filter.name().to_owned(), |count| format!("{count} samples"));
        let point =
            (skip, cell.error_deg, if cell.particles.is_some() { cell.seed_std_deg } else { cell.cycle_std_deg });
        match all.iter_mut().find(|series| series.name == name) {
            Some(series) => series.points.push(point),
            None => all.push(Series { name, points: vec![point] }),
        }
    }
    all
}
