//! Strides: from a foot's strike to its next one, with the other foot's events in between.

use super::events::FootEvents;
use super::extrema::{is_whole, slope, value_at};
use super::foot_paths::FootPaths;
use crate::cyclic::stops::longest_without_stop;
use crate::signal::median::median;
use serde::Serialize;
use std::fmt::Write as _;

/// Shares of the stance in which a foot lies flat. Source: foot flat from 8 % and heel off at 30 %
/// of the stride (Perry, "Gait Analysis", 1992), with 60 % of stance.
const FLAT_SHARES: [f64; 2] = [0.2, 0.5];

/// Way of the hips in the picture over their way by the feet, between which the camera stands
/// still. Chosen: by the feet a walk is 10 % short. A camera that pans, a treadmill and a view that
/// turns with the person have about 0.
const HIPS_AGREE: [f64; 2] = [0.7, 1.6];

/// A foot: the person's own side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Foot {
    /// Left.
    Left,
    /// Right.
    Right,
}

impl Foot {
    /// The name in tables and sentences.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// One stride of one foot. Shares are of its time, in [0, 1]; frames may lie between two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Stride {
    /// The foot.
    pub foot: Foot,
    /// Its strike, frame.
    pub strike: f64,
    /// Its toe-off, frame.
    pub toe_off: f64,
    /// Its next strike, frame.
    pub next_strike: f64,
    /// From strike to strike, seconds.
    pub stride_time_s: f64,
    /// From the other foot's strike to this foot's next one, seconds.
    pub step_time_s: Option<f64>,
    /// Share with the foot on the ground: the duty factor of running.
    pub stance_share: f64,
    /// Share with the foot in the air.
    pub swing_share: f64,
    /// Share with both feet on the ground, before and after the other one's swing; 0 in running.
    pub double_support_share: Option<f64>,
    /// From this foot's toe-off to the other one's strike, seconds; `None` where both are on the
    /// ground in between, as in walking.
    pub flight_time_s: Option<f64>,
    /// From where the other foot struck to where this one strikes next, metres.
    pub step_length_m: Option<f64>,
    /// Both steps of the stride, metres.
    pub stride_length_m: Option<f64>,
    /// Speed, metres a second.
    pub speed_m_per_s: Option<f64>,
}

/// A foot's events and paths, frames from the start of the paths.
#[derive(Debug, Clone, Copy)]
pub(super) struct FootData<'a> {
    pub events: &'a FootEvents,
    pub paths: &'a FootPaths,
}

/// What times and lengths need beside the feet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units<'a> {
    /// Frames a second.
    pub rate_hz: f64,
    /// Metres of one unit of the paths, if known.
    pub metres: Option<f64>,
    /// How far the hips are along the way, in the unit of the paths.
    pub hips: Option<&'a [Option<f64>]>,
}

/// The strides of `foot` beside `other` in which no value is missing and the person does not stop.
pub(super) fn strides(foot: Foot, own: FootData<'_>, other: FootData<'_>, units: Units<'_>) -> Vec<Stride> {
    let pairs = own.events.strikes.windows(2);
    let all: Vec<Stride> = pairs.filter_map(|pair| stride(foot, [pair[0], pair[1]], own, other, units)).collect();
    let longest_s = longest_without_stop(&all.iter().map(|stride| stride.stride_time_s).collect::<Vec<f64>>());
    all.into_iter().filter(|stride| stride.stride_time_s <= longest_s).collect()
}

