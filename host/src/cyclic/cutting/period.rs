//! The period of a motion, by autocorrelation.

use super::channels::Channels;

/// Correlation of the motion with itself one period later, below which there is no period.
const MIN_CORRELATION: f64 = 0.4;
/// A shorter lag is the period if it is nearly as good as the best: multiples of the period are as
/// good as it.
pub(super) const NEARLY: f64 = 0.8;
/// Share of the recording by which it may be shifted against itself: about a third has to overlap.
const LONGEST_SHIFT: f64 = 0.67;

/// The period in frames, within `bounds`.
///
/// # Errors
/// Says, to follow the name of the table, why there is none.
pub fn find(channels: &Channels, bounds: [usize; 2]) -> Result<usize, String> {
    let [shortest, longest] = bounds;
    let longest = longest.min((LONGEST_SHIFT * channels.len() as f64) as usize);
    if longest <= shortest + 2 {
        return Err(format!(
            "its {} frames are too short: about one and a half cycles of at least {shortest} frames are needed",
            channels.len()
        ));
    }
    // From a lag of zero on, so that the flank of the peak at zero is no peak itself.
    let first = shortest - 1;
    let correlations: Vec<f64> = (first..=longest + 1)
        .map(|lag| channels.correlation(0..channels.len().saturating_sub(lag), lag).unwrap_or(-1.0))
        .collect();
    let peaks: Vec<(usize, f64)> = correlations
        .windows(3)
        .enumerate()
        .filter(|(_, around)| around[1] > around[0] && around[1] >= around[2])
        .map(|(index, around)| (first + index + 1, around[1]))
        .collect();
    let best = peaks.iter().map(|peak| peak.1).fold(-1.0, f64::max);
    if best < MIN_CORRELATION {
        let hint = if longest < bounds[1] { "; it may be too short" } else { "" };
        return Err(format!(
            "nothing comes back in it: shifted by {shortest} to {longest} frames it resembles itself by {best:.2} at most, {MIN_CORRELATION} is needed{hint}"
        ));
    }
    // The list is not empty where the best of it is above the least.
    Ok(peaks.iter().find(|peak| peak.1 >= NEARLY * best).map_or(shortest, |peak| peak.0))
}
