//! The structured filter against the dense one of the textbooks, and its properties.

use crate::angle::angle_difference;
use crate::cyclic::kalman::filter::KalmanFilter;
use crate::cyclic::{
    AngleMeasurement, CovarianceScaling, CycleStart, CyclicEstimate, GainReach, KalmanOptions, MotionModel, synthetic,
};
use crate::error::Rule;
use crate::numeric::semi_definite::{DIAGONAL_EXCESS, packed_index};
use crate::random::Stream;
use crate::skeleton::stick_figure::HUMAN;
use core::f32::consts::{PI, TAU};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const N: usize = 13;
/// Largest mean distance of the angles of the structured filter from the dense one's, degrees: the
/// last figure of the paper's tables is a tenth of it.
const MAX_MEAN_DISTANCE_DEG: f64 = 1.0e-3;

/// cyclic (1) to cyclic (12) with dense matrices in `f64`, Joseph's form, all angles at once.
struct Dense {
    x: DVector<f64>,
    p: DMatrix<f64>,
}

impl Dense {
    fn new(start: &CycleStart<N>, options: &KalmanOptions) -> Self {
        let mut x = DVector::zeros(2 * N + 2);
        let mut p = DMatrix::zeros(2 * N + 2, 2 * N + 2);
        for i in 0..N {
            x[2 * i] = f64::from(start.angles_rad[i]);
            x[2 * i + 1] = f64::from(start.velocities[i]);
            p[(2 * i, 2 * i)] = f64::from(options.angle_variance);
            p[(2 * i + 1, 2 * i + 1)] = f64::from(options.velocity_variance);
        }
        x[2 * N] = f64::from(start.cycle_position);
        x[2 * N + 1] = f64::from(start.cycle_velocity);
        p[(2 * N, 2 * N)] = f64::from(options.cycle_position_variance);
        p[(2 * N + 1, 2 * N + 1)] = f64::from(options.cycle_velocity_variance);
        Self { x, p }
    }

    fn predict(&mut self, model: &MotionModel<'_>, options: &KalmanOptions) {
        let size = 2 * N + 2;
        let point = model.point(self.x[2 * N].rem_euclid(1.0) as f32);
        let ratio = self.x[2 * N + 1] * model.position_count() as f64;
        let scale = ratio.powi(if options.scaling == CovarianceScaling::Square { 2 } else { 4 });
        let mut packed = [0.0; N * (N + 1) / 2];
        model.acceleration_covariance(point, &mut packed);
        let mut a = DMatrix::identity(size, size);
        let mut k = DMatrix::zeros(size, N + 1);
        let mut noise = DMatrix::zeros(N + 1, N + 1);
        let mut mean = DVector::zeros(N + 1);
        for i in 0..=N {
            a[(2 * i, 2 * i + 1)] = 1.0;
            k[(2 * i, i)] = 0.5;
            k[(2 * i + 1, i)] = 1.0;
        }
        for i in 0..N {
            mean[i] = ratio * ratio * f64::from(model.mean_acceleration::<N>(point)[i]);
            for j in 0..N {
                let excess = if i == j { 1.0 + f64::from(DIAGONAL_EXCESS) } else { 1.0 };
                noise[(i, j)] = excess * scale * f64::from(packed[packed_index(i, j)]);
            }
        }
        noise[(N, N)] = f64::from(options.temporal_acceleration_std).powi(2);
        self.x = &a * &self.x + &k * mean;
        self.p = &a * &self.p * a.transpose() + &k * noise * k.transpose();
    }

