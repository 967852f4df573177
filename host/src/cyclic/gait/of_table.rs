//! Gait from an angle table.

use super::events::{FootEvents, GaitEvents};
use super::extrema::is_whole;
use super::foot_paths::{FootPaths, hips_path};
use super::means::FootMeans;
use super::scale::{LegLengths, Scale};
use super::strides::{self, Foot, FootData, Stride, Units};
use crate::cyclic::angle_table::AngleTable;
use crate::cyclic::even_rows::EvenRows;
use crate::cyclic::place_columns::PlaceColumns;
use serde::Serialize;

/// When in a foot's stride the other foot may strike, as a share of it. Chosen: 0.5 is even, a bad
/// limp has 0.4; a jump or a squat has 0 and 1.
const ALTERNATION: [f64; 2] = [0.2, 0.8];

/// Events, strides and their means.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gait {
    /// Foot strikes and toe-offs.
    pub events: GaitEvents,
    /// Whether there is a flight phase and no double support.
    pub is_running: bool,
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
}

/// The gait in `table`, whose angles are those of a person who faces right, at `rate_hz` frames a
/// second. Step lengths and speeds need a scale: metres in the table, or the body's height.
///
/// `None` where there is no stride, or the feet do not take turns.
#[must_use]
pub fn of_table(table: &AngleTable, rate_hz: f64, scale: Scale) -> Option<Gait> {
    let even = EvenRows::new(table)?;
    let columns = PlaceColumns::find(table);
    let legs = LegLengths::find(&even, columns.as_ref());
    let metres = scale.metres_per_unit(&legs, columns.as_ref().map(|columns| columns.unit));
    let path = |side: usize| FootPaths::find(&even, columns.as_ref(), (side, &legs[side]), rate_hz).ok();
    let paths = [path(0)?, path(1)?];
    let events = [0, 1].map(|side| FootEvents::find(&paths[side], legs[side].sum(), rate_hz));
    let [left, right] = [0, 1].map(|side| FootData { events: &events[side], paths: &paths[side] });
    let hips = hips_path(&even, columns.as_ref(), &legs, rate_hz);
    let units = Units { rate_hz, metres, hips: hips.as_deref() };
    let mut left_strides = strides::strides(Foot::Left, left, right, units);
    let mut right_strides = strides::strides(Foot::Right, right, left, units);
    if !takes_turns([&left_strides, &right_strides], &paths, rate_hz) {
        return None;
    }
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
    let flights = strides.iter().filter(|stride| stride.flight_time_s.is_some()).count();
    Some(Gait { events, is_running: 2 * flights > strides.len(), strides, left, right })
}

/// Whether the feet take turns in more than half of the strides in which both are seen.
fn takes_turns([left, right]: [&[Stride]; 2], paths: &[FootPaths; 2], rate_hz: f64) -> bool {
    let [left_path, right_path] = paths.each_ref().map(|paths| paths.ankle.as_slice());
    let of_left = left.iter().filter_map(|stride| alternates(stride, [left_path, right_path], rate_hz));
    let of_right = right.iter().filter_map(|stride| alternates(stride, [right_path, left_path], rate_hz));
    let turns: Vec<bool> = of_left.chain(of_right).collect();
    2 * turns.iter().filter(|takes_turn| **takes_turn).count() > turns.len()
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
