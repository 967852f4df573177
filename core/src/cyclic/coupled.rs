//! The phase-coupled filter: measurements move the cycle position, and each person keeps their own way of moving.
//!
//! An angle is the mean cycle at c plus its deviation ([`super::Deviation`]). Given (c, v) the angles are taken as
//! independent of each other: each has a block of five numbers, all together inform (c, v), and (c, v) informs each.

use super::coupled_block::{AngleBlock, Basis, Outlook, PARTS, Spread};
use super::measurement::MAX_STEP_FRAMES;
use super::phase::wrap_position;
use super::{AngleMeasurement, CyclicEstimate, MotionModel};
use crate::error::{ParameterError, Rule, finite, within};
use crate::math::{abs, clamp, exp, ln, max, min, round, wrap_angle};
use core::f32::consts::TAU;

/// Variance of each angle of the first row, rad^2 (0.57 degrees of standard deviation).
const FIRST_VARIANCE: f32 = 1.0e-4;
/// Temporal acceleration, cycles per frame^2.
const TEMPORAL_STD: f32 = 1.0e-4;
/// Rate per cycle at which constant and swing are forgotten.
const FORGETTING: f32 = 0.02;
/// Angles deviate together, so that thirteen of them say less about the phase than thirteen independent ones would.
const PHASE_TEMPERING: f32 = 2.5;
/// An angle this many standard deviations off says nothing about the phase, and its own constant is learned anew.
pub(super) const GATE_SIGMAS: f32 = 4.0;
/// Beyond this standard deviation of c, in cycles, the linearisation is void and the position is searched for.
const LOST_STD: f32 = 0.15;
/// Frames in a row with most angles beyond the gate after which the position is searched for.
const LOST_FRAMES: u8 = 8;

/// State of the filter `coupled` for models of up to `N` angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledFilter<const N: usize> {
    pub(super) blocks: [AngleBlock; N],
    angles_rad: [f32; N],
    turns: [i32; N],
    pub(super) position: f32,
    pub(super) velocity: f32,
    /// Covariance of (c, v): cc, cv, vv.
    pub(super) cycle: [f32; 3],
    cycles: i32,
    strange_frames: u8,
    /// Times that the position was searched for anew.
    pub(super) relocks: u16,
}

const _: () = assert!(size_of::<CoupledFilter<13>>() <= 2560, "the state has to fit 2.5 KiB");

impl<const N: usize> CoupledFilter<N> {
    /// The standard start: the angles of the first row; `position` by best match and `velocity` by the model where absent.
    ///
    /// # Errors
    /// At most `N` angles, a model with a deviation, a finite position, a velocity within +-0.5 cycles a frame.
    pub fn new(
        model: &MotionModel<'_>,
        first_rad: &[Option<f32>; N],
        position: Option<f32>,
        velocity: Option<f32>,
    ) -> Result<Self, ParameterError> {
        if model.angle_count() > N {
            return Err(ParameterError::new("angles of the model", Rule::Capacity { capacity: N }));
        }
        if model.parts().deviation.is_absent() {
            return Err(ParameterError::new("deviation of the model", Rule::NotEmpty));
        }
        let velocity = within("initial cycle velocity", velocity.unwrap_or(model.mean_cycle_velocity()), -0.5, 0.5)?;
        let mut filter = Self {
            blocks: core::array::from_fn(|i| AngleBlock::unknown(&spread(model, i))),
            angles_rad: [0.0; N],
            turns: [0; N],
            position: 0.0,
            velocity,
            cycle: [1.0e-5, 0.0, 1.0e-6],
            cycles: 0,
            strange_frames: 0,
            relocks: 0,
        };
        let first = AngleMeasurement::with_std(first_rad, &[crate::math::sqrt(FIRST_VARIANCE); N])?;
        filter.position = match position {
            Some(position) => wrap_position(finite("initial cycle position", position)?),
            None => filter.best_position(model, &first),
        };
        filter.correct(model, &first);
        filter.cycles = 0;
        // Whole turns of the first row (of the mean pose where an angle is missing) are kept, so that nothing jumps after it.
        let pose = model.mean_pose_rad::<N>(model.point(filter.position));
        filter.turns = core::array::from_fn(|i| {
            let first = first_rad[i].unwrap_or(pose[i]);
            round((first - filter.angles_rad[i]) / TAU) as i32
        });
        Ok(filter)
    }

    /// One frame: predict over the measurement's step, then correct by the angles seen.
    pub fn step(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        self.predict(model, measurement.step_frames());
        let (log_likelihood, outlier) = self.correct(model, measurement);
        self.estimate(model, log_likelihood, outlier)
    }

