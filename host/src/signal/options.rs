//! Which filter a series goes through, and with what numbers.

use crate::error::{Result, ensure_option};
use serde::Serialize;

/// Cut-off of the low-pass filters, hertz. Source: Winter, "Biomechanics and Motor Control of Human
/// Movement", 2009, section 3.4.4, for gait; Sports2D and Pose2Sim have the same default.
pub const DEFAULT_CUTOFF_HZ: f64 = 6.0;
/// Order of both passes together. Source: as [`DEFAULT_CUTOFF_HZ`].
const DEFAULT_ORDER: usize = 4;
/// Highest order. Chosen: nothing steeper is in use for motion, and sections stay well conditioned.
const MAX_ORDER: usize = 16;
/// Highest cut-off as a share of the rate. Chosen: at half the rate the design has no solution, and
/// from 0.45 on a pass changes nothing that can be seen.
pub const MAX_CUTOFF_SHARE: f64 = 0.45;
/// Longest gap that is filled, seconds. Chosen: half a swing phase of walking, six frames at 30 a
/// second. Sports2D fills ten frames.
const DEFAULT_GAP_LIMIT_S: f64 = 0.2;
/// Window of the median, seconds: three frames at 30 a second, which is the kernel of Sports2D.
const DEFAULT_MEDIAN_WINDOW_S: f64 = 0.1;

/// A smoothing filter without lag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum FilterKind {
    /// Butterworth's low-pass filter, forwards and backwards.
    Butterworth {
        /// Frequency at which each pass leaves 1 over root 2, both passes together one half, hertz.
        cutoff_hz: f64,
        /// Order of both passes together; even.
        order: usize,
    },
    /// A weighted mean with Gaussian weights.
    Gaussian {
        /// Frequency at which one half is left, hertz.
        cutoff_hz: f64,
    },
    /// The median of a window.
    Median {
        /// Length of the window, seconds; rounded to an odd number of samples, three at least.
        window_s: f64,
    },
    /// Locally weighted regression by parabolas (Cleveland and Devlin 1988).
    Loess {
        /// Frequency at which one half is left, hertz.
        cutoff_hz: f64,
    },
    /// A cubic smoothing spline whose smoothness generalized cross-validation finds (Craven and
    /// Wahba 1979).
    GcvSpline,
    /// No smoothing.
    None,
}

impl FilterKind {
    /// Butterworth's filter with the usual numbers.
    pub const BUTTERWORTH: Self = Self::Butterworth { cutoff_hz: DEFAULT_CUTOFF_HZ, order: DEFAULT_ORDER };
    /// A Gaussian with the usual cut-off.
    pub const GAUSSIAN: Self = Self::Gaussian { cutoff_hz: DEFAULT_CUTOFF_HZ };
    /// A median of the usual window.
    pub const MEDIAN: Self = Self::Median { window_s: DEFAULT_MEDIAN_WINDOW_S };
    /// Locally weighted regression with the usual cut-off.
    pub const LOESS: Self = Self::Loess { cutoff_hz: DEFAULT_CUTOFF_HZ };

    /// The cut-off; `None` for a filter without one.
    #[must_use]
    pub const fn cutoff_hz(&self) -> Option<f64> {
        match self {
            Self::Butterworth { cutoff_hz, .. } | Self::Gaussian { cutoff_hz } | Self::Loess { cutoff_hz } => {
                Some(*cutoff_hz)
            }
            Self::Median { .. } | Self::GcvSpline | Self::None => None,
        }
    }

    /// The same filter with another cut-off; `None` for a filter without one.
    #[must_use]
    pub const fn with_cutoff_hz(self, cutoff_hz: f64) -> Option<Self> {
        match self {
            Self::Butterworth { order, .. } => Some(Self::Butterworth { cutoff_hz, order }),
            Self::Gaussian { .. } => Some(Self::Gaussian { cutoff_hz }),
            Self::Loess { .. } => Some(Self::Loess { cutoff_hz }),
            Self::Median { .. } | Self::GcvSpline | Self::None => None,
        }
    }
}

/// How a series is filtered.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FilterOptions {
    /// The smoothing filter.
    pub filter: FilterKind,
    /// Reject outliers first, by Hampel's identifier.
    pub hampel: bool,
    /// Longest gap that is filled, seconds; a longer one stays, and its sides are filtered apart.
    pub gap_limit_s: f64,
}

