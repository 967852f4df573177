//! Cubic smoothing spline; generalized cross-validation finds how smooth it is.
//!
//! The spline minimises the sum of (y - f)^2 plus lambda times the integral of f''^2 (Reinsch
//! 1967). Its second derivatives gamma solve (R + lambda Q'Q) gamma = Q'y, and f = y - lambda Q
//! gamma. The score is n RSS / tr(I - A)^2 (Craven and Wahba 1979). Its trace is by the five middle
//! bands of the inverse (Hutchinson and de Hoog 1985). So all is linear in the number of samples.
//!
//! Each row waits for the one before it, so several lambdas go through the rows side by side.

/// Decimal logarithms of lambda that are tried, samples cubed. Chosen: at the lower end nothing is
/// smoothed; the upper one leaves half of a swing of 1100 samples.
const LOG_LAMBDA: [f64; 2] = [-3.0, 9.0];
/// Steps of the search over all of it. Chosen: about half a decade, below the width of a minimum.
const STEPS: usize = 23;
/// Lambdas that are tried at once. Chosen: two vectors of AVX2, so that one works while the other
/// waits.
const LANES: usize = 8;
/// Narrowings of the range about the least score, to 1e-5 decades: each leaves two ninths of it.
const NARROWINGS: usize = 7;
/// Samples below which there is nothing to validate: the least that SciPy takes.
const MIN_SAMPLES: usize = 5;

/// The smoothing spline with the least score, at the samples.
#[must_use]
pub fn smoothed(values: &[f64]) -> Vec<f64> {
    if values.len() < MIN_SAMPLES {
        return values.to_vec();
    }
    spline(values, 10.0_f64.powf(best_log_lambda(values)))
}

/// Decimal logarithm of the lambda with the least score: of even steps over the whole range, then
/// of ninths of the two steps about the best.
fn best_log_lambda(values: &[f64]) -> f64 {
    let bends = bends(values);
    let mut rows = Vec::with_capacity(bends.len());
    let mut best_of = |tried: [f64; LANES]| {
        let scores = scores(&bends, tried.map(|log_lambda| 10.0_f64.powf(log_lambda)), &mut rows);
        least(scores.into_iter().zip(tried))
    };
    let mut width = (LOG_LAMBDA[1] - LOG_LAMBDA[0]) / STEPS as f64;
    let steps = (0..=STEPS).step_by(LANES);
    let tried = steps.map(|first| std::array::from_fn(|lane| LOG_LAMBDA[0] + width * (first + lane).min(STEPS) as f64));
    let (_, mut best) = least(tried.map(&mut best_of));
    for _ in 0..NARROWINGS {
        let (low, high) = ((best - width).max(LOG_LAMBDA[0]), (best + width).min(LOG_LAMBDA[1]));
        width = (high - low) / (LANES + 1) as f64;
        (_, best) = best_of(std::array::from_fn(|lane| low + width * (lane + 1) as f64));
    }
    best
}

/// The least score, with its logarithm of lambda.
fn least(scored: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    scored.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, LOG_LAMBDA[0]))
}

/// Second differences, Q'y.
fn bends(values: &[f64]) -> Vec<f64> {
    values.windows(3).map(|three| three[0] - 2.0 * three[1] + three[2]).collect()
}

/// The spline of one lambda.
fn spline(values: &[f64], lambda: f64) -> Vec<f64> {
    let mut rows = Vec::new();
    eliminate(&bends(values), [lambda], &mut rows);
    // Second derivatives are zero at both ends and beyond.
    let mut gamma = vec![0.0; values.len() + 2];
    for (index, row) in rows.iter().enumerate().rev() {
        gamma[index + 2] = row.solved(&[gamma[index + 3]], &[gamma[index + 4]])[0];
    }
    let change = |around: &[f64]| lambda * (around[0] - 2.0 * around[1] + around[2]);
    values.iter().zip(gamma.windows(3)).map(|(value, around)| value - change(around)).collect()
}

