//! What cannot be right about a tracked recording, in words.

use super::anatomy::{ANATOMICAL_ANGLES, AnatomicalSeries, COUNT};
use super::gait::{Direction, Gait, NoGait};
use super::model::CyclicModel;
use super::model_file;
use super::model_range::share_of_model;
use super::tracking::Summary;
use super::tracking::summary::MIN_CYCLES;

/// Cadences that people have of one motion, over the model's mean. They reach from a stroll of the
/// elderly to a sprint, 40 to 220 strides a minute where the models have 50 to 90.
const CADENCE_RANGE: [f64; 2] = [0.4, 2.5];

/// Share of the cycles that the cadence gives in the time that was seen, below which the count is
/// doubted. Chosen: who stands still for less than half of a recording is not doubted.
const LEAST_COUNTED_SHARE: f64 = 0.5;

/// Largest range of an angle in degrees. No hinge of a person goes farther, and in a side view no
/// ball joint except about the shoulder.
const MAX_RANGE_DEG: f64 = 170.0;

/// Angles whose range has a limit: all but the shoulders.
const LIMITED: [&str; 4] = ["trunk_lean", "elbow_flexion", "hip_flexion", "knee_flexion"];

/// Largest mean of the trunk's lean in a walk or a run, degrees. Chosen: who bends far forward has
/// 45, and a picture that is turned has 90.
const MAX_LEAN_DEG: f64 = 60.0;

/// Models of people who are upright.
const UPRIGHT: [&str; 2] = ["walking", "running"];

