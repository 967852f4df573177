//! Going back over the phase-coupled filter: (c, v), then five numbers an angle.

use super::pass::{Link, Smoothable, Smoothed};
use super::recursion::Moments;
use nalgebra::{DMatrix, DVector};
use sinew_core::cyclic::coupled::person::block::{Basis, PARTS};
use sinew_core::cyclic::{AngleMeasurement, CoupledFilter, MotionModel};
use std::f64::consts::TAU;

/// `coupled` after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledState<const N: usize>(pub CoupledFilter<N>);

/// Position and velocity.
const CYCLE: usize = 2;

/// Index of the first number of an angle's block.
const fn block(angle: usize) -> usize {
    CYCLE + PARTS * angle
}

impl<const N: usize> CoupledState<N> {
    fn size(model: &MotionModel<'_>) -> usize {
        block(model.angle_count().min(N))
    }

    fn mean(&self, model: &MotionModel<'_>) -> DVector<f64> {
        let cycle = self.0.cycle();
        let parts = self.0.blocks().iter().flat_map(|block| block.mean);
        let all = [cycle.position, cycle.velocity].into_iter().chain(parts);
        DVector::from_iterator(Self::size(model), all.take(Self::size(model)).map(f64::from))
    }

    /// Joint covariance: given (c, v) the angles are independent, through it they are not.
    fn covariance(&self, model: &MotionModel<'_>) -> DMatrix<f64> {
        let (cycle, size) = (self.0.cycle(), Self::size(model));
        let cc = DMatrix::from_row_slice(
            CYCLE,
            CYCLE,
            &[cycle.position_variance, cycle.covariance, cycle.covariance, cycle.velocity_variance].map(f64::from),
        );
        // Rows of the state as functions of (c, v).
        let mut regression = DMatrix::zeros(size, CYCLE);
        regression.view_mut((0, 0), (CYCLE, CYCLE)).fill_with_identity();
        for (angle, parts) in self.0.blocks().iter().take(model.angle_count()).enumerate() {
            for (row, values) in parts.regression.iter().enumerate() {
                for (column, value) in values.iter().enumerate() {
                    regression[(block(angle) + row, column)] = f64::from(*value);
                }
            }
        }
        let mut covariance = &regression * cc * regression.transpose();
        for (angle, parts) in self.0.blocks().iter().take(model.angle_count()).enumerate() {
            for (row, values) in parts.covariance_matrix().iter().enumerate() {
                for (column, value) in values.iter().enumerate() {
                    covariance[(block(angle) + row, block(angle) + column)] += f64::from(*value);
                }
            }
        }
        covariance
    }
}

impl<const N: usize> Smoothable<N> for CoupledState<N> {
    /// The position wraps at a cycle, each angle's constant at a turn.
    fn period(&self, _model: &MotionModel<'_>, index: usize) -> Option<f64> {
        match index {
            0 => Some(1.0),
            _ if index >= CYCLE && (index - CYCLE).is_multiple_of(PARTS) => Some(TAU),
            _ => None,
        }
    }

    fn moments(&self, model: &MotionModel<'_>) -> Moments {
        Moments { mean: self.mean(model), covariance: self.covariance(model) }
    }

    fn led_as_in(&self, next: &Self) -> Option<Self> {
        self.0.led_as_in(&next.0).map(Self)
    }

    /// There is none where the position is searched for. An angle whose constant
    /// was opened at the gate has that much more noise. So what is learned anew after it says
    /// nothing about what was before.
    fn link(&self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>, next: &Self) -> Option<Link> {
        if next.0.is_searching() {
            return None;
        }
        let size = Self::size(model);
        let transition = self.0.transition(model, measurement.step_frames());
        let mut moved = *self;
        moved.0.predict(model, measurement.step_frames());
        let opened = moved.0.gated_variance_rad2(model, measurement);
        let (mut map, mut noise) = (DMatrix::identity(size, size), DMatrix::zeros(size, size));
        map[(0, 1)] = f64::from(transition.step_frames);
        let [cc, cv, vv] = transition.cycle_noise.map(f64::from);
        noise.view_mut((0, 0), (CYCLE, CYCLE)).copy_from_slice(&[cc, cv, cv, vv]);
        for (angle, step) in transition.blocks.iter().take(model.angle_count()).enumerate() {
            let first = block(angle);
            for i in 0..PARTS {
                for j in 0..PARTS {
                    map[(first + i, first + j)] = f64::from(step.map[i][j]);
                    noise[(first + i, first + j)] = f64::from(step.noise[i][j]);
                }
            }
            noise[(first, first)] += f64::from(opened[angle]);
        }
        let cross = self.covariance(model) * map.transpose();
        let predicted_covariance = &map * &cross + noise;
        Some(Link { predicted_mean: moved.mean(model), cross, predicted_covariance })
    }

    /// While the phase is unknown the estimate is the mean over all places, which these moments do
    /// not describe.
    fn smoothed(&self, model: &MotionModel<'_>, moments: &Moments) -> Option<Smoothed<N>> {
        if self.0.is_searching() {
            return None;
        }
        let mean = &moments.mean;
        let position = mean[0].rem_euclid(1.0);
        let pose = model.mean_pose_rad::<N>(model.point(position as f32));
        let slope = model.mean_pose_secant::<N>(position as f32, moments.covariance[(0, 0)].max(0.0).sqrt() as f32);
        let basis = Basis::at(position as f32);
        let (mut angles_rad, mut angle_variance_rad2) = ([0.0; N], [0.0; N]);
        for angle in 0..model.angle_count().min(N) {
            let parts = mean.rows(block(angle), PARTS);
            let along = |values: &[f32; PARTS]| -> f64 {
                values.iter().zip(parts.iter()).map(|(value, part)| f64::from(*value) * part).sum()
            };
            angles_rad[angle] = f64::from(pose[angle]) + along(&basis.value);
            // Derivatives by c and by the parts.
            let gradient: [f64; PARTS + 1] = std::array::from_fn(|i| match i {
                0 => f64::from(slope[angle]) + along(&basis.slope),
                _ => f64::from(basis.value[i - 1]),
            });
            let index = |i: usize| if i == 0 { 0 } else { block(angle) + i - 1 };
            let mut variance = 0.0;
            for i in 0..=PARTS {
                for j in 0..=PARTS {
                    variance += gradient[i] * gradient[j] * moments.covariance[(index(i), index(j))];
                }
            }
            angle_variance_rad2[angle] = f64::from(self.0.band_scale(angle)) * variance.max(0.0);
        }
        // An angle that is judged by itself moves its own parts but not (c, v). What looks back
        // adds that up as if it knew less of them.
        let filtered = self.0.cycle();
        let variance = |index: usize, filtered: f32| moments.covariance[(index, index)].clamp(0.0, f64::from(filtered));
        Some(Smoothed {
            angles_rad,
            angle_variance_rad2,
            cycle_position: position,
            cycle_position_variance: variance(0, filtered.position_variance),
            cycle_velocity: mean[1],
            cycle_velocity_variance: variance(1, filtered.velocity_variance),
        })
    }
}