    /// The log-likelihood of the measurement.
    fn correct(&mut self, gain: GainReach, measurement: &AngleMeasurement<N>) -> f64 {
        let seen: Vec<usize> = (0..N).filter(|&i| measurement.angle_rad(i).is_some()).collect();
        if seen.is_empty() {
            return 0.0;
        }
        let size = 2 * N + 2;
        let h = DMatrix::from_fn(seen.len(), size, |row, column| f64::from(u8::from(column == 2 * seen[row])));
        let noise = DMatrix::from_fn(seen.len(), seen.len(), |i, j| {
            if i == j { f64::from(measurement.std_rad()[seen[i]]).powi(2) } else { 0.0 }
        });
        let innovation = DVector::from_fn(seen.len(), |row, _| {
            let difference = f64::from(measurement.angle_rad(seen[row]).unwrap()) - self.x[2 * seen[row]];
            difference - std::f64::consts::TAU * (difference / std::f64::consts::TAU).round()
        });
        let s = &h * &self.p * h.transpose() + &noise;
        let inverse = s.clone().try_inverse().unwrap();
        let mut k = &self.p * h.transpose() * &inverse;
        for row in 0..size {
            if row >= 2 * N || (gain == GainReach::AnglesOnly && row % 2 == 1) {
                k.row_mut(row).fill(0.0);
            }
        }
        let rest = DMatrix::identity(size, size) - &k * &h;
        self.x += &k * &innovation;
        self.p = &rest * &self.p * rest.transpose() + &k * noise * k.transpose();
        let squared = (innovation.transpose() * inverse * &innovation)[0];
        -0.5 * (squared + s.determinant().ln() + seen.len() as f64 * std::f64::consts::TAU.ln())
    }
}

fn first_pose() -> [Option<f32>; N] {
    core::array::from_fn(|i| Some(synthetic::mean_angle(i, 0.0)))
}

/// A noisy measurement of the synthetic motion with a share of the angles missing.
fn seen(frame: u32, std: f32, missing: f32, stream: &mut Stream) -> AngleMeasurement<N> {
    let angles = core::array::from_fn(|i| {
        let angle = synthetic::mean_angle(i, frame as f32 / 65.0) + std * stream.normal();
        (stream.uniform() >= missing).then_some(angle)
    });
    AngleMeasurement::new(&angles, std).unwrap()
}

#[test]
fn the_structured_filter_gives_the_numbers_of_the_dense_one() {
    let table = synthetic::table(4.0e-3, 9);
    let model = table.model().unwrap();
    let paper = KalmanOptions::default();
    let square = KalmanOptions { scaling: CovarianceScaling::Square, ..paper };
    for (case, options) in [paper, KalmanOptions::cut(), square].into_iter().enumerate() {
        for std in [0.02, 0.1, 1.0] {
            let mut stream = Stream::new(5, case as u64, 0);
            let start = CycleStart::standard(&model, &first_pose(), Some(0.0), None).unwrap();
            let mut filter = KalmanFilter::new(&model, &options, &start).unwrap();
            let mut dense = Dense::new(&start, &options);
            let mut distance_rad = 0.0;
            for frame in 1..200 {
                let measurement = seen(frame, std, 0.3, &mut stream);
                let estimate = filter.step(&model, &options, &measurement);
                dense.predict(&model, &options);
                let log_likelihood = dense.correct(options.gain, &measurement);
                assert_same(&dense, &filter, &estimate, &format!("case {case}, std {std}, frame {frame}"));
                let difference = f64::from(estimate.log_likelihood) - log_likelihood;
                assert!(difference.abs() < 5.0e-3, "likelihood off by {difference} in case {case}, {std}, {frame}");
                distance_rad += (0..N).map(|i| (unwrapped_rad(&estimate, i) - dense.x[2 * i]).abs()).sum::<f64>();
            }
            let mean_deg = (distance_rad / (199 * N) as f64).to_degrees();
            assert!(mean_deg < MAX_MEAN_DISTANCE_DEG, "{mean_deg} degrees on the mean in case {case}, std {std}");
        }
    }
}

/// An estimate's angle with its whole turns.
fn unwrapped_rad(estimate: &CyclicEstimate<N>, i: usize) -> f64 {
    f64::from(estimate.angles_rad[i]) + f64::from(estimate.turns[i]) * f64::from(TAU)
}

