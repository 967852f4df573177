//! What becomes of an arm on which the camera finds no points for a while.

use super::trial::{SeenMotion, trial};
use anyhow::Result;
use serde::{Deserialize, Serialize};
use serde_json::json;
use sinew::body::tracking::filter::WholeBodyEstimate;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::resume::Cells;
use sinew::stereo::{Hidden, Limb};
use sinew_core::skeleton::full_body::{FOREARMS, UPPER_ARMS};
use std::fmt::Write;

/// Frames that a tracker gets to settle before the first arm's level is taken.
const SETTLING: usize = 5;
/// Frames before an arm is hidden that its level is the mean of.
pub const BEFORE: usize = 10;
/// Frames after its return in which it has to be back.
pub const AFTER: usize = 10;
/// An arm is back where its error is below this many times its level before.
pub const BACK_TIMES: f64 = 2.0;

/// An arm that was hidden in one run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HiddenArm {
    /// The motion's name.
    pub motion: String,
    /// The model.
    pub model: BodyModelKind,
    /// Number of particles.
    pub particles: usize,
    /// Seed of camera and tracker.
    pub seed: u64,
    /// The arm, and its first and last frame without points.
    pub hidden: Hidden,
    /// What was measured.
    #[serde(flatten)]
    pub course: Course,
}

/// Errors are means over elbow and wrist; spread and flag are those of the wrist's bone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// Mean error of the ten frames before, metres.
    pub error_before_m: f64,
    /// Mean error while hidden, metres.
    pub error_hidden_m: f64,
    /// Mean spread of the ten frames before, metres.
    pub spread_before_m: f64,
    /// Spread in the last hidden frame, metres.
    pub spread_hidden_m: f64,
    /// Hidden frames in which the forearm is said to be observed.
    pub frames_said_observed: usize,
    /// How many frames after its return (1 is the first with points) its error is below twice the
    /// level before. Absent where none of the first ten is.
    pub back_after_frames: Option<usize>,
}

impl Course {
    /// Whether the spread grew, the arm was said to be unobserved in all hidden frames, and it came
    /// back.
    #[must_use]
    pub fn is_as_wanted(&self) -> bool {
        self.spread_grows() && self.frames_said_observed == 0 && self.back_after_frames.is_some()
    }

    fn spread_grows(&self) -> bool {
        self.spread_hidden_m > self.spread_before_m
    }
}

/// Left and right arm in turns, hidden for `length` frames as often as a motion of `frames` frames
/// lets them be. Seeds differ in which arm begins.
#[must_use]
pub fn windows(frames: usize, length: usize, seed: u64) -> Vec<Hidden> {
    let first = 1 + SETTLING + BEFORE;
    let starts = (first..).step_by(BEFORE + length + AFTER).take_while(|start| start + length + AFTER <= frames);
    let limb = |turn: u64| if (turn + seed).is_multiple_of(2) { Limb::LArm } else { Limb::RArm };
    (0..).zip(starts).map(|(turn, start)| Hidden { limb: limb(turn), frames: start..=start + length - 1 }).collect()
}

