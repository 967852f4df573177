//! The phase-coupled filter: measurements move the cycle position, and each person keeps their own way of moving.
//!
//! An angle is the mean cycle at c plus its deviation ([`crate::cyclic::Deviation`]). Given (c, v) the angles are taken as
//! independent of each other: each has a block of five numbers, all together inform (c, v), and (c, v) informs each.

use crate::angle::split_turns;
use crate::cyclic::coupled::block::{AngleBlock, Basis, Outlook, PARTS, Spread};
use crate::cyclic::coupled::cycle_pair::CyclePair;
use crate::cyclic::coupled::first_row::FirstRow;
use crate::cyclic::coupled::measured_path::MeasuredPath;
use crate::cyclic::coupled::phase_evidence::{Judgement, PhaseEvidence};
use crate::cyclic::coupled::phase_grid::PhaseGrid;
use crate::cyclic::coupled::stored_grid::StoredGrid;
use crate::cyclic::coupled::watch::{LOST_STD, Watch};
use crate::cyclic::coupled::winding::Winding;
use crate::cyclic::phase::wrap_position;
use crate::cyclic::recognition::explained_swing::ExplainedSwing;
use crate::cyclic::substeps::Substeps;
use crate::cyclic::{AngleMeasurement, CyclicEstimate, MotionModel};
use crate::error::{ParameterError, Rule, finite, within};
use crate::math::{abs, clamp, exp, max, round, sqrt, wrap_angle};
use core::f32::consts::TAU;

/// Spread of a person's speed about the model's mean, as a part of it.
const SPEED_SPREAD: f32 = 0.1;
/// Rate per cycle at which constant and swing are forgotten.
const FORGETTING: f32 = 0.02;
/// Share of the computed variance of an angle that is reported. The spread between people is taken wider and the evidence on the
/// phase weaker than measured, for the gains' sake; without this share the bands hold more than they say.
pub const BAND_CALIBRATION: f32 = 0.9;
/// Parts of a step over frames that were left out: what a step costs does not grow with the gap before it.
pub const MOST_SUBSTEPS: u8 = 6;
/// An angle this many standard deviations off says nothing about the phase, and its own constant is learned anew.
pub(super) const GATE_SIGMAS: f32 = 4.0;

/// State of the filter `coupled` for models of up to `N` angles.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::phase::position_difference;
/// use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
///
/// // Somebody walks into view, nobody knows where in the cycle: the filter looks everywhere until it has found it.
/// let model = WALKING.model()?;
/// let position = |frame: u8| 0.7 + f32::from(frame) * model.mean_cycle_velocity();
/// let seen = |frame| AngleMeasurement::new(&model.mean_pose_rad::<13>(model.point(position(frame))).map(Some), 0.1);
/// let mut filter = CoupledFilter::anywhere(&model, &seen(0)?)?;
/// assert!(filter.is_searching());
/// for frame in 1..=90 {
///     filter.step(&model, &seen(frame)?);
/// }
/// assert!(!filter.is_searching());
/// assert!(position_difference(filter.cycle().position, position(90)).abs() < 0.02);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledFilter<const N: usize> {
    pub(super) blocks: [AngleBlock; N],
    pub(super) angles_rad: [f32; N],
    pub(super) turns: [i32; N],
    pub(super) position: f32,
    pub(super) velocity: f32,
    /// Covariance of position and velocity.
    pub(super) pair: CyclePair,
    pub(super) cycles: i32,
    pub(super) grid: StoredGrid,
    pub(super) watch: Watch,
    pub(super) winding: Winding<N>,
    pub(super) path: MeasuredPath<N>,
    /// What the mean cycle, at the filter's position, tells of the swing that is seen.
    pub(super) swing: ExplainedSwing<N>,
    /// Times that the position was taken from the grid.
    pub(super) relocks: u16,
}

const _: () = assert!(size_of::<CoupledFilter<13>>() <= 2560, "the state has to fit 2.5 KiB");

