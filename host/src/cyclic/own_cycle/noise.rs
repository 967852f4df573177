//! The noise of measured angles, from the recording itself.

use super::seen::Seen;
use crate::cyclic::AngleTable;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::tracking::{TrackingOptions, Updates};
use crate::signal::median::STD_PER_MEDIAN;
use sinew_core::skeleton::stick_figure::HUMAN;

/// Least noise, radians: half a degree, what annotators of keypoints differ by at a limb of 100
/// pixels. A recording without noise still differs from every model.
pub const MIN_NOISE_RAD: f64 = 0.0087;

/// Standard deviation of a measured angle, radians: the median over the long segments, between
/// neighbouring frames. `None` where too few successive frames were seen.
#[must_use]
pub fn of_table(table: &AngleTable, updates: &Updates) -> Option<f64> {
    let seen = Seen::<ANGLES>::of_table(table, updates)?;
    let is_long = |name: &str| name != "l_shoulder" && name != "r_shoulder" && name != "l_hip" && name != "r_hip";
    let long = HUMAN.angle_names().enumerate().filter(|(_, name)| is_long(name));
    let mut stds_rad: Vec<f64> = long.filter_map(|(angle, _)| of_angle(&seen, angle, 1)).collect();
    stds_rad.sort_by(f64::total_cmp);
    stds_rad.get(stds_rad.len() / 2).map(|std_rad| std_rad.max(MIN_NOISE_RAD))
}

/// The options with the noise of `table` in place of their own, where the table shows it.
#[must_use]
pub fn with_noise_of(table: &AngleTable, options: TrackingOptions) -> TrackingOptions {
    let sigma_rad = of_table(table, &options.updates).unwrap_or(options.sigma_rad);
    TrackingOptions { sigma_rad, ..options }
}

/// Frames in a thirtieth of a second. Fourth differences of a limb's motion are below half a degree
/// at that distance. In a table that was interpolated from fewer frames, neighbours differ by less
/// than the noise.
#[must_use]
pub fn thirtieth_frames(rate_hz: f64) -> usize {
    ((rate_hz / 30.0).round() as usize).max(1)
}

/// Standard deviation of measured angles, radians, by the median of fourth differences between
/// frames that are `stride` apart. `None` where too few were seen at such distances.
#[must_use]
pub fn of_angle<const N: usize>(seen: &Seen<N>, angle: usize, stride: usize) -> Option<f64> {
    /// Standard deviation of the fourth difference of independent numbers: the root of
    /// 1 + 16 + 36 + 16 + 1.
    const DIFFERENCE_STD: f64 = 8.366_600_265_340_756;
    /// Fourth differences that have to be there: their median is then within a third of the truth
    /// in nineteen of twenty cases.
    const MIN_DIFFERENCES: usize = 20;
    let series = seen.series(angle);
    let difference = |frames: &[Option<f64>]| {
        let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|index| frames[index * stride]);
        Some((a? - 4.0 * b? + 6.0 * c? - 4.0 * d? + e?).abs())
    };
    let mut sizes: Vec<f64> = series.windows(4 * stride + 1).filter_map(difference).collect();
    if sizes.len() < MIN_DIFFERENCES {
        return None;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    Some(STD_PER_MEDIAN * *median / DIFFERENCE_STD)
}
