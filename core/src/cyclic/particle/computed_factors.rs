//! Accelerations from a model alone: the Cholesky factor of a position is computed where a particle
//! needs it, so that no table of 83 KB has to lie in memory.

use crate::cyclic::MotionModel;
use crate::cyclic::particle::angle_blocks::AngleBlocks;
use crate::cyclic::particle::factors::Accelerations;
use crate::math::sqrt;
use crate::numeric::semi_definite::{DIAGONAL_EXCESS, VANISHED_PIVOT, packed_index, packed_len};

/// The factor of one position at a time.
#[derive(Debug)]
pub(super) struct ComputedFactors<'m, const N: usize> {
    mean_acceleration: &'m [f32],
    covariances: &'m [f32],
    angle_count: usize,
    /// The position that `factor` belongs to. Resampling keeps particles of one ancestor beside
    /// each other, so that the next one often asks for the same.
    place: usize,
    factor: [[f32; N]; N],
}

impl<'m, const N: usize> ComputedFactors<'m, N> {
    /// Before the first position.
    pub(super) fn new(model: &MotionModel<'m>) -> Self {
        let parts = model.parts();
        Self {
            mean_acceleration: parts.mean_acceleration,
            covariances: parts.acceleration_covariance,
            angle_count: model.angle_count().min(N),
            place: usize::MAX,
            factor: [[0.0; N]; N],
        }
    }

    /// The mean accelerations of a position.
    fn mean(&self, position: usize) -> &[f32] {
        row(self.mean_acceleration, position, self.angle_count)
    }

    /// Computes the factor of `place`, with the operations of
    /// [`crate::numeric::semi_definite::semi_cholesky`] in their order: the same bits.
    // Not inlined: seldom called, and its stack is the loop's no more.
    #[inline(never)]
    fn factorise(&mut self, place: usize) {
        self.place = place;
        let covariance = row(self.covariances, place, packed_len(self.angle_count));
        let entry = |i: usize, j: usize| covariance.get(packed_index(i, j)).copied().unwrap_or(0.0);
        for i in 0..N {
            for j in 0..N {
                if i >= self.angle_count || j > i {
                    self.factor[i][j] = 0.0;
                    continue;
                }
                let mut sum = entry(i, j) * if i == j { 1.0 + DIAGONAL_EXCESS } else { 1.0 };
                for k in 0..N {
                    if k < j {
                        sum -= self.factor[i][k] * self.factor[j][k];
                    }
                }
                self.factor[i][j] = if i == j {
                    if sum > VANISHED_PIVOT * entry(i, i) { sqrt(sum) } else { 0.0 }
                } else {
                    let pivot = self.factor[j][j];
                    if pivot > 0.0 { sum / pivot } else { 0.0 }
                };
            }
        }
    }
}

/// Row `index` of rows of `len` numbers.
fn row(numbers: &[f32], index: usize, len: usize) -> &[f32] {
    let from = index.saturating_mul(len);
    numbers.get(from..from.saturating_add(len)).unwrap_or_default()
}

impl<const N: usize> Accelerations<N> for ComputedFactors<'_, N> {
    fn accelerations(
        &mut self,
        (before, after, fraction): (usize, usize, f32),
        place: usize,
        (mean_scale, noise_scale): (f32, f32),
        draws: &AngleBlocks,
    ) -> AngleBlocks {
        if self.place != place {
            self.factorise(place);
        }
        let mut accelerations = AngleBlocks::default();
        let means = self.mean(before).iter().zip(self.mean(after)).zip(&self.factor);
        for (slot, ((a, b), factor)) in accelerations.as_flattened_mut().iter_mut().zip(means) {
            let mut noise = 0.0;
            for (factor, draw) in factor.iter().zip(draws.as_flattened()) {
                noise += factor * draw;
            }
            let mean = a + fraction * (b - a);
            *slot = mean_scale * mean + noise_scale * noise;
        }
        accelerations
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::particle::factors::{ParticleTable, factors_len, fill_factors};
    use crate::cyclic::synthetic;
    use crate::random::Stream;

    #[test]
    fn it_gives_the_bits_of_the_table() {
        let (narrow, wide) = (synthetic::table(4.0e-3, 9), synthetic::table(4.0e-3, 13));
        for model in [narrow.model().unwrap(), wide.model().unwrap()] {
            let mut factors = vec![0.0; factors_len(&model)];
            fill_factors(&model, &mut factors);
            let mut table = ParticleTable::new(&model, &factors);
            let mut computed = ComputedFactors::<13>::new(&model);
            let mut stream = Stream::new(1, 0, 0);
            for step in 0..200_usize {
                let (before, after) = (step / 2 % 100, (step / 2 + 1) % 100);
                let mut draws = AngleBlocks::default();
                draws.as_flattened_mut().iter_mut().take(13).for_each(|draw| *draw = stream.normal());
                let (place, scales) = (if step % 2 == 0 { before } else { after }, (1.1, 0.9));
                let at = (before, after, stream.uniform());
                let wanted = Accelerations::<13>::accelerations(&mut table, at, place, scales, &draws);
                let found = computed.accelerations(at, place, scales, &draws);
                assert_eq!(found.map(|block| block.map(f32::to_bits)), wanted.map(|block| block.map(f32::to_bits)));
            }
        }
    }
}
