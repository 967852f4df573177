//! The cyclic tracker: pose and phase by a filter, the cycles counted, the cadence, root and segment lengths.
//!
//! ```
//! # #[cfg(feature = "walking-model")] {
//! use sinew_core::cyclic::AngleMeasurement;
//! use sinew_core::cyclic::model::walking::WALKING;
//! use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
//!
//! // The walking model is in flash (feature `walking-model`); somebody walks as it says.
//! let model = WALKING.model().expect("the shipped model is sound");
//! let seen = |frame: usize| {
//!     let pose = model.mean_pose_rad::<13>(model.point(0.3 + frame as f32 * model.mean_cycle_velocity()));
//!     AngleMeasurement::new(&pose.map(Some), 0.1).expect("a standard deviation above zero").into()
//! };
//! let options = CyclicTrackerOptions::default();
//! let mut tracker = CyclicTracker::<13>::new(&model, options, &seen(0), FirstPhase::default()).expect("13 angles");
//! let mut answer = tracker.step(&model, &seen(1));
//! for frame in 2..300 {
//!     answer = tracker.step(&model, &seen(frame));
//! }
//! let cycles = 299.0 * model.mean_cycle_velocity();
//! assert!((answer.cycles_completed - cycles as i32).abs() <= 1);
//! let cadence = 60.0 * model.rate_hz() * model.mean_cycle_velocity();
//! assert!((answer.cadence_per_min - cadence).abs() < 2.0);
//!
//! // A frame without a measurement is an ordinary input.
//! let bridged = tracker.step(&model, &AngleMeasurement::nothing().into());
//! assert!(bridged.cadence_std_per_min >= answer.cadence_std_per_min);
//! # }
//! ```

use crate::cyclic::events::{CycleCounter, CycleStep};
use crate::cyclic::figure::place::{FigurePlace, PlaceOptions};
use crate::cyclic::filter::{CyclicFilter, FilterChoice};
use crate::cyclic::{AngleMeasurement, CyclicEstimate, MotionModel};
use crate::error::ParameterError;
use crate::skeleton::stick_figure::{ImagePoint, StickFigure};
use core::f32::consts::{PI, SQRT_2};

/// What may be chosen.
///
/// ```
/// use sinew_core::cyclic::PlaceOptions;
/// use sinew_core::cyclic::filter::FilterChoice;
/// use sinew_core::tracker::cyclic::CyclicTrackerOptions;
///
/// // A person in a picture, with a trunk of 100 pixels, half a centimetre each: hips and segments are followed, too.
/// let options = CyclicTrackerOptions {
///     place: Some(PlaceOptions::of_person(100.0, 0.005, 0.1, 60.0)?),
///     ..CyclicTrackerOptions::default()
/// };
/// assert_eq!(options.filter, FilterChoice::Coupled, "the default");
/// assert!(options.place.is_some_and(|place| place.keypoint_std_px > 5.0));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CyclicTrackerOptions {
    /// Filter.
    pub filter: FilterChoice,
    /// How root and lengths are filtered (at the model's rate); `None` where there are angles only.
    pub place: Option<PlaceOptions>,
}

/// First position and velocity in the cycle; where absent the position fits best and the velocity is the model's mean.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
/// # use core::f32::consts::TAU;
/// # use sinew_core::cyclic::ModelTable;
/// # use sinew_core::math::sin_cos;
/// # let pose = |position: f32| [0.5 * sin_cos(TAU * position).0, 0.3 * sin_cos(TAU * position).1];
/// # let mut table = ModelTable::<100, 2, 3> {
/// #     mean_acceleration: [[0.0; 2]; 100],
/// #     acceleration_covariance: [[1e-8, 0.0, 1e-8]; 100],
/// #     mean_pose_rad: core::array::from_fn(|i| pose(i as f32 / 100.0)),
/// #     mean_velocity: [[0.0; 2]; 100],
/// #     offset_std_rad: [0.08; 2],
/// #     swing_std_rad: [0.05; 2],
/// #     rest_std_rad: [0.03; 2],
/// #     rest_rate_per_cycle: [6.0; 2],
/// #     turns_per_cycle: [0; 2],
/// #     mean_duration_frames: 60.0,
/// #     rate_hz: 60.0,
/// # };
/// # for i in 0..100 {
/// #     let [before, after] = [99, 1].map(|step| table.mean_pose_rad[(i + step) % 100]);
/// #     for j in 0..2 {
/// #         table.mean_velocity[i][j] = 0.5 * (after[j] - before[j]);
/// #         table.mean_acceleration[i][j] = after[j] - 2.0 * table.mean_pose_rad[i][j] + before[j];
/// #     }
/// # }
/// # let model = table.model().expect("the numbers agree");
///
/// // The first frame shows one joint only, and where in the cycle it stands is known: by a switch on the treadmill.
/// let first = AngleMeasurement::new(&[Some(pose(0.3)[0]), None], 0.05)?.into();
/// let phase = FirstPhase { position: Some(0.3), velocity_per_frame: None };
/// let tracker = CyclicTracker::<2>::new(&model, CyclicTrackerOptions::default(), &first, phase)?;
/// assert_eq!(tracker.filter().cycle_position(), 0.3);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FirstPhase {
    /// Position in the cycle, [0, 1).
    pub position: Option<f32>,
    /// Cycles per frame of the model's rate.
    pub velocity_per_frame: Option<f32>,
}

