//! The filters' steps in the widest vectors that serve them on the processor at hand, chosen when
//! the program runs.
//!
//! No operation is contracted or taken in another order, so the bits are those of any other
//! processor. Speeds of both ways: `docs/measurements.md`.

use sinew_core::cyclic::particle::moments::ParticleMoments;
use sinew_core::cyclic::particle::propose::{CyclicParticle, ParticleOptions};
use sinew_core::cyclic::particle::{sweep::sweep, weigh::ParticleTarget};
use sinew_core::cyclic::{AngleMeasurement, CoupledFilter, CyclicEstimate, KalmanFilter, KalmanOptions, MotionModel};

/// [`KalmanFilter::step`], with AVX2 on AMD's processors, which `sse4a` identifies: there it takes
/// a fifth off the step. An Intel Xeon took a third longer with it, as rows of 13 numbers then
/// straddle what was just stored.
#[multiversion::multiversion(targets("x86_64+avx2+sse4a"))]
pub fn kalman_step<const N: usize>(
    filter: &mut KalmanFilter<N>,
    model: &MotionModel<'_>,
    options: &KalmanOptions,
    measurement: &AngleMeasurement<N>,
) -> CyclicEstimate<N> {
    filter.step(model, options, measurement)
}

/// [`CoupledFilter::step`], with AVX2 wherever it is.
#[multiversion::multiversion(targets("x86_64+avx2"))]
pub fn coupled_step<const N: usize>(
    filter: &mut CoupledFilter<N>,
    model: &MotionModel<'_>,
    measurement: &AngleMeasurement<N>,
) -> CyclicEstimate<N> {
    filter.step(model, measurement)
}

/// The particle filter's [`sweep`], with AVX2 wherever it is.
#[multiversion::multiversion(targets("x86_64+avx2"))]
pub fn particle_sweep<const N: usize>(
    model: &MotionModel<'_>,
    factors: &[f32],
    options: &ParticleOptions,
    frame: (&ParticleTarget<N>, f32),
    key: (u64, u64, u32),
    particles: &mut [CyclicParticle<N>],
    weights: &mut [f32],
) -> ParticleMoments<N> {
    sweep(model, factors, options, frame, key, particles, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::CyclicModel;
    use sinew_core::cyclic::CycleStart;
    use sinew_core::random::Stream;
    use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;

    /// Two hundred frames of a noisy walk in which every fourth angle is missing.
    #[test]
    fn wide_vectors_give_the_bits_of_the_core() {
        let shipped = CyclicModel::from_option("walking").unwrap();
        let (model, options) = (shipped.view(), KalmanOptions::default());
        let seen = |frame: u16| {
            let mut stream = Stream::new(5, u64::from(frame), 0);
            let position = f32::from(frame) * model.mean_cycle_velocity();
            let pose_rad = model.mean_pose_rad::<HUMAN_ANGLES>(model.point(position));
            let angles = pose_rad.map(|rad| (stream.uniform() < 0.75).then_some(rad + 0.1 * stream.normal()));
            AngleMeasurement::new(&angles, 0.1).unwrap()
        };
        let start = CycleStart::standard(&model, seen(0).angles_rad(), None, None).unwrap();
        let mut kalman = KalmanFilter::new(&model, &options, &start).unwrap();
        let mut coupled = CoupledFilter::new(&model, &seen(0), None, None).unwrap();
        let (mut wide_kalman, mut wide_coupled) = (kalman, coupled);
        for frame in 1..200 {
            let measurement = seen(frame);
            let estimate = kalman.step(&model, &options, &measurement);
            assert_eq!(kalman_step(&mut wide_kalman, &model, &options, &measurement), estimate, "frame {frame}");
            let estimate = coupled.step(&model, &measurement);
            assert_eq!(coupled_step(&mut wide_coupled, &model, &measurement), estimate, "frame {frame}");
        }
        assert_eq!((wide_kalman, wide_coupled), (kalman, coupled));
    }
}
