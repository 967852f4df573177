//! Covariance of angles and angular velocities in the block form that the kinematics of the cyclic paper gives it.
//!
//! With the angles first and the velocities second, A of eq. (6) is [I, dt I; 0, I], K of eq. (8) is [dt^2/2 I; dt I] and
//! the measurement selects angles. So the covariance is three N x N blocks and no step needs a general matrix product.
//!
//! Rounding: an update takes w w' off the covariance. Row and column of the measured angle are set to r / s of what they
//! were instead, so that a precise measurement after a long gap leaves no difference of large numbers; and the noise has
//! full rank ([`DIAGONAL_EXCESS`]), so that no direction's variance sinks below what `f32` resolves. A test runs ten
//! million frames with gaps and finds no eigenvalue below zero.

use super::semi_definite::{DIAGONAL_EXCESS, packed_index};
use crate::math::sqrt;

/// What rounding may do to an entry, relative to the variances, where numbers nearly cancel or correlations reach one.
const MARGIN: f32 = 4.0e-6;
/// A measurement with less than this part of the innovation's variance comes after a gap: differences nearly cancel.
const SEVERE: f32 = 1.0e-3;
/// Greatest variance of an angle, rad^2: (4 pi)^2. Beyond it the angle is unknown, and the squares stay within `f32`.
pub const MAX_ANGLE_VARIANCE: f32 = 158.0;
/// Greatest variance of an angular velocity, (rad per frame)^2: pi^2, half a turn between two frames.
pub const MAX_VELOCITY_VARIANCE: f32 = 9.87;

/// Symmetric covariance of N angles and N velocities.
///
/// Invariants: the angle and the velocity block are symmetric to the bit; the whole is positive semi-definite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KinematicCovariance<const N: usize> {
    /// Angle and angle.
    angle: [[f32; N]; N],
    /// Row: angle, column: velocity.
    cross: [[f32; N]; N],
    /// Velocity and velocity.
    velocity: [[f32; N]; N],
}

/// Column of the state's covariance that a measured angle calls for, scaled by the root of the innovation variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaledColumn<const N: usize> {
    /// Covariances of the angles with the measured one over the root of the innovation variance.
    pub angle: [f32; N],
    /// The same of the velocities.
    pub velocity: [f32; N],
    /// Variance of the innovation: that of the angle plus that of the measurement.
    pub innovation_variance: f32,
    /// 1 over its root.
    pub inverse_std: f32,
    /// Index of the measured angle.
    index: usize,
    /// Part of the covariances with the measured angle that is left after the update, times the root of the innovation
    /// variance: exact where the difference P - w w' would leave rounding only.
    left: f32,
    /// Whether the measurement takes nearly all of the angle's variance away.
    is_severe: bool,
}

