//! Ten million frames of `f32`: the covariances stay symmetric, finite and positive semi-definite.

use nalgebra::DMatrix;
use sinew_core::cyclic::coupled::person::block::PARTS;
use sinew_core::cyclic::model::table::HumanModelTable;
use sinew_core::cyclic::{
    AngleMeasurement, CoupledFilter, CycleStart, CyclicEstimate, KalmanFilter, KalmanOptions, MotionModel,
};
use sinew_core::numeric::semi_definite::{packed_index, packed_len};
use sinew_core::random::Stream;
use sinew_tests::leaves_out_long_tests;

const N: usize = 13;
const POSITIONS: usize = 100;

/// A walk-like model whose covariance has rank nine at every position, as ten training cycles give
/// it.
fn model_table() -> Box<HumanModelTable> {
    let mut table = Box::new(HumanModelTable {
        mean_acceleration: [[0.0; N]; POSITIONS],
        acceleration_covariance: [[0.0; packed_len(N)]; POSITIONS],
        mean_pose_rad: [[0.0; N]; POSITIONS],
        mean_velocity: [[0.0; N]; POSITIONS],
        offset_std_rad: [0.08; N],
        cosine_std_rad: [0.05; N],
        sine_std_rad: [0.05; N],
        rest_std_rad: [0.03; N],
        rest_rate_per_cycle: [6.0; N],
        turns_per_cycle: [0; N],
        mean_duration_frames: 65.0,
        rate_hz: 60.0,
    });
    let tau = std::f32::consts::TAU;
    for position in 0..POSITIONS {
        let phase = tau * position as f32 / POSITIONS as f32;
        let mut stream = Stream::new(3, position as u64 / 10, 0);
        let factor: [[f32; 9]; N] = std::array::from_fn(|_| std::array::from_fn(|_| 7.0e-4 * stream.normal()));
        for i in 0..N {
            let swing = 0.1 + 0.05 * i as f32;
            let rate = tau / POSITIONS as f32;
            table.mean_pose_rad[position][i] = swing * (phase + i as f32).sin();
            table.mean_velocity[position][i] = swing * rate * (phase + i as f32).cos();
            table.mean_acceleration[position][i] = -swing * rate * rate * (phase + i as f32).sin();
            for j in 0..=i {
                let sum: f32 = (0..9).map(|k| factor[i][k] * factor[j][k]).sum();
                table.acceleration_covariance[position][packed_index(i, j)] = sum;
            }
        }
    }
    table
}

/// Asserts the invariants of the covariance, the eigenvalues after scaling to a diagonal of ones.
fn check(filter: &KalmanFilter<N>, step: u32) {
    let entry = |i: usize, j: usize| f64::from(filter.covariance().entry(i, j));
    let scaled = DMatrix::from_fn(2 * N, 2 * N, |i, j| {
        assert!(entry(i, j).is_finite(), "entry {i} {j} at step {step}");
        assert_eq!(entry(i, j), entry(j, i), "entry {i} {j} at step {step}");
        entry(i, j) / (entry(i, i) * entry(j, j)).sqrt()
    });
    let least = scaled.symmetric_eigenvalues().min();
    assert!(least >= 0.0, "eigenvalue {least:e} at step {step}");
}

