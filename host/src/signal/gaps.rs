//! Gaps in a series: which are filled, which split it, and what is put in.

use crate::cyclic::spline::CubicSpline;
use std::ops::Range;

/// Number of missing samples in the longest gap that is filled.
#[must_use]
pub fn longest_filled(gap_limit_s: f64, rate_hz: f64) -> usize {
    (gap_limit_s * rate_hz + 1.0e-6).floor() as usize
}

/// The pieces of `series` between gaps of more than `longest` samples. Each begins and ends with a
/// value.
#[must_use]
pub fn pieces(series: &[Option<f64>], longest: usize) -> Vec<Range<usize>> {
    let mut pieces: Vec<Range<usize>> = Vec::new();
    for sample in (0..series.len()).filter(|sample| series[*sample].is_some()) {
        match pieces.last_mut() {
            Some(piece) if sample - piece.end <= longest => piece.end = sample + 1,
            _ => pieces.push(sample..sample + 1),
        }
    }
    pieces
}

/// The values of a piece, with a natural cubic spline through them in its gaps.
#[must_use]
pub fn filled(piece: &[Option<f64>]) -> Vec<f64> {
    let known = || piece.iter().enumerate().filter_map(|(sample, value)| Some((sample as f64, (*value)?)));
    let (places, values): (Vec<f64>, Vec<f64>) = known().unzip();
    if values.len() == piece.len() {
        return values;
    }
    let spline = CubicSpline::natural(places, values);
    let put_in = |sample: usize| spline.as_ref().map_or(0.0, |spline| spline.at(sample as f64));
    piece.iter().enumerate().map(|(sample, value)| value.unwrap_or_else(|| put_in(sample))).collect()
}

/// For each sample the last and the next one with a value, itself where it has one: their number
/// and value.
#[must_use]
pub fn beside(series: &[Option<f64>]) -> Vec<[Option<(usize, f64)>; 2]> {
    let mut beside = vec![[None; 2]; series.len()];
    let known = |sample: usize| series[sample].map(|value| (sample, value));
    let (mut last, mut next) = (None, None);
    for sample in 0..series.len() {
        last = known(sample).or(last);
        beside[sample][0] = last;
        let from_end = series.len() - 1 - sample;
        next = known(from_end).or(next);
        beside[from_end][1] = next;
    }
    beside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_end_at_long_gaps() {
        let series: Vec<Option<f64>> = "..x.xx..xx...x".chars().map(|letter| (letter == 'x').then_some(1.0)).collect();
        assert_eq!(pieces(&series, 2), [2..10, 13..14]);
        assert_eq!(pieces(&series, 0), [2..3, 4..6, 8..10, 13..14]);
        assert_eq!(pieces(&[None, None], 9), []);
        assert_eq!((longest_filled(0.2, 30.0), longest_filled(0.1, 25.0), longest_filled(0.0, 60.0)), (6, 2, 0));
    }

    #[test]
    fn neighbours_of_a_gap_are_on_both_sides() {
        let [one, two] = [Some((1, 5.0)), Some((3, 7.0))];
        let found = beside(&[None, Some(5.0), None, Some(7.0), None]);
        assert_eq!(found, [[None, one], [one, one], [one, two], [two, two], [two, None]]);
        assert_eq!(beside(&[None]), [[None, None]]);
    }

    #[test]
    fn a_gap_follows_the_curve() {
        let curve = |sample: usize| (0.3 * sample as f64).sin();
        let piece: Vec<Option<f64>> =
            (0..30).map(|sample| (!(12..15).contains(&sample)).then(|| curve(sample))).collect();
        for (sample, value) in filled(&piece).into_iter().enumerate() {
            assert!((value - curve(sample)).abs() < 0.01, "{sample}: {value}");
        }
        assert_eq!(filled(&[Some(1.0), None, Some(3.0)]), [1.0, 2.0, 3.0]);
    }
}
