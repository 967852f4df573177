//! Covariance of angles and angular velocities in the block form that the kinematics give it.
//!
//! With the angles first and the velocities second, the matrix A of cyclic (6) is [I, dt I; 0, I]
//! and K of cyclic (8) is [dt^2/2 I; dt I]. The measurement selects angles. So the covariance is
//! three N x N blocks, and no step needs a general matrix product.
//!
//! Rounding: an update subtracts w w' from the covariance. Row and column of the measured angle are
//! set to r / s of their values instead. So a precise measurement after a long gap subtracts no
//! large numbers. The noise has full rank ([`DIAGONAL_EXCESS`]), so that no direction's variance
//! sinks below the resolution of `f32`. A test runs ten million frames with gaps and finds no
//! eigenvalue below zero.

use crate::cyclic::saved_ranges::covariance_bound;
use crate::math::{abs, sqrt};
use crate::numeric::semi_definite::{DIAGONAL_EXCESS, packed_index};

/// Bound on the rounding of an entry, relative to the variances, where numbers nearly cancel or
/// correlations reach one. Chosen: about 32 units of the last place of `f32`.
pub(super) const ROUNDING_MARGIN: f32 = 4.0e-6;
/// Share of the innovation's variance below which a measurement's variance makes differences nearly
/// cancel, as after a gap. Chosen: three of the seven digits of `f32` are lost there.
pub(super) const CANCELLATION_RATIO: f32 = 1.0e-3;
/// Largest variance of an angle, rad^2. Chosen: (4 pi)^2, at which the angle is unknown.
pub(super) const MAX_ANGLE_VARIANCE: f32 = 158.0;
/// Largest variance of an angular velocity, (rad per frame)^2. Chosen: pi^2, half a turn a frame.
pub(super) const MAX_VELOCITY_VARIANCE: f32 = 9.87;

/// Rows and columns of the squares that the velocities' covariance is worked on in: sixteen sums
/// stay in registers.
pub(super) const SQUARE: usize = 4;

/// Symmetric covariance of N angles and N velocities.
///
/// Invariant: the whole is positive semi-definite. The two symmetric blocks are kept as whole rows,
/// which may differ from their columns by rounding; [`Self::entry`] reads one of the two.
///
/// ```
/// use sinew_core::cyclic::kalman::covariance::KinematicCovariance;
///
/// // Two angles known to 0.1 rad, their velocities to 0.02 rad a frame. Angles come first.
/// let covariance = KinematicCovariance::diagonal(&[0.01; 2], &[0.0004; 2]);
/// assert_eq!((covariance.entry(0, 0), covariance.entry(2, 2)), (0.01, 0.0004));
/// assert_eq!(covariance.entry(0, 2), 0.0, "nothing ties an angle to its velocity before the first step");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KinematicCovariance<const N: usize> {
    /// Angle and angle, symmetric.
    pub(super) angle: [[f32; N]; N],
    /// Row: angle, column: velocity.
    pub(super) cross: [[f32; N]; N],
    /// Velocity and velocity, symmetric.
    pub(super) velocity: [[f32; N]; N],
}

impl<const N: usize> KinematicCovariance<N> {
    /// Whether no variance is negative, and no covariance beyond what the variances allow.
    pub(super) fn is_plausible(&self) -> bool {
        let variance = |i: usize| self.entry(i, i);
        (0..2 * N).all(|i| {
            variance(i) >= 0.0 && (0..i).all(|j| abs(self.entry(i, j)) <= covariance_bound([variance(i), variance(j)]))
        })
    }

    /// Independent angles and velocities with the variances given.
    #[must_use]
    pub fn diagonal(angle_variance: &[f32; N], velocity_variance: &[f32; N]) -> Self {
        let mut covariance = Self { angle: [[0.0; N]; N], cross: [[0.0; N]; N], velocity: [[0.0; N]; N] };
        for i in 0..N {
            covariance.angle[i][i] = angle_variance[i];
            covariance.velocity[i][i] = velocity_variance[i];
        }
        covariance
    }

    /// Variance of each angle.
    #[must_use]
    pub fn angle_variances(&self) -> [f32; N] {
        core::array::from_fn(|i| self.angle[i][i])
    }

    /// Variance of each velocity.
    #[must_use]
    pub fn velocity_variances(&self) -> [f32; N] {
        core::array::from_fn(|i| self.velocity[i][i])
    }

