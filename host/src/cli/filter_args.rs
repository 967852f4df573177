//! Options of filters of what was measured.

use crate::error::{Result, ensure_option};
use crate::signal::{FilterKind, FilterOptions};
use clap::{Args, ValueEnum};

/// A filter by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FilterName {
    /// Butterworth's low-pass filter of order 4 without lag.
    Butterworth,
    /// A mean with Gaussian weights.
    Gaussian,
    /// The median of 0.1 s.
    Median,
    /// Locally weighted regression.
    Loess,
    /// A smoothing spline by generalized cross-validation.
    Gcv,
    /// No filter.
    None,
}

/// How measured angles are filtered.
#[derive(Debug, Clone, Args)]
pub struct FilterArgs {
    /// Filter of the anatomical angles.
    #[arg(long, value_enum, default_value_t = FilterName::Butterworth)]
    pub filter: FilterName,
    /// Cut-off of the filters butterworth, gaussian and loess [default: 6].
    #[arg(long, value_name = "HZ")]
    pub cutoff: Option<f64>,
    /// Longest gap that is filled; 0 fills none.
    #[arg(long, value_name = "SECONDS", default_value_t = FilterOptions::default().gap_limit_s)]
    pub gap_limit: f64,
    /// Keep values that stand out from their neighbours.
    #[arg(long)]
    pub no_outlier_rejection: bool,
}

impl FilterArgs {
    /// The filter for a series at `rate_hz`, and a sentence for the user where the default cut-off
    /// was lowered.
    ///
    /// # Errors
    /// Names the option, the rule and the remedy.
    pub fn options(&self, rate_hz: f64) -> Result<(FilterOptions, Option<String>)> {
        let usual = match self.filter {
            FilterName::Butterworth => FilterKind::BUTTERWORTH,
            FilterName::Gaussian => FilterKind::GAUSSIAN,
            FilterName::Median => FilterKind::MEDIAN,
            FilterName::Loess => FilterKind::LOESS,
            FilterName::Gcv => FilterKind::GcvSpline,
            FilterName::None => FilterKind::None,
        };
        let hampel = !self.no_outlier_rejection;
        let options = FilterOptions { filter: usual, hampel, gap_limit_s: self.gap_limit };
        let Some(cutoff_hz) = self.cutoff else {
            let (options, note) = options.lowered_for(rate_hz);
            options.check(rate_hz)?;
            return Ok((options, note));
        };
        let filter = usual.with_cutoff_hz(cutoff_hz);
        ensure_option!(
            filter.is_some(),
            "`--cutoff {cutoff_hz}`: this filter has no cut-off; leave it out, or take butterworth, gaussian or loess"
        );
        let options = FilterOptions { filter: filter.unwrap_or(usual), ..options };
        options.check(rate_hz)?;
        Ok((options, None))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_off_goes_with_some_filters() {
        let args = |filter: FilterName, cutoff: Option<f64>| FilterArgs {
            filter,
            cutoff,
            gap_limit: 0.2,
            no_outlier_rejection: true,
        };
        let (options, note) = args(FilterName::Loess, Some(4.0)).options(30.0).unwrap();
        assert_eq!((options.filter, options.hampel, note), (FilterKind::Loess { cutoff_hz: 4.0 }, false, None));
        assert!(args(FilterName::Gcv, Some(4.0)).options(30.0).unwrap_err().to_string().contains("leave it out"));
        assert!(args(FilterName::Butterworth, Some(20.0)).options(30.0).is_err());
        assert!(args(FilterName::Butterworth, None).options(10.0).unwrap().1.is_some());
    }
}
