use super::*;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::tracking::{FilterName, Tracked, TrackingOptions, track};
use crate::cyclic::turns::least_angle;
use crate::cyclic::{AngleRow, AngleTable, CyclicModel};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use sinew_core::cyclic::{
    AngleMeasurement, CoupledFilter, CycleStart, Deviation, KalmanFilter, KalmanOptions, ModelParts, MotionModel,
};
use sinew_core::numeric::semi_definite::DIAGONAL_EXCESS;

const NOISE: f64 = 0.05;
const ACCELERATION: [f32; 2] = [2.0e-3, -1.0e-3];
const COVARIANCE: [f32; 3] = [4.0e-5, 1.0e-5, 3.0e-5];

/// The same acceleration at every position: then the paper's filter is linear.
fn linear_model(work: impl FnOnce(&MotionModel<'_>)) {
    let (acceleration, covariance) = (ACCELERATION.repeat(5), COVARIANCE.repeat(5));
    let model = MotionModel::new(ModelParts {
        angle_count: 2,
        mean_acceleration: &acceleration,
        acceleration_covariance: &covariance,
        mean_pose_rad: &[0.0; 10],
        mean_velocity: &[0.0; 10],
        turns_per_cycle: &[0, 0],
        mean_duration_frames: 4.0,
        rate_hz: 60.0,
        deviation: Deviation::default(),
    });
    work(&model.unwrap());
}

/// F, the mean's shift and Q of a step of parts of at most a frame: part by part, by cyclic (6) to
/// (9).
fn dense_step(step: f64) -> (DMatrix<f64>, DVector<f64>, DMatrix<f64>) {
    let k = 5.0 / 4.0_f64;
    let (mut f, mut shift, mut q) = (DMatrix::identity(4, 4), DVector::zeros(4), DMatrix::zeros(4, 4));
    let mut left = step;
    while left > 1.0e-6 {
        let h = left.min(1.0);
        left -= h;
        let mut part = DMatrix::identity(4, 4);
        part[(0, 2)] = h;
        part[(1, 3)] = h;
        let reach = DMatrix::from_row_slice(4, 2, &[0.5 * h * h, 0.0, 0.0, 0.5 * h * h, h, 0.0, 0.0, h]);
        let [a, b, c] = COVARIANCE.map(f64::from);
        let excess = 1.0 + f64::from(DIAGONAL_EXCESS);
        let sigma = DMatrix::from_row_slice(2, 2, &[excess * a, b, b, excess * c]) * (k.powi(4) / h);
        let mean = DVector::from_vec(ACCELERATION.map(|value| f64::from(value) * k * k).to_vec());
        f = &part * f;
        shift = &part * shift + &reach * mean;
        q = &part * q * part.transpose() + &reach * sigma * reach.transpose();
    }
    (f, shift, q)
}

/// `paper` forward and back against the joint Gaussian of all states given all measurements, gaps
/// and parts of frames included.
#[test]
fn the_smoothed_paper_filter_is_the_joint_posterior() {
    let steps = [1.0, 1.0, 2.5, 1.0, 0.25, 3.0, 1.0, 1.0, 1.0, 1.5];
    let seen = |k: usize| {
        let angle = |i: usize| 0.3 + 0.02 * k as f32 + 0.1 * ((3 * k + 5 * i) as f32).sin();
        [(k != 4 && k != 5).then(|| angle(0)), (!k.is_multiple_of(3)).then(|| angle(1))]
    };
    linear_model(|model| {
        let start = CycleStart::standard(model, &[Some(0.3), Some(0.2)], Some(0.0), None).unwrap();
        let options = KalmanOptions::default();
        let mut filter = KalmanFilter::<2>::new(model, &options, &start).unwrap();
        let mut states = vec![KalmanState { filter, options }];
        let mut taken = Vec::new();
        let size = 4 * (steps.len() + 1);
        // All states before any measurement after the first, then given the rows `h` of them.
        let (mut mean, mut joint) = (DVector::<f64>::zeros(size), DMatrix::<f64>::zeros(size, size));
        mean.rows_mut(0, 2).copy_from_slice(&[0.3_f32, 0.2].map(f64::from));
        joint.view_mut((0, 0), (4, 4)).fill_diagonal(1.0e-4);
        let mut rows = Vec::new();
        for (k, step) in steps.into_iter().enumerate() {
            let measurement = AngleMeasurement::new(&seen(k + 1), NOISE as f32).unwrap().after(step as f32).unwrap();
            filter.step(model, &options, &measurement);
            states.push(KalmanState { filter, options });
            taken.push(measurement);
            let (f, shift, q) = dense_step(step);
            let (old, new) = (4 * k, 4 * k + 4);
            let moved = &f * mean.rows(old, 4) + shift;
            mean.rows_mut(new, 4).copy_from(&moved);
            let with_before = &f * joint.view((old, 0), (4, new));
            joint.view_mut((new, 0), (4, new)).copy_from(&with_before);
            joint.view_mut((0, new), (new, 4)).copy_from(&with_before.transpose());
            let own = &f * joint.view((old, new), (4, 4)) + q;
            joint.view_mut((new, new), (4, 4)).copy_from(&own);
            rows.extend((0..2).filter_map(|i| Some((new + i, f64::from(seen(k + 1)[i]?)))));
        }
        let with_seen = DMatrix::from_fn(size, rows.len(), |i, j| joint[(i, rows[j].0)]);
        let mut innovation = DMatrix::from_fn(rows.len(), rows.len(), |i, j| joint[(rows[i].0, rows[j].0)]);
        innovation += DMatrix::identity(rows.len(), rows.len()) * NOISE * NOISE;
        let gain = &with_seen * innovation.try_inverse().unwrap();
        let off = DVector::from_fn(rows.len(), |i, _| rows[i].1 - mean[rows[i].0]);
        let (mean, joint) = (mean + &gain * off, &joint - gain * with_seen.transpose());
        for (k, found) in backward(model, &states, &taken).into_iter().flatten().enumerate() {
            for i in 0..2 {
                let (wanted, variance) = (mean[4 * k + i], joint[(4 * k + i, 4 * k + i)]);
                assert!(
                    (found.angles_rad[i] - wanted).abs() < 2.0e-6,
                    "{k} {i}: {} is not {wanted}",
                    found.angles_rad[i]
                );
                let ratio = found.angle_variance_rad2[i] / variance;
                assert!((ratio - 1.0).abs() < 1.0e-5, "{k} {i}: variance times {ratio}");
            }
        }
    });
}

/// The shipped walk at 60 cycles a minute. Frame f is at f / 60 of a cycle and `jump` of a cycle
/// further from frame `at` on.
fn walk(frames: u64, at: u64, jump: f64) -> AngleTable {
    let model = CyclicModel::from_option("walking").unwrap();
    let rows = (0..frames).map(|frame| {
        let position = frame as f64 / 60.0 + if frame >= at { jump } else { 0.0 };
        let pose = model.view().mean_pose_rad::<ANGLES>(model.view().point(position.fract() as f32));
        AngleRow { frame, angles_rad: pose.map(|angle| Some(f64::from(angle))), extra: Vec::new() }
    });
    AngleTable::new(rows.collect(), Vec::new()).unwrap()
}

fn tracked(table: &AngleTable, filter: FilterName, smooth: bool, rate_hz: f64) -> Tracked {
    let model = CyclicModel::from_option("walking").unwrap();
    let options = TrackingOptions { filter, smooth, rate_hz: Some(rate_hz), ..TrackingOptions::default() };
    track(table, &model, &options).unwrap()
}

fn phase_error(tracked: &Tracked, frame: usize, truth: f64) -> f64 {
    let off = f64::from(tracked.frames[frame].estimate.cycle_position) - truth;
    (off - off.round()).abs()
}

/// Likelihood, flags, rows and the last estimate are those of the forward pass.
#[test]
fn what_looks_back_only_stays() {
    let noisy = walk(150, 150, 0.0).with_noise(0.1, 3);
    for filter in [FilterName::Coupled, FilterName::Paper, FilterName::PaperCut] {
        let [forward, back] = [false, true].map(|smooth| tracked(&noisy, filter, smooth, 60.0));
        assert_ne!(forward, back);
        // The first row's forward answer is the measurement itself.
        for (f, b) in forward.frames.iter().zip(&back.frames).skip(1) {
            assert_eq!((f.frame, f.estimate.log_likelihood), (b.frame, b.estimate.log_likelihood));
            assert_eq!(f.estimate.outlier, b.estimate.outlier);
            assert!(b.estimate.cycle_position_variance <= 1.000_01 * f.estimate.cycle_position_variance);
            assert!(b.estimate.cycle_velocity_variance <= 1.000_01 * f.estimate.cycle_velocity_variance);
        }
        let [f, b] = [&forward, &back].map(|run| run.frames.last().unwrap());
        for i in 0..ANGLES {
            assert!((f.angles_rad[i] - b.angles_rad[i]).abs() < 1.0e-5, "{filter:?} {i}");
            assert!((f.estimate.angle_variance_rad2[i] / b.estimate.angle_variance_rad2[i] - 1.0).abs() < 1.0e-3);
        }
        assert!(f64::from(back.frames[0].estimate.angles_rad[0]).is_finite() && back.frames[0].cycles == 0.0);
    }
}

/// After five seconds without a measurement the position is searched for anew. What comes after
/// then says nothing about what was before: those frames are answered to the bit as if the
/// recording ended there.
#[test]
fn a_position_found_anew_does_not_drag_the_frames_before_it() {
    let mut rows = walk(550, 400, 0.4).with_noise(0.05, 9).rows().to_vec();
    for row in &mut rows[100..400] {
        row.angles_rad = [None; ANGLES];
    }
    let run = |rows: &[AngleRow]| {
        let table = AngleTable::new(rows.to_vec(), Vec::new()).unwrap();
        tracked(&table, FilterName::Coupled, true, 60.0)
    };
    let (back, ended) = (run(&rows), run(&rows[..400]));
    assert_eq!(back.frames[..400], ended.frames[..]);
    // The place in the cycle is found to a fifteenth at once, and better in a quarter second.
    for (frames, jump) in [(10..100, 0.0), (415..550, 0.4)] {
        for frame in frames {
            let error = phase_error(&back, frame, frame as f64 / 60.0 + jump);
            assert!(error < 0.04, "frame {frame}: {error}");
        }
    }
}

/// The place that wins later is that of the frames since its hypothesis began.
#[test]
fn a_place_that_wins_later_is_taken_back_to_where_it_began() {
    let off = |smooth| -> usize {
        let of_seed = |seed| {
            let run = tracked(&walk(240, 100, 0.5).with_noise(0.7, seed), FilterName::Coupled, smooth, 60.0);
            (100..240).filter(|frame| phase_error(&run, *frame, *frame as f64 / 60.0 + 0.5) > 0.1).count()
        };
        (1..=20).map(of_seed).sum()
    };
    let [forward, back] = [false, true].map(off);
    assert!(back > 0 && 10 * back < 9 * forward, "{back} instead of {forward} frames are off");
}

/// Across a second without a measurement the whole recording knows more than what came before.
#[test]
fn a_gap_is_bridged_from_both_sides() {
    let truth = walk(240, 240, 0.0);
    let mut rows = truth.with_noise(0.1, 4).rows().to_vec();
    for row in &mut rows[100..160] {
        row.angles_rad = [None; ANGLES];
    }
    let gaps = AngleTable::new(rows.clone(), Vec::new()).unwrap();
    let error = |run: &Tracked| {
        let sum = |frame: usize| -> f64 {
            let truth = &truth.rows()[frame].angles_rad;
            (0..ANGLES).map(|i| least_angle(run.frames[frame].angles_rad[i] - truth[i].unwrap()).abs()).sum()
        };
        (100..160).map(sum).sum::<f64>() / (60 * ANGLES) as f64
    };
    for (filter, share) in [(FilterName::Coupled, 0.9), (FilterName::Paper, 0.7)] {
        let [forward, back] = [false, true].map(|smooth| error(&tracked(&gaps, filter, smooth, 60.0)));
        assert!(back > 0.0 && back < share * forward, "{filter:?}: {back} beside {forward}");
    }
    // Frame numbers that are left out are the same gap.
    rows.retain(|row| !(100..160).contains(&row.frame));
    let skipped = tracked(&AngleTable::new(rows, Vec::new()).unwrap(), FilterName::Coupled, true, 60.0);
    let whole = tracked(&gaps, FilterName::Coupled, true, 60.0);
    for (a, b) in [(99, 99), (100, 160), (179, 239)] {
        for i in 0..ANGLES {
            let off = skipped.frames[a].angles_rad[i] - whole.frames[b].angles_rad[i];
            assert!(off.abs() < 2.0e-3, "frame {b}, angle {i}: {off}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    /// Any pattern of gaps and rates: finite, on the circle; of the paper's filters no surer
    /// without the later frames than with them. `coupled` may look back along a hypothesis that
    /// won later, and knew less.
    #[test]
    fn it_stays_sound(seed in 0_u64..1000, sigma in 0.02_f64..1.5, drop in 1_u64..9, slow in 1_u64..3) {
        let noisy = walk(120, 80, 0.3).with_noise(sigma, seed);
        let rows = noisy.rows().iter().filter(|row| row.frame == 0 || !(row.frame * seed).is_multiple_of(drop + 1)).cloned();
        let table = AngleTable::new(rows.collect(), Vec::new()).unwrap();
        for filter in [FilterName::Coupled, FilterName::Paper, FilterName::PaperCut] {
            let [forward, back] = [false, true].map(|smooth| tracked(&table, filter, smooth, 60.0 / slow as f64));
            for (f, b) in forward.frames.iter().zip(&back.frames).skip(1) {
                let (one, other) = (&f.estimate, &b.estimate);
                prop_assert!((0.0..=1.0).contains(&other.cycle_position));
                prop_assert!(other.angle_variance_rad2.iter().all(|variance| variance.is_finite() && *variance > 0.0));
                prop_assert!(b.angles_rad.iter().all(|angle| angle.is_finite()));
                for variance in [other.cycle_position_variance, other.cycle_velocity_variance] {
                    prop_assert!(variance.is_finite() && variance >= 0.0);
                }
                if filter != FilterName::Coupled {
                    prop_assert!(other.cycle_position_variance <= 1.000_1 * one.cycle_position_variance);
                    prop_assert!(other.cycle_velocity_variance <= 1.000_1 * one.cycle_velocity_variance);
                    for i in 0..ANGLES {
                        prop_assert!(other.angle_variance_rad2[i] <= 1.000_1 * one.angle_variance_rad2[i]);
                    }
                }
            }
        }
    }

    /// As long as the hypothesis that leads at the end has led, `coupled` is no surer of the cycle
    /// without the later frames than with them.
    #[test]
    fn the_last_leader_knows_more_later(seed in 0_u64..1000, sigma in 0.02_f32..1.5) {
        let model = CyclicModel::from_option("walking").unwrap();
        let model = model.view();
        let noisy = walk(120, 80, 0.3).with_noise(f64::from(sigma), seed);
        let mut measurements = noisy.rows().iter().map(|row| {
            AngleMeasurement::<ANGLES>::new(&row.angles_rad.map(|angle| angle.map(|angle| angle as f32)), sigma).unwrap()
        });
        let mut filter = CoupledFilter::new(&model, &measurements.next().unwrap(), None, None).unwrap();
        let measurements: Vec<_> = measurements.collect();
        let mut states = vec![CoupledState(filter)];
        states.extend(measurements.iter().map(|measurement| {
            filter.step(&model, measurement);
            CoupledState(filter)
        }));
        let smoothed = backward(&model, &states, &measurements);
        let mut later = *states.last().unwrap();
        for (state, smoothed) in states.iter().zip(&smoothed).rev() {
            if state.led_as_in(&later) != Some(*state) {
                break;
            }
            later = *state;
            let (cycle, Some(smoothed)) = (state.0.cycle(), smoothed) else { continue };
            prop_assert!(smoothed.cycle_position_variance <= 1.000_1 * f64::from(cycle.position_variance));
            prop_assert!(smoothed.cycle_velocity_variance <= 1.000_1 * f64::from(cycle.velocity_variance));
        }
    }
}
