//! Medians.

/// Standard deviation of a normal number over the median of its size, 1 / 0.6745.
pub const STD_PER_MEDIAN: f64 = 1.4826;

/// The median of `values`, which it sorts; the mean of the middle two of an even number. `None` of
/// none.
pub fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len().is_multiple_of(2) { 0.5 * (values[middle - 1] + upper) } else { upper })
}

/// The median of a window about each sample. `window` is its length in samples, rounded to an odd
/// number, three at least; towards the ends it shrinks alike on both sides.
#[must_use]
pub fn smoothed(values: &[f64], window: f64) -> Vec<f64> {
    let half = ((0.5 * (window - 1.0)).round() as usize).max(1);
    let at = |sample: usize| {
        let half = half.min(sample).min(values.len() - 1 - sample);
        median(&mut values[sample - half..=sample + half].to_vec()).unwrap_or(values[sample])
    };
    (0..values.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lone_value_goes_and_a_step_stays() {
        assert_eq!(smoothed(&[1.0, 9.0, 1.0, 1.0, 5.0, 5.0, 5.0], 3.0), [1.0, 1.0, 1.0, 1.0, 5.0, 5.0, 5.0]);
        assert_eq!(smoothed(&[1.0, 9.0, 8.0, 1.0, 1.0], 5.0), [1.0, 8.0, 1.0, 1.0, 1.0]);
        assert_eq!(smoothed(&[4.0, 2.0], 0.1), [4.0, 2.0]);
        assert_eq!((median(&mut [3.0, 1.0]), median(&mut [])), (Some(2.0), None));
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 10.0]), Some(2.5));
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), Some(2.0));
    }
}