    /// Moves on by `step_frames`, in substeps of at most one frame.
    pub fn predict(&mut self, model: &MotionModel<'_>, step_frames: f32) {
        let mut left = clamp(step_frames, 0.0, MAX_STEP_FRAMES);
        for _ in 0..=(MAX_STEP_FRAMES as usize) {
            if left < 1.0e-4 {
                break;
            }
            let step = min(left, 1.0);
            left -= step;
            self.advance(model, step);
        }
    }

    fn advance(&mut self, model: &MotionModel<'_>, step: f32) {
        let [cc, cv, vv] = self.cycle;
        let noise = TEMPORAL_STD * TEMPORAL_STD * step;
        let square = step * step;
        let new = [
            min(cc + 2.0 * step * cv + square * vv + 0.25 * square * noise, 1.0),
            cv + step * vv + 0.5 * step * noise,
            min(vv + noise, 0.01),
        ];
        // Covariance of old and new z, times the inverse of the new: the regression of the old on the new.
        let cross = [[cc + step * cv, cv], [cv + step * vv, vv]];
        let inverse = inverse(&new);
        let map: [[f32; 2]; 2] = core::array::from_fn(|i| {
            [cross[i][0] * inverse[0] + cross[i][1] * inverse[1], cross[i][0] * inverse[1] + cross[i][1] * inverse[2]]
        });
        let rest_cc = max(cc - map[0][0] * cross[0][0] - map[0][1] * cross[0][1], 0.0);
        let rest_vv = max(vv - map[1][0] * cross[1][0] - map[1][1] * cross[1][1], 0.0);
        let bound = crate::math::sqrt(rest_cc * rest_vv);
        let rest_cv = clamp(cv - map[0][0] * cross[1][0] - map[0][1] * cross[1][1], -bound, bound);
        let phase = step * max(abs(self.velocity), 0.1 * model.mean_cycle_velocity());
        let memory = exp(-FORGETTING * phase);
        for i in 0..model.angle_count().min(N) {
            self.blocks[i].advance(&spread(model, i), phase, memory, &map, &[rest_cc, rest_cv, rest_vv]);
        }
        self.cycle = new;
        self.move_to(self.position + step * self.velocity);
    }

    fn move_to(&mut self, position: f32) {
        let wrapped = wrap_position(position);
        self.cycles = self.cycles.saturating_add(round(position - wrapped) as i32);
        self.position = wrapped;
    }