/// What a frame shows.
///
/// ```
/// use sinew_core::skeleton::stick_figure::{HUMAN, HUMAN_ANGLES, HUMAN_JOINTS};
/// use sinew_core::tracker::cyclic::CyclicFrameInput;
///
/// // A keypoint detector saw hips and neck, each within two pixels.
/// let mut joints_px = [None; HUMAN_JOINTS];
/// joints_px[0] = Some([320.0, 240.0]);
/// joints_px[1] = Some([320.0, 140.0]);
/// let input = CyclicFrameInput::<HUMAN_ANGLES>::from_joints(&HUMAN, &joints_px, 2.0)?;
/// assert_eq!((input.root_px, input.lengths_px[0]), (Some([320.0, 240.0]), Some(100.0)));
/// assert_eq!(input.angles.present(HUMAN_ANGLES), 1, "the trunk's angle, and no other");
/// // The frames before it were dropped: two and a half frames of the model's rate have passed.
/// assert_eq!(input.after(2.5)?.angles.step_frames(), 2.5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicFrameInput<const N: usize> {
    /// Angles with their noise, and the time since the last frame.
    pub angles: AngleMeasurement<N>,
    /// The root, if it was seen, px.
    pub root_px: Option<ImagePoint>,
    /// Length of each segment that was seen, px.
    pub lengths_px: [Option<f32>; N],
}

impl<const N: usize> From<AngleMeasurement<N>> for CyclicFrameInput<N> {
    fn from(angles: AngleMeasurement<N>) -> Self {
        Self { angles, root_px: None, lengths_px: [None; N] }
    }
}

impl<const N: usize> CyclicFrameInput<N> {
    /// From the joints of `figure` as a picture shows them, each coordinate with a standard deviation of `keypoint_std_px`, one
    /// frame after the last.
    ///
    /// An angle's standard deviation is sqrt(2) times that over the segment's length, at most pi: a short segment says little.
    ///
    /// # Errors
    /// `keypoint_std_px` has to be positive.
    pub fn from_joints(
        figure: &StickFigure<'_>,
        joints_px: &[Option<ImagePoint>],
        keypoint_std_px: f32,
    ) -> Result<Self, ParameterError> {
        crate::error::positive("keypoint_std_px", keypoint_std_px)?;
        let (mut angles_rad, mut std_rad, mut lengths_px) = ([None; N], [PI; N], [None; N]);
        for index in 0..N {
            if let Some(segment) = figure.segment(joints_px, index) {
                angles_rad[index] = segment.angle_rad;
                lengths_px[index] = Some(segment.length_px);
                if segment.length_px * PI > SQRT_2 * keypoint_std_px {
                    std_rad[index] = SQRT_2 * keypoint_std_px / segment.length_px;
                }
            }
        }
        let angles = AngleMeasurement::with_std(&angles_rad, &std_rad)?;
        Ok(Self { angles, root_px: joints_px.first().copied().flatten(), lengths_px })
    }

    /// The same, `step_frames` after the last frame (frames of the model's rate).
    ///
    /// # Errors
    /// Those of [`AngleMeasurement::after`].
    pub fn after(mut self, step_frames: f32) -> Result<Self, ParameterError> {
        self.angles = self.angles.after(step_frames)?;
        Ok(self)
    }
}