impl<const N: usize> CoupledFilter<N> {
    /// The standard start: the angles of the first row, which the paper takes as exact. A row that looks noisy beside the mean
    /// pose is trusted less, down to what its standard deviations say. `position` by best match and `velocity` by the model where absent.
    ///
    /// # Errors
    /// At most `N` angles, a model with a deviation, a finite position, a velocity within +-0.5 cycles a frame.
    pub fn new(
        model: &MotionModel<'_>,
        first: &AngleMeasurement<N>,
        position: Option<f32>,
        velocity: Option<f32>,
    ) -> Result<Self, ParameterError> {
        let mut filter = Self::empty();
        filter.begin(model, first, position, velocity)?;
        Ok(filter)
    }

    /// A filter that has not begun, so that one in static memory can begin there; it takes no stack. Its answers mean nothing.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            blocks: [AngleBlock::zero(); N],
            angles_rad: [0.0; N],
            turns: [0; N],
            position: 0.0,
            velocity: 0.0,
            pair: CyclePair { cc: 0.0, cv: 0.0, vv: 0.0 },
            cycles: 0,
            grid: StoredGrid::uniform(),
            watch: Watch::new(),
            winding: Winding::new(),
            path: MeasuredPath::new(),
            relocks: 0,
            swing: ExplainedSwing::new(),
        }
    }

    /// Becomes what [`Self::new`] gives, in place.
    ///
    /// # Errors
    /// Those of [`Self::new`]; the filter is as before then.
    pub fn begin(
        &mut self,
        model: &MotionModel<'_>,
        first: &AngleMeasurement<N>,
        position: Option<f32>,
        velocity: Option<f32>,
    ) -> Result<(), ParameterError> {
        let velocity = within("initial cycle velocity", velocity.unwrap_or(model.mean_cycle_velocity()), -0.5, 0.5)?;
        let position = match position {
            Some(position) => wrap_position(finite("initial cycle position", position)?),
            None => crate::cyclic::start::best_position(model, first.angles_rad()),
        };
        let row = FirstRow::of(model, first, position)?;
        self.forget(model)?;
        self.position = position;
        self.velocity = velocity;
        self.grid.keep(&PhaseGrid::near(position));
        for (block, otherwise_rad2) in self.blocks.iter_mut().zip(row.otherwise_rad2) {
            block.hold_otherwise(otherwise_rad2);
        }
        self.correct_phase(model, &row.measurement);
        self.start_counting(model, first);
        Ok(())
    }

    /// A start anywhere in the cycle at any speed, with the first row as a measurement among others.
    ///
    /// # Errors
    /// At most `N` angles, a model with a deviation.
    pub fn anywhere(model: &MotionModel<'_>, first: &AngleMeasurement<N>) -> Result<Self, ParameterError> {
        let mut filter = Self::empty();
        filter.forget(model)?;
        filter.watch.searching = true;
        filter.correct(model, first);
        filter.start_counting(model, first);
        Ok(filter)
    }

    /// Position 0, the model's mean speed, nothing known of the person.
    fn forget(&mut self, model: &MotionModel<'_>) -> Result<(), ParameterError> {
        if model.angle_count() > N {
            return Err(ParameterError::new("angles of the model", Rule::Capacity { capacity: N }));
        }
        if model.parts().deviation.is_absent() {
            return Err(ParameterError::new("deviation of the model", Rule::NotEmpty));
        }
        let velocity = model.mean_cycle_velocity();
        for (i, block) in self.blocks.iter_mut().enumerate() {
            *block = AngleBlock::unknown(&spread(model, i));
        }
        self.angles_rad = [0.0; N];
        self.turns = [0; N];
        self.position = 0.0;
        self.velocity = velocity;
        self.pair =
            CyclePair { cc: 1.0e-5, cv: 0.0, vv: max(1.0e-6, SPEED_SPREAD * SPEED_SPREAD * velocity * velocity) };
        self.cycles = 0;
        self.grid = StoredGrid::uniform();
        self.watch = Watch::new();
        self.winding = Winding::new();
        self.path = MeasuredPath::new();
        self.relocks = 0;
        self.swing = ExplainedSwing::new();
        Ok(())
    }

    /// Counts from here on. Whole turns of the first row (of the mean pose where an angle is missing) are kept, so that nothing
    /// jumps after it.
    fn start_counting(&mut self, model: &MotionModel<'_>, first: &AngleMeasurement<N>) {
        let pose = model.mean_pose_rad::<N>(model.point(self.position));
        self.turns = core::array::from_fn(|i| {
            let first = first.angle_rad(i).unwrap_or(pose[i]);
            round((first - self.angles_rad[i]) / TAU) as i32
        });
        self.cycles = 0;
        self.relocks = 0;
        self.winding = Winding::new();
    }

    /// One frame: predict over the measurement's step, then correct by the angles seen. On x86-64 what every frame needs is inlined, so
    /// that a caller compiled for wider vectors than the crate has them; elsewhere it would cost flash.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn step(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        self.predict(model, measurement.step_frames());
        self.correct(model, measurement)
    }

    /// Moves on by `step_frames`, in substeps of one frame, longer ones where that would be more than [`MOST_SUBSTEPS`].
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn predict(&mut self, model: &MotionModel<'_>, step_frames: f32) {
        for step in Substeps::few(step_frames, MOST_SUBSTEPS) {
            self.advance(model, step);
        }
        self.watch.unwatched_frames += step_frames;
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn advance(&mut self, model: &MotionModel<'_>, step: f32) {
        let (map, rest) = self.pair.advance(step);
        let phase = step * max(abs(self.velocity), 0.1 * model.mean_cycle_velocity());
        let memory = exp(-FORGETTING * phase);
        let lost = self.pair.cc > LOST_STD * LOST_STD;
        for i in 0..model.angle_count().min(N) {
            if lost {
                // Nothing is a straight line of (c, v) any more.
                self.blocks[i].regression = [[0.0; 2]; PARTS];
            }
            self.blocks[i].advance(&spread(model, i), phase, memory, &map, &rest);
        }
        self.move_by(step * self.velocity);
    }

    pub(super) fn move_by(&mut self, way: f32) {
        let position = self.position + way;
        let wrapped = wrap_position(position);
        self.cycles = self.cycles.saturating_add(round(position - wrapped) as i32);
        self.position = wrapped;
    }

    /// Corrects by the angles seen, after the grid has told whether the position is still the right one.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn correct(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        let mode = if measurement.is_empty(model.angle_count()) { None } else { self.watch(model, measurement) };
        if self.watch.searching {
            return self.estimate_of_all_places(model, measurement, mode);
        }
        let judgement = self.correct_phase(model, measurement);
        self.watch.fit.see(&judgement, measurement.step_frames());
        self.estimate(model, judgement.log_likelihood, judgement.outlier)
    }

    /// The estimate after `measurement` was taken in, without its likelihood.
    pub fn present(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        if self.watch.searching {
            return self.estimate_of_all_places(model, measurement, None);
        }
        self.estimate(model, 0.0, false)
    }

    /// The extended Kalman correction about the present position; gives how the measurement fitted the prediction.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn correct_phase(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> Judgement {
        let point = model.point(self.position);
        let (pose, slope) = (model.mean_pose_rad::<N>(point), self.pose_slope(model));
        let basis = Basis::at(self.position);
        let (told_scale, share) = (self.watch.fit.noise_scale(), self.watch.noise.share());
        let mut evidence = PhaseEvidence::none(model.winds(), self.watch.noise.score());
        let mut seen: [Option<(Outlook, f32, f32)>; N] = [None; N];
        for i in 0..model.angle_count().min(N) {
            let Some(measured) = measurement.angle_rad(i) else { continue };
            let told = told_scale * measurement.std_rad()[i] * measurement.std_rad()[i];
            let noise = share * told;
            let residual = wrap_angle(measured - pose[i] - self.blocks[i].deviation(&basis));
            let mut outlook = self.blocks[i].outlook(&basis, slope[i]);
            let given = outlook.variance + noise;
            let (total, is_believed) = (given + self.pair.along(&outlook.gradient), self.winding.is_believed(i));
            if is_believed {
                evidence.add(&outlook.gradient, given, residual);
                evidence.noise.add(told, total - noise, residual);
            } else {
                evidence.add_apart(total, residual);
            }
            if residual * residual > GATE_SIGMAS * GATE_SIGMAS * total {
                self.blocks[i].loosen_offset(residual * residual);
                outlook.loosen_offset(residual * residual);
            } else if is_believed {
                evidence.trust(&outlook.gradient, given, residual);
            }
            seen[i] = Some((outlook, noise, residual));
        }
        self.watch.noise.see(&evidence.noise);
        let judgement = evidence.judge(&self.pair, told_scale * share);
        let shift = self.pair.correct(&evidence.trusted);
        for (block, seen) in self.blocks.iter_mut().zip(&seen) {
            block.follow(shift);
            if let Some((outlook, noise, residual)) = seen {
                block.correct(outlook, *noise, *residual, shift);
                block.mean[0] = wrap_angle(block.mean[0]);
            }
        }
        self.velocity = clamp(self.velocity + shift[1], -0.5, 0.5);
        self.move_by(clamp(shift[0], -0.5, 0.5));
        self.update_angles(model, measurement);
        judgement
    }

    /// Change of the mean pose with the position, rad per cycle, over as much of the cycle as the position is uncertain by (statistical
    /// linearisation): where the mean pose jumps its tangent would hold the position there.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn pose_slope(&self, model: &MotionModel<'_>) -> [f32; N] {
        model.mean_pose_secant(self.position, sqrt(self.pair.cc))
    }

    /// Angles from the state.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn update_angles(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) {
        let pose = model.mean_pose_rad::<N>(model.point(self.position));
        let basis = Basis::at(self.position);
        self.winding.complete(self.cycles);
        for i in 0..model.angle_count().min(N) {
            let (before, angle) = (self.angles_rad[i], wrap_angle(pose[i] + self.blocks[i].deviation(&basis)));
            self.turn_to(i, angle);
            let beyond = self.path.turns(i, [before, angle], measurement);
            self.turns[i] = self.turns[i].saturating_add(beyond);
            let turns_a_cycle = model.parts().turns_per_cycle.get(i).map_or(0, |turns| i32::from(*turns));
            self.winding.see(
                i,
                self.turns[i].wrapping_sub(turns_a_cycle.wrapping_mul(self.cycles)),
                self.angles_rad[i] - pose[i],
            );
        }
        self.winding.begin();
    }

    /// Sets an angle; its turns follow from the shorter way since the last one.
    pub(super) fn turn_to(&mut self, index: usize, angle_rad: f32) {
        let (_, turns_less) = split_turns(angle_rad - self.angles_rad[index]);
        self.turns[index] = self.turns[index].saturating_sub(turns_less);
        self.angles_rad[index] = angle_rad;
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn estimate(&self, model: &MotionModel<'_>, log_likelihood: f32, outlier: bool) -> CyclicEstimate<N> {
        let slope = self.pose_slope(model);
        let (basis, band_calibration) = (Basis::at(self.position), self.band_calibration());
        let mut angle_variance_rad2 = [0.0; N];
        for i in 0..model.angle_count().min(N) {
            let outlook = self.blocks[i].outlook(&basis, slope[i]);
            angle_variance_rad2[i] = band_calibration * (outlook.variance + self.pair.along(&outlook.gradient));
        }
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2,
            cycle_position: self.position,
            cycle_position_variance: self.pair.cc,
            cycle_velocity_per_frame: self.velocity,
            cycle_velocity_variance: self.pair.vv,
            log_likelihood,
            outlier,
        }
    }

    /// Factor of the computed variances of the angles that is reported: [`BAND_CALIBRATION`], and more where measurements are taken for
    /// better than their standard deviations say. Noise that moves slowly cannot be told from such, so that bands stay as wide as told.
    #[must_use]
    pub fn band_calibration(&self) -> f32 {
        BAND_CALIBRATION * self.watch.noise.band_scale()
    }

    /// Cycles completed since the start (negative backwards).
    #[must_use]
    pub const fn cycles(&self) -> i32 {
        self.cycles
    }
}

/// Stationary spread of an angle's parts.
#[cfg_attr(target_arch = "x86_64", inline(always))]
pub(super) fn spread(model: &MotionModel<'_>, index: usize) -> Spread {
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
