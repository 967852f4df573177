//! Symmetric matrices stored as packed lower triangles: test for a negative eigenvalue, and a
//! factor that may be singular.
//!
//! Entry (i, j) with j <= i stands at i (i + 1) / 2 + j.

use crate::math::{abs, sqrt};

/// Most rows of a matrix here: two angles a joint of a body of 16 joints.
pub const MAX_ROWS: usize = 32;
/// Rows of a matrix that is judged with less stack. Chosen: the angles of the
/// figures.
const FEW_ROWS: usize = 13;

/// Entries of the lower triangle of a matrix with `rows` rows.
///
/// ```
/// use sinew_core::numeric::semi_definite::packed_len;
///
/// // A covariance of 13 angles, 91 numbers instead of 169.
/// const COVARIANCE: [f32; packed_len(13)] = [0.0; packed_len(13)];
/// assert_eq!(COVARIANCE.len(), 91);
/// ```
#[must_use]
pub const fn packed_len(rows: usize) -> usize {
    rows * (rows + 1) / 2
}

/// Place of entry (`row`, `column`) of a symmetric matrix, in either order.
///
/// ```
/// use sinew_core::numeric::semi_definite::packed_index;
///
/// // Row by row: (0,0); (1,0), (1,1); (2,0), (2,1), (2,2).
/// let packed = [4.0, 0.5, 9.0, 0.1, 0.2, 1.0];
/// assert_eq!(packed[packed_index(2, 1)], 0.2);
/// assert_eq!(packed_index(1, 2), packed_index(2, 1));
/// ```
#[inline]
#[must_use]
pub const fn packed_index(row: usize, column: usize) -> usize {
    if row >= column { row * (row + 1) / 2 + column } else { column * (column + 1) / 2 + row }
}

/// Smallest pivot that counts as positive, in a matrix scaled to a diagonal of ones.
///
/// Chosen: ten cycles give a covariance of rank nine. Rounding to `f32` or to six decimals in a
/// file leaves its other eigenvalues within this.
pub const RELATIVE_TOLERANCE: f32 = 1.0e-4;

/// Relative inflation of the diagonal of the acceleration's covariance, cyclic (7).
///
/// Chosen: ten training cycles give a matrix of rank nine, in which four directions never vary.
/// 1e-4 gives them one hundredth of the standard deviation. It changes the tables by less than
/// 0.1 %.
pub const DIAGONAL_EXCESS: f32 = 1.0e-4;

/// Whether the matrix with lower triangle `packed` has no eigenvalue below zero by more than
/// rounding.
///
/// The matrix is scaled to a diagonal of ones and eliminated with the greatest remaining pivot
/// first, which is stable for singular matrices. False for other lengths, for NaN, and beyond
/// [`MAX_ROWS`].
///
/// ```
/// use sinew_core::numeric::semi_definite::is_positive_semi_definite;
///
/// // Two angles with variance 1: a covariance of 0.9 can be, one of 1.1 cannot; one that ties them fully is allowed.
/// assert!(is_positive_semi_definite(&[1.0, 0.9, 1.0], 2));
/// assert!(!is_positive_semi_definite(&[1.0, 1.1, 1.0], 2));
/// assert!(is_positive_semi_definite(&[1.0, 1.0, 1.0], 2));
/// ```
#[must_use]
pub fn is_positive_semi_definite(packed: &[f32], rows: usize) -> bool {
    // On the stack of who begins with a model: a sixth where that suffices.
    if rows <= FEW_ROWS { is_sound::<FEW_ROWS>(packed, rows) } else { is_sound::<MAX_ROWS>(packed, rows) }
}