/// The same for the covariances of `coupled`: that of (c, v), and each angle's given them.
fn check_coupled(filter: &CoupledFilter<N>, step: u32) {
    let cycle = filter.cycle();
    let determinant = f64::from(cycle.position_variance) * f64::from(cycle.velocity_variance)
        - f64::from(cycle.covariance) * f64::from(cycle.covariance);
    assert!(cycle.position_variance > 0.0 && cycle.velocity_variance > 0.0, "{cycle:?} at step {step}");
    let product = f64::from(cycle.position_variance) * f64::from(cycle.velocity_variance);
    assert!(determinant > -1.0e-6 * product, "{cycle:?} at step {step}");
    for (angle, block) in filter.blocks().iter().enumerate() {
        let entry = |i: usize, j: usize| f64::from(block.covariance(i, j));
        let scaled = DMatrix::from_fn(PARTS, PARTS, |i, j| entry(i, j) / (entry(i, i) * entry(j, j)).sqrt());
        assert!(scaled.iter().all(|value| value.is_finite()), "angle {angle} at step {step}");
        // Rounding of single precision about a matrix that is singular: what was measured is known,
        // its parts are not.
        let least = scaled.symmetric_eigenvalues().min();
        assert!(least > -1.0e-5, "angle {angle}: eigenvalue {least:e} at step {step}");
    }
}

/// Frames with all, some or no angles, gaps of up to thousands of frames, and noise from a tenth of
/// a degree to 115. `step` of `filter` takes them, with a `check` now and then.
fn run<F>(
    steps: u32,
    filter: &mut F,
    step: impl Fn(&mut F, &AngleMeasurement<N>) -> CyclicEstimate<N>,
    check: impl Fn(&F, u32),
) {
    let mut stream = Stream::new(1, 0, 0);
    let (mut gap, mut std, mut missing) = (0_u32, 0.1, 0.0);
    for count in 0..steps {
        if count % 500 == 0 {
            std = 0.002 * (stream.uniform() * 6.9).exp();
            missing = stream.uniform();
            gap = if stream.below(4) == 0 { stream.below(5000) } else { gap };
        }
        let measurement = if gap > 0 {
            gap -= 1;
            AngleMeasurement::nothing()
        } else {
            let angles = std::array::from_fn(|_| (stream.uniform() >= missing).then(|| 3.0 * (stream.uniform() - 0.5)));
            AngleMeasurement::new(&angles, std).expect("a sound measurement")
        };
        let estimate = step(filter, &measurement);
        let sound = estimate.angles_rad.iter().all(|a| a.abs() <= std::f32::consts::PI)
            && estimate.log_likelihood.is_finite()
            && estimate.angle_variance_rad2.iter().all(|&v| v > 0.0 && v.is_finite());
        assert!(sound, "step {count}: {estimate:?}");
        if count % 997 == 0 {
            check(filter, count);
        }
    }
}

fn run_kalman(steps: u32, options: &KalmanOptions, model: &MotionModel<'_>) {
    let start = CycleStart::standard(model, &[Some(0.0); N], Some(0.0), None).expect("a sound start");
    let mut filter = KalmanFilter::<N>::new(model, options, &start).expect("a sound filter");
    run(steps, &mut filter, |filter, measurement| filter.step(model, options, measurement), check);
}

fn run_coupled(steps: u32, model: &MotionModel<'_>) {
    let first = AngleMeasurement::new(&[Some(0.0); N], 0.1).expect("a sound measurement");
    let mut filter = CoupledFilter::<N>::new(model, &first, Some(0.0), None).expect("a sound filter");
    run(steps, &mut filter, |filter, measurement| filter.step(model, measurement), check_coupled);
}

#[test]
fn a_hundred_thousand_frames() {
    let table = model_table();
    let model = table.model().expect("a sound model");
    run_kalman(100_000, &KalmanOptions::default(), &model);
    run_kalman(100_000, &KalmanOptions::cut(), &model);
    run_coupled(100_000, &model);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "ten million frames take a release build")]
fn ten_million_frames() {
    if leaves_out_long_tests() {
        return;
    }
    let table = model_table();
    let model = table.model().expect("a sound model");
    run_kalman(10_000_000, &KalmanOptions::default(), &model);
    run_kalman(10_000_000, &KalmanOptions::cut(), &model);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "ten million frames take a release build")]
fn ten_million_frames_of_coupled() {
    if leaves_out_long_tests() {
        return;
    }
    let table = model_table();
    run_coupled(10_000_000, &table.model().expect("a sound model"));
}
