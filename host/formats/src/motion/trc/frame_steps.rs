//! Which frame each row of a TRC file is: `Frame#` or `Time` may leave frames out.

use super::row::Row;

/// How far the median step of `Time` may be from the header's rate to count in its frames. Chosen:
/// times with two decimals are 20 % off at 120 frames a second.
const MAX_RATE_ERROR: f64 = 0.25;

/// The frame of each row, counted from 0 and rising. `Frame#` gives it where it rises by more than
/// its usual step; `Time` where it does not. One row a frame where neither can be used.
pub fn frame_indices(rows: &[Row], rate_hz: f32) -> Vec<usize> {
    let numbered = by_number(rows).filter(|steps| steps.iter().any(|&step| step > 1));
    let steps = numbered.or_else(|| by_time(rows, f64::from(rate_hz)));
    let mut frame = 0_usize;
    let first = (!rows.is_empty()).then_some(0);
    let later = rows.iter().skip(1).enumerate().map(|(index, _)| {
        let step = steps.as_ref().map_or(1, |steps| steps[index]);
        frame = frame.saturating_add(usize::try_from(step).unwrap_or(usize::MAX));
        frame
    });
    first.into_iter().chain(later).collect()
}

/// Steps between rows in units of the usual step of `Frame#`; `None` where it does not rise, or by
/// parts of that step.
fn by_number(rows: &[Row]) -> Option<Vec<u64>> {
    let steps = rows.windows(2).map(|two| two[1].frame?.checked_sub(two[0].frame?).filter(|&step| step > 0));
    let steps = steps.collect::<Option<Vec<u64>>>()?;
    let usual = median(&steps)?;
    steps.iter().map(|step| (step % usual == 0).then_some(step / usual)).collect()
}

/// Steps between rows by `Time`; `None` where it does not rise.
fn by_time(rows: &[Row], rate_hz: f64) -> Option<Vec<u64>> {
    let steps = rows.windows(2).map(|two| Some(two[1].time_s? - two[0].time_s?).filter(|&step| step >= 0.0));
    let steps_s = steps.collect::<Option<Vec<f64>>>()?;
    // In whole nanoseconds, which can be sorted.
    let usual_s = median(&steps_s.iter().map(|step_s| (step_s * 1.0e9) as u64).collect::<Vec<_>>())? as f64 * 1.0e-9;
    if usual_s <= 0.0 {
        return None;
    }
    let is_rate = (usual_s * rate_hz - 1.0).abs() < MAX_RATE_ERROR;
    let frame_s = if is_rate { 1.0 / rate_hz } else { usual_s };
    Some(steps_s.iter().map(|step_s| ((step_s / frame_s).round() as u64).max(1)).collect())
}

/// The middle value; the lower one of both middle values.
fn median(values: &[u64]) -> Option<u64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    sorted.get(sorted.len().saturating_sub(1) / 2).copied()
}
