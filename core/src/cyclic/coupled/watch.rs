//! Where the phase-coupled filter's linearisation is not to be believed: the grid says so, and says where the motion is.

use crate::cyclic::coupled::block::{AngleBlock, Basis, PARTS};
use crate::cyclic::coupled::cycle_pair::{CyclePair, Information};
use crate::cyclic::coupled::filter::{CoupledFilter, spread};
use crate::cyclic::coupled::measured_path::MeasuredPath;
use crate::cyclic::coupled::noise_share::NoiseShare;
use crate::cyclic::coupled::phase_grid::{POSITIONS, PhaseMode};
use crate::cyclic::coupled::prediction_fit::PredictionFit;
use crate::cyclic::coupled::winding::Winding;
use crate::cyclic::phase::position_difference;
use crate::cyclic::recognition::explained_swing::{ExplainedSwing, cycle_variances_rad2};
use crate::cyclic::{AngleMeasurement, CyclicEstimate, MotionModel};
use crate::math::{abs, clamp, max, wrap_angle};
use crate::numeric::chi_square::{DEFAULT_GATE_SIGMAS, is_outlier};
use crate::numeric::log_product::LogProduct;
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};
use core::f32::consts::TAU;

/// Beyond this standard deviation of c, in cycles, the linearisation is void and the position is searched for.
pub(super) const LOST_STD: f32 = 0.15;
/// Frames between two looks at the grid while the position is known.
const WATCH_FRAMES: f32 = 3.0;
/// Weight of a place of which the grid is sure.
const SURE: f32 = 0.9;
/// Weight of a place that is likelier than all others together.
const PROBABLE: f32 = 0.5;
/// Cycles at the mean speed in which a person is learned: after them a filter that predicts well is not sent elsewhere.
const LEARNING_CYCLES: f32 = 1.5;
/// Cycles at the mean speed, from a place found anew on, for which the filter leans on the grid. Somebody who swings little would otherwise
/// be taken for one who moves slowly, before either is known.
const LEANING_CYCLES: f32 = 1.2;
/// Times that the grid's variances count: it sees the same measurements.
const LEANING: f32 = 3.0;
/// Way beyond the usual one between the filter's position and the grid's up to which they agree, cycles.
const AGREED_WAY: f32 = 0.06;
/// Way beyond the usual one that is strange, cycles.
const STRANGE_WAY: f32 = 0.12;
/// Frames in a row of a strange way after which the filter takes the grid's place: a tenth of a second at 60 Hz.
const STRANGE_FRAMES: f32 = 6.0;
/// Frames over which the usual way is averaged.
const USUAL_FRAMES: f32 = 120.0;
/// Greatest usual way, cycles: people who move a little earlier or later than the mean are known by it.
const USUAL_LIMIT: f32 = 0.1;
/// Share of the swing seen that is left over by a mean cycle that tells nothing of it. A filter at its right place leaves two thirds at most,
/// one at a wrong place or that runs backwards nine tenths and more.
const NOTHING_TOLD: f32 = 0.9;
/// Least swing of which that is said, as a share of the cycle's: who stands does not swing.
const LEAST_SWING: f32 = 0.15;
/// Least part of the swing's memory that has to be filled: a third of a cycle since the place was found.
const LEAST_FILLED: f32 = 0.28;
/// Positions by which the cycle's own swing is taken.
const CYCLE_POSITIONS: u8 = 8;
/// Most frames for which one measurement stands in the grid.
const MOST_FRAMES: f32 = 4.0;

/// How the filter stands to the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Watch {
    /// Frames since the grid last moved.
    pub(super) unwatched_frames: f32,
    /// Way from the filter's position to the grid's, cycles, averaged: the grid knows nothing of the person.
    usual_way: f32,
    /// Frames in a row in which the way was another one.
    strange_frames: f32,
    /// Whether the position is unknown, so that the pose is that of all places together.
    pub(super) searching: bool,
    /// How well measurements are predicted.
    pub(super) fit: PredictionFit,
    /// How much of the noise told is there.
    pub(super) noise: NoiseShare,
}

impl SavedState for Watch {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.unwatched_frames, &NOT_NEGATIVE);
        visitor.real(&mut self.usual_way, &(-USUAL_LIMIT..=USUAL_LIMIT));
        visitor.real(&mut self.strange_frames, &NOT_NEGATIVE);
        visitor.flag(&mut self.searching);
        self.fit.visit(visitor);
        self.noise.visit(visitor);
    }
}

impl Watch {
    /// As if the position had been known for ever.
    pub(super) const fn new() -> Self {
        let (fit, noise) = (PredictionFit::new(), NoiseShare::new());
        Self { unwatched_frames: 0.0, usual_way: 0.0, strange_frames: 0.0, searching: false, fit, noise }
    }

