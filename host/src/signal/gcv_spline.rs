//! Cubic smoothing spline; generalized cross-validation finds how smooth it is.
//!
//! The spline minimises the sum of (y - f)^2 plus lambda times the integral of f''^2 (Reinsch
//! 1967). Its second derivatives gamma solve (R + lambda Q'Q) gamma = Q'y, and f = y - lambda Q
//! gamma. The score is n RSS / tr(I - A)^2 (Craven and Wahba 1979). Its trace is by the five middle
//! bands of the inverse (Hutchinson and de Hoog 1985). So all is linear in the number of samples.
//!
//! Each row waits for the one before it, so eight lambdas go through the rows side by side.

use wide::f64x8;

/// Decimal logarithms of lambda that are tried, samples cubed. Chosen: at the lower end nothing is
/// smoothed; the upper one leaves half of a swing of 1100 samples.
const LOG_LAMBDA: [f64; 2] = [-3.0, 9.0];
/// Steps of the search over all of it. Chosen: about half a decade, below the width of a minimum.
const STEPS: usize = 23;
/// Lambdas that are tried at once.
const LANES: usize = 8;
/// Narrowings of the range about the least score, to 3e-4 decades: each leaves two ninths of it.
const NARROWINGS: usize = 5;
/// Samples below which there is nothing to validate: the least that SciPy takes.
const MIN_SAMPLES: usize = 5;

/// A smoothing spline at the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    /// Its values.
    pub values: Vec<f64>,
    /// What a change of each sample changes the value there by: 1 where nothing is smoothed. The
    /// value's variance is that of the noise times this (Wahba 1983).
    pub leverages: Vec<f64>,
}

/// The smoothing spline with the least score, at the samples: even steps over all lambdas, then
/// ninths of the two steps about the best.
#[must_use]
pub fn smoothed(values: &[f64]) -> Spline {
    if values.len() < MIN_SAMPLES {
        return Spline { values: values.to_vec(), leverages: vec![1.0; values.len()] };
    }
    let bends = bends(values);
    let mut rows = Vec::with_capacity(bends.len());
    let mut best_of = |tried: [f64; LANES]| {
        let scores = scores(&bends, tried.map(lambda), &mut rows);
        least((0..LANES).map(|lane| Tried { score: scores[lane], log_lambda: tried[lane], lane }))
    };
    let mut width = (LOG_LAMBDA[1] - LOG_LAMBDA[0]) / STEPS as f64;
    let firsts = (0..=STEPS).step_by(LANES);
    let mut best =
        least(firsts.map(|first| {
            best_of(std::array::from_fn(|lane| LOG_LAMBDA[0] + width * (first + lane).min(STEPS) as f64))
        }));
    for _ in 0..NARROWINGS {
        let (low, high) = ((best.log_lambda - width).max(LOG_LAMBDA[0]), (best.log_lambda + width).min(LOG_LAMBDA[1]));
        width = (high - low) / (LANES + 1) as f64;
        best = best_of(std::array::from_fn(|lane| low + width * (lane + 1) as f64));
    }
    let lambda = lambda(best.log_lambda);
    Spline { values: spline(values, lambda, &rows, best.lane), leverages: leverages(lambda, &rows, best.lane) }
}

/// A lambda with its score, and its lane among those that were tried with it.
#[derive(Debug, Clone, Copy)]
struct Tried {
    score: f64,
    log_lambda: f64,
    lane: usize,
}

/// That with the least score.
fn least(tried: impl Iterator<Item = Tried>) -> Tried {
    let none = Tried { score: f64::INFINITY, log_lambda: LOG_LAMBDA[0], lane: 0 };
    tried.min_by(|a, b| a.score.total_cmp(&b.score)).unwrap_or(none)
}

fn lambda(log_lambda: f64) -> f64 {
    10.0_f64.powf(log_lambda)
}

/// Second differences, Q'y.
fn bends(values: &[f64]) -> Vec<f64> {
    values.windows(3).map(|three| three[0] - 2.0 * three[1] + three[2]).collect()
}

