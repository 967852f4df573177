//! Angles that were not seen, from the person's own cycle.

use super::phase::Phased;
use crate::cyclic::turns::{least_angle, nearest_turn};
use crate::signal::gaps::beside;

/// How fast a deviation from the own cycle is forgotten where it was last seen on one side only. It
/// falls by e in so many cycles. Chosen: what differs from cycle to cycle lasts about a quarter of
/// one in the shipped models.
const FADE_CYCLES: f64 = 0.25;

/// Adds whole turns to what was measured after each gap. The angle then winds in the gap as often
/// as the own cycle does: its difference from that changes by at most half a turn.
pub fn wind_in_gaps<const N: usize>(phased: &Phased<N>, angle: usize, measured: &mut [Option<f64>]) {
    let mut turns_rad = 0.0;
    let mut last: Option<(usize, f64)> = None;
    for (frame, value) in measured.iter_mut().enumerate() {
        let Some(measured_rad) = *value else { continue };
        let own_rad = phased.expected[frame].0[angle];
        if let Some((_, off_rad)) = last.filter(|(at, _)| at + 1 < frame) {
            turns_rad = nearest_turn(measured_rad, own_rad + off_rad) - measured_rad;
        }
        *value = Some(measured_rad + turns_rad);
        last = Some((frame, measured_rad + turns_rad - own_rad));
    }
}

/// The angle `angle` in every frame: `measured` where it is there, else the own cycle and what the
/// frames beside the gap differ from it, on a straight line between them. What was measured winds
/// in the gaps as [`wind_in_gaps`] has it.
#[must_use]
pub fn filled<const N: usize>(phased: &Phased<N>, angle: usize, measured: &[Option<f64>]) -> Vec<f64> {
    let own: Vec<f64> = phased.expected.iter().map(|(pose, _)| pose[angle]).collect();
    let off: Vec<Option<f64>> = (0..own.len()).map(|frame| Some(measured[frame]? - own[frame])).collect();
    let beside = beside(&off);
    let fade = |frame: usize, (at, off): (usize, f64)| {
        let turns = off - least_angle(off);
        turns + least_angle(off) * (-(phased.phases[frame] - phased.phases[at]).abs() / FADE_CYCLES).exp()
    };
    let angle_rad = |frame: usize| {
        let off_rad = match beside[frame].into() {
            (Some((a, a_off)), Some((b, b_off))) if b > a => {
                a_off + (b_off - a_off) * (frame - a) as f64 / (b - a) as f64
            }
            (Some((_, off)), Some(_)) => off,
            (Some(side), None) | (None, Some(side)) => fade(frame, side),
            (None, None) => 0.0,
        };
        own[frame] + off_rad
    };
    (0..own.len()).map(angle_rad).collect()
}