/// Scores of several lambdas. Lambda itself cancels in the score of Q gamma and the trace of
/// (R + lambda Q'Q)^-1 Q'Q. With AVX2 wherever it is: the bits are the same.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn scores<const L: usize>(bends: &[f64], lambda: [f64; L], rows: &mut Vec<Row<L>>) -> [f64; L] {
    eliminate(bends, lambda, rows);
    // Of the two rows after: second derivatives, and the inverse at (i + 1, i + 1),
    // (i + 1, i + 2) and (i + 2, i + 2).
    let (mut after, mut second_after) = ([0.0; L], [0.0; L]);
    let (mut next, mut beside, mut second) = ([0.0; L], [0.0; L], [0.0; L]);
    let (mut residual, mut trace) = ([0.0; L], [0.0; L]);
    for row in rows.iter().rev() {
        let gamma = row.solved(&after, &second_after);
        for lane in 0..L {
            let change = gamma[lane] - 2.0 * after[lane] + second_after[lane];
            residual[lane] += change * change;
            let to_next = -row.below[lane] * next[lane] - row.second_below[lane] * beside[lane];
            let to_second = -row.below[lane] * beside[lane] - row.second_below[lane] * second[lane];
            let here = row.inverse_pivot[lane] - row.below[lane] * to_next - row.second_below[lane] * to_second;
            trace[lane] += 6.0 * here - 8.0 * to_next + 2.0 * to_second;
            (next[lane], beside[lane], second[lane]) = (here, to_next, next[lane]);
        }
        (second_after, after) = (after, gamma);
    }
    std::array::from_fn(|lane| {
        let ends = [second_after[lane] - 2.0 * after[lane], after[lane]];
        let residual = residual[lane] + ends[0] * ends[0] + ends[1] * ends[1];
        (bends.len() + 2) as f64 * residual / (trace[lane] * trace[lane])
    })
}

/// A row of R + lambda Q'Q as L D L', whose L has ones and two bands below, and its right side
/// after the forward substitution. Every lane has a lambda of its own.
#[derive(Debug)]
struct Row<const L: usize> {
    inverse_pivot: [f64; L],
    below: [f64; L],
    second_below: [f64; L],
    right: [f64; L],
}

impl<const L: usize> Row<L> {
    /// The row's unknown, given those of the two rows after it.
    #[inline(always)]
    fn solved(&self, after: &[f64; L], second_after: &[f64; L]) -> [f64; L] {
        std::array::from_fn(|lane| {
            self.right[lane] * self.inverse_pivot[lane]
                - self.below[lane] * after[lane]
                - self.second_below[lane] * second_after[lane]
        })
    }
}

/// Factors and substitutes forwards. R has 2/3 and 1/6 in its bands, Q'Q has 6, -4 and 1, for
/// samples one apart.
#[inline(always)]
fn eliminate<const L: usize>(bends: &[f64], lambda: [f64; L], rows: &mut Vec<Row<L>>) {
    rows.clear();
    // Of the row before: the band below times the pivot, and the band; of the one before that, the
    // second band; and what both take from the right side.
    let (mut next, mut below, mut second_below, mut before_second) = ([0.0; L], [0.0; L], [0.0; L], [0.0; L]);
    let (mut right, mut before_right) = ([0.0; L], [0.0; L]);
    for bend in bends {
        let mut row = Row { inverse_pivot: [0.0; L], below: [0.0; L], second_below: [0.0; L], right: [0.0; L] };
        for lane in 0..L {
            let main = 2.0 / 3.0 + 6.0 * lambda[lane];
            let pivot = main - below[lane] * next[lane] - before_second[lane] * lambda[lane];
            row.right[lane] = bend - below[lane] * right[lane] - before_second[lane] * before_right[lane];
            next[lane] = 1.0 / 6.0 - 4.0 * lambda[lane] - lambda[lane] * below[lane];
            row.inverse_pivot[lane] = 1.0 / pivot;
            row.below[lane] = next[lane] * row.inverse_pivot[lane];
            row.second_below[lane] = lambda[lane] * row.inverse_pivot[lane];
        }
        (before_right, right) = (right, row.right);
        (before_second, second_below, below) = (second_below, row.second_below, row.below);
        rows.push(row);
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
        check(
            &spline(&rough(), 0.5),
            [0.066504508811, 0.368486009032, 0.732011422098, -0.628823233415, 0.953319050949, 1.001250369464],
            1.0e-9,
        );
        check(
            &spline(&rough(), 50.0),
            [0.500039901959, 0.576430511955, 0.429840262672, -0.470486866064, 0.861015156666, 1.106577572684],
            1.0e-9,
        );
        let scores = scores(&bends(&rough()), [0.5, 50.0], &mut Vec::new());
        for (score, wanted) in scores.into_iter().zip([0.061586721655915916, 0.13133192730056004]) {
            assert!((score - wanted).abs() < 1.0e-9, "{score} instead of {wanted}");
        }
    }

    /// `make_smoothing_spline(i, x)`, whose lambda is 2.2828.
    #[test]
    fn the_least_score_is_found() {
        check(
            &smoothed(&rough()),
            [0.098295763818, 0.371486225541, 0.707204399315, -0.667989173010, 0.964192583704, 1.068915739137],
            1.0e-6,
        );
    }

    #[test]
    fn a_line_stays_and_a_short_series_too() {
        let line: Vec<f64> = (0..50).map(|i| 2.0 - 0.1 * f64::from(i)).collect();
        assert!(smoothed(&line).iter().zip(&line).all(|(value, wanted)| (value - wanted).abs() < 1.0e-6));
        assert_eq!(smoothed(&[1.0, 9.0, 1.0, 9.0]), [1.0, 9.0, 1.0, 9.0]);
    }
}