/// The spline of one lambda, from the rows that it was eliminated in, and its lane there.
fn spline(values: &[f64], lambda: f64, rows: &[Row], lane: usize) -> Vec<f64> {
    // Second derivatives are zero at both ends and beyond.
    let mut gamma = vec![0.0; values.len() + 2];
    for (index, row) in rows.iter().enumerate().rev() {
        let [inverse_pivot, below, second_below, right] =
            [&row.inverse_pivot, &row.below, &row.second_below, &row.right].map(|all| all.as_array()[lane]);
        gamma[index + 2] = right * inverse_pivot - below * gamma[index + 3] - second_below * gamma[index + 4];
    }
    let change = |around: &[f64]| lambda * (around[0] - 2.0 * around[1] + around[2]);
    values.iter().zip(gamma.windows(3)).map(|(value, around)| value - change(around)).collect()
}

/// The diagonal of the matrix A that maps samples to the spline of one lambda: 1 - lambda Q (R +
/// lambda Q'Q)^-1 Q', by the five middle bands of the inverse.
fn leverages(lambda: f64, rows: &[Row], lane: usize) -> Vec<f64> {
    // Of each row, the inverse on the diagonal, one beside it and two beside it; two rows of zeros
    // before the first and two behind the last.
    let mut bands = vec![[0.0; 3]; rows.len() + 4];
    for (index, row) in rows.iter().enumerate().rev() {
        let [inverse_pivot, below, second_below] =
            [&row.inverse_pivot, &row.below, &row.second_below].map(|all| all.as_array()[lane]);
        let ([next, beside, _], [second, ..]) = (bands[index + 3], bands[index + 4]);
        let to_next = -(below * next + second_below * beside);
        let to_second = -(below * beside + second_below * second);
        bands[index + 2] = [inverse_pivot - below * to_next - second_below * to_second, to_next, to_second];
    }
    let leverage = |three: &[[f64; 3]]| {
        let [a, b, c] = [three[0], three[1], three[2]];
        1.0 - lambda * (a[0] + 4.0 * b[0] + c[0] - 4.0 * (a[1] + b[1]) + 2.0 * a[2])
    };
    bands.windows(3).map(leverage).collect()
}

/// Scores of several lambdas. Lambda itself cancels in the score of Q gamma and the trace of
/// (R + lambda Q'Q)^-1 Q'Q.
fn scores(bends: &[f64], lambdas: [f64; LANES], rows: &mut Vec<Row>) -> [f64; LANES] {
    eliminate(bends, f64x8::new(lambdas), rows);
    // Of the two rows after: second derivatives, and the inverse at (i + 1, i + 1),
    // (i + 1, i + 2) and (i + 2, i + 2).
    let (mut after, mut second_after) = (f64x8::ZERO, f64x8::ZERO);
    let (mut next, mut beside, mut second) = (f64x8::ZERO, f64x8::ZERO, f64x8::ZERO);
    let (mut residual, mut trace) = (f64x8::ZERO, f64x8::ZERO);
    for row in rows.iter().rev() {
        let gamma = row.right * row.inverse_pivot - row.below * after - row.second_below * second_after;
        let change = gamma - 2.0 * after + second_after;
        residual += change * change;
        let to_next = -(row.below * next + row.second_below * beside);
        let to_second = -(row.below * beside + row.second_below * second);
        let here = row.inverse_pivot - row.below * to_next - row.second_below * to_second;
        trace += 6.0 * here - 8.0 * to_next + 2.0 * to_second;
        (next, beside, second) = (here, to_next, next);
        (second_after, after) = (after, gamma);
    }
    let ends = [second_after - 2.0 * after, after];
    residual += ends[0] * ends[0] + ends[1] * ends[1];
    ((bends.len() + 2) as f64 * residual / (trace * trace)).to_array()
}

/// A row of R + lambda Q'Q as L D L', whose L has ones and two bands below, and its right side
/// after the forward substitution. Every lane has a lambda of its own.
#[derive(Debug)]
struct Row {
    inverse_pivot: f64x8,
    below: f64x8,
    second_below: f64x8,
    right: f64x8,
}

