//! Log-weights, normalised weights and effective sample size in one type, always consistent.
//!
//! ```
//! use sinew_core::particle::{Degenerate, Weights};
//!
//! let mut weights = Weights::<8>::uniform(2)?;
//! weights.set_log(0, f32::NAN); // counts as zero
//! weights.set_log(1, f32::NEG_INFINITY);
//! // No particle fits: the frame has no information, which is reported.
//! assert_eq!(weights.normalise(), Err(Degenerate));
//! assert_eq!(weights.normalised(), [0.5, 0.5]);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::error::{ParameterError, Rule};
use crate::math::{exp, ln};
use crate::saved_state::{SavedState, StateVisitor};
use heapless::Vec;

/// All weights were zero (or not a number). The set is uniform: the frame had no information.
///
/// ```
/// use sinew_core::particle::{Degenerate, Weights};
///
/// // No particle is near the hand: go on as without a measurement.
/// let mut weights = Weights::<2>::uniform(2)?;
/// weights.set_log(0, f32::NEG_INFINITY);
/// weights.set_log(1, f32::NEG_INFINITY);
/// let has_learned = !matches!(weights.normalise(), Err(Degenerate));
/// assert!(!has_learned && weights.effective_sample_size() == 2.0);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Degenerate;

/// Weights of up to `CAPACITY` particles.
///
/// Invariant after [`Weights::normalise`]: the normalised weights are finite, not negative, and sum
/// to one.
///
/// ```
/// use sinew_core::particle::Weights;
///
/// // Room for fifty particles, three in use. Only differences of log-weights matter, so nothing
/// // underflows.
/// let mut weights = Weights::<50>::uniform(3)?;
/// for (index, log_weight) in [-1000.0, -1000.0, -1000.7].into_iter().enumerate() {
///     weights.set_log(index, log_weight);
/// }
/// let log_evidence = weights.normalise().expect("one of them is above zero");
/// assert!((log_evidence + 1000.18).abs() < 0.01);
/// assert!((weights.normalised()[2] - 0.2).abs() < 0.01);
/// assert!(weights.effective_sample_size() > 2.7, "no need to resample");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Weights<const CAPACITY: usize> {
    log: Vec<f32, CAPACITY>,
    normalised: Vec<f32, CAPACITY>,
}

impl<const CAPACITY: usize> SavedState for Weights<CAPACITY> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.length(&mut self.normalised, 0.0);
        visitor.reals(&mut self.normalised, &(0.0..=1.001));
        let sum: f32 = self.normalised.iter().sum();
        if !(0.99..=1.01).contains(&sum) {
            visitor.refuse();
        }
        // The logarithms are set anew before they are read.
        let _ = self.log.resize(self.normalised.len(), 0.0);
    }
}

impl<const CAPACITY: usize> Weights<CAPACITY> {
    /// `len` equal weights.
    ///
    /// # Errors
    /// `len` has to be from 1 to `CAPACITY`.
    pub fn uniform(len: usize) -> Result<Self, ParameterError> {
        let mut weights = Self::none();
        weights.begin(len)?;
        Ok(weights)
    }

    /// No weights, see [`Self::begin`].
    #[must_use]
    pub const fn none() -> Self {
        Self { log: Vec::new(), normalised: Vec::new() }
    }

