//! The update by all angles seen against the textbook's, for capacities that fill registers and for
//! those that do not.

use crate::cyclic::AngleMeasurement;
use crate::cyclic::kalman::covariance::KinematicCovariance;
use crate::cyclic::kalman::joint_update::SeenAngles;
use crate::random::Stream;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// A covariance with correlations between all of its numbers; angles vary by a tenth of a radian,
/// velocities by a hundredth.
fn any_covariance<const N: usize>(stream: &mut Stream) -> (KinematicCovariance<N>, DMatrix<f64>) {
    let scale = |i: usize| if i < N { 0.1 } else { 0.01 };
    let factor = DMatrix::from_fn(2 * N, 2 * N, |i, _| scale(i) * f64::from(stream.normal()) / (2.0 * N as f64).sqrt());
    let floor = DMatrix::from_fn(2 * N, 2 * N, |i, j| if i == j { 0.1 * scale(i) * scale(i) } else { 0.0 });
    let dense = &factor * factor.transpose() + floor;
    let mut covariance = KinematicCovariance::diagonal(&[0.0; N], &[0.0; N]);
    for i in 0..N {
        for j in 0..N {
            covariance.angle[i][j] = dense[(i, j)] as f32;
            covariance.cross[i][j] = dense[(i, N + j)] as f32;
            covariance.velocity[i][j] = dense[(N + i, N + j)] as f32;
        }
    }
    (covariance, dense)
}

/// Corrects one and the same state in both ways and asserts that they agree.
fn assert_same_update<const N: usize>(seed: u64, missing: f32, std_rad: f32) {
    let mut stream = Stream::new(seed, N as u64, 0);
    let (mut covariance, before) = any_covariance::<N>(&mut stream);
    let angles_rad: [Option<f32>; N] = core::array::from_fn(|_| {
        let angle_rad = 0.3 * stream.normal();
        (stream.uniform() >= missing).then_some(angle_rad)
    });
    let measurement = AngleMeasurement::new(&angles_rad, std_rad).unwrap();
    let shift = covariance.correct(&SeenAngles::of(&measurement, &[0.0; N], N), false);

    let seen: Vec<usize> = (0..N).filter(|&i| angles_rad[i].is_some()).collect();
    let columns = before.select_columns(&seen);
    let noise = DMatrix::identity(seen.len(), seen.len()) * f64::from(std_rad).powi(2);
    let innovation_covariance = columns.select_rows(&seen) + noise;
    let gain = &columns * innovation_covariance.clone().try_inverse().unwrap();
    let innovation_rad = DVector::from_iterator(seen.len(), angles_rad.iter().flatten().map(|&rad| f64::from(rad)));
    let (mean, after) = (&gain * innovation_rad, &before - &gain * columns.transpose());
    let place = format!("{N} angles, {} seen, seed {seed}, std {std_rad} rad", seen.len());
    for i in 0..2 * N {
        let own = if i < N { shift.angles_rad[i] } else { shift.velocities[i - N] };
        let spread = before[(i, i)].sqrt();
        assert!((f64::from(own) - mean[i]).abs() < 1.0e-4 * spread.max(mean[i].abs()), "mean {i}, {place}");
        for j in 0..2 * N {
            let scale = spread * before[(j, j)].sqrt();
            let difference = f64::from(covariance.entry(i, j)) - after[(i, j)];
            assert!(difference.abs() < 1.0e-5 * scale, "covariance {i}, {j} off by {difference}, {place}");
        }
    }
    let determinant = f64::from(shift.determinant.ln());
    assert!((determinant - innovation_covariance.determinant().ln()).abs() < 1.0e-3, "determinant, {place}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn any_capacity_is_corrected_as_in_the_textbook(
        seed in 0_u64..1_000_000,
        missing in prop_oneof![Just(0.0_f32), 0.0_f32..0.9],
        std_rad in 0.03_f32..1.0,
    ) {
        assert_same_update::<1>(seed, missing, std_rad);
        assert_same_update::<2>(seed, missing, std_rad);
        assert_same_update::<4>(seed, missing, std_rad);
        assert_same_update::<5>(seed, missing, std_rad);
        assert_same_update::<8>(seed, missing, std_rad);
        assert_same_update::<9>(seed, missing, std_rad);
        assert_same_update::<13>(seed, missing, std_rad);
        assert_same_update::<15>(seed, missing, std_rad);
        assert_same_update::<16>(seed, missing, std_rad);
        assert_same_update::<26>(seed, missing, std_rad);
    }
}
