//! The course of one angle over a finished recording.

use super::fill::filled;
use super::noise;
use super::phase::Phased;
use super::seen::Seen;
use crate::error::Result;
use crate::signal::{FilterKind, FilterOptions, filtered, hampel};

/// What makes a row an outlier is at least so far off, radians. Three degrees are seen in no angle
/// that people read, though Hampel's identifier rejects less where nothing else is noisy.
const MIN_OUTLIER_RAD: f64 = 0.052;
/// The same in standard deviations of the noise: of 13 angles one is beyond 4.5 by chance in one
/// row of ten thousand.
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
    /// None: the filter fits any rate.
    pub fn new<const N: usize>(
        seen: &Seen<N>,
        angle: usize,
        phased: &Phased<N>,
        is_known: &[bool],
        rate_hz: f64,
    ) -> Result<Self> {
        let raw = seen.series(angle);
        let mut measured = raw.clone();
        let rejected = hampel::reject(&mut measured);
        // Gaps stay: what is beside them is smooth already where the own cycle joins it.
        let smooth = filtered(&measured, rate_hz, &FILTER)?;
        let bridged = filled(phased, angle, &smooth);
        let whole: Vec<Option<f64>> = (0..measured.len())
            .map(|frame| is_known[frame].then(|| measured[frame].unwrap_or(bridged[frame])))
            .collect();
        // Without a gap that was the whole course.
        let smooth = if whole == measured { smooth } else { filtered(&whole, rate_hz, &FILTER)? };
        let noise_rad = noise::of_angle(seen, angle).unwrap_or(phased.std_rad[angle]);
        let angles_rad = (0..measured.len()).map(|frame| smooth[frame].unwrap_or(bridged[frame])).collect();
        let is_outlier = (0..raw.len()).map(|frame| {
            let off = raw[frame].zip(smooth[frame]).map_or(0.0, |(raw, smooth)| (raw - smooth).abs());
            rejected[frame] && off > MIN_OUTLIER_RAD.max(OUTLIER_STDS * noise_rad)
        });
        let is_outlier = is_outlier.collect();
        let std_rad = measured.iter().map(|value| if value.is_some() { noise_rad } else { phased.std_rad[angle] });
        Ok(Self { angles_rad, std_rad: std_rad.collect(), is_outlier })
    }
}

/// The filter: a smoothing spline finds how much noise there is, and leaves a clean recording as it
/// is, which no fixed cut-off does. Gaps and outliers are dealt with before it.
const FILTER: FilterOptions = FilterOptions { filter: FilterKind::GcvSpline, hampel: false, gap_limit_s: 0.0 };
