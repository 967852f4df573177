//! Mean acceleration and Cholesky factor at each stored position, laid out for steps of several
//! angles at once.
//!
//! The angles are cut into blocks of eight, the last one filled up with zeros. A position holds its
//! mean acceleration, block after block, then its covariance's Cholesky factor in squares of eight
//! rows and eight columns. The squares are those on and below the diagonal, row after row of
//! squares, each by columns.

use crate::cyclic::MotionModel;
use crate::cyclic::model::coupled_model::MAX_ANGLES;
use crate::cyclic::particle::angle_blocks::{AngleBlocks, BLOCK};
use crate::numeric::semi_definite::{packed_index, packed_len, semi_cholesky};

/// Squares of 8 x 8 numbers below and on the diagonal.
const fn squares_of(blocks: usize) -> usize {
    blocks * (blocks + 1) / 2
}

/// Numbers that one position takes.
const fn len_of_position(angles: usize) -> usize {
    let blocks = angles.div_ceil(BLOCK);
    BLOCK * blocks + BLOCK * BLOCK * squares_of(blocks)
}

/// Numbers that [`fill_factors`] writes: 20,800 for 13 angles and 100 positions.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::factors_len;
///
/// // How large the static memory for a model has to be, numbers.
/// assert_eq!(factors_len(&WALKING.model()?), 20_800);
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[must_use]
pub const fn factors_len(model: &MotionModel<'_>) -> usize {
    len_of_position(model.coupled().angle_count()) * model.coupled().position_count()
}

/// Writes mean accelerations and the Cholesky factors of the covariances at all positions, computed
/// once a model.
///
/// `factors` has [`factors_len`] numbers; what does not fit is left out, and particles there move
/// without noise.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{factors_len, fill_factors};
///
/// // Once for each model, before the first particle moves.
/// let model = WALKING.model()?;
/// let mut factors = [0.0; 20_800];
/// assert_eq!(factors.len(), factors_len(&model));
/// fill_factors(&model, &mut factors);
/// assert_eq!(factors[..13], WALKING.mean_acceleration[0], "each position begins with its mean");
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
pub fn fill_factors(model: &MotionModel<'_>, factors: &mut [f32]) {
    let n = model.angle_count();
    let mut packed = [0.0; packed_len(MAX_ANGLES)];
    let covariances = model.parts().acceleration_covariance.chunks_exact(packed_len(n));
    let means = model.parts().mean_acceleration.chunks_exact(n);
    let positions = factors.chunks_exact_mut(len_of_position(n));
    for ((covariance, mean), position) in covariances.zip(means).zip(positions) {
        let Some(factor) = packed.get_mut(..packed_len(n)) else { return };
        semi_cholesky(covariance, n, factor);
        position.fill(0.0);
        for (value, mean) in position.iter_mut().zip(mean) {
            *value = *mean;
        }
        let mut squares = position.iter_mut().skip(BLOCK * n.div_ceil(BLOCK));
        for block in 0..n.div_ceil(BLOCK) {
            for (index, value) in squares.by_ref().take(BLOCK * BLOCK * (block + 1)).enumerate() {
                let (column, row) = (index / BLOCK, block * BLOCK + index % BLOCK);
                if row < n && column <= row {
                    *value = factor.get(packed_index(row, column)).copied().unwrap_or(0.0);
                }
            }
        }
    }
}

/// Where particles have their accelerations from.
pub(super) trait Accelerations<const N: usize> {
    /// `mean_scale` mean + `noise_scale` factor draws: the mean a `fraction` of the way from
    /// position `before` to `after`, the factor that of position `place`. The model has up to `N`
    /// angles; `draws` beyond them are zero.
    fn accelerations(
        &mut self,
        between: (usize, usize, f32),
        place: usize,
        scales: (f32, f32),
        draws: &AngleBlocks,
    ) -> AngleBlocks;
}

/// The table that [`fill_factors`] wrote.
#[derive(Debug, Clone, Copy)]
pub(super) struct ParticleTable<'a> {
    factors: &'a [f32],
    blocks: usize,
    per_position: usize,
}

impl<'a> ParticleTable<'a> {
    pub(super) fn new(model: &MotionModel<'_>, factors: &'a [f32]) -> Self {
        let angles = model.angle_count();
        Self { factors, blocks: angles.div_ceil(BLOCK), per_position: len_of_position(angles) }
    }