/// Asserts that the structured filter's numbers are the dense one's: angles to 1e-4 rad,
/// covariances to 1 % of the spread.
fn assert_same(dense: &Dense, filter: &KalmanFilter<N>, estimate: &CyclicEstimate<N>, place: &str) {
    let spread = |i: usize| dense.p[(i, i)].sqrt();
    for i in 0..N {
        assert!((unwrapped_rad(estimate, i) - dense.x[2 * i]).abs() < 1.0e-4, "angle {i}: {place}");
        assert!((f64::from(filter.velocities()[i]) - dense.x[2 * i + 1]).abs() < 1.0e-4, "velocity {i}: {place}");
        for j in 0..N {
            let pairs =
                [((i, j), (2 * i, 2 * j)), ((i, N + j), (2 * i, 2 * j + 1)), ((N + i, N + j), (2 * i + 1, 2 * j + 1))];
            for (own, textbook) in pairs {
                let entry = f64::from(filter.covariance().entry(own.0, own.1));
                let scale = spread(textbook.0) * spread(textbook.1);
                assert!((entry - dense.p[textbook]).abs() < 1.0e-2 * scale, "covariance {own:?}: {place}");
            }
        }
    }
    let variance = dense.p[(2 * N, 2 * N)];
    assert!((f64::from(estimate.cycle_position_variance) / variance - 1.0).abs() < 1.0e-4, "phase: {place}");
}

#[test]
fn angles_that_wind_are_followed_across_the_seam_and_counted() {
    let table = synthetic::table(4.0e-3, 9);
    let model = table.model().unwrap();
    let options = KalmanOptions::default();
    let first = first_pose();
    let start = CycleStart::standard(&model, &first, None, None).unwrap();
    let mut filter = KalmanFilter::new(&model, &options, &start).unwrap();
    let mut stream = Stream::new(6, 0, 0);
    let mut previous = start.angles_rad[12];
    for frame in 1..=650 {
        let estimate = filter.step(&model, &options, &seen(frame, 0.05, 0.2, &mut stream));
        let unwrapped = estimate.angles_rad[12] + estimate.turns[12] as f32 * TAU;
        assert!((unwrapped - previous).abs() < 0.5, "frame {frame} jumps from {previous} to {unwrapped}");
        previous = unwrapped;
    }
    assert!((previous - start.angles_rad[12] - 10.0 * TAU).abs() < 0.3, "ten turns, not {}", previous / TAU);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn whole_turns_in_the_measurement_change_nothing(seed in 0_u64..1000, turns in -3_i8..=3) {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let options = KalmanOptions::default();
        let first = first_pose();
        let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
        let mut plain = KalmanFilter::new(&model, &options, &start).unwrap();
        let mut turned = plain;
        let mut stream = Stream::new(seed, 0, 0);
        for frame in 1..40 {
            let measurement = seen(frame, 0.1, 0.3, &mut stream);
            let more = measurement.angles_rad().map(|angle| angle.map(|a| a + f32::from(turns) * TAU));
            let a = plain.step(&model, &options, &measurement);
            let b = turned.step(&model, &options, &AngleMeasurement::new(&more, 0.1).unwrap());
            for i in 0..N {
                prop_assert!(angle_difference(a.angles_rad[i], b.angles_rad[i]).abs() < 1.0e-4);
                prop_assert!(a.angles_rad[i] > -PI && a.angles_rad[i] <= PI);
            }
        }
    }

    #[test]
    fn a_mirrored_person_is_tracked_as_the_mirror_image(seed in 0_u64..1000) {
        // Mirroring the model: angle i becomes pi - angle of the other side, so accelerations
        // change sign.
        let table = synthetic::table(4.0e-3, 9);
        let mut mirrored = table.clone();
        let other: [usize; N] = core::array::from_fn(|i| usize::from(HUMAN.joints()[i + 1].mirror) - 1);
        for l in 0..100 {
            for i in 0..N {
                mirrored.mean_acceleration[l][i] = -table.mean_acceleration[l][other[i]];
                mirrored.mean_velocity[l][i] = -table.mean_velocity[l][other[i]];
                mirrored.mean_pose_rad[l][i] = PI - table.mean_pose_rad[l][other[i]];
                for j in 0..=i {
                    mirrored.acceleration_covariance[l][packed_index(i, j)] =
                        table.acceleration_covariance[l][packed_index(other[i], other[j])];
                }
            }
        }
        mirrored.turns_per_cycle = other.map(|o| -table.turns_per_cycle[o]);
        let (model, mirror_model) = (table.model().unwrap(), mirrored.model().unwrap());
        let options = KalmanOptions::default();
        let mut first = first_pose();
        let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
        let mut filter = KalmanFilter::new(&model, &options, &start).unwrap();
        HUMAN.mirror(&mut first);
        let start = CycleStart::standard(&mirror_model, &first, Some(0.0), None).unwrap();
        let mut mirror_filter = KalmanFilter::new(&mirror_model, &options, &start).unwrap();
        let mut stream = Stream::new(seed, 1, 0);
        for frame in 1..40 {
            let measurement = seen(frame, 0.1, 0.3, &mut stream);
            let mut image = *measurement.angles_rad();
            HUMAN.mirror(&mut image);
            let estimate = filter.step(&model, &options, &measurement);
            let reflected = mirror_filter.step(&mirror_model, &options, &AngleMeasurement::new(&image, 0.1).unwrap());
            let mut expected = estimate.angles_rad.map(Some);
            HUMAN.mirror(&mut expected);
            for i in 0..N {
                prop_assert!(angle_difference(expected[i].unwrap(), reflected.angles_rad[i]).abs() < 1.0e-3);
            }
        }
    }
}

