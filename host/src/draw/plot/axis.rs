//! Ranges and round tick marks.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// One axis: what it spans and where it is marked. Always finite, with `low < high`.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Lower end, in the axis' own scale (the logarithm where logarithmic).
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Marks, ascending, with their labels.
    pub ticks: Vec<(f64, String)>,
    /// Whether `low` is at the right or at the top.
    pub reversed: bool,
}

/// Largest size of a number that is plotted; greater ones are left out like those that are not
/// finite.
pub const LARGEST: f64 = 1.0e30;

/// Whether `value` can be plotted.
pub fn plottable(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Place of `x` on a logarithmic axis to the base 10; `None` where it has none.
pub fn log_place(x: f64) -> Option<f64> {
    (x >= 1.0e-30 && plottable(x)).then(|| x.log10())
}

impl Axis {
    /// A linear axis over all of `values` that can be plotted, with some room; 0..1 without any.
    pub fn over(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = bounds(values).unwrap_or((0.0, 1.0));
        let (spread, size) = (high - low, low.abs().max(high.abs()));
        let flat = spread <= 1.0e-9 * size || spread < 1.0e-12;
        let room = if flat { (0.05 * size).max(0.5) } else { 0.05 * spread };
        Self::linear(low - room, high + room)
    }

    /// A linear axis from `low` to `high`, which have to be in this order.
    pub fn linear(low: f64, high: f64) -> Self {
        Self { low, high, ticks: linear_ticks(low, high, 8), reversed: false }
    }

    /// A logarithmic axis over all of `values` (not logarithms) that can be plotted, with some
    /// room; 1..10 without any.
    pub fn logarithmic(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = bounds(values.filter_map(log_place)).unwrap_or((0.0, 1.0));
        let room = (0.05 * (high - low)).max(0.05);
        let (low, high) = (low - room, high + room);
        Self { low, high, ticks: log_ticks(low, high), reversed: false }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first_px, last_px): (i32, i32)) -> i32 {
        let share = (value - self.low) / (self.high - self.low);
        let share = if self.reversed { 1.0 - share } else { share }.clamp(-1.0, 2.0);
        first_px + (share * f64::from(last_px - first_px)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.iter().map(|tick| tick.0).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.iter().find(|tick| tick.0 == *value);
        tick.map_or_else(String::new, |tick| tick.1.clone())
    }
}

fn bounds(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| plottable(*value)).fold(None, |known, value| match known {
        None => Some((value, value)),
        Some((low, high)) => Some((low.min(value), high.max(value))),
    })
}

/// Multiples of 1, 2 or 5 times a power of ten in `low..=high`, about `wanted` of them.
fn linear_ticks(low: f64, high: f64, wanted: u32) -> Vec<(f64, String)> {
    let rough = (high - low) / f64::from(wanted);
    let exponent = rough.log10().floor() as i32;
    let decade = 10.0_f64.powi(exponent);
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * decade >= rough).unwrap_or(10.0);
    let step = factor * decade;
    let first = (low / step).ceil();
    let decimals = usize::try_from(-exponent - i32::from(factor == 10.0)).unwrap_or(0);
    let ticks = (0..=2 * wanted).map(|index| (first + f64::from(index)) * step).filter(|tick| *tick <= high);
    ticks.map(|tick| (tick, number(tick, decimals))).collect()
}

/// `value` with so many decimals, or as a power of ten where that would be long.
fn number(value: f64, decimals: usize) -> String {
    if decimals > 4 || value.abs() >= 1.0e6 {
        return if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") };
    }
    let text = format!("{value:.decimals$}");
    if text.trim_start_matches('-').chars().all(|digit| matches!(digit, '0' | '.')) {
        return "0".to_owned();
    }
    text
}

/// 1, 2 and 5 times powers of ten; powers alone over many decades, and every few of them over very
/// many.
fn log_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let factors: &[f64] = if high - low < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let every = (((high - low) / 10.0).ceil() as i32).max(1);
    let decades = (low.floor() as i32..=high.ceil() as i32).filter(|exponent| exponent.rem_euclid(every) == 0);
    let values = decades.flat_map(|exponent| factors.iter().map(move |factor| (exponent, factor)));
    let ticks = values.map(|(exponent, factor)| {
        let value = factor * 10.0_f64.powi(exponent);
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        (factor.log10() + f64::from(exponent), number(value, decimals))
    });
    let ticks: Vec<_> = ticks.filter(|tick| tick.0 >= low && tick.0 <= high).collect();
    if ticks.len() > 1 {
        return ticks;
    }
    let linear = linear_ticks(10.0_f64.powf(low), 10.0_f64.powf(high), 8).into_iter();
    linear.map(|(value, label)| (value.log10(), label)).filter(|tick| tick.0 >= low && tick.0 <= high).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|tick| tick.1.as_str()).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(labels(&Axis::linear(0.0, 1.0)), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&Axis::linear(-3.0, 100.0)), ["0", "20", "40", "60", "80", "100"]);
        assert_eq!(labels(&Axis::linear(1.51, 1.56)), ["1.51", "1.52", "1.53", "1.54", "1.55", "1.56"]);
        assert_eq!(
            labels(&Axis::linear(-6.0e9, 6.0e9)),
            ["-6.0e9", "-4.0e9", "-2.0e9", "0", "2.0e9", "4.0e9", "6.0e9"]
        );
        assert_eq!(labels(&Axis::logarithmic([25.0, 1000.0].into_iter())), ["50", "100", "200", "500", "1000"]);
    }

    #[test]
    fn values_that_cannot_be_plotted_do_not_spoil_the_range() {
        let axis = Axis::over([f64::NAN, 3.0, f64::INFINITY, 5.0].into_iter());
        assert!(axis.low > 2.5 && axis.high < 5.5);
        let axis = Axis::over(std::iter::empty());
        assert!(axis.low < 0.0 && axis.high > 1.0);
        assert!(log_place(0.0).is_none() && log_place(f64::NAN).is_none());
    }

    proptest! {
        #[test]
        fn axes_have_width_and_few_ticks_inside(values in prop::collection::vec(any::<f64>(), 0..5), log: bool) {
            let values = values.into_iter();
            let axis = if log { Axis::logarithmic(values) } else { Axis::over(values) };
            prop_assert!(axis.low < axis.high && axis.low.is_finite() && axis.high.is_finite());
            prop_assert!((1..=20).contains(&axis.ticks.len()), "{:?}", axis);
            prop_assert!(axis.ticks.iter().all(|tick| tick.0 >= axis.low && tick.0 <= axis.high));
        }
    }
}