/// State of a tracker for models of up to `N` angles.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
/// # use core::f32::consts::TAU;
/// # use sinew_core::cyclic::ModelTable;
/// # use sinew_core::math::sin_cos;
/// # let pose = |position: f32| [0.5 * sin_cos(TAU * position).0, 0.3 * sin_cos(TAU * position).1];
/// # let mut table = ModelTable::<100, 2, 3> {
/// #     mean_acceleration: [[0.0; 2]; 100],
/// #     acceleration_covariance: [[1e-8, 0.0, 1e-8]; 100],
/// #     mean_pose_rad: core::array::from_fn(|i| pose(i as f32 / 100.0)),
/// #     mean_velocity: [[0.0; 2]; 100],
/// #     offset_std_rad: [0.08; 2],
/// #     swing_std_rad: [0.05; 2],
/// #     rest_std_rad: [0.03; 2],
/// #     rest_rate_per_cycle: [6.0; 2],
/// #     turns_per_cycle: [0; 2],
/// #     mean_duration_frames: 60.0,
/// #     rate_hz: 60.0,
/// # };
/// # for i in 0..100 {
/// #     let [before, after] = [99, 1].map(|step| table.mean_pose_rad[(i + step) % 100]);
/// #     for j in 0..2 {
/// #         table.mean_velocity[i][j] = 0.5 * (after[j] - before[j]);
/// #         table.mean_acceleration[i][j] = after[j] - 2.0 * table.mean_pose_rad[i][j] + before[j];
/// #     }
/// # }
/// # let model = table.model().expect("the numbers agree");
///
/// // Somebody who moves a tenth faster than the model; every fifth frame shows nothing.
/// let seen = |frame: usize| match frame % 5 {
///     4 => Ok(AngleMeasurement::nothing().into()),
///     _ => AngleMeasurement::new(&pose(frame as f32 / 54.0).map(Some), 0.05).map(Into::into),
/// };
/// let options = CyclicTrackerOptions::default();
/// let mut tracker = CyclicTracker::<2>::new(&model, options, &seen(0)?, FirstPhase::default())?;
/// let mut last = tracker.step(&model, &seen(1)?);
/// for frame in 2..300 {
///     last = tracker.step(&model, &seen(frame)?);
/// }
/// assert!((last.estimate.angles_rad[0] - pose(299.0 / 54.0)[0]).abs() < 0.05);
/// assert!((last.cadence_per_min - 3600.0 / 54.0).abs() < 3.0);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicTracker<const N: usize> {
    options: CyclicTrackerOptions,
    filter: CyclicFilter<N>,
    counter: CycleCounter,
    place: Option<FigurePlace<N>>,
}

const _: () = assert!(size_of::<CyclicTracker<13>>() <= 4096, "the tracker has to fit 4 KiB");

/// What the tracker says after a frame.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::tracker::{coupled::CoupledTracker, cyclic::FirstPhase};
/// # use core::f32::consts::TAU;
/// # use sinew_core::cyclic::ModelTable;
/// # use sinew_core::math::sin_cos;
/// # let pose = |position: f32| [0.5 * sin_cos(TAU * position).0, 0.3 * sin_cos(TAU * position).1];
/// # let mut table = ModelTable::<100, 2, 3> {
/// #     mean_acceleration: [[0.0; 2]; 100],
/// #     acceleration_covariance: [[1e-8, 0.0, 1e-8]; 100],
/// #     mean_pose_rad: core::array::from_fn(|i| pose(i as f32 / 100.0)),
/// #     mean_velocity: [[0.0; 2]; 100],
/// #     offset_std_rad: [0.08; 2],
/// #     swing_std_rad: [0.05; 2],
/// #     rest_std_rad: [0.03; 2],
/// #     rest_rate_per_cycle: [6.0; 2],
/// #     turns_per_cycle: [0; 2],
/// #     mean_duration_frames: 60.0,
/// #     rate_hz: 60.0,
/// # };
/// # for i in 0..100 {
/// #     let [before, after] = [99, 1].map(|step| table.mean_pose_rad[(i + step) % 100]);
/// #     for j in 0..2 {
/// #         table.mean_velocity[i][j] = 0.5 * (after[j] - before[j]);
/// #         table.mean_acceleration[i][j] = after[j] - 2.0 * table.mean_pose_rad[i][j] + before[j];
/// #     }
/// # }
/// # let model = table.model().expect("the numbers agree");
///
/// // A beep at the middle of every cycle: the frame says whether it was passed, and how long after the frame before.
/// let seen = |frame: usize| AngleMeasurement::new(&pose(frame as f32 / 60.0).map(Some), 0.05);
/// let mut tracker = CoupledTracker::<2>::new(&model, &seen(0)?, FirstPhase::default())?;
/// let (mut beeps, mut at_frame) = (0, 0.0);
/// for frame in 1..=120 {
///     let answer = tracker.step(&model, &seen(frame)?);
///     if let Some(after_frames) = answer.cycle_step.passed(0.5) {
///         beeps += 1;
///         at_frame = (frame - 1) as f32 + after_frames;
///     }
/// }
/// assert_eq!(beeps, 2);
/// assert!((at_frame - 90.0).abs() < 1.0, "in the middle of the second cycle: {at_frame}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicFrame<const N: usize> {
    /// Pose, phase and how sure they are; likelihood and outlier.
    pub estimate: CyclicEstimate<N>,
    /// Whole cycles since the first frame.
    pub cycles_completed: i32,
    /// Cycles per minute.
    pub cadence_per_min: f32,
    /// Standard deviation of the cadence.
    pub cadence_std_per_min: f32,
    /// The way through the cycle since the last frame; asks it for the time at which a phase was passed.
    pub cycle_step: CycleStep,
}