    /// Corrects by the angles seen; gives the log-likelihood and whether most of them lay beyond the gate.
    pub fn correct(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> (f32, bool) {
        let count = model.angle_count().min(N);
        let present = measurement.present(count);
        if present == 0 {
            self.update_angles(model);
            return (0.0, false);
        }
        if self.cycle[0] > LOST_STD * LOST_STD || self.strange_frames >= LOST_FRAMES {
            self.relock(model, measurement);
        }
        let point = model.point(self.position);
        let (pose, slope) = (model.mean_pose_rad::<N>(point), model.mean_pose_slope::<N>(point));
        let basis = Basis::at(self.position);
        let mut information = inverse(&self.cycle);
        let (mut vector, mut log_likelihood, mut strange) = ([0.0_f32; 2], 0.0, 0_usize);
        let mut seen: [Option<(Outlook, f32, f32)>; N] = [None; N];
        for i in 0..count {
            let Some(measured) = measurement.angle_rad(i) else { continue };
            let noise = measurement.std_rad()[i] * measurement.std_rad()[i];
            let residual = wrap_angle(measured - pose[i] - self.blocks[i].deviation(&basis));
            let mut outlook = self.blocks[i].outlook(&basis, slope[i]);
            let given = outlook.variance + noise;
            let total = given + quadratic(&outlook.gradient, &self.cycle);
            log_likelihood -= 0.5 * (residual * residual / total + ln(TAU * total));
            if residual * residual > GATE_SIGMAS * GATE_SIGMAS * total {
                strange += 1;
                self.blocks[i].covariance[0][0] += residual * residual;
                outlook = self.blocks[i].outlook(&basis, slope[i]);
            } else {
                let weight = 1.0 / (PHASE_TEMPERING * given);
                let g = outlook.gradient;
                information[0] += weight * g[0] * g[0];
                information[1] += weight * g[0] * g[1];
                information[2] += weight * g[1] * g[1];
                vector[0] += weight * g[0] * residual;
                vector[1] += weight * g[1] * residual;
            }
            seen[i] = Some((outlook, noise, residual));
        }
        self.cycle = inverse(&information);
        let [cc, cv, vv] = self.cycle;
        let shift = [cc * vector[0] + cv * vector[1], cv * vector[0] + vv * vector[1]];
        for (block, seen) in self.blocks.iter_mut().zip(&seen) {
            block.follow(shift);
            if let Some((outlook, noise, residual)) = seen {
                block.correct(outlook, *noise, *residual, shift);
                block.mean[0] = wrap_angle(block.mean[0]);
            }
        }
        self.velocity = clamp(self.velocity + shift[1], -0.5, 0.5);
        self.move_to(self.position + clamp(shift[0], -0.5, 0.5));
        self.update_angles(model);
        let outlier = 2 * strange > present;
        self.strange_frames = if outlier { self.strange_frames.saturating_add(1) } else { 0 };
        (log_likelihood, outlier)
    }

    /// Takes the position at which the measurement is likeliest, and forgets how the parts depended on it.
    fn relock(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) {
        if self.strange_frames >= LOST_FRAMES {
            for (i, block) in self.blocks.iter_mut().enumerate() {
                *block = AngleBlock::unknown(&spread(model, i));
            }
        }
        self.position = self.best_position(model, measurement);
        for block in &mut self.blocks {
            block.regression = [[0.0; 2]; PARTS];
        }
        let speed = 0.2 * model.mean_cycle_velocity();
        self.cycle = [0.0025, 0.0, max(speed * speed, self.cycle[2])];
        self.relocks = self.relocks.wrapping_add(1);
        self.strange_frames = 0;
    }

    fn best_position(&self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> f32 {
        let mut best = (f32::NEG_INFINITY, 0.0);
        for index in 0..model.position_count() {
            let position = index as f32 / model.position_count() as f32;
            let pose = model.mean_pose_rad::<N>(model.point(position));
            let basis = Basis::at(position);
            let mut score = 0.0;
            for i in 0..model.angle_count().min(N) {
                let Some(measured) = measurement.angle_rad(i) else { continue };
                let residual = wrap_angle(measured - pose[i] - self.blocks[i].deviation(&basis));
                let std = measurement.std_rad()[i];
                let variance = self.blocks[i].outlook(&basis, 0.0).variance + std * std;
                score -= min(residual * residual / variance, GATE_SIGMAS * GATE_SIGMAS) + ln(variance);
            }
            if score > best.0 {
                best = (score, position);
            }
        }
        best.1
    }

    /// Angles from the state, and their turns from the way since the last ones.
    fn update_angles(&mut self, model: &MotionModel<'_>) {
        let pose = model.mean_pose_rad::<N>(model.point(self.position));
        let basis = Basis::at(self.position);
        for i in 0..model.angle_count().min(N) {
            let angle = wrap_angle(pose[i] + self.blocks[i].deviation(&basis));
            let before = self.angles_rad[i];
            let turned = round((before + wrap_angle(angle - before) - angle) / TAU) as i32;
            self.turns[i] = self.turns[i].saturating_add(turned);
            self.angles_rad[i] = angle;
        }
    }

    fn estimate(&self, model: &MotionModel<'_>, log_likelihood: f32, outlier: bool) -> CyclicEstimate<N> {
        let slope = model.mean_pose_slope::<N>(model.point(self.position));
        let basis = Basis::at(self.position);
        let mut angle_variance_rad2 = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let outlook = self.blocks[i].outlook(&basis, slope[i]);
            angle_variance_rad2[i] = outlook.variance + quadratic(&outlook.gradient, &self.cycle);
        }
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2,
            cycle_position: self.position,
            cycle_position_variance: self.cycle[0],
            cycle_velocity_per_frame: self.velocity,
            cycle_velocity_variance: self.cycle[2],
            log_likelihood,
            outlier,
        }
    }

    /// Cycles completed since the start (negative backwards).
    #[must_use]
    pub const fn cycles(&self) -> i32 {
        self.cycles
    }
}

fn spread(model: &MotionModel<'_>, index: usize) -> Spread {
    let deviation = &model.parts().deviation;
    let at = |values: &[f32]| values.get(index).copied().unwrap_or(1.0);
    let square = |std: f32| std * std;
    Spread {
        offset: square(at(deviation.offset_std_rad)),
        swing: square(at(deviation.swing_std_rad)),
        rest: square(at(deviation.rest_std_rad)),
        rate: at(deviation.rest_rate_per_cycle),
    }
}

/// Inverse of the symmetric matrix (cc, cv, vv); its correlation is kept within what can be inverted.
fn inverse(matrix: &[f32; 3]) -> [f32; 3] {
    let (cc, vv) = (max(matrix[0], 1.0e-14), max(matrix[2], 1.0e-14));
    let root = crate::math::sqrt(cc * vv);
    let correlation = clamp(matrix[1] / root, -0.999, 0.999);
    let scale = 1.0 / (1.0 - correlation * correlation);
    [scale / cc, -scale * correlation / root, scale / vv]
}

pub(super) fn quadratic(g: &[f32; 2], matrix: &[f32; 3]) -> f32 {
    max(g[0] * g[0] * matrix[0] + 2.0 * g[0] * g[1] * matrix[1] + g[1] * g[1] * matrix[2], 0.0)
}