#[test]
fn half_steps_give_the_state_of_whole_steps() {
    let table = synthetic::table(4.0e-3, 9);
    let model = table.model().unwrap();
    let options = KalmanOptions::default();
    let first = first_pose();
    let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
    let mut whole = KalmanFilter::new(&model, &options, &start).unwrap();
    let mut halves = whole;
    let mut long = whole;
    for _ in 0..20 {
        whole.predict(&model, &options, 1.0);
        halves.predict(&model, &options, 0.5);
        halves.predict(&model, &options, 0.5);
    }
    long.predict(&model, &options, 20.0);
    assert_eq!(long, whole, "a long step is made of frames");
    for i in 0..N {
        let ratio = halves.covariance().velocity_variances()[i] / whole.covariance().velocity_variances()[i];
        assert!((ratio - 1.0).abs() < 0.02, "velocity variance ratio {ratio}");
        let ratio = halves.covariance().angle_variances()[i] / whole.covariance().angle_variances()[i];
        assert!((ratio - 1.0).abs() < 0.05, "angle variance ratio {ratio}");
    }
}

#[test]
fn an_outlier_is_flagged_and_kept_out_where_that_is_asked() {
    let table = synthetic::table(4.0e-3, 9);
    let model = table.model().unwrap();
    let options = KalmanOptions { protect_from_outliers: true, ..KalmanOptions::default() };
    let first = first_pose();
    let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
    let mut filter = KalmanFilter::new(&model, &options, &start).unwrap();
    let mut stream = Stream::new(8, 0, 0);
    for frame in 1..60 {
        let estimate = filter.step(&model, &options, &seen(frame, 0.05, 0.0, &mut stream));
        assert!(!estimate.outlier, "frame {frame}");
    }
    let mut predicted = filter;
    predicted.predict(&model, &options, 1.0);
    let wrong = AngleMeasurement::new(&[Some(0.3); N], 0.05).unwrap();
    assert!(filter.step(&model, &options, &wrong).outlier);
    assert_eq!(filter, predicted);
}

#[test]
fn a_figure_with_fewer_angles_leaves_the_rest_of_the_capacity_at_zero() {
    let table = synthetic::table(4.0e-3, 9);
    let model = table.model().unwrap();
    let first = [Some(0.0); 16];
    let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
    let options = KalmanOptions::default();
    let mut filter = KalmanFilter::<16>::new(&model, &options, &start).unwrap();
    let estimate = filter.step(&model, &options, &AngleMeasurement::new(&first, 0.1).unwrap());
    assert!(estimate.angle_variance_rad2[13..].iter().all(|&variance| variance == 0.0));
    let small = CycleStart::standard(&model, &[Some(0.0); 5], Some(0.0), None).unwrap();
    let refused = KalmanFilter::<5>::new(&model, &options, &small).unwrap_err();
    assert_eq!(refused.rule, Rule::Capacity { capacity: 5 });
}
