//! The course of one angle over a finished recording.

use super::fill::{filled, wind_in_gaps};
use super::noise::MIN_NOISE_RAD;
use super::phase::Phased;
use super::seen::Seen;
use super::shape;
use crate::cyclic::turns::least_angle;
use crate::signal::gaps::{beside, pieces};
use crate::signal::{gcv_spline, hampel};

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
    /// Standard deviations: what smoothing leaves of the measurements' noise. In a gap that of the
    /// frames beside it, and the person's distance from their own cycle.
    pub std_rad: Vec<f64>,
    /// Whether the measurement was left out and far from what was taken in its place.
    pub is_outlier: Vec<bool>,
}

impl Course {
    /// The course of `angle`, measured with this noise; frames that are not `is_known` get the
    /// person's own cycle.
    #[must_use]
    pub fn new<const N: usize>(
        seen: &Seen<N>,
        angle: usize,
        phased: &Phased<N>,
        (is_known, noise_rad): (&[bool], f64),
    ) -> Self {
        let raw = seen.series(angle);
        let mut measured = raw.clone();
        let rejected = hampel::reject(&mut measured);
        wind_in_gaps(phased, angle, &mut measured);
        // Gaps stay: what is beside them is smooth already where the own cycle joins it.
        let smooth = splines(&measured);
        let bridged = filled(phased, angle, &smooth.angles_rad);
        let whole: Vec<Option<f64>> = (0..measured.len())
            .map(|frame| is_known[frame].then(|| measured[frame].unwrap_or(bridged[frame])))
            .collect();
        // Without a gap that was the whole course.
        let smooth = if whole == measured { smooth } else { splines(&whole) };
        let angles_rad = (0..measured.len()).map(|frame| smooth.angles_rad[frame].unwrap_or(bridged[frame])).collect();
        let is_outlier = (0..raw.len()).map(|frame| {
            let off =
                raw[frame].zip(smooth.angles_rad[frame]).map_or(0.0, |(raw, smooth)| least_angle(raw - smooth).abs());
            rejected[frame] && off > MIN_OUTLIER_RAD.max(OUTLIER_STDS * noise_rad)
        });
        let is_outlier = is_outlier.collect();
        let leverages = measured.iter().zip(smooth.leverages).map(|(value, leverage)| value.and(leverage));
        let beside = beside(&leverages.collect::<Vec<_>>());
        let has_gap = measured.iter().any(Option::is_none);
        let gaps_rad2 = if has_gap { gap_variances_rad2(seen, angle, phased, noise_rad) } else { Vec::new() };
        let std_rad = (0..measured.len()).map(|frame| {
            let [last, next] = beside[frame];
            let [last, next] = [last.or(next), next.or(last)].map(|side| side.map_or(1.0, |(_, leverage)| leverage));
            let gap_rad2 = if measured[frame].is_some() { 0.0 } else { gaps_rad2[frame] };
            (noise_rad.powi(2) * 0.5 * (last + next) + gap_rad2).sqrt()
        });
        Self { angles_rad, std_rad: std_rad.collect(), is_outlier }
    }
}

/// Variance of the person about their own cycle in each frame, as far as it is known, rad^2.
fn gap_variances_rad2<const N: usize>(seen: &Seen<N>, angle: usize, phased: &Phased<N>, noise_rad: f64) -> Vec<f64> {
    let over_fitted = shape::distances_over_fitted(seen, &phased.phases, angle);
    let fitted_rad2 = phased.std_rad[angle].powi(2);
    // The measured angles' distance from the person's cycle has their noise in it.
    let variance_rad2 = |over: f64| (over * fitted_rad2 - noise_rad.powi(2)).max(MIN_NOISE_RAD.powi(2));
    over_fitted.into_iter().map(variance_rad2).collect()
}

/// Splines of one angle, with their leverages; nothing in gaps.
struct Splines {
    angles_rad: Vec<Option<f64>>,
    leverages: Vec<Option<f64>>,
}

/// A smoothing spline of each stretch without a gap. It finds how much noise there is, and leaves a
/// clean recording as it is, which no fixed cut-off does.
fn splines(series: &[Option<f64>]) -> Splines {
    let mut splines = Splines { angles_rad: vec![None; series.len()], leverages: vec![None; series.len()] };
    for piece in pieces(series, 0) {
        let values: Vec<f64> = series[piece.clone()].iter().copied().flatten().collect();
        let spline = gcv_spline::smoothed(&values);
        for (sample, (value, leverage)) in piece.zip(spline.values.into_iter().zip(spline.leverages)) {
            splines.angles_rad[sample] = Some(value);
            splines.leverages[sample] = Some(leverage);
        }
    }
    splines
}