impl<const N: usize> CyclicTracker<N> {
    /// A tracker that begins with the frame `first`.
    ///
    /// # Errors
    /// Those of [`CyclicFilter::new`] and [`PlaceOptions::check`].
    pub fn new(
        model: &MotionModel<'_>,
        options: CyclicTrackerOptions,
        first: &CyclicFrameInput<N>,
        phase: FirstPhase,
    ) -> Result<Self, ParameterError> {
        let filter =
            CyclicFilter::new(model, &options.filter, &first.angles, phase.position, phase.velocity_per_frame)?;
        let mut place = options.place.map(FigurePlace::new).transpose()?;
        if let Some(place) = &mut place {
            place.step(first.angles.step_frames(), first.root_px, &first.lengths_px);
        }
        let counter = CycleCounter::new(filter.cycle_position());
        Ok(Self { options, filter, counter, place })
    }

    /// Begins anew with the same options; cycles are counted from zero.
    ///
    /// # Errors
    /// Those of [`Self::new`]; the tracker is as before then.
    pub fn reset(
        &mut self,
        model: &MotionModel<'_>,
        first: &CyclicFrameInput<N>,
        phase: FirstPhase,
    ) -> Result<(), ParameterError> {
        *self = Self::new(model, self.options, first, phase)?;
        Ok(())
    }

    /// One frame: predict and correct, count, follow root and lengths.
    pub fn step(&mut self, model: &MotionModel<'_>, input: &CyclicFrameInput<N>) -> CyclicFrame<N> {
        let step_frames = input.angles.step_frames();
        let estimate = self.filter.step(model, &self.options.filter, &input.angles);
        let cycle_step = self.counter.advance(estimate.cycle_position, estimate.cycle_velocity_per_frame, step_frames);
        if let Some(place) = &mut self.place {
            place.step(step_frames, input.root_px, &input.lengths_px);
        }
        let (cadence_per_min, cadence_std_per_min) = estimate.cadence_per_min(model.rate_hz());
        let cycles_completed = self.counter.completed();
        CyclicFrame { estimate, cycles_completed, cadence_per_min, cadence_std_per_min, cycle_step }
    }

    /// Writes the joints of `figure`, px, at the angles of an estimate; see [`FigurePlace::joints_px`]. All are missing where the
    /// tracker follows angles only.
    pub fn joints_px(
        &self,
        figure: &StickFigure<'_>,
        estimate: &CyclicEstimate<N>,
        joints_px: &mut [Option<ImagePoint>],
    ) {
        match &self.place {
            Some(place) => place.joints_px(figure, &estimate.angles_rad, joints_px),
            None => joints_px.fill(None),
        }
    }

    /// The filter.
    #[must_use]
    pub const fn filter(&self) -> &CyclicFilter<N> {
        &self.filter
    }

