//! The course of one angle over a finished recording.

use super::fill::filled;
use super::noise;
use super::phase::Phased;
use super::seen::Seen;
use crate::error::Result;
use crate::signal::{FilterOptions, filtered, hampel};

/// What makes a row an outlier is at least so far off, radians: three degrees are seen in no angle
/// that people read, though Hampel's identifier rejects less where nothing else is noisy.
const MIN_OUTLIER_RAD: f64 = 0.052;
/// The same in standard deviations of the noise: of 13 angles one is beyond 4.5 by chance in one row
/// of ten thousand.
const OUTLIER_STDS: f64 = 4.5;

/// One angle in every frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// What was measured, filtered; where nothing was, from the person's own cycle. Radians.
    pub angles_rad: Vec<f64>,
    /// Standard deviations: that of the measurements, or in a gap that of the person's cycles.
    pub std_rad: Vec<f64>,
    /// Whether the measurement was left out and far from what was taken in its place.
    pub is_outlier: Vec<bool>,
}

impl Course {
    /// The course of `angle`; frames that are not `is_known` get the person's own cycle.
    ///
    /// # Errors
    /// None: the filter is the usual one, at a rate that it can have.
    pub fn new<const N: usize>(
        seen: &Seen<N>,
        angle: usize,
        phased: &Phased<N>,
        is_known: &[bool],
        rate_hz: f64,
    ) -> Result<Self> {
        let mut measured = seen.series(angle);
        let rejected = hampel::reject(&mut measured);
        // Gaps stay: what is beside them is smooth already where the own cycle joins it.
        let smooth = filtered(&measured, rate_hz, &options(rate_hz))?;
        let bridged = filled(phased, angle, &smooth);
        let whole: Vec<Option<f64>> = (0..measured.len())
            .map(|frame| is_known[frame].then(|| measured[frame].unwrap_or(bridged[frame])))
            .collect();
        let smooth = filtered(&whole, rate_hz, &options(rate_hz))?;
        let noise_rad = noise::of_angle(seen, angle).unwrap_or(phased.std_rad[angle]);
        let through_rad = noise_rad * noise_share(rate_hz).sqrt();
        let kept = kept_share(&whole, &smooth, &measured, through_rad);
        let angles_rad = (0..measured.len())
            .map(|frame| match (whole[frame], smooth[frame]) {
                (Some(whole), Some(smooth)) => smooth + kept * (whole - smooth),
                _ => bridged[frame],
            })
            .collect();
        let raw = seen.series(angle);
        let is_outlier = (0..raw.len()).map(|frame| {
            let off = raw[frame].zip(smooth[frame]).map_or(0.0, |(raw, smooth)| (raw - smooth).abs());
            rejected[frame] && off > MIN_OUTLIER_RAD.max(OUTLIER_STDS * noise_rad)
        });
        let is_outlier = is_outlier.collect();
        let std_rad = measured.iter().map(|value| if value.is_some() { noise_rad } else { phased.std_rad[angle] });
        Ok(Self { angles_rad, std_rad: std_rad.collect(), is_outlier })
    }
}

/// The usual filter, whose cut-off a slow camera lowers, without what was done before it.
fn options(rate_hz: f64) -> FilterOptions {
    FilterOptions { hampel: false, gap_limit_s: 0.0, ..FilterOptions::default().lowered_for(rate_hz).0 }
}

/// Share of white noise that the filter takes away: all above its cut-off.
fn noise_share(rate_hz: f64) -> f64 {
    1.0 - options(rate_hz).filter.cutoff_hz().map_or(0.0, |cutoff_hz| 2.0 * cutoff_hz / rate_hz)
}

/// Share of what the filter took away that was no noise, and is kept: what is left of its mean
/// square without that of the noise. A recording without noise is not smoothed.
fn kept_share(whole: &[Option<f64>], smooth: &[Option<f64>], measured: &[Option<f64>], noise_rad: f64) -> f64 {
    let away = (0..whole.len()).filter_map(|frame| measured[frame].and(Some(whole[frame]? - smooth[frame]?)));
    let (count, squares) = away.fold((0.0, 0.0), |(count, squares), off| (count + 1.0, squares + off * off));
    if squares > 0.0 { (1.0 - noise_rad * noise_rad * count / squares).max(0.0) } else { 0.0 }
}
