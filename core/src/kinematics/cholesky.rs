//! Cholesky factor of a small symmetric matrix: H = L L'.
//!
//! nalgebra's has no access to the rows of L, which the proposal needs, and can panic.

use crate::math::sqrt;

/// Up to this size entry by entry is faster than column by column; the bits are the same.
const SMALL: usize = 8;

/// Lower triangular factor; entries above the diagonal are zero.
///
/// ```
/// use sinew_core::kinematics::cholesky::Cholesky;
/// use sinew_core::math::ln;
///
/// let factor = Cholesky::new(&[[4.0, 2.0], [2.0, 3.0]]).expect("it is positive definite");
/// let x = factor.solve(&[8.0, 7.0]);
/// assert!(
///     (x[0] - 1.25).abs() < 1e-6 && (x[1] - 1.5).abs() < 1e-6,
///     "4 x + 2 y = 8, 2 x + 3 y = 7"
/// );
/// assert!((factor.log_determinant() - ln(8.0)).abs() < 1e-6);
/// // A density with a saddle has no factor.
/// assert_eq!(Cholesky::new(&[[1.0, 2.0], [2.0, 1.0]]), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cholesky<const N: usize> {
    /// Rows of L.
    pub lower: [[f32; N]; N],
}

impl<const N: usize> Cholesky<N> {
    /// Factors `matrix` (only its lower half is read); `None` where it is not positive definite.
    #[inline(always)]
    #[must_use]
    pub fn new(matrix: &[[f32; N]; N]) -> Option<Self> {
        if N > SMALL {
            return Self::by_columns(matrix, 0);
        }
        let mut lower = [[0.0; N]; N];
        // Bounds that are constants, so that small ones are unrolled.
        for i in 0..N {
            for j in 0..N {
                if j > i {
                    continue;
                }
                let mut sum = matrix[i][j];
                for k in 0..N {
                    if k < j {
                        sum -= lower[i][k] * lower[j][k];
                    }
                }
                if i == j {
                    if !(sum > 0.0 && sum < f32::INFINITY) {
                        return None;
                    }
                    lower[i][i] = sqrt(sum);
                } else {
                    lower[i][j] = sum / lower[j][j];
                }
            }
        }
        Some(Self { lower })
    }

    /// As [`Self::new`], of the part of `matrix` from row and column `first` on; the rest of the
    /// factor is zero.
    ///
    /// Beyond a few rows, a column of L is taken out of all later rows at once: the innermost loop
    /// runs along a row. Rows with a zero factor, those of independent limbs, are left out.
    #[inline(always)]
    #[must_use]
    pub fn from(matrix: &[[f32; N]; N], first: usize) -> Option<Self> {
        if N <= SMALL && first == 0 {
            return Self::new(matrix);
        }
        Self::by_columns(matrix, first)
    }

    fn by_columns(matrix: &[[f32; N]; N], first: usize) -> Option<Self> {
        let mut factor = Self { lower: [[0.0; N]; N] };
        factor.refactor(matrix, first).then_some(factor)
    }

    /// Becomes what [`Self::from`] gives, in place; not where it answers that there is none.
    pub(super) fn refactor(&mut self, matrix: &[[f32; N]; N], first: usize) -> bool {
        self.lower = *matrix;
        self.factor_in_place(first)
    }

    /// As [`Self::refactor`], of the matrix that stands in place of the factor.
    pub(super) fn factor_in_place(&mut self, first: usize) -> bool {
        let lower = &mut self.lower;
        for (i, row) in lower.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                if j < first || j > i {
                    *entry = 0.0;
                }
            }
        }
        for k in first..N {
            if !(lower[k][k] > 0.0 && lower[k][k] < f32::INFINITY) {
                return false;
            }
            let pivot = sqrt(lower[k][k]);
            lower[k][k] = pivot;
            let mut column = [0.0; N];
            for i in k + 1..N {
                lower[i][k] /= pivot;
                column[i] = lower[i][k];
            }
            for i in k + 1..N {
                let factor = column[i];
                if factor == 0.0 {
                    continue;
                }
                for j in k + 1..i + 1 {
                    lower[i][j] -= factor * column[j];
                }
            }
        }
        true
    }

    /// x with H x = `right`.
    #[must_use]
    pub fn solve(&self, right: &[f32; N]) -> [f32; N] {
        let mut x = *right;
        self.substitute(&mut x, 0);
        x
    }

    /// As [`Self::solve`], for a factor [`Self::from`] row `first` on; the entries before it are
    /// zero.
    #[inline(always)]
    #[must_use]
    pub fn solve_from(&self, right: &[f32; N], first: usize) -> [f32; N] {
        if first == 0 {
            return self.solve(right);
        }
        let mut x = *right;
        for entry in x.iter_mut().take(first) {
            *entry = 0.0;
        }
        self.substitute(&mut x, first);
        x
    }

    #[inline(always)]
    fn substitute(&self, x: &mut [f32; N], first: usize) {
        for i in first..N {
            for k in first..i {
                x[i] -= self.lower[i][k] * x[k];
            }
            x[i] /= self.lower[i][i];
        }
        for i in (first..N).rev() {
            for k in i + 1..N {
                x[i] -= self.lower[k][i] * x[k];
            }
            x[i] /= self.lower[i][i];
        }
    }

    /// ln |H|.
    #[must_use]
    pub fn log_determinant(&self) -> f32 {
        self.log_determinant_from(0)
    }

    /// ln |H| of a factor [`Self::from`] row `first` on.
    #[must_use]
    pub fn log_determinant_from(&self, first: usize) -> f32 {
        (first..N).map(|i| 2.0 * crate::math::ln(self.lower[i][i])).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solving_undoes_multiplying(factor in prop::array::uniform3(prop::array::uniform3(-1.0_f32..1.0)),
                                      x in prop::array::uniform3(-1.0_f32..1.0)) {
            let mut matrix = [[0.0; 3]; 3];
            let mut right = [0.0; 3];
            for i in 0..3 {
                for j in 0..3 {
                    matrix[i][j] = (0..3).map(|k| factor[i][k] * factor[j][k]).sum::<f32>() + if i == j { 0.5 } else { 0.0 };
                }
                right[i] = (0..3).map(|j| matrix[i][j] * x[j]).sum();
            }
            let back = Cholesky::new(&matrix).unwrap().solve(&right);
            for i in 0..3 {
                prop_assert!((back[i] - x[i]).abs() < 1.0e-4);
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        assert_eq!(Cholesky::new(&[[1.0, 2.0], [2.0, 1.0]]), None);
        assert_eq!(Cholesky::new(&[[f32::NAN]]), None);
        assert!((Cholesky::new(&[[4.0, 0.0], [0.0, 9.0]]).unwrap().log_determinant() - 36.0_f32.ln()).abs() < 1.0e-6);
    }
}
