//! The logarithm of a product, taken once for many factors.

use crate::math::{clamp, ln};

/// ln of a product of positive numbers between 1e-18 and 1e18.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LogProduct {
    product: f32,
    logarithm: f32,
}

impl LogProduct {
    /// The empty product.
    #[inline]
    #[must_use]
    pub(crate) const fn one() -> Self {
        Self { product: 1.0, logarithm: 0.0 }
    }

    /// Multiplies by `factor`.
    #[inline]
    pub(crate) fn multiply(&mut self, factor: f32) {
        self.product *= factor;
        if !(1.0e-18..1.0e18).contains(&self.product) {
            self.flush();
        }
    }

    /// Moves the product into the logarithm, which is rare.
    #[cold]
    #[inline(never)]
    fn flush(&mut self) {
        // Not positive, or no number, where a restored covariance was indefinite.
        self.logarithm += ln(clamp(self.product, f32::MIN_POSITIVE, f32::MAX));
        self.product = 1.0;
    }

    /// Logarithm of the product.
    #[inline]
    #[must_use]
    pub(crate) fn ln(self) -> f32 {
        self.logarithm + ln(self.product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sum_of_logarithms() {
        let (mut product, mut sum) = (LogProduct::one(), 0.0);
        for i in 1..40_u8 {
            let factor = if i % 3 == 0 { 1.0e-9 * f32::from(i) } else { f32::from(i) };
            product.multiply(factor);
            sum += factor.ln();
        }
        assert!((product.ln() - sum).abs() < 1.0e-3, "{} and {sum}", product.ln());
    }

    #[test]
    fn it_is_finite_whatever_the_factors() {
        for factor in [0.0, -1.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            let mut product = LogProduct::one();
            product.multiply(3.0);
            product.multiply(factor);
            assert!(product.ln().is_finite(), "{factor}");
        }
    }
}