/// Doubts about a run, one sentence each, with the remedy.
#[must_use]
pub fn doubts(summary: &Summary, series: &AnatomicalSeries, model: &CyclicModel, gait: Option<&Gait>) -> Vec<String> {
    let mean_per_min = 60.0 * f64::from(model.numbers().rate_hz) / f64::from(model.numbers().mean_duration_frames);
    let [low, high] = CADENCE_RANGE.map(|share| share * mean_per_min);
    let direction = gait.map(|gait| gait.direction);
    // Who walks backward has no cycles of a walk forward, whatever the rate.
    let is_backward = direction == Some(Direction::Backward) && is_upright(model);
    let range = small_range(series, model).unwrap_or_default();
    let mut doubts: Vec<String> = few_cycles(summary, low, &range).filter(|_| !is_backward).into_iter().collect();
    if let Some(cadence) = summary.cadence_per_min.filter(|cadence| *cadence > 0.0 && !(low..=high).contains(cadence)) {
        doubts.push(format!(
            "{cadence:.1} cycles a minute: this motion has {low:.0} to {high:.0}; is the rate right (--input-rate)?{range}"
        ));
    }
    if model.numbers().turns_per_cycle.iter().all(|turns| *turns == 0) {
        doubts.extend(wide_ranges(series));
    }
    if is_upright(model) {
        doubts.extend(lying_trunk(series));
    }
    doubts.extend(direction.and_then(|direction| other_direction(direction, model)));
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

/// What a doubt about cycles adds where joints move less far than in the model's mean cycle.
fn small_range(series: &AnatomicalSeries, model: &CyclicModel) -> Option<String> {
    let percent = (100.0 * share_of_model(series, model)?).round();
    (percent < 100.0).then(|| {
        format!(
            "; the joints move {percent:.0} % as far as the model's: for a much smaller range train your own by `sinew train cyclic`"
        )
    })
}

/// What a user should know of the feet, one sentence each; why there is no gait only if one of the
/// models is that of a walk or a run.
#[must_use]
pub fn notes(models: &[CyclicModel], gait: &Result<Gait, NoGait>) -> Vec<String> {
    let is_gait = || models.iter().any(is_upright);
    let note = match gait {
        Ok(gait) => gait.note(),
        Err(reason) => is_gait().then(|| reason.to_string()),
    };
    note.into_iter().collect()
}

/// The doubt about feet that go another way than the model's, or none that shows.
fn other_direction(direction: Direction, model: &CyclicModel) -> Option<String> {
    match direction {
        Direction::Backward if is_upright(model) => Some(
            "the feet go backward, and those of the model forward: strikes, toe-offs and strides are those of a walk backward, cycles and cadence are of no use; does the person face the other way (--facing of `sinew angles`)?"
                .to_owned(),
        ),
        Direction::Unknown => Some(
            "the feet do not show whether they go forward or backward: strikes and toe-offs are those of a walk forward; look at an overlay"
                .to_owned(),
        ),
        _ => None,
    }
}

/// The doubt about a recording of which no row, or `rows` of less than a cycle, show the motion of
/// any of the models `names`.
#[must_use]
pub fn no_motion(names: &str, rows: usize) -> String {
    let shown = match rows {
        0 => "no frame shows".to_owned(),
        _ => format!("only {rows} frames, less than a cycle, show"),
    };
    format!(
        "{shown} one of the motions {names}: it is another motion, or less than a cycle of it; give --model of that motion, your own by `sinew train cyclic`"
    )
}

fn backwards(cycles: f64) -> String {
    format!(
        "the motion runs backwards ({cycles:.1} cycles): the person walks backward or faces the other way, or the camera moves with them; see --facing of `sinew angles`"
    )
}

/// The doubt about a finished recording, whose cycles are taken forwards, in which the filter
/// counted `cycles` backwards.
#[must_use]
pub fn counted_backwards(cycles: f64) -> Option<String> {
    (cycles <= -MIN_CYCLES).then(|| backwards(cycles))
}

/// Less than two cycles, less than half of those of the cadence, or cycles backwards.
/// `low_per_min` is the slowest cadence of the motion, `range` what is to be said of a small range.
///
/// Rows that do not fit the model are no doubt: real walks have up to 92 % of them.
fn few_cycles(summary: &Summary, low_per_min: f64, range: &str) -> Option<String> {
    let Summary { cycles, seen_s, .. } = *summary;
    if cycles < 0.0 {
        return Some(backwards(cycles));
    }
    let least = low_per_min * seen_s / 60.0;
    let by_cadence = summary.cadence_per_min.unwrap_or(0.0) * seen_s / 60.0;
    if cycles >= MIN_CYCLES && cycles < LEAST_COUNTED_SHARE * by_cadence {
        return Some(format!(
            "{cycles:.1} cycles were counted in {seen_s:.0} s, in which the cadence gives {by_cadence:.0}: the person stood still for most of the time, or the motion was lost; look at `cycle_position` in the table"
        ));
    }
    (cycles < MIN_CYCLES).then(|| {
        // 1.99 are no 2.0.
        let cycles = (10.0 * cycles).floor() / 10.0;
        if least < MIN_CYCLES {
            format!(
                "{cycles:.1} cycles were seen: with less than {MIN_CYCLES} there is no cadence; record longer"
            )
        } else {
            format!(
                "{cycles:.1} cycles were seen in {seen_s:.0} s, in which this motion has {least:.0} or more: is it this motion (`--model`), and is the rate right (--input-rate)?{range}"
            )
        }
    })
}

/// The trunk lies: the picture is turned.
fn lying_trunk(series: &AnatomicalSeries) -> Option<String> {
    let lean = ANATOMICAL_ANGLES.iter().position(|name| *name == "trunk_lean")?;
    // A series goes on over whole turns, which do not change how the trunk lies.
    let within_turn = |deg: f64| (deg + 180.0).rem_euclid(360.0) - 180.0;
    let leans_deg: Vec<f64> = series.angles_deg.iter().filter_map(|pose| pose[lean]).map(within_turn).collect();
    let mean_deg = leans_deg.iter().sum::<f64>() / leans_deg.len() as f64;
    (mean_deg.abs() > MAX_LEAN_DEG).then(|| {
        format!(
            "trunk lean is {mean_deg:.0} degrees in the mean, and who walks or runs is upright: the picture is turned; turn the video, or choose the motion's `--model`"
        )
    })
}

/// Whether a model is a shipped one of people who are upright.
fn is_upright(model: &CyclicModel) -> bool {
    UPRIGHT.iter().any(|name| is_shipped(model, name))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(cycles: f64, seen_s: f64) -> Summary {
        Summary {
            frames: 100,
            skipped_frames: 0,
            duration_s: seen_s,
            seen_s,
            cycles,
            cadence_per_min: None,
            cadence_std_per_min: None,
            last_cadence_per_min: 0.0,
            last_cadence_std_per_min: 0.0,
            outliers: 0,
            misfits: 0,
            log_likelihood: 0.0,
            cycle_starts_s: Vec::new(),
            whole_cycles_s: Vec::new(),
        }
    }

    /// A trunk at these angles, degrees; the last row does not see it.
    fn leaning(leans_deg: &[f64]) -> AnatomicalSeries {
        let pose = |lean: Option<f64>| std::array::from_fn(|angle| lean.filter(|_| angle == 0));
        let leans = leans_deg.iter().map(|lean| Some(*lean)).chain([None]);
        let angles_deg: Vec<_> = leans.map(pose).collect();
        AnatomicalSeries { frames: (0..angles_deg.len() as u64).collect(), angles_deg, rate_hz: 30.0 }
    }

    fn of(summary: &Summary, leans_deg: &[f64], model: &str) -> Vec<String> {
        doubts(summary, &leaning(leans_deg), model_file::shipped(model).unwrap(), None)
    }

    #[test]
    fn a_trunk_that_lies_is_doubted_in_walks_and_runs_only() {
        let seen = summary(5.0, 6.0);
        for model in ["walking", "running"] {
            assert_eq!(of(&seen, &[45.0, 62.0], model), [""; 0]);
            assert_eq!(of(&seen, &[350.0, 365.0], model), [""; 0], "a turn too many");
            let turned = of(&seen, &[-85.0, -91.0], model);
            assert!(turned.len() == 1 && turned[0].starts_with("trunk lean is -88 degrees"), "{turned:?}");
        }
        assert_eq!(of(&seen, &[-85.0, -91.0], "arm-circles"), [""; 0], "swimmers lie");
        assert_eq!(of(&seen, &[], "walking"), [""; 0], "a trunk that is not seen");
    }

    #[test]
    fn few_cycles_of_joints_that_move_less_far_name_the_range() {
        let knee = |range_deg: f64| {
            let pose = |row: u32| {
                std::array::from_fn(|angle| Some(f64::from(u8::from(angle == 4 && row.is_multiple_of(2))) * range_deg))
            };
            let angles_deg = (0..100).map(pose).collect();
            let series = AnatomicalSeries { frames: (0..100).collect(), angles_deg, rate_hz: 30.0 };
            doubts(&summary(0.6, 30.0), &series, model_file::shipped("walking").unwrap(), None).remove(0)
        };
        assert!(knee(40.0).contains("is the rate right (--input-rate)?; the joints move "), "{}", knee(40.0));
        assert!(knee(160.0).ends_with("(--input-rate)?"), "{}", knee(160.0));
    }

    #[test]
    fn few_cycles_of_a_long_recording_are_of_another_motion() {
        let only = |summary: &Summary| of(summary, &[0.0], "walking").join("; ");
        assert!(only(&summary(0.6, 30.0)).starts_with("0.6 cycles were seen in 30 s, in which this motion has 10 or"));
        assert!(only(&summary(0.6, 3.0)).ends_with("record longer"));
        assert!(only(&summary(-3.0, 30.0)).starts_with("the motion runs backwards (-3.0 cycles)"));
        assert_eq!(only(&summary(20.0, 30.0)), "");
        assert!(counted_backwards(-16.0).is_some() && counted_backwards(-0.4).is_none());
        let lost = Summary { cadence_per_min: Some(50.0), ..summary(8.0, 30.0) };
        assert!(only(&lost).starts_with("8.0 cycles were counted in 30 s, in which the cadence gives 25"));
    }
}
