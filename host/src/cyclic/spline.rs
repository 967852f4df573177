//! Natural cubic splines through knots at rising, not necessarily even, places.
//!
//! Own code: the published crates are either parts of large numerical suites or no longer kept. The
//! second derivatives at the knots solve a tridiagonal system (de Boor, "A Practical Guide to
//! Splines", chapter IV).

/// A twice continuously differentiable curve of cubic pieces; its second derivative is zero at both
/// ends.
#[derive(Debug, Clone, PartialEq)]
pub struct CubicSpline {
    places: Vec<f64>,
    values: Vec<f64>,
    /// Second derivative at each knot.
    curvatures: Vec<f64>,
}

impl CubicSpline {
    /// The spline through `values` at `places`; `None` unless there are at least two of them,
    /// finite, as many of the one as of the other, and the places rise.
    #[must_use]
    pub fn natural(places: Vec<f64>, values: Vec<f64>) -> Option<Self> {
        let finite = places.iter().chain(&values).all(|value| value.is_finite());
        let rising = places.windows(2).all(|pair| pair[0] < pair[1]);
        if places.len() < 2 || places.len() != values.len() || !finite || !rising {
            return None;
        }
        let curvatures = curvatures(&places, &values);
        Some(Self { places, values, curvatures })
    }

    /// Value at `place`; beyond the ends the curve goes on straight.
    #[must_use]
    pub fn at(&self, place: f64) -> f64 {
        let last = self.places.len() - 1;
        let piece = self.places.partition_point(|knot| *knot <= place).clamp(1, last) - 1;
        let (left, right) = (self.places[piece], self.places[piece + 1]);
        let width = right - left;
        if place < left || place > right {
            let (end, other, sign) = if place < left { (piece, piece + 1, 1.0) } else { (piece + 1, piece, -1.0) };
            let chord = (self.values[piece + 1] - self.values[piece]) / width;
            let slope = chord - sign * width * (2.0 * self.curvatures[end] + self.curvatures[other]) / 6.0;
            return self.values[end] + slope * (place - self.places[end]);
        }
        let (a, b) = ((right - place) / width, (place - left) / width);
        let bend = (a * a * a - a) * self.curvatures[piece] + (b * b * b - b) * self.curvatures[piece + 1];
        a * self.values[piece] + b * self.values[piece + 1] + bend * width * width / 6.0
    }

    /// First and last knot.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.places[0], self.places[self.places.len() - 1]]
    }
}

/// Thomas algorithm on the continuity of the first derivative at the inner knots.
fn curvatures(places: &[f64], values: &[f64]) -> Vec<f64> {
    let count = places.len();
    let mut curvatures = vec![0.0; count];
    let mut upper = vec![0.0; count];
    for i in 1..count - 1 {
        let (before, after) = (places[i] - places[i - 1], places[i + 1] - places[i]);
        let bend = (values[i + 1] - values[i]) / after - (values[i] - values[i - 1]) / before;
        let pivot = 2.0 * (before + after) - before * upper[i - 1];
        upper[i] = after / pivot;
        curvatures[i] = (6.0 * bend - before * curvatures[i - 1]) / pivot;
    }
    for i in (1..count - 1).rev() {
        curvatures[i] -= upper[i] * curvatures[i + 1];
    }
    curvatures
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_sine_is_met_between_the_knots() {
        let places: Vec<f64> = (0..=40).map(|i| f64::from(i) * 0.1 + 0.02 * f64::from(i % 3)).collect();
        let values = places.iter().map(|x| x.sin()).collect();
        let spline = CubicSpline::natural(places, values).unwrap();
        for i in 0..200 {
            let x = 0.8 + 0.012 * f64::from(i);
            assert!((spline.at(x) - x.sin()).abs() < 2.0e-5, "{x}");
        }
    }

    /// Through (0, 0), (1, 1), (2, 0) the natural spline has curvature -3 at 1; worked by hand at
    /// 0.5.
    #[test]
    fn three_knots_by_hand() {
        let spline = CubicSpline::natural(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 0.0]).unwrap();
        assert!((spline.at(0.5) - 0.6875).abs() < 1.0e-12);
        assert!((spline.at(-1.0) + 1.5).abs() < 1.0e-12, "straight on with slope 1.5: {}", spline.at(-1.0));
        assert!((spline.at(3.0) + 1.5).abs() < 1.0e-12);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        assert!(CubicSpline::natural(vec![0.0], vec![1.0]).is_none());
        assert!(CubicSpline::natural(vec![0.0, 0.0], vec![1.0, 2.0]).is_none());
        assert!(CubicSpline::natural(vec![0.0, 1.0], vec![1.0]).is_none());
        assert!(CubicSpline::natural(vec![0.0, 1.0], vec![1.0, f64::NAN]).is_none());
    }

    proptest! {
        #[test]
        fn the_curve_passes_its_knots(values in prop::collection::vec(-5.0..5.0_f64, 2..30), step in 0.1..3.0_f64) {
            let places: Vec<f64> = (0..values.len()).map(|i| i as f64 * step).collect();
            let spline = CubicSpline::natural(places.clone(), values.clone()).unwrap();
            for (place, value) in places.iter().zip(&values) {
                prop_assert!((spline.at(*place) - value).abs() < 1.0e-9);
            }
        }
    }
}