    /// Mean acceleration and factor at a stored position.
    #[inline]
    fn position(&self, position: usize) -> (&'a [[f32; BLOCK]], &'a [[f32; BLOCK * BLOCK]]) {
        let from = position * self.per_position;
        let numbers = self.factors.get(from..from + self.per_position).unwrap_or_default();
        let (mean, factor) = numbers.split_at_checked(BLOCK * self.blocks).unwrap_or_default();
        (mean.as_chunks().0, factor.as_chunks().0)
    }
}

impl<const N: usize> Accelerations<N> for ParticleTable<'_> {
    /// The factor's columns beyond the model's angles are not looked at.
    #[inline(always)]
    fn accelerations(
        &mut self,
        (before, after, fraction): (usize, usize, f32),
        place: usize,
        (mean_scale, noise_scale): (f32, f32),
        draws: &AngleBlocks,
    ) -> AngleBlocks {
        let mut accelerations = AngleBlocks::default();
        let means = self.position(before).0.iter().zip(self.position(after).0);
        let mut rest = self.position(place).1;
        for (block, ((a, b), acceleration)) in means.zip(&mut accelerations).enumerate() {
            let Some((squares, others)) = rest.split_at_checked(block + 1) else { break };
            rest = others;
            let mut noise = [0.0; BLOCK];
            let mut products = squares.iter().zip(draws);
            for (square, draw) in products.by_ref().take(const { N / BLOCK }) {
                for column in 0..BLOCK {
                    add_column(&mut noise, square, draw, column);
                }
            }
            // Of the last block of columns the first few are numbers, the rest zeros.
            for (square, draw) in products {
                for column in 0..const { N % BLOCK } {
                    add_column(&mut noise, square, draw, column);
                }
            }
            for row in 0..BLOCK {
                let mean = a[row] + fraction * (b[row] - a[row]);
                acceleration[row] = mean_scale * mean + noise_scale * noise[row];
            }
        }
        accelerations
    }
}

/// Adds the product of one column of a square, stored by columns, and its number of `draw`.
#[inline(always)]
fn add_column(sum: &mut [f32; BLOCK], square: &[f32; BLOCK * BLOCK], draw: &[f32; BLOCK], column: usize) {
    for row in 0..BLOCK {
        sum[row] += square[BLOCK * column + row] * draw[column];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic;
    use crate::numeric::semi_definite::DIAGONAL_EXCESS;

    #[test]
    fn the_table_gives_the_mean_and_the_factor_of_the_model() {
        let table = synthetic::table(4.0e-3, 13);
        let model = table.model().unwrap();
        let mut factors = vec![0.0; factors_len(&model)];
        assert_eq!(factors.len(), 20_800);
        fill_factors(&model, &mut factors);
        let mut particle_table = ParticleTable::new(&model, &factors);
        let mut accelerations = |between, place, scales, draws: &AngleBlocks| {
            Accelerations::<13>::accelerations(&mut particle_table, between, place, scales, draws)
        };
        let still = accelerations((99, 0, 0.25), 0, (2.0, 1.0), &AngleBlocks::default());
        let point = crate::cyclic::CyclePoint { before: 99, after: 0, fraction: 0.25 };
        let mean = model.mean_acceleration::<13>(point);
        assert_eq!(still.as_flattened()[..13], mean.map(|value| 2.0 * value));
        assert_eq!(still.as_flattened()[13..], [0.0; 19]);
        // The sum of the columns' outer products is the covariance.
        let covariance = &model.parts().acceleration_covariance[7 * 91..8 * 91];
        let columns: Vec<AngleBlocks> = (0..13)
            .map(|column| {
                let mut draws = AngleBlocks::default();
                draws[column / BLOCK][column % BLOCK] = 1.0;
                accelerations((7, 8, 0.0), 7, (0.0, 1.0), &draws)
            })
            .collect();
        for i in 0..13 {
            for j in 0..=i {
                let sum: f32 = columns.iter().map(|c| c.as_flattened()[i] * c.as_flattened()[j]).sum();
                let excess = if i == j { 1.0 + DIAGONAL_EXCESS } else { 1.0 };
                let expected = excess * covariance[packed_index(i, j)];
                let scale = (covariance[packed_index(i, i)] * covariance[packed_index(j, j)]).sqrt();
                assert!((sum - expected).abs() < 1.0e-4 * scale, "{i} {j}: {sum} {expected}");
            }
        }
    }
}