impl Default for FilterOptions {
    fn default() -> Self {
        Self { filter: FilterKind::BUTTERWORTH, hampel: true, gap_limit_s: DEFAULT_GAP_LIMIT_S }
    }
}

impl FilterOptions {
    /// The same, with a cut-off that a series at `rate_hz` can have, and a sentence for the user if
    /// it was lowered. For options that nobody chose; a chosen cut-off is refused instead.
    #[must_use]
    pub fn lowered_for(mut self, rate_hz: f64) -> (Self, Option<String>) {
        let highest_hz = MAX_CUTOFF_SHARE * rate_hz;
        let Some(cutoff_hz) = self.filter.cutoff_hz().filter(|cutoff_hz| *cutoff_hz > highest_hz) else {
            return (self, None);
        };
        self.filter = self.filter.with_cutoff_hz(highest_hz).unwrap_or(self.filter);
        let note = format!(
            "the filter's cut-off is {highest_hz:.3} Hz instead of {cutoff_hz} Hz: {rate_hz} frames a second allow no higher one"
        );
        (self, Some(note))
    }

    /// Refuses numbers that no filter can have.
    ///
    /// # Errors
    /// Names the number, the rule and the remedy.
    pub fn check(&self, rate_hz: f64) -> Result<()> {
        ensure_option!(rate_hz > 0.0 && rate_hz.is_finite(), "a rate of {rate_hz} Hz: it has to be greater than zero");
        let limit_s = self.gap_limit_s;
        ensure_option!(limit_s >= 0.0, "a gap limit of {limit_s} s: it has to be zero or more");
        if let Some(cutoff_hz) = self.filter.cutoff_hz() {
            ensure_option!(cutoff_hz > 0.0, "a cut-off of {cutoff_hz} Hz: it has to be greater than zero");
            let highest_hz = MAX_CUTOFF_SHARE * rate_hz;
            ensure_option!(
                cutoff_hz <= highest_hz * (1.0 + 1.0e-9),
                "a cut-off of {cutoff_hz} Hz is too high for {rate_hz} frames a second; give {highest_hz:.3} or less"
            );
        }
        if let FilterKind::Butterworth { order, .. } = self.filter {
            ensure_option!(
                order.is_multiple_of(2) && (2..=MAX_ORDER).contains(&order),
                "a Butterworth filter of order {order}: give an even number from 2 to {MAX_ORDER}, half for each pass"
            );
        }
        if let FilterKind::Median { window_s } = self.filter {
            ensure_option!(
                window_s > 0.0 && window_s.is_finite(),
                "a median over {window_s} s: it has to be greater than zero"
            );
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_off_beyond_the_rate_is_refused_or_lowered() {
        let options = FilterOptions::default();
        assert!(options.check(30.0).is_ok());
        let message = options.check(12.0).unwrap_err().to_string();
        assert_eq!(message, "a cut-off of 6 Hz is too high for 12 frames a second; give 5.400 or less");
        let (lowered, note) = options.lowered_for(12.0);
        assert!((lowered.filter.cutoff_hz().unwrap() - 5.4).abs() < 1.0e-12 && note.unwrap().contains("5.400 Hz"));
        assert!(lowered.check(12.0).is_ok());
        assert_eq!(options.lowered_for(30.0), (options, None));
    }

    #[test]
    fn numbers_that_no_filter_has_are_refused() {
        let with = |filter: FilterKind| FilterOptions { filter, ..FilterOptions::default() };
        for options in [
            with(FilterKind::Butterworth { cutoff_hz: 6.0, order: 3 }),
            with(FilterKind::Butterworth { cutoff_hz: 6.0, order: 0 }),
            with(FilterKind::Gaussian { cutoff_hz: 0.0 }),
            with(FilterKind::Loess { cutoff_hz: f64::NAN }),
            with(FilterKind::Median { window_s: -1.0 }),
            FilterOptions { gap_limit_s: f64::NAN, ..FilterOptions::default() },
        ] {
            assert!(options.check(60.0).is_err(), "{options:?}");
        }
        assert!(with(FilterKind::None).check(0.0).is_err());
    }
}