/// Tracks `seen`, the `motion` in which arms are hidden as `windows` says, and follows each of
/// these arms; all of them are a cell.
///
/// # Errors
/// Names a parameter of the tracker that broke a rule; as [`Cells::cell`].
pub fn follow(
    motion: &str,
    (seen, windows): (&SeenMotion, &[Hidden]),
    (model, particles): (BodyModelKind, usize),
    (tuning, cells): (&BodyTuning, &Cells<'_>),
    seed: u64,
) -> Result<Vec<HiddenArm>> {
    let key = json!(["hidden arms", motion, seen.key(), model.name(), particles, seed]);
    let courses: Vec<Option<Course>> = cells.cell(&key, || -> Result<_> {
        let (_, estimates) = trial(seen, model, tuning, particles, seed)?;
        Ok(windows.iter().map(|hidden| course(seen, &estimates, hidden)).collect())
    })?;
    let arm = |(hidden, course): (&Hidden, Option<Course>)| {
        Some(HiddenArm { motion: motion.to_owned(), model, particles, seed, hidden: hidden.clone(), course: course? })
    };
    Ok(windows.iter().zip(courses).filter_map(arm).collect())
}

/// The course of one hidden arm in a track whose first estimate is that of the frame 1; `None`
/// where the truth misses the arm or the track ends before its return.
#[must_use]
pub fn course(seen: &SeenMotion, estimates: &[WholeBodyEstimate], hidden: &Hidden) -> Option<Course> {
    let arm: Vec<usize> = [UPPER_ARMS, FOREARMS].concat().into_iter().filter(|&bone| hidden.limb.has(bone)).collect();
    let wrist = *arm.last()?;
    let (first, last) = (*hidden.frames.start(), *hidden.frames.end());
    let estimate = |frame: usize| estimates.get(frame.checked_sub(1)?);
    let error_m = |frame: usize| {
        let mut sum = 0.0;
        for &bone in &arm {
            sum += f64::from((estimate(frame)?.ends_m[bone] - seen.joints_m.get(frame)?[bone]?).norm());
        }
        Some(sum / arm.len() as f64)
    };
    let before = first.checked_sub(BEFORE)?..first;
    let error_before_m = mean(before.clone().map(error_m))?;
    let back = |after: &usize| error_m(last + after).is_some_and(|error_m| error_m < BACK_TIMES * error_before_m);
    estimate(last + AFTER)?;
    let said = |frame: &usize| estimate(*frame).is_some_and(|estimate| estimate.observed[wrist]);
    Some(Course {
        error_before_m,
        error_hidden_m: mean(hidden.frames.clone().map(error_m))?,
        spread_before_m: mean(before.map(|frame| Some(f64::from(estimate(frame)?.spread_m[wrist]))))?,
        spread_hidden_m: f64::from(estimate(last)?.spread_m[wrist]),
        frames_said_observed: hidden.frames.clone().filter(said).count(),
        back_after_frames: (1..=AFTER).find(back),
    })
}

fn mean(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Shares of the arms that one model with one count was asked to find again.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HiddenArmSummary {
    /// The model.
    pub model: BodyModelKind,
    /// Number of particles.
    pub particles: usize,
    /// Hidden arms.
    pub arms: usize,
    /// Share whose spread grew.
    pub spread_grew: f64,
    /// Share said to be unobserved in all hidden frames.
    pub said_unobserved: f64,
    /// Share below twice its level before within ten frames.
    pub came_back: f64,
    /// Share with all three.
    pub as_wanted: f64,
}

/// Shares by model and count, in the order in which they first come.
#[must_use]
pub fn summaries(arms: &[HiddenArm]) -> Vec<HiddenArmSummary> {
    let mut cells: Vec<(BodyModelKind, usize)> = Vec::new();
    for arm in arms {
        if !cells.contains(&(arm.model, arm.particles)) {
            cells.push((arm.model, arm.particles));
        }
    }
    let summary = |(model, particles)| {
        let of_it: Vec<&Course> =
            arms.iter().filter(|arm| (arm.model, arm.particles) == (model, particles)).map(|arm| &arm.course).collect();
        let share = |holds: fn(&Course) -> bool| {
            of_it.iter().filter(|course| holds(course)).count() as f64 / of_it.len().max(1) as f64
        };
        HiddenArmSummary {
            model,
            particles,
            arms: of_it.len(),
            spread_grew: share(Course::spread_grows),
            said_unobserved: share(|course| course.frames_said_observed == 0),
            came_back: share(|course| course.back_after_frames.is_some()),
            as_wanted: share(Course::is_as_wanted),
        }
    };
    cells.into_iter().map(summary).collect()
}

/// A line a model and count.
#[must_use]
pub fn to_text(summaries: &[HiddenArmSummary]) -> String {
    let mut text = String::new();
    for cell in summaries {
        let percent = |share: f64| 100.0 * share;
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "hidden arms, {} with {}: {} arms; spread grew {:.0} %, said unobserved {:.0} %, back within {AFTER} frames {:.0} %, all three {:.0} %",
            cell.model.name(),
            cell.particles,
            cell.arms,
            percent(cell.spread_grew),
            percent(cell.said_unobserved),
            percent(cell.came_back),
            percent(cell.as_wanted)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn windows_leave_room_before_and_after(frames in 0_usize..400, length in 1_usize..60, seed in 0_u64..9) {
            let windows = windows(frames, length, seed);
            let mut free = 1 + SETTLING;
            for window in &windows {
                prop_assert!(*window.frames.start() >= free + BEFORE);
                prop_assert_eq!(window.frames.clone().count(), length);
                free = window.frames.end() + 1 + AFTER;
                prop_assert!(free <= frames);
            }
            // One more would not fit.
            prop_assert!(free + BEFORE + length + AFTER > frames);
            prop_assert!(windows.windows(2).all(|pair| pair[0].limb != pair[1].limb));
        }
    }

    #[test]
    fn an_arm_that_stays_away_has_not_come_back() {
        let course = Course {
            error_before_m: 0.02,
            error_hidden_m: 0.2,
            spread_before_m: 0.03,
            spread_hidden_m: 0.1,
            frames_said_observed: 0,
            back_after_frames: Some(4),
        };
        assert!(course.is_as_wanted());
        let away = Course { back_after_frames: None, ..course };
        let believed = Course { frames_said_observed: 1, ..course };
        let sure = Course { spread_hidden_m: 0.02, ..course };
        assert!([away, believed, sure].iter().all(|course| !course.is_as_wanted()));
        let hidden: Hidden = "l_arm:5-9".parse().unwrap();
        let arm = |course| HiddenArm {
            motion: "m".into(),
            model: BodyModelKind::EndEffector,
            particles: 100,
            seed: 1,
            hidden: hidden.clone(),
            course,
        };
        let found = summaries(&[course, away, believed, sure].map(arm));
        assert_eq!(found.len(), 1);
        let HiddenArmSummary { spread_grew, said_unobserved, came_back, as_wanted, .. } = found[0];
        assert_eq!([spread_grew, said_unobserved, came_back, as_wanted], [0.75, 0.75, 0.75, 0.25]);
    }
}