    /// Becomes `len` equal weights.
    ///
    /// # Errors
    /// `len` has to be from 1 to `CAPACITY`; the weights are as before then.
    pub fn begin(&mut self, len: usize) -> Result<(), ParameterError> {
        if len == 0 {
            return Err(ParameterError::new("particles", Rule::NotEmpty));
        }
        if len > CAPACITY {
            return Err(ParameterError::new("particles", Rule::Capacity { capacity: CAPACITY }));
        }
        // Both fit.
        let _ = self.log.resize(len, 0.0);
        let _ = self.normalised.resize(len, 1.0);
        self.reset();
        Ok(())
    }

    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.log.len()
    }

    /// Whether there is no particle; never true for a set made by [`Weights::uniform`].
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.log.is_empty()
    }

    /// Makes all weights equal, as after resampling.
    pub fn reset(&mut self) {
        let share = 1.0 / self.len() as f32;
        self.log.fill(0.0);
        self.normalised.fill(share);
    }

    /// Sets the log-weight of particle `index`; an index beyond the end is ignored. Call
    /// [`Weights::normalise`] after.
    pub fn set_log(&mut self, index: usize, log_weight: f32) {
        if let Some(slot) = self.log.get_mut(index) {
            *slot = log_weight;
        }
    }

    /// Log-weights as set, not normalised.
    #[must_use]
    pub fn log(&self) -> &[f32] {
        &self.log
    }

    /// Weights that sum to one.
    #[must_use]
    pub fn normalised(&self) -> &[f32] {
        &self.normalised
    }

    /// Normalises and returns ln of the mean weight, a frame's part of the log evidence.
    ///
    /// # Errors
    /// [`Degenerate`] where no weight is above zero: all weights are equal then. NaN counts as
    /// zero.
    pub fn normalise(&mut self) -> Result<f32, Degenerate> {
        let mut greatest = f32::NEG_INFINITY;
        for &value in &self.log {
            if value > greatest {
                greatest = value;
            }
        }
        if !greatest.is_finite() {
            self.reset();
            return Err(Degenerate);
        }
        let mut sum = 0.0;
        for (weight, &log_weight) in self.normalised.iter_mut().zip(&self.log) {
            *weight = if log_weight.is_nan() { 0.0 } else { exp(log_weight - greatest) };
            sum += *weight;
        }
        for weight in &mut self.normalised {
            *weight /= sum;
        }
        Ok(greatest + ln(sum / self.len() as f32))
    }

    /// 1 / sum of squared weights: from 1 (one particle has it all) to the number of particles.
    #[must_use]
    pub fn effective_sample_size(&self) -> f32 {
        1.0 / self.normalised.iter().map(|w| w * w).sum::<f32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn normalised_weights_sum_to_one(logs in prop::collection::vec(-500.0_f32..500.0, 1..64)) {
            let mut weights = Weights::<64>::uniform(logs.len()).unwrap();
            for (i, &value) in logs.iter().enumerate() {
                weights.set_log(i, value);
            }
            weights.normalise().unwrap();
            let sum: f32 = weights.normalised().iter().sum();
            prop_assert!((sum - 1.0).abs() < 1.0e-5);
            prop_assert!(weights.normalised().iter().all(|w| *w >= 0.0));
            let ess = weights.effective_sample_size();
            prop_assert!(ess >= 0.999 && ess <= logs.len() as f32 * 1.001);
        }
    }

    #[test]
    fn all_weights_zero_is_said_and_leaves_a_uniform_set() {
        let mut weights = Weights::<4>::uniform(4).unwrap();
        for i in 0..4 {
            weights.set_log(i, if i == 1 { f32::NAN } else { f32::NEG_INFINITY });
        }
        assert_eq!(weights.normalise(), Err(Degenerate));
        assert_eq!(weights.normalised(), &[0.25; 4]);
        assert_eq!(weights.effective_sample_size(), 4.0);
    }

    #[test]
    fn the_evidence_is_the_mean_weight() {
        let mut weights = Weights::<2>::uniform(2).unwrap();
        weights.set_log(0, ln(0.3));
        weights.set_log(1, ln(0.5));
        assert!((weights.normalise().unwrap() - ln(0.4)).abs() < 1.0e-6);
    }

    #[test]
    fn zero_and_too_many_particles_are_refused() {
        assert_eq!(Weights::<4>::uniform(0).unwrap_err().rule, Rule::NotEmpty);
        assert_eq!(Weights::<4>::uniform(5).unwrap_err().rule, Rule::Capacity { capacity: 4 });
    }
}