/// Factors and substitutes forwards. R has 2/3 and 1/6 in its bands, Q'Q has 6, -4 and 1, for
/// samples one apart.
fn eliminate(bends: &[f64], lambda: f64x8, rows: &mut Vec<Row>) {
    rows.clear();
    let (main, first) = (2.0 / 3.0 + 6.0 * lambda, 1.0 / 6.0 - 4.0 * lambda);
    // Of the row before: the band below times the pivot, and both bands; of the one before that,
    // the second band; and the right sides of both.
    let (mut next, mut below) = (f64x8::ZERO, f64x8::ZERO);
    let (mut second_below, mut before_second) = (f64x8::ZERO, f64x8::ZERO);
    let (mut right, mut before_right) = (f64x8::ZERO, f64x8::ZERO);
    for bend in bends {
        let inverse_pivot = 1.0 / (main - below * next - before_second * lambda);
        let row_right = *bend - below * right - before_second * before_right;
        next = first - lambda * below;
        (before_second, second_below, below) = (second_below, lambda * inverse_pivot, next * inverse_pivot);
        (before_right, right) = (right, row_right);
        rows.push(Row { inverse_pivot, below, second_below, right });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rough() -> Vec<f64> {
        (0..24).map(f64::from).map(|i| (0.35 * i).sin() + 0.3 * (2.5 * i * i).sin()).collect()
    }

    fn check(smooth: &[f64], wanted: [f64; 6], within: f64) {
        for (sample, wanted) in [0, 1, 7, 12, 22, 23].into_iter().zip(wanted) {
            assert!((smooth[sample] - wanted).abs() < within, "{sample}: {}", smooth[sample]);
        }
    }

    /// `make_smoothing_spline(i, x, lam=lambda)` of SciPy 1.17.1; scores by its dense matrices.
    #[test]
    fn splines_and_scores_are_those_of_scipy() {
        let mut rows = Vec::new();
        let scores = scores(&bends(&rough()), [0.5, 50.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0], &mut rows);
        for (score, wanted) in scores.into_iter().zip([0.061586721655915916, 0.13133192730056004]) {
            assert!((score - wanted).abs() < 1.0e-9, "{score} instead of {wanted}");
        }
        check(
            &spline(&rough(), 0.5, &rows, 0),
            [0.066504508811, 0.368486009032, 0.732011422098, -0.628823233415, 0.953319050949, 1.001250369464],
            1.0e-9,
        );
        check(
            &spline(&rough(), 50.0, &rows, 1),
            [0.500039901959, 0.576430511955, 0.429840262672, -0.470486866064, 0.861015156666, 1.106577572684],
            1.0e-9,
        );
    }

    /// `make_smoothing_spline(i, x)`, whose lambda is 2.2828.
    #[test]
    fn the_least_score_is_found() {
        check(
            &smoothed(&rough()).values,
            [0.098295763818, 0.371486225541, 0.707204399315, -0.667989173010, 0.964192583704, 1.068915739137],
            1.0e-5,
        );
    }

    #[test]
    fn a_line_stays_and_a_short_series_too() {
        let line: Vec<f64> = (0..50).map(|i| 2.0 - 0.1 * f64::from(i)).collect();
        assert!(smoothed(&line).values.iter().zip(&line).all(|(value, wanted)| (value - wanted).abs() < 1.0e-6));
        let short = smoothed(&[1.0, 9.0, 1.0, 9.0]);
        assert_eq!((short.values, short.leverages), (vec![1.0, 9.0, 1.0, 9.0], vec![1.0; 4]));
    }

    /// A spline is linear in its samples.
    #[test]
    fn a_leverage_is_what_a_sample_changes_its_own_value_by() {
        for lambda in [0.01, 2.0, 500.0] {
            let mut rows = Vec::new();
            for sample in 0..24 {
                let mut unit = vec![0.0; 24];
                unit[sample] = 1.0;
                eliminate(&bends(&unit), f64x8::splat(lambda), &mut rows);
                let (changed, leverages) = (spline(&unit, lambda, &rows, 3)[sample], leverages(lambda, &rows, 3));
                assert!((leverages[sample] - changed).abs() < 1.0e-9, "{lambda}, {sample}: {leverages:?}");
                assert_eq!(leverages.len(), 24);
            }
        }
    }
}
