//! Going back over the paper's filters: angles and angular velocities. No measurement moves the
//! cycle in them, so that nothing later bears on it either.

use super::pass::{Link, Smoothable, Smoothed};
use super::recursion::Moments;
use nalgebra::{DMatrix, DVector};
use sinew_core::cyclic::substeps::Substeps;
use sinew_core::cyclic::{AngleMeasurement, CovarianceScaling, GainReach, KalmanFilter, KalmanOptions, MotionModel};
use sinew_core::numeric::semi_definite::{DIAGONAL_EXCESS, packed_index, packed_len};
use std::f64::consts::TAU;

/// `paper` or `paper-cut` after a frame.
///
/// Of `paper-cut` only angles are smoothed, as it corrects only angles: its velocities are the
/// model's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KalmanState<const N: usize> {
    /// The filter.
    pub filter: KalmanFilter<N>,
    /// Its options.
    pub options: KalmanOptions,
}

impl<const N: usize> KalmanState<N> {
    /// Numbers of the state that are smoothed.
    fn size(&self, model: &MotionModel<'_>) -> usize {
        let count = model.angle_count().min(N);
        if self.options.gain == GainReach::Full { 2 * count } else { count }
    }

    /// Angles, then velocities.
    fn mean(&self, model: &MotionModel<'_>) -> DVector<f64> {
        let count = model.angle_count().min(N);
        let all = self.filter.angles_rad()[..count].iter().chain(&self.filter.velocities()[..count]);
        DVector::from_iterator(self.size(model), all.take(self.size(model)).map(|value| f64::from(*value)))
    }

    /// Covariance of all angles and velocities.
    fn whole_covariance(&self, count: usize) -> DMatrix<f64> {
        // The filter's matrix has its velocities from N on.
        let index = |i: usize| if i < count { i } else { N + i - count };
        DMatrix::from_fn(2 * count, 2 * count, |i, j| f64::from(self.filter.covariance().entry(index(i), index(j))))
    }

    /// Noise of a step by cyclic (8) and (9), part by part as the filter takes it, each carried on
    /// to the step's end.
    fn noise(&self, model: &MotionModel<'_>, step_frames: f32) -> DMatrix<f64> {
        let count = model.angle_count().min(N);
        let parts: Vec<f32> = Substeps::of(step_frames).collect();
        let mut cycle = *self.filter.cycle();
        let ratio = f64::from(model.speed_ratio(cycle.velocity));
        let speed_scale = match self.options.scaling {
            CovarianceScaling::FourthPower => ratio.powi(4),
            CovarianceScaling::Square => ratio.powi(2),
        };
        let mut left: f64 = parts.iter().map(|part| f64::from(*part)).sum();
        let mut packed = vec![0.0_f32; packed_len(count)];
        let mut noise = DMatrix::zeros(2 * count, 2 * count);
        for part in parts {
            model.acceleration_covariance(model.point(cycle.position), &mut packed);
            let step = f64::from(part);
            left -= step;
            let (to_angle, to_velocity) = (step * (0.5 * step + left), step);
            for i in 0..count {
                for j in 0..=i {
                    let excess = if i == j { 1.0 + f64::from(DIAGONAL_EXCESS) } else { 1.0 };
                    let variance = excess * speed_scale / step * f64::from(packed[packed_index(i, j)]);
                    for (a, b) in [(i, j), (j, i)].into_iter().take(if i == j { 1 } else { 2 }) {
                        noise[(a, b)] += to_angle * to_angle * variance;
                        noise[(a, count + b)] += to_angle * to_velocity * variance;
                        noise[(count + a, b)] += to_angle * to_velocity * variance;
                        noise[(count + a, count + b)] += to_velocity * to_velocity * variance;
                    }
                }
            }
            cycle.advance(part, 0.0);
        }
        noise
    }
}

impl<const N: usize> Smoothable<N> for KalmanState<N> {
    fn period(&self, model: &MotionModel<'_>, index: usize) -> Option<f64> {
        (index < model.angle_count().min(N)).then_some(TAU)
    }

    fn moments(&self, model: &MotionModel<'_>) -> Moments {
        let size = self.size(model);
        let whole = self.whole_covariance(model.angle_count().min(N));
        Moments { mean: self.mean(model), covariance: whole.view((0, 0), (size, size)).into_owned() }
    }

    fn link(&self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>, _next: &Self) -> Option<Link> {
        let (count, size, step) = (model.angle_count().min(N), self.size(model), measurement.step_frames());
        let covariance = self.whole_covariance(count);
        // Columns of P F' and rows of F P F': each angle takes `step` times its velocity with it.
        let step_frames: f64 = Substeps::of(step).map(f64::from).sum();
        let mut cross = covariance;
        for i in 0..count {
            let velocity = cross.column(count + i) * step_frames;
            let mut angle = cross.column_mut(i);
            angle += velocity;
        }
        let mut predicted = cross.clone();
        for i in 0..count {
            let velocity = predicted.row(count + i) * step_frames;
            let mut angle = predicted.row_mut(i);
            angle += velocity;
        }
        predicted += self.noise(model, step);
        let mut moved = *self;
        moved.filter.predict(model, &self.options, step);
        let part = |matrix: &DMatrix<f64>| matrix.view((0, 0), (size, size)).into_owned();
        Some(Link { predicted_mean: moved.mean(model), cross: part(&cross), predicted_covariance: part(&predicted) })
    }

    fn smoothed(&self, model: &MotionModel<'_>, moments: &Moments) -> Option<Smoothed<N>> {
        let count = model.angle_count().min(N);
        let cycle = self.filter.cycle();
        Some(Smoothed {
            angles_rad: std::array::from_fn(|i| if i < count { moments.mean[i] } else { 0.0 }),
            angle_variance_rad2: std::array::from_fn(
                |i| if i < count { moments.covariance[(i, i)].max(0.0) } else { 0.0 },
            ),
            cycle_position: cycle.position.into(),
            cycle_position_variance: cycle.position_variance.into(),
            cycle_velocity: cycle.velocity.into(),
            cycle_velocity_variance: cycle.velocity_variance.into(),
        })
    }
}