#[inline(never)]
fn is_sound<const R: usize>(packed: &[f32], rows: usize) -> bool {
    if rows > R || packed.len() != packed_len(rows) {
        return false;
    }
    let mut matrix = [[0.0; R]; R];
    if !correlation(packed, rows, &mut matrix) {
        return false;
    }
    let mut done = [false; R];
    for _ in 0..rows {
        let Some(pivot) = greatest_pivot(&matrix, &done, rows) else { break };
        let Some((row, diagonal)) = matrix.get(pivot).and_then(|row| Some((*row, *row.get(pivot)?))) else { break };
        if diagonal <= RELATIVE_TOLERANCE {
            return rest_is_zero(&matrix, &done, rows);
        }
        if let Some(done) = done.get_mut(pivot) {
            *done = true;
        }
        for (line, _) in matrix.iter_mut().zip(&done).take(rows).filter(|(_, done)| !**done) {
            let factor = line.get(pivot).map_or(0.0, |entry| entry / diagonal);
            for ((entry, above), done) in line.iter_mut().zip(&row).zip(&done).take(rows) {
                if !done {
                    *entry -= factor * above;
                }
            }
        }
    }
    true
}

/// Writes the full matrix scaled to a diagonal of ones; a row of zeros keeps its zeros. False where
/// an entry is out of the question by itself: not finite, a negative variance, a covariance beside
/// a variance of zero.
fn correlation<const R: usize>(packed: &[f32], rows: usize, matrix: &mut [[f32; R]; R]) -> bool {
    let entry = |i: usize, j: usize| packed.get(packed_index(i, j)).copied().unwrap_or(f32::NAN);
    let mut scale = [0.0_f32; R];
    for (i, scale) in scale.iter_mut().enumerate().take(rows) {
        let variance = entry(i, i);
        if !(variance >= 0.0 && variance.is_finite()) {
            return false;
        }
        *scale = if variance > 0.0 { 1.0 / sqrt(variance) } else { 0.0 };
    }
    for (i, (line, of_row)) in matrix.iter_mut().zip(&scale).enumerate().take(rows) {
        for (j, (slot, of_column)) in line.iter_mut().zip(&scale).enumerate().take(rows) {
            let value = entry(i, j);
            if !value.is_finite() || (of_row * of_column == 0.0 && value != 0.0) {
                return false;
            }
            *slot = (value * of_row) * of_column;
        }
    }
    true
}

fn greatest_pivot<const R: usize>(matrix: &[[f32; R]; R], done: &[bool; R], rows: usize) -> Option<usize> {
    let mut best: Option<(usize, f32)> = None;
    for (i, (line, _)) in matrix.iter().zip(done).enumerate().take(rows).filter(|(_, (_, done))| !**done) {
        let diagonal = line.get(i).copied().unwrap_or(0.0);
        if best.is_none_or(|(_, greatest)| diagonal > greatest) {
            best = Some((i, diagonal));
        }
    }
    best.map(|(pivot, _)| pivot)
}

/// Whether all that is left of the elimination is zero up to rounding. Off the diagonal the limit
/// is wider: a pivot of `RELATIVE_TOLERANCE` may stand beside entries of up to that size by
/// rounding of both rows.
fn rest_is_zero<const R: usize>(matrix: &[[f32; R]; R], done: &[bool; R], rows: usize) -> bool {
    matrix.iter().zip(done).enumerate().take(rows).filter(|(_, (_, done))| !**done).all(|(i, (line, _))| {
        let left = line.iter().zip(done).enumerate().take(rows).filter(|(_, (_, done))| !**done);
        left.into_iter().all(|(j, (entry, _))| abs(*entry) <= if i == j { 1.0 } else { 2.0 } * RELATIVE_TOLERANCE)
    })
}

