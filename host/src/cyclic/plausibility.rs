//! What cannot be right about a tracked recording, in words.

use super::anatomy::{ANATOMICAL_ANGLES, AnatomicalSeries, COUNT};
use super::gait::Gait;
use super::model::CyclicModel;
use super::model_file;
use super::tracking::Summary;
use super::tracking::summary::MIN_CYCLES;

/// Cadences that people have of one motion, over the model's mean. They reach from a stroll of the
/// elderly to a sprint, 40 to 220 strides a minute where the models have 50 to 90.
const CADENCE_RANGE: [f64; 2] = [0.4, 2.5];

/// Largest range of an angle in degrees. No hinge of a person goes farther, and in a side view no
/// ball joint except about the shoulder.
const MAX_RANGE_DEG: f64 = 170.0;

/// Angles whose range has a limit: all but the shoulders.
const LIMITED: [&str; 4] = ["trunk_lean", "elbow_flexion", "hip_flexion", "knee_flexion"];

/// Doubts about a run, one sentence each, with the remedy.
#[must_use]
pub fn doubts(summary: &Summary, series: &AnatomicalSeries, model: &CyclicModel, gait: Option<&Gait>) -> Vec<String> {
    let mut doubts = Vec::new();
    if summary.cycles < 0.0 {
        doubts.push(format!(
            "the motion runs backwards ({:.1} cycles): the person faces the other way, or the camera moves with them; see --facing of `sinew angles`",
            summary.cycles
        ));
    } else if summary.cycles < MIN_CYCLES {
        doubts.push(format!(
            "{:.1} cycles were seen: with less than {MIN_CYCLES} there is no cadence; record longer",
            summary.cycles
        ));
    }
    let mean_per_min = 60.0 * f64::from(model.numbers().rate_hz) / f64::from(model.numbers().mean_duration_frames);
    let [low, high] = CADENCE_RANGE.map(|share| share * mean_per_min);
    if let Some(cadence) = summary.cadence_per_min.filter(|cadence| *cadence > 0.0 && !(low..=high).contains(cadence)) {
        doubts.push(format!(
            "{cadence:.1} cycles a minute: this motion has {low:.0} to {high:.0}; is the rate right (--input-rate)?"
        ));
    }
    if model.numbers().turns_per_cycle.iter().all(|turns| *turns == 0) {
        doubts.extend(wide_ranges(series));
    }
    match gait.map(|gait| gait.is_running) {
        Some(true) if is_shipped(model, "walking") => {
            doubts.push("the feet run, and the model walks: use --model running".to_owned());
        }
        Some(false) if is_shipped(model, "running") => {
            doubts.push("the feet walk, and the model runs: use --model walking".to_owned());
        }
        _ => {}
    }
    doubts
}

/// Whether a model is the one that ships under this name.
fn is_shipped(model: &CyclicModel, name: &str) -> bool {
    model_file::shipped(name).is_some_and(|shipped| shipped.numbers() == model.numbers())
}

fn wide_ranges(series: &AnatomicalSeries) -> Vec<String> {
    let range = |angle: usize| {
        let values = || series.angles_deg.iter().filter_map(|pose| pose[angle]);
        Some(values().reduce(f64::max)? - values().reduce(f64::min)?)
    };
    let is_limited = |name: &str| LIMITED.iter().any(|limited| name.ends_with(limited));
    let wide = (0..COUNT).filter(|angle| is_limited(ANATOMICAL_ANGLES[*angle])).filter_map(|angle| {
        let range = range(angle).filter(|range| *range > MAX_RANGE_DEG)?;
        let name = ANATOMICAL_ANGLES[angle].replace('_', " ");
        Some(format!("{name} ranges over {range:.0} degrees, more than a body can: wrong keypoints, or the wrong ones"))
    });
    wide.collect()
}
