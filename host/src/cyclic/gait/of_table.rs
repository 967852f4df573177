//! Gait from an angle table.

use super::direction::Direction;
use super::events::{FootEvents, GaitEvents};
use super::extrema::is_whole;
use super::foot_paths::{FootPaths, hips_path, turn};
use super::means::FootMeans;
use super::no_gait::NoGait;
use super::scale::{LegLengths, Scale};
use super::strides::{self, Foot, FootData, Stride, Units};
use crate::cyclic::angle_table::AngleTable;
use crate::cyclic::even_rows::EvenRows;
use crate::cyclic::place_columns::PlaceColumns;
use serde::Serialize;

/// When in a foot's stride the other foot may strike, as a share of it. Chosen: 0.5 is even, a bad
/// limp has 0.4; a jump or a squat has 0 and 1.
const ALTERNATION: [f64; 2] = [0.2, 0.8];

/// Share of its stride beyond which a foot that is seen alone walks. Source: the duty factor of
/// running is below it (R. M. Alexander, "Principles of Animal Locomotion", 2003).
const MAX_RUNNING_STANCE: f64 = 0.5;

/// Events, strides and their means.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gait {
    /// Foot strikes and toe-offs.
    pub events: GaitEvents,
    /// Where the person goes, from where they face.
    pub direction: Direction,
    /// Whether there is a flight phase and no double support.
    pub is_running: bool,
    /// The foot whose leg is in no stride of the other one: nothing compares both.
    pub unseen: Option<Foot>,
    /// Strides of both feet in the order of time.
    pub strides: Vec<Stride>,
    /// Means over the left foot's strides.
    pub left: FootMeans,
    /// Means over the right foot's strides.
    pub right: FootMeans,
}

impl Gait {
    /// The strides as CSV, one row each.
    #[must_use]
    pub fn strides_to_csv(&self, rate_hz: f64) -> String {
        strides::to_csv(&self.strides, rate_hz)
    }

    /// What is missing because of a leg that is not seen, in a sentence.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        let name = self.unseen?.name();
        Some(format!(
            "the {name} leg is not seen in any stride: there is no step time, step length, double support or flight time; film the {name} side, too"
        ))
    }
}

/// The gait in `table`, whose angles are those of a person who faces right, at `rate_hz` frames a
/// second. Step lengths and speeds need a scale: metres in the table, or the body's height.
///
/// # Errors
/// There is no stride, the feet do not take turns, or one foot is seen alone and does not step.
pub fn of_table(table: &AngleTable, rate_hz: f64, scale: Scale) -> Result<Gait, NoGait> {
    let even = EvenRows::new(table).ok_or(NoGait::TooFewFrames)?;
    let columns = PlaceColumns::find(table);
    let legs = LegLengths::find(&even, columns.as_ref());
    let metres = scale.metres_per_unit(&legs, columns.as_ref().map(|columns| columns.unit));
    let path = |side: usize| FootPaths::find(&even, columns.as_ref(), (side, &legs[side]), rate_hz).ok();
    let (Some(left), Some(right)) = (path(0), path(1)) else { return Err(NoGait::TooFewFrames) };
    let mut paths = [left, right];
    let mut hips = hips_path(&even, columns.as_ref(), &legs, rate_hz);
    let direction = Direction::find(&paths);
    if direction == Direction::Backward {
        paths = paths.map(FootPaths::turned);
        hips.iter_mut().for_each(|hips| turn(hips));
    }
    let events = [0, 1].map(|side| FootEvents::find(&paths[side], legs[side].sum(), rate_hz, direction));
    let [left, right] = [0, 1].map(|side| FootData { events: &events[side], paths: &paths[side] });
    let units = Units { rate_hz, metres, hips: hips.as_deref() };
    let mut left_strides = strides::strides(Foot::Left, left, right, units);
    let mut right_strides = strides::strides(Foot::Right, right, left, units);
    let unseen = unseen([&left_strides, &right_strides], &paths, (rate_hz, direction))?;
    let first = even.first_frame as f64;
    for stride in left_strides.iter_mut().chain(&mut right_strides) {
        [&mut stride.strike, &mut stride.toe_off, &mut stride.next_strike]
            .into_iter()
            .for_each(|frame| *frame += first);
    }
    let [left, right] = [&left_strides, &right_strides].map(|strides| FootMeans::of(strides));
    let mut strides = [left_strides, right_strides].concat();
    strides.sort_by(|a, b| a.strike.total_cmp(&b.strike));
    let [left_events, right_events] = events;
    let mut events = GaitEvents { left: left_events, right: right_events };
    events.shift(even.first_frame);
    let runs = |stride: &&Stride| match unseen {
        Some(_) => stride.stance_share < MAX_RUNNING_STANCE,
        None => stride.flight_time_s.is_some(),
    };
    let is_running = 2 * strides.iter().filter(runs).count() > strides.len();
    Ok(Gait { events, direction, is_running, unseen, strides, left, right })
}

