//! Foot strikes and toe-offs.

use super::direction::Direction;
use super::extrema::{Way, maxima, slope, slope_reaches};
use super::foot_paths::FootPaths;
use crate::signal::median::median;
use serde::Serialize;
use std::fmt::Write as _;

/// Share of a path's range by which it has to turn back for an event. Chosen: a limp halves a step;
/// what noise leaves after the filter is a tenth.
const MIN_RANGE_SHARE: f64 = 0.3;
/// The least of that, in lengths of the leg: the feet of a person who stands do less. Chosen: a
/// shuffling step is a quarter of the leg.
const MIN_LEG_SHARE: f64 = 0.1;
/// Speed back under the hips from which a foot counts as on the ground, as a share of the median of
/// its speed back. Source: 0.5 m/s over the ground (Bruening and Ridge 2014, after Ghoussayni et
/// al. 2004), so 0.83 m/s under hips that go 1.33 m/s; the median is 1.17 m/s there.
const GROUND_SPEED_SHARE: f64 = 0.7;
/// How long after it is farthest ahead a foot may reach that speed, seconds. Chosen: twice the
/// 0.07 s of a walker.
const MAX_DELAY_S: f64 = 0.15;

/// The point whose path gave events.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PointUsed {
    /// The heel.
    Heel,
    /// The tip of the foot.
    Toe,
    /// The ankle, where heel or toe are not seen. Its toe-offs are 15 to 44 ms before those of the
    /// toe on walks (`base.trc`, CMU 02 and 35). In running they are 35 to 62 ms after them.
    Ankle,
}

/// Events of one foot, as numbers of frames that may lie between two.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FootEvents {
    /// Foot strikes, rising.
    pub strikes: Vec<f64>,
    /// Toe-offs, rising.
    pub toe_offs: Vec<f64>,
    /// Point that gave the strikes.
    pub strikes_from: PointUsed,
    /// Point that gave the toe-offs.
    pub toe_offs_from: PointUsed,
}

/// Events of both feet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GaitEvents {
    /// The person's left foot.
    pub left: FootEvents,
    /// The person's right foot.
    pub right: FootEvents,
}

impl FootEvents {
    /// Events of a foot whose leg is `leg` long; frames from the start of the paths, which are
    /// counted in the direction of the walk.
    ///
    /// Backward the foot strikes with the toe and leaves the ground with the heel, as in a walk
    /// forward that runs backwards in time. Source: D. A. Winter, N. Pluck, J. F. Yang, Journal of
    /// Motor Behavior 21, 1989.
    pub(super) fn find(paths: &FootPaths, leg: f64, rate_hz: f64, direction: Direction) -> Self {
        let heel = paths.heel.as_ref().map_or((&paths.ankle, PointUsed::Ankle), |heel| (heel, PointUsed::Heel));
        let toe = paths.toe.as_ref().map_or((&paths.ankle, PointUsed::Ankle), |toe| (toe, PointUsed::Toe));
        let is_backward = direction == Direction::Backward;
        let [(ahead, strikes_from), (behind, toe_offs_from)] = if is_backward { [toe, heel] } else { [heel, toe] };
        // An ankle is slow also while the foot still, or already, rolls over the toe.
        let strikes_are_exact = !is_backward || strikes_from != PointUsed::Ankle;
        let toe_offs_are_exact = is_backward || toe_offs_from != PointUsed::Ankle;
        let limit = MAX_DELAY_S * rate_hz;
        let refined = |moments: Vec<f64>, path: &[Option<f64>], way: Way, is_exact: bool| -> Vec<f64> {
            let level = ground_slope(path);
            let reached = |moment: f64| slope_reaches(path, moment, level, way, limit).unwrap_or(moment);
            if is_exact { moments.into_iter().map(reached).collect() } else { moments }
        };
        let strikes = maxima(ahead, min_prominence(ahead, leg));
        let backwards: Vec<Option<f64>> = behind.iter().map(|value| value.map(|value| -value)).collect();
        let toe_offs = maxima(&backwards, min_prominence(behind, leg));
        Self {
            strikes: refined(strikes, ahead, Way::Later, strikes_are_exact),
            toe_offs: refined(toe_offs, behind, Way::Earlier, toe_offs_are_exact),
            strikes_from,
            toe_offs_from,
        }
    }

    fn shift(&mut self, frames: f64) {
        self.strikes.iter_mut().chain(&mut self.toe_offs).for_each(|moment| *moment += frames);
    }
}

impl GaitEvents {
    /// Counts frames from `first_frame` instead of 0.
    pub(super) fn shift(&mut self, first_frame: u64) {
        [&mut self.left, &mut self.right].into_iter().for_each(|foot| foot.shift(first_frame as f64));
    }

    /// As CSV in the order of time: `frame,time_s,foot,event,from`.
    #[must_use]
    pub fn to_csv(&self, rate_hz: f64) -> String {
        let mut rows: Vec<(f64, &str, &str, PointUsed)> = Vec::new();
        for (name, foot) in [("left", &self.left), ("right", &self.right)] {
            rows.extend(foot.strikes.iter().map(|frame| (*frame, name, "foot_strike", foot.strikes_from)));
            rows.extend(foot.toe_offs.iter().map(|frame| (*frame, name, "toe_off", foot.toe_offs_from)));
        }
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut text = "frame,time_s,foot,event,from\n".to_owned();
        for (frame, foot, event, from) in rows {
            let from = format!("{from:?}").to_lowercase();
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{frame:.2},{:.4},{foot},{event},{from}", frame / rate_hz);
        }
        text
    }
}

fn min_prominence(path: &[Option<f64>], leg: f64) -> f64 {
    let (low, high) =
        path.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    (MIN_RANGE_SHARE * (high - low)).max(MIN_LEG_SHARE * leg)
}

/// The slope below which a foot is on the ground: it goes back there most of the time that it goes
/// back.
fn ground_slope(path: &[Option<f64>]) -> f64 {
    let mut back: Vec<f64> =
        (0..path.len()).filter_map(|sample| slope(path, sample)).filter(|slope| *slope < 0.0).collect();
    GROUND_SPEED_SHARE * median(&mut back).unwrap_or(0.0)
}