    /// Factor of the noise variances told by which measurements are taken in.
    #[inline]
    pub(super) fn noise_scale(&self) -> f32 {
        self.fit.noise_scale() * self.noise.share()
    }

    /// Compares the place `mode` with the filter's `position`, `frames` after the last time.
    fn compare(&mut self, mode: &PhaseMode, position: f32, frames: f32) {
        let strange = position_difference(position_difference(mode.position, position), self.usual_way);
        self.usual_way = clamp(self.usual_way + frames / USUAL_FRAMES * strange, -USUAL_LIMIT, USUAL_LIMIT);
        if mode.weight > PROBABLE && abs(strange) < AGREED_WAY {
            self.fit.agree(frames);
        }
        let is_strange = mode.weight > SURE && abs(strange) > STRANGE_WAY;
        self.strange_frames = if is_strange { self.strange_frames + frames } else { 0.0 };
    }
}

impl<const N: usize> CoupledFilter<N> {
    /// Whether the position in the cycle is unknown at the moment, so that estimates are those of all places together.
    #[must_use]
    pub const fn is_searching(&self) -> bool {
        self.watch.searching
    }

    /// Shows the grid a measurement, and takes its place where the filter has none or the wrong one. Gives the grid's place if it was
    /// looked for.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn watch(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> Option<PhaseMode> {
        let frames = self.watch.unwatched_frames;
        if self.pair.cc > LOST_STD * LOST_STD {
            self.watch.searching = true;
        }
        if !self.watch.searching && frames < WATCH_FRAMES {
            return None;
        }
        self.watch.unwatched_frames = 0.0;
        self.see_swing(model, measurement, frames);
        let mode = self.look_at_grid(model, measurement, frames);
        let frames = clamp(frames, 1.0, MOST_FRAMES);
        if self.watch.searching {
            if mode.weight > SURE {
                self.settle(&mode);
            }
            return Some(mode);
        }
        if self.velocity < 0.0 && !self.watch.fit.is_bad() && !self.follows_nothing(model, measurement) {
            // The grid knows forward motion only.
            return Some(mode);
        }
        self.watch.compare(&mode, self.position, frames);
        if self.watch.strange_frames > STRANGE_FRAMES && !self.knows_better(model, measurement) {
            // What was learned of the person since was learned at the wrong place.
            self.blocks = core::array::from_fn(|i| AngleBlock::unknown(&spread(model, i)));
            let position = mode.position - self.watch.usual_way;
            self.settle(&PhaseMode { position, ..mode });
            self.meet(model, measurement);
        } else if mode.weight > SURE && self.was_found_lately(model) {
            self.lean_on(&mode);
        }
        Some(mode)
    }

    /// Moves the grid on by `frames`, shows it the measurement, and gives its place.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn look_at_grid(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>, frames: f32) -> PhaseMode {
        let mut grid = self.grid.open();
        grid.advance(model, frames);
        grid.weigh(model, measurement, clamp(frames, 1.0, MOST_FRAMES));
        self.grid.keep(&grid);
        grid.mode(model)
    }

    /// Keeps what the mean cycle tells, at the filter's place, of what is seen.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn see_swing(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>, frames: f32) {
        let told_rad = model.mean_pose_rad::<N>(model.point(self.position));
        self.swing.add(frames * model.mean_cycle_velocity(), measurement, &told_rad);
    }

    /// Whether the filter knows the person, and predicts well by that; the grid knows nobody.
    fn knows_better(&self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> bool {
        self.watch.fit.is_good(LEARNING_CYCLES / model.mean_cycle_velocity())
            && !self.follows_nothing(model, measurement)
    }

    /// Whether somebody swings and the mean cycle, at the filter's place, tells nothing of it: however well that is predicted then, it
    /// is by deviations that follow anything.
    fn follows_nothing(&self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> bool {
        if self.swing.filled() < LEAST_FILLED {
            return false;
        }
        let cycle_rad2 = cycle_variances_rad2(model, CYCLE_POSITIONS);
        let left_over = self.swing.left_over(&cycle_rad2, measurement.std_rad());
        left_over.is_some_and(|left_over| left_over > NOTHING_TOLD)
            && self.swing.seen(&cycle_rad2, measurement.std_rad()) > LEAST_SWING
    }

    /// Whether the place was taken from the grid less than [`LEANING_CYCLES`] ago.
    fn was_found_lately(&self, model: &MotionModel<'_>) -> bool {
        self.relocks > 0 && self.watch.fit.is_new(LEANING_CYCLES / model.mean_cycle_velocity())
    }

    /// Lets the grid's place correct position and velocity.
    fn lean_on(&mut self, mode: &PhaseMode) {
        let way = position_difference(position_difference(mode.position, self.position), self.watch.usual_way);
        let mut said = Information::NONE;
        said.add(&[1.0, 0.0], 1.0 / (LEANING * mode.covariance[0]), way);
        said.add(&[0.0, 1.0], 1.0 / (LEANING * mode.covariance[2]), mode.velocity - self.velocity);
        let shift = self.pair.correct(&said);
        self.blocks.iter_mut().for_each(|block| block.follow(shift));
        self.velocity = clamp(self.velocity + shift[1], -0.5, 0.5);
        self.move_by(clamp(shift[0], -0.5, 0.5));
    }

    /// Learns from one measurement how the person differs from the mean cycle at the present place, which that does not move.
    fn meet(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) {
        let (velocity, pair) = (self.velocity, self.pair);
        self.pair = CyclePair { cc: 1.0e-8, cv: 0.0, vv: 1.0e-12 };
        self.correct_phase(model, measurement);
        (self.velocity, self.pair) = (velocity, pair);
    }

    /// Goes on from the place `mode`, on which nothing learned so far depends.
    fn settle(&mut self, mode: &PhaseMode) {
        self.move_by(position_difference(mode.position, self.position));
        self.velocity = mode.velocity;
        let [cc, cv, vv] = mode.covariance;
        self.pair = CyclePair { cc, cv, vv };
        for block in &mut self.blocks {
            block.regression = [[0.0; 2]; PARTS];
        }
        self.watch.searching = false;
        self.relocks = self.relocks.wrapping_add(1);
        self.watch.strange_frames = 0.0;
        self.watch.fit.restart();
        self.swing = ExplainedSwing::new();
        self.winding = Winding::new();
    }

    /// The pose over all places of the grid, each with its weight, corrected angle by angle. `mode` is the grid's place if it is known.
    pub(super) fn estimate_of_all_places(
        &mut self,
        model: &MotionModel<'_>,
        measurement: &AngleMeasurement<N>,
        mode: Option<PhaseMode>,
    ) -> CyclicEstimate<N> {
        let mode = mode.unwrap_or_else(|| self.grid.open().mode(model));
        self.move_by(position_difference(mode.position, self.position));
        self.velocity = mode.velocity;
        self.path = MeasuredPath::new();
        let (mean, mut variance) = self.pose_of_all_places(model);
        let (mut squares, mut volume, mut count) = (0.0, LogProduct::one(), 0);
        for i in 0..model.angle_count().min(N) {
            let mut angle = mean[i];
            if let Some(measured) = measurement.angle_rad(i) {
                let total = variance[i] + measurement.std_rad()[i] * measurement.std_rad()[i];
                let residual = wrap_angle(measured - angle);
                squares += residual * residual / total;
                volume.multiply(TAU * total);
                count += 1;
                angle += variance[i] / total * residual;
                variance[i] -= variance[i] * variance[i] / total;
            }
            self.turn_to(i, wrap_angle(angle));
        }
        let elsewhere = 1.0 - mode.weight;
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2: variance,
            cycle_position: self.position,
            // Elsewhere means anywhere: the variance of a uniform position.
            cycle_position_variance: mode.weight * mode.covariance[0] + elsewhere / 12.0,
            cycle_velocity_per_frame: self.velocity,
            cycle_velocity_variance: mode.covariance[2],
            log_likelihood: -0.5 * (squares + volume.ln()),
            outlier: is_outlier(squares, count, DEFAULT_GATE_SIGMAS),
        }
    }

    /// Mean and variance of each angle over the grid's positions, with what is known of the person.
    fn pose_of_all_places(&self, model: &MotionModel<'_>) -> ([f32; N], [f32; N]) {
        let reference = model.mean_pose_rad::<N>(model.point(self.position));
        let (mut mean, mut square) = ([0.0; N], [0.0; N]);
        for (cell, weight) in self.grid.open().by_position().into_iter().enumerate() {
            let pose = model.mean_pose_rad::<N>(model.point(cell as f32 / POSITIONS as f32));
            for i in 0..model.angle_count().min(N) {
                let off = wrap_angle(pose[i] - reference[i]);
                mean[i] += weight * off;
                square[i] += weight * off * off;
            }
        }
        let basis = Basis::at(self.position);
        let mut variance = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let outlook = self.blocks[i].outlook(&basis, 0.0);
            variance[i] = max(square[i] - mean[i] * mean[i], 0.0) + outlook.variance;
            mean[i] += reference[i] + self.blocks[i].deviation(&basis);
        }
        (mean, variance)
    }
}