impl<const N: usize> KinematicCovariance<N> {
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
            (true, true) => self.angle[row][column],
            (true, false) => self.cross[row][column - N],
            (false, true) => self.cross[column][row - N],
            (false, false) => self.velocity[row - N][column - N],
        }
    }

    /// P <- A P A' + K Sigma K' over `step` frames (eqs. 6 and 9), Sigma being `scale` times the packed lower triangle
    /// between `before` and `after`.
    ///
    /// Only as many rows of noise are added as the triangles hold.
    #[inline]
    pub fn advance(&mut self, step: f32, before: &[f32], after: &[f32], fraction: f32, scale: f32) {
        let square = step * step;
        let (angle_noise, cross_noise, velocity_noise) = (0.25 * square * square, 0.5 * square * step, square);
        for i in 0..N {
            for j in 0..=i {
                let (cross_ij, cross_ji) = (self.cross[i][j], self.cross[j][i]);
                let velocity = self.velocity[i][j];
                let noise = match (before.get(packed_index(i, j)), after.get(packed_index(i, j))) {
                    (Some(&a), Some(&b)) if i == j => (1.0 + DIAGONAL_EXCESS) * scale * (a + fraction * (b - a)),
                    (Some(&a), Some(&b)) => scale * (a + fraction * (b - a)),
                    _ => 0.0,
                };
                let angle = self.angle[i][j] + step * (cross_ij + cross_ji) + square * velocity + angle_noise * noise;
                self.angle[i][j] = angle;
                self.angle[j][i] = angle;
                self.cross[i][j] = cross_ij + step * velocity + cross_noise * noise;
                if i != j {
                    self.cross[j][i] = cross_ji + step * velocity + cross_noise * noise;
                }
                let velocity = velocity + velocity_noise * noise;
                self.velocity[i][j] = velocity;
                self.velocity[j][i] = velocity;
            }
        }
    }

    /// Shrinks what has grown beyond all knowledge in a long gap: row and column of an angle or a velocity are scaled, which
    /// keeps the matrix positive semi-definite.
    #[inline]
    pub fn saturate(&mut self) {
        for i in 0..N {
            if self.angle[i][i] > MAX_ANGLE_VARIANCE {
                let scale = (1.0 - MARGIN) * sqrt(MAX_ANGLE_VARIANCE / self.angle[i][i]);
                for j in 0..N {
                    self.angle[i][j] *= scale;
                    self.angle[j][i] *= scale;
                    self.cross[i][j] *= scale;
                }
                self.angle[i][i] = MAX_ANGLE_VARIANCE;
            }
            if self.velocity[i][i] > MAX_VELOCITY_VARIANCE {
                let scale = (1.0 - MARGIN) * sqrt(MAX_VELOCITY_VARIANCE / self.velocity[i][i]);
                for j in 0..N {
                    self.velocity[i][j] *= scale;
                    self.velocity[j][i] *= scale;
                    self.cross[j][i] *= scale;
                }
                self.velocity[i][i] = MAX_VELOCITY_VARIANCE;
            }
        }
    }

    /// The column that a measurement of angle `index` with variance `noise_variance` uses.
    #[inline]
    #[must_use]
    pub fn column(&self, index: usize, noise_variance: f32) -> ScaledColumn<N> {
        let innovation_variance = self.angle[index][index] + noise_variance;
        let inverse_std = 1.0 / sqrt(innovation_variance);
        ScaledColumn {
            angle: core::array::from_fn(|i| self.angle[index][i] * inverse_std),
            velocity: core::array::from_fn(|i| self.cross[index][i] * inverse_std),
            innovation_variance,
            inverse_std,
            index,
            left: noise_variance * inverse_std,
            is_severe: noise_variance < SEVERE * innovation_variance,
        }
    }

    /// P <- P - w w': the Kalman update of all of the state by one angle.
    #[inline]
    pub fn reduce(&mut self, column: &ScaledColumn<N>) {
        for i in 0..N {
            let (angle, velocity) = (column.angle[i], column.velocity[i]);
            for j in 0..N {
                self.angle[i][j] -= angle * column.angle[j];
                self.cross[i][j] -= angle * column.velocity[j];
                self.velocity[i][j] -= velocity * column.velocity[j];
            }
        }
        self.settle(column);
    }

    /// The update (Joseph's form) by one angle with a gain that moves the angles only: the velocities keep their
    /// covariance.
    #[inline]
    pub fn reduce_angles(&mut self, column: &ScaledColumn<N>) {
        for i in 0..N {
            let angle = column.angle[i];
            for j in 0..N {
                self.angle[i][j] -= angle * column.angle[j];
                self.cross[i][j] -= angle * column.velocity[j];
            }
        }
        self.settle(column);
    }

    /// Sets row and column of the measured angle to r / s of what they were, without a difference.
    #[inline]
    fn settle(&mut self, column: &ScaledColumn<N>) {
        for i in 0..N {
            let angle = column.angle[i] * column.left;
            self.angle[column.index][i] = angle;
            self.angle[i][column.index] = angle;
            self.cross[column.index][i] = column.velocity[i] * column.left;
        }
        if column.is_severe {
            for i in 0..N {
                self.angle[i][i] += MARGIN * column.angle[i] * column.angle[i];
                self.velocity[i][i] += MARGIN * column.velocity[i] * column.velocity[i];
            }
        }
    }
}
