//! What a filter sees beyond the ends of a series.

/// `values` with up to `length` samples more at each end. These are turned about the end value by
/// half a turn, so that level and slope go on. Also the number of samples that were put before.
pub fn extended(values: &[f64], length: usize) -> (Vec<f64>, usize) {
    let length = length.min(values.len().saturating_sub(1));
    let last = values.len().saturating_sub(1);
    let before = (1..=length).rev().map(|step| 2.0 * values[0] - values[step]);
    let after = (1..=length).map(|step| 2.0 * values[last] - values[last - step]);
    (before.chain(values.iter().copied()).chain(after).collect(), length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_goes_on() {
        assert_eq!(extended(&[1.0, 2.0, 3.0], 2), (vec![-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 2));
        assert_eq!(extended(&[7.0], 9), (vec![7.0], 0));
        assert_eq!(extended(&[], 9), (vec![], 0));
    }
}
