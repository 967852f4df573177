//! Cubic smoothing spline; generalized cross-validation finds how smooth it is.
//!
//! The spline minimises the sum of (y - f)^2 plus lambda times the integral of f''^2 (Reinsch
//! 1967). Its second derivatives gamma solve (R + lambda Q'Q) gamma = Q'y, and f = y - lambda Q
//! gamma. The score is n RSS / tr(I - A)^2 (Craven and Wahba 1979). Its trace is by the five middle
//! bands of the inverse (Hutchinson and de Hoog 1985). So all is linear in the number of samples.

/// Decimal logarithms of lambda that are tried, samples cubed. Chosen: at the lower end nothing is
/// smoothed; the upper one leaves half of a swing of 1100 samples.
const LOG_LAMBDA: [f64; 2] = [-3.0, 9.0];
/// Steps of the search over all of it. Chosen: half a decade, below the width of a minimum.
const STEPS: usize = 24;
/// Steps of the golden section that refines it, to 1e-5 decades.
const REFINEMENTS: usize = 25;
/// Samples below which there is nothing to validate: the least that SciPy takes.
const MIN_SAMPLES: usize = 5;

/// The smoothing spline with the least score, at the samples.
#[must_use]
pub fn smoothed(values: &[f64]) -> Vec<f64> {
    if values.len() < MIN_SAMPLES {
        return values.to_vec();
    }
    let score = |log_lambda: f64| Fit::new(values, 10.0_f64.powf(log_lambda)).score();
    let width = (LOG_LAMBDA[1] - LOG_LAMBDA[0]) / STEPS as f64;
    let tried = (0..=STEPS).map(|step| LOG_LAMBDA[0] + width * step as f64);
    let scored = tried.map(|log_lambda| (score(log_lambda), log_lambda));
    let best = scored.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(LOG_LAMBDA[0], |(_, log_lambda)| log_lambda);
    let range = [(best - width).max(LOG_LAMBDA[0]), (best + width).min(LOG_LAMBDA[1])];
    Fit::new(values, 10.0_f64.powf(golden_section(score, range))).smooth
}

/// Where a function with one minimum in `range` is least (Kiefer 1953).
fn golden_section(score: impl Fn(f64) -> f64, range: [f64; 2]) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let [mut low, mut high] = range;
    let (mut left, mut right) = (high - share * (high - low), low + share * (high - low));
    let (mut at_left, mut at_right) = (score(left), score(right));
    for _ in 0..REFINEMENTS {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - share * (high - low);
            at_left = score(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + share * (high - low);
            at_right = score(right);
        }
    }
    0.5 * (low + high)
}

/// A spline for one lambda.
#[derive(Debug)]
struct Fit {
    smooth: Vec<f64>,
    /// Sum of squared residuals.
    residual: f64,
    /// Trace of I - A.
    freedom: f64,
}

impl Fit {
    fn new(values: &[f64], lambda: f64) -> Self {
        let inner = values.len() - 2;
        let factors = Factors::new(inner, lambda);
        let bends: Vec<f64> = values.windows(3).map(|three| three[0] - 2.0 * three[1] + three[2]).collect();
        let (gamma, trace) = factors.solve_and_trace(bends);
        // Second derivatives are zero beyond both ends.
        let mut changes = vec![0.0; values.len()];
        let (mut second, mut before) = (0.0, 0.0);
        for (change, at) in changes.iter_mut().zip(gamma.into_iter().chain([0.0; 2])) {
            *change = lambda * (second - 2.0 * before + at);
            (second, before) = (before, at);
        }
        Self {
            residual: changes.iter().map(|change| change * change).sum(),
            freedom: lambda * trace,
            smooth: values.iter().zip(&changes).map(|(value, change)| value - change).collect(),
        }
    }

    fn score(&self) -> f64 {
        self.smooth.len() as f64 * self.residual / (self.freedom * self.freedom)
    }
}