    /// Root and lengths, if they are followed.
    #[must_use]
    pub const fn place(&self) -> Option<&FigurePlace<N>> {
        self.place.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::{KalmanOptions, synthetic};
    use crate::skeleton::stick_figure::{HUMAN, HUMAN_JOINTS};

    const LENGTHS_PX: [f32; 13] = [60.0; 13];

    fn pose(frame: f32) -> [f32; 13] {
        core::array::from_fn(|i| synthetic::mean_angle(i, frame / 65.0))
    }

    fn seen(frame: f32) -> CyclicFrameInput<13> {
        AngleMeasurement::new(&pose(frame).map(Some), 0.1).unwrap().into()
    }

    const START: FirstPhase = FirstPhase { position: Some(0.0), velocity_per_frame: None };

    #[test]
    fn cycles_cadence_and_phases_come_out_of_a_steady_motion() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        for filter in [FilterChoice::Coupled, FilterChoice::Kalman(KalmanOptions::default())] {
            let options = CyclicTrackerOptions { filter, place: None };
            let mut tracker = CyclicTracker::new(&model, options, &seen(0.0), START).unwrap();
            let mut passages = Vec::new();
            for frame in 1..=200_u8 {
                let answer = tracker.step(&model, &seen(f32::from(frame)));
                let passed = answer.cycle_step.passed(0.5);
                passages.extend(passed.map(|after| f32::from(frame - 1) + after));
                let cycles = f32::from(frame) / 65.0;
                let near_a_border = (cycles - cycles.round()).abs() < 0.02;
                assert!(near_a_border || answer.cycles_completed == cycles as i32, "frame {frame}: {answer:?}");
                assert!((answer.cadence_per_min - 3600.0 / 65.0).abs() < 1.0, "{}", answer.cadence_per_min);
                assert!(answer.cadence_std_per_min > 0.0 && !answer.estimate.outlier);
            }
            assert_eq!(passages.len(), 3, "{passages:?}");
            for (index, passage) in passages.iter().enumerate() {
                assert!((passage - 65.0 * (index as f32 + 0.5)).abs() < 1.0, "between frames: {passages:?}");
            }
            let unchanged = tracker;
            let bad = FirstPhase { velocity_per_frame: Some(3.0), ..START };
            assert!(tracker.reset(&model, &seen(0.0), bad).is_err() && tracker == unchanged);
            tracker.reset(&model, &seen(0.0), START).unwrap();
            let answer = tracker.step(&model, &AngleMeasurement::nothing().into());
            assert_eq!(answer.cycles_completed, 0);
        }
    }

    #[test]
    fn joints_are_followed_in_the_picture_through_a_gap() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let place = PlaceOptions::of_person(60.0, 0.008, 0.05, 60.0).unwrap();
        let drawn = |frame: f32| {
            let mut joints = [[0.0; 2]; HUMAN_JOINTS];
            HUMAN.joint_positions([100.0 + 1.5 * frame, 200.0], &LENGTHS_PX, &pose(frame), &mut joints);
            joints
        };
        let input = |frame: f32| CyclicFrameInput::<13>::from_joints(&HUMAN, &drawn(frame).map(Some), 2.0).unwrap();
        let options = CyclicTrackerOptions { place: Some(place), ..Default::default() };
        let mut tracker = CyclicTracker::new(&model, options, &input(0.0), START).unwrap();
        let mut joints = [None; HUMAN_JOINTS];
        for frame in 1..=150_u8 {
            let frame = f32::from(frame);
            let hidden = (120.0..125.0).contains(&frame);
            let input = if hidden { AngleMeasurement::nothing().into() } else { input(frame) };
            let answer = tracker.step(&model, &input);
            tracker.joints_px(&HUMAN, &answer.estimate, &mut joints);
            if frame > 60.0 {
                for (truth, found) in drawn(frame).iter().zip(joints) {
                    let [x, y] = found.unwrap();
                    assert!((truth[0] - x).hypot(truth[1] - y) < 6.0, "frame {frame}: {truth:?}, {x}, {y}");
                }
            }
        }
        assert!(tracker.place().unwrap().lengths_px().iter().all(|length| (length.unwrap() - 60.0).abs() < 0.5));
        let angles_only = CyclicTracker::new(&model, CyclicTrackerOptions::default(), &input(0.0), START).unwrap();
        let mut joints = [Some([0.0; 2]); HUMAN_JOINTS];
        let estimate = { angles_only }.step(&model, &input(1.0)).estimate;
        angles_only.joints_px(&HUMAN, &estimate, &mut joints);
        assert_eq!(joints, [None; HUMAN_JOINTS]);
    }

    #[test]
    fn a_short_segment_is_a_noisy_angle_and_a_joint_that_is_missing_none() {
        let mut joints = [Some([0.0, 0.0]); HUMAN_JOINTS];
        joints[1] = Some([0.0, -100.0]);
        joints[2] = Some([1.0, -100.0]);
        joints[9] = None;
        let input = CyclicFrameInput::<13>::from_joints(&HUMAN, &joints, 2.0).unwrap().after(2.0).unwrap();
        assert!((input.angles.std_rad()[0] - SQRT_2 * 0.02).abs() < 1.0e-6);
        assert_eq!((input.angles.std_rad()[1], input.lengths_px[1]), (SQRT_2 * 2.0, Some(1.0)));
        assert_eq!((input.angles.angle_rad(8), input.lengths_px[8], input.angles.angle_rad(9)), (None, None, None));
        assert_eq!((input.angles.step_frames(), input.root_px), (2.0, Some([0.0, 0.0])));
        assert!(CyclicFrameInput::<13>::from_joints(&HUMAN, &joints, 0.0).is_err());
    }
}