fn stride(
    foot: Foot,
    [strike, next_strike]: [f64; 2],
    own: FootData<'_>,
    other: FootData<'_>,
    units: Units<'_>,
) -> Option<Stride> {
    let frames = next_strike - strike;
    let toe_off = the_one_between(&own.events.toe_offs, strike, next_strike)?;
    if !is_whole(&own.paths.ankle, strike, next_strike) {
        return None;
    }
    let other_strike = the_one_between(&other.events.strikes, strike, next_strike);
    let other_toe_off = the_one_between(&other.events.toe_offs, strike - 0.5 * frames, strike + 0.5 * frames);
    let double_support = other_strike.zip(other_toe_off).map(|(other_strike, other_toe_off)| {
        ((other_toe_off - strike).max(0.0) + (toe_off - other_strike).max(0.0)) / frames
    });
    let speed = ground_speed(path_for_steps(own.paths, other.paths), [strike, toe_off]);
    let step = |from: [&FootPaths; 2], strikes: [f64; 2]| {
        Some(step_length(from, strikes, speed?, units.hips)? * units.metres?)
    };
    let other_step = other_strike.and_then(|between| step([own.paths, other.paths], [strike, between]));
    let own_step = other_strike.and_then(|between| step([other.paths, own.paths], [between, next_strike]));
    let stride_length_m = own_step.zip(other_step).map(|(own, other)| own + other);
    let stride_time_s = frames / units.rate_hz;
    Some(Stride {
        foot,
        strike,
        toe_off,
        next_strike,
        stride_time_s,
        step_time_s: other_strike.map(|other_strike| (next_strike - other_strike) / units.rate_hz),
        stance_share: (toe_off - strike) / frames,
        swing_share: (next_strike - toe_off) / frames,
        double_support_share: double_support,
        flight_time_s: other_strike.map(|strike| (strike - toe_off) / units.rate_hz).filter(|flight_s| *flight_s > 0.0),
        step_length_m: own_step,
        stride_length_m,
        speed_m_per_s: stride_length_m.map(|length_m| length_m / stride_time_s),
    })
}

/// The moment between two others, if there is exactly one.
fn the_one_between(moments: &[f64], from: f64, to: f64) -> Option<f64> {
    let mut inside = moments.iter().copied().filter(|moment| (from..to).contains(moment));
    inside.next().filter(|_| inside.next().is_none())
}

/// From where the first foot struck to where the second one strikes next; `speed` is that of the
/// hips over the ground, a frame.
fn step_length(
    [first, second]: [&FootPaths; 2],
    [strike, next]: [f64; 2],
    speed: f64,
    hips: Option<&[Option<f64>]>,
) -> Option<f64> {
    let ahead = value_at(path_for_steps(second, first), next)? - value_at(path_for_steps(first, second), strike)?;
    let by_feet = speed * (next - strike);
    let by_hips = hips.and_then(|hips| Some(value_at(hips, next)? - value_at(hips, strike)?));
    let agrees = |way: &f64| (HIPS_AGREE[0] * by_feet..=HIPS_AGREE[1] * by_feet).contains(way);
    Some(ahead + by_hips.filter(agrees).unwrap_or(by_feet))
}

/// The path that gives steps: the heel's where both feet have one, else the ankle's.
fn path_for_steps<'a>(own: &'a FootPaths, other: &FootPaths) -> &'a [Option<f64>] {
    own.heel.as_ref().filter(|_| other.heel.is_some()).unwrap_or(&own.ankle)
}

/// Speed of the hips over the ground, a frame: that of a foot back under them while it lies flat.
/// It is the same over ground, on a treadmill and before a camera that pans. The hips are slowest
/// then: a walk at 1.25 m/s has 1.11.
fn ground_speed(path: &[Option<f64>], [strike, toe_off]: [f64; 2]) -> Option<f64> {
    let [from, to] = FLAT_SHARES.map(|share| (strike + share * (toe_off - strike)).round() as usize);
    let mut speeds: Vec<f64> = (from..=to).filter_map(|sample| Some(-slope(path, sample)?)).collect();
    median(&mut speeds)
}

/// The strides as CSV, frames counted from `first_frame`.
#[must_use]
pub(super) fn to_csv(strides: &[Stride], rate_hz: f64) -> String {
    let mut text = "foot,strike_frame,toe_off_frame,next_strike_frame,strike_s,stride_time_s,step_time_s,stance_share,\
                    swing_share,double_support_share,flight_time_s,step_length_m,stride_length_m,speed_m_per_s\n"
        .to_owned();
    for stride in strides {
        let foot = stride.foot.name();
        let Stride { strike, toe_off, next_strike, .. } = stride;
        let cells = [
            Some(strike / rate_hz),
            Some(stride.stride_time_s),
            stride.step_time_s,
            Some(stride.stance_share),
            Some(stride.swing_share),
            stride.double_support_share,
            stride.flight_time_s,
            stride.step_length_m,
            stride.stride_length_m,
            stride.speed_m_per_s,
        ];
        let cells = cells.map(|cell| cell.map_or_else(String::new, |value| format!("{value:.4}"))).join(",");
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{foot},{strike:.2},{toe_off:.2},{next_strike:.2},{cells}");
    }
    text
}