/// The foot that is in no stride of the other one, if there is one.
///
/// # Errors
/// There is no stride, the feet do not take turns in more than half of the strides in which both
/// are seen, or one is seen alone and goes in no direction.
fn unseen(
    strides: [&[Stride]; 2],
    paths: &[FootPaths; 2],
    (rate_hz, direction): (f64, Direction),
) -> Result<Option<Foot>, NoGait> {
    let [left_path, right_path] = paths.each_ref().map(|paths| paths.ankle.as_slice());
    let of_left = strides[0].iter().filter_map(|stride| alternates(stride, [left_path, right_path], rate_hz));
    let of_right = strides[1].iter().filter_map(|stride| alternates(stride, [right_path, left_path], rate_hz));
    let turns: Vec<bool> = of_left.chain(of_right).collect();
    if !turns.is_empty() {
        let takes_turns = 2 * turns.iter().filter(|takes_turn| **takes_turn).count() > turns.len();
        return if takes_turns { Ok(None) } else { Err(NoGait::NoTurns) };
    }
    let [left, right] = [left_path, right_path].map(|path| path.iter().flatten().count());
    let unseen = if left < right { Foot::Left } else { Foot::Right };
    let is_stepping = direction != Direction::Unknown;
    match strides.iter().any(|strides| !strides.is_empty()) {
        true if is_stepping => Ok(Some(unseen)),
        _ if left.max(right) == 0 => Err(NoGait::NoLeg),
        false if left.min(right) > 0 || is_stepping => Err(NoGait::NoStride),
        _ => Err(NoGait::Unseen(unseen)),
    }
}

/// Whether the other foot strikes well inside a stride, and the ankles travel against each other in
/// it. `None` where the other foot's strike is not found and its ankle is not seen all along.
fn alternates(stride: &Stride, [own, other]: [&[Option<f64>]; 2], rate_hz: f64) -> Option<bool> {
    let Stride { strike, next_strike, .. } = *stride;
    let Some(step_time_s) = stride.step_time_s else {
        return is_whole(other, strike, next_strike).then_some(false);
    };
    let share = 1.0 - step_time_s * rate_hz / (next_strike - strike);
    let frames = strike.ceil() as usize..=next_strike.floor() as usize;
    let places: Vec<[f64; 2]> = frames.filter_map(|frame| Some([(*own.get(frame)?)?, (*other.get(frame)?)?])).collect();
    Some((ALTERNATION[0]..=ALTERNATION[1]).contains(&share) && covariance(&places) < 0.0)
}

/// Sum of the products of two series' distances from their means.
fn covariance(pairs: &[[f64; 2]]) -> f64 {
    let mean = [0, 1].map(|side| pairs.iter().map(|pair| pair[side]).sum::<f64>() / pairs.len() as f64);
    pairs.iter().map(|pair| (pair[0] - mean[0]) * (pair[1] - mean[1])).sum()
}