/// R + lambda Q'Q as L D L'; L has ones and two bands below.
#[derive(Debug)]
struct Factors {
    pivots: Vec<f64>,
    below: Vec<f64>,
    second_below: Vec<f64>,
}

impl Factors {
    /// R has 2/3 and 1/6 in its bands, Q'Q has 6, -4 and 1, for samples one apart.
    fn new(size: usize, lambda: f64) -> Self {
        let (main, first, second) = (2.0 / 3.0 + 6.0 * lambda, 1.0 / 6.0 - 4.0 * lambda, lambda);
        let mut factors = Self { pivots: vec![0.0; size], below: vec![0.0; size], second_below: vec![0.0; size] };
        let Self { pivots, below, second_below } = &mut factors;
        for i in 0..size {
            let (mut pivot, mut next) = (main, first);
            if i >= 1 {
                pivot -= below[i - 1] * below[i - 1] * pivots[i - 1];
                next -= second_below[i - 1] * below[i - 1] * pivots[i - 1];
            }
            if i >= 2 {
                pivot -= second_below[i - 2] * second_below[i - 2] * pivots[i - 2];
            }
            (pivots[i], below[i], second_below[i]) = (pivot, next / pivot, second / pivot);
            if i >= 2 && (1..=2).all(|back| pivots[i - back] == pivot && below[i - back] == below[i]) {
                // A row hangs on the two before it only: all further ones are the same.
                pivots[i..].fill(pivot);
                below[i..].fill(next / pivot);
                second_below[i..].fill(second / pivot);
                break;
            }
        }
        below[size - 1..].fill(0.0);
        second_below[size.saturating_sub(2)..].fill(0.0);
        factors
    }

    /// The solution of a right side, and the trace of the inverse times Q'Q, from the last row of
    /// the inverse's bands to the first.
    fn solve_and_trace(&self, mut right: Vec<f64>) -> (Vec<f64>, f64) {
        // What the solutions one and two rows before take from a row.
        let (mut first, mut second, mut next_second) = (0.0, 0.0, 0.0);
        for (value, (below, second_below)) in right.iter_mut().zip(self.below.iter().zip(&self.second_below)) {
            *value = *value - first - second;
            (first, second, next_second) = (below * *value, next_second, second_below * *value);
        }
        // The inverse at (i + 1, i + 1), (i + 1, i + 2) and (i + 2, i + 2).
        let (mut next, mut beside, mut second) = (0.0, 0.0, 0.0);
        let (mut after, mut second_after) = (0.0, 0.0);
        let mut trace = 0.0;
        let bands = self.below.iter().zip(&self.second_below);
        for ((value, pivot), (below, second_below)) in right.iter_mut().zip(&self.pivots).zip(bands).rev() {
            *value = *value / pivot - below * after - second_below * second_after;
            (second_after, after) = (after, *value);
            let to_next = -below * next - second_below * beside;
            let to_second = -below * beside - second_below * second;
            let here = 1.0 / pivot - below * to_next - second_below * to_second;
            trace += 6.0 * here - 8.0 * to_next + 2.0 * to_second;
            (next, beside, second) = (here, to_next, next);
        }
        (right, trace)
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
        let little = Fit::new(&rough(), 0.5);
        check(
            &little.smooth,
            [0.066504508811, 0.368486009032, 0.732011422098, -0.628823233415, 0.953319050949, 1.001250369464],
            1.0e-9,
        );
        assert!((little.score() - 0.061586721655915916).abs() < 1.0e-9, "{}", little.score());
        let much = Fit::new(&rough(), 50.0);
        check(
            &much.smooth,
            [0.500039901959, 0.576430511955, 0.429840262672, -0.470486866064, 0.861015156666, 1.106577572684],
            1.0e-9,
        );
        assert!((much.score() - 0.13133192730056004).abs() < 1.0e-9, "{}", much.score());
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