/// Writes the lower triangular L with L L' = the matrix, its diagonal raised by
/// [`DIAGONAL_EXCESS`], into `factor` (both packed). A column whose pivot has vanished all the same
/// becomes zero; nothing is written where a slice is too short.
pub(crate) fn semi_cholesky(packed: &[f32], rows: usize, factor: &mut [f32]) {
    if packed.len() < packed_len(rows) || factor.len() < packed_len(rows) {
        return;
    }
    for i in 0..rows {
        let row = packed_index(i, 0);
        for j in 0..=i {
            let other = packed_index(j, 0);
            let mut sum = packed[row + j] * if i == j { 1.0 + DIAGONAL_EXCESS } else { 1.0 };
            for k in 0..j {
                sum -= factor[row + k] * factor[other + k];
            }
            if i == j {
                let vanished = !(sum > VANISHED_PIVOT * packed[row + i]);
                factor[row + i] = if vanished { 0.0 } else { sqrt(sum) };
            } else {
                let pivot = factor[other + j];
                factor[row + j] = if pivot > 0.0 { sum / pivot } else { 0.0 };
            }
        }
    }
}

/// Share of an angle's variance below which its variance given the angles before counts as
/// rounding. Chosen: about eight units of the last place of `f32`, far below [`DIAGONAL_EXCESS`].
pub(crate) const VANISHED_PIVOT: f32 = 1.0e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Lower triangle of F F' for `rows` rows and `rank` columns, the rows scaled very differently.
    fn product(values: &[f32], rows: usize, rank: usize) -> Vec<f32> {
        let scale = |i: usize| 10.0_f32.powi((i % 4) as i32 - 2);
        let mut packed = vec![0.0; packed_len(rows)];
        for i in 0..rows {
            for j in 0..=i {
                let sum: f64 =
                    (0..rank).map(|k| f64::from(values[i * rank + k]) * f64::from(values[j * rank + k])).sum();
                packed[packed_index(i, j)] = sum as f32 * scale(i) * scale(j);
            }
        }
        packed
    }

    proptest! {
        #[test]
        fn a_singular_covariance_is_accepted_and_its_factor_gives_it_back(
            values in prop::collection::vec(-1.0_f32..1.0, 13 * 9),
        ) {
            let packed = product(&values, 13, 9);
            prop_assert!(is_positive_semi_definite(&packed, 13));
            let mut factor = vec![0.0; packed_len(13)];
            semi_cholesky(&packed, 13, &mut factor);
            for i in 0..13 {
                for j in 0..=i {
                    let back: f32 = (0..=j).map(|k| factor[packed_index(i, k)] * factor[packed_index(j, k)]).sum();
                    let size = (packed[packed_index(i, i)] * packed[packed_index(j, j)]).sqrt();
                    prop_assert!((back - packed[packed_index(i, j)]).abs() <= 2.0e-4 * size, "entry {} {}", i, j);
                }
            }
        }

        #[test]
        fn an_eigenvalue_clearly_below_zero_is_found(values in prop::collection::vec(-1.0_f32..1.0, 6 * 3)) {
            let mut packed = product(&values, 6, 3);
            // The unit vector of coordinate 2 loses more than its own variance.
            let at = packed_index(2, 2);
            packed[at] *= 0.2;
            let correlated = (0..6).any(|j| j != 2 && {
                let covariance = packed[packed_index(2, j)];
                covariance * covariance > 1.5 * packed[at] * packed[packed_index(j, j)]
            });
            prop_assume!(correlated);
            prop_assert!(!is_positive_semi_definite(&packed, 6));
        }
    }

    #[test]
    fn a_matrix_that_is_no_covariance_is_refused() {
        assert!(!is_positive_semi_definite(&[1.0, 2.0, 1.0], 2));
        assert!(!is_positive_semi_definite(&[1.0, 0.5, -1.0], 2));
        assert!(!is_positive_semi_definite(&[0.0, 0.5, 1.0], 2));
        assert!(!is_positive_semi_definite(&[1.0, f32::NAN, 1.0], 2));
        assert!(!is_positive_semi_definite(&[1.0, 0.0], 2));
        assert!(is_positive_semi_definite(&[1.0, 1.0, 1.0], 2), "fully correlated");
        assert!(is_positive_semi_definite(&[0.0, 0.0, 1.0], 2), "one angle that never varies");
    }
}