    /// Entry (`row`, `column`) of the 2N x 2N matrix, angles first; 0 outside of it.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> f32 {
        match (row < N, column < N) {
            _ if row >= 2 * N || column >= 2 * N => 0.0,
            (true, true) if row < column => self.angle[column][row],
            (true, true) => self.angle[row][column],
            (true, false) => self.cross[row][column - N],
            (false, true) => self.cross[column][row - N],
            (false, false) if row < column => self.velocity[column - N][row - N],
            (false, false) => self.velocity[row - N][column - N],
        }
    }

    /// P <- A P A' + K Sigma K' over `step` frames, cyclic (6) and cyclic (9). Sigma is `scale`
    /// times the packed lower triangle between `before` and `after`.
    ///
    /// Only as many rows of noise are added as the triangles hold.
    #[inline(always)]
    pub(super) fn advance(&mut self, step: f32, before: &[f32], after: &[f32], fraction: f32, scale: f32) {
        // Half of what the velocities gain, of which the other blocks are made up.
        let mut half = [[0.0; N]; N];
        interpolate(&mut half, before, after, fraction, 0.5 * scale * step * step);
        let transposed = transpose(&self.cross);
        let angle_excess = 0.5 * step * step;
        for i in 0..N {
            let (mut angle, mut cross, mut velocity) = (self.angle[i], self.cross[i], self.velocity[i]);
            for j in 0..N {
                let middle = velocity[j] + half[i][j];
                cross[j] += step * middle;
                angle[j] += step * (cross[j] + transposed[i][j]) - angle_excess * half[i][j];
                velocity[j] = middle + half[i][j];
            }
            (self.angle[i], self.cross[i], self.velocity[i]) = (angle, cross, velocity);
        }
    }

    /// Scales row and column of a variance above its limit, which keeps the matrix positive
    /// semi-definite.
    #[inline(always)]
    pub(super) fn saturate(&mut self) {
        for i in 0..N {
            if self.angle[i][i] > MAX_ANGLE_VARIANCE {
                let scale = (1.0 - ROUNDING_MARGIN) * sqrt(MAX_ANGLE_VARIANCE / self.angle[i][i]);
                scale_symmetric(&mut self.angle, i, scale);
                self.cross[i] = self.cross[i].map(|covariance| scale * covariance);
                self.angle[i][i] = MAX_ANGLE_VARIANCE;
            }
            if self.velocity[i][i] > MAX_VELOCITY_VARIANCE {
                let scale = (1.0 - ROUNDING_MARGIN) * sqrt(MAX_VELOCITY_VARIANCE / self.velocity[i][i]);
                scale_symmetric(&mut self.velocity, i, scale);
                for row in &mut self.cross {
                    row[i] *= scale;
                }
                self.velocity[i][i] = MAX_VELOCITY_VARIANCE;
            }
        }
    }
}

/// Fills `matrix`, all zeros, with a symmetric matrix. Its packed lower triangle is `scale` times
/// the interpolation between `before` and `after`, with the diagonal inflated by
/// [`DIAGONAL_EXCESS`]. Zeros stay beyond the triangles.
#[inline(always)]
fn interpolate<const N: usize>(matrix: &mut [[f32; N]; N], before: &[f32], after: &[f32], fraction: f32, scale: f32) {
    let between = |(a, b): (&f32, &f32)| scale * (a + fraction * (b - a));
    let (first, last) = matrix.split_at_mut(half::<N>());
    for (i, row) in first.iter_mut().enumerate() {
        fill_row::<N>(&mut row[..half::<N>()], i, before, after, between);
    }
    for (i, row) in last.iter_mut().enumerate() {
        fill_row::<N>(row, half::<N>() + i, before, after, between);
    }
    mirror(matrix);
}

/// Numbers of a row that come first, whole blocks: the rows of a triangle that begin or end there
/// need the other half alone.
pub(super) const fn half<const N: usize>() -> usize {
    let half = (N / 2).div_ceil(SQUARE) * SQUARE;
    if half < N { half } else { N }
}

/// Row `i` of a lower triangle, of `between` two packed ones.
#[inline(always)]
fn fill_row<const N: usize>(
    row: &mut [f32],
    i: usize,
    before: &[f32],
    after: &[f32],
    between: impl Fn((&f32, &f32)) -> f32,
) {
    let from = packed_index(i, 0);
    let numbers = |values| <[f32]>::get(values, from..).and_then(<[f32]>::first_chunk::<N>);
    // Where the triangles have N rows, N numbers are at hand from there; those beyond the diagonal
    // are written over.
    if let (Some(before), Some(after)) = (numbers(before), numbers(after)) {
        for (j, value) in row.iter_mut().enumerate() {
            *value = between((&before[j], &after[j]));
        }
    } else if let (Some(before), Some(after)) = (before.get(from..=from + i), after.get(from..=from + i)) {
        for (value, pair) in row.iter_mut().zip(before.iter().zip(after)) {
            *value = between(pair);
        }
    }
    row[i] *= 1.0 + DIAGONAL_EXCESS;
}

/// Copies what stands below the diagonal to above it.
#[inline(always)]
pub(super) fn mirror<const N: usize>(matrix: &mut [[f32; N]; N]) {
    for i in 0..N {
        for j in 0..i {
            matrix[j][i] = matrix[i][j];
        }
    }
}

/// Rows as columns, in squares that fit the registers.
#[inline(always)]
fn transpose<const N: usize>(matrix: &[[f32; N]; N]) -> [[f32; N]; N] {
    let mut transposed = [[0.0; N]; N];
    let whole = const { N - N % SQUARE };
    let (rows, _) = matrix.as_chunks::<SQUARE>();
    let (columns, _) = transposed.as_chunks_mut::<SQUARE>();
    for (first, rows) in rows.iter().enumerate() {
        for (other, columns) in columns.iter_mut().enumerate() {
            for (i, row) in (0..SQUARE).zip(rows) {
                let Some(row) = row.as_chunks::<SQUARE>().0.get(other) else { continue };
                for (column, entry) in columns.iter_mut().zip(row) {
                    let Some(column) = column.as_chunks_mut::<SQUARE>().0.get_mut(first) else { continue };
                    column[i] = *entry;
                }
            }
        }
    }
    for i in 0..N {
        for j in whole..N {
            transposed[i][j] = matrix[j][i];
            transposed[j][i] = matrix[i][j];
        }
    }
    transposed
}

/// Scales row and column `index`; the entry on the diagonal is the caller's.
fn scale_symmetric<const N: usize>(matrix: &mut [[f32; N]; N], index: usize, scale: f32) {
    for j in 0..N {
        matrix[index][j] *= scale;
        matrix[j][index] *= scale;
    }
}
