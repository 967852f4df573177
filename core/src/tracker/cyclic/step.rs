//! Step of the cyclic tracker: filter, cycle count, root and lengths.

use super::estimate::CyclicFrame;
use super::frame::CyclicFrameInput;
use super::options::{CyclicTrackerOptions, FirstPhase};
use crate::cyclic::events::CycleCounter;
use crate::cyclic::filter::CyclicFilter;
use crate::cyclic::{CyclicEstimate, FigurePlace, MotionModel};
use crate::error::ParameterError;
use crate::saved_state::{SavedState, StateVisitor};
use crate::skeleton::stick_figure::{ImagePoint, StickFigure};

/// State of a tracker for models of up to `N` angles.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::example::swing_pose_rad;
/// use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
/// # let table = sinew_core::cyclic::example::swing_table();
/// # let model = table.model().expect("the numbers agree");
///
/// // A person who moves a tenth faster than the model. Every fifth frame has no measurement.
/// let seen = |frame: usize| match frame % 5 {
///     4 => Ok(AngleMeasurement::nothing().into()),
///     _ => AngleMeasurement::new(&swing_pose_rad(frame as f32 / 54.0).map(Some), 0.05).map(Into::into),
/// };
/// let options = CyclicTrackerOptions::default();
/// let mut tracker = CyclicTracker::<2>::new(&model, options, &seen(0)?, FirstPhase::default())?;
/// let mut last = tracker.step(&model, &seen(1)?);
/// for frame in 2..300 {
///     last = tracker.step(&model, &seen(frame)?);
/// }
/// assert!((last.estimate.angles_rad[0] - swing_pose_rad(299.0 / 54.0)[0]).abs() < 0.05);
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

const _: () = assert!(size_of::<CyclicTracker<13>>() <= 5632, "the tracker has to fit 5.5 KiB");

impl<const N: usize> CyclicTracker<N> {
    /// A tracker that begins with the frame `first`.
    ///
    /// # Errors
    /// Those of [`CyclicFilter::new`] and
    /// [`PlaceOptions::check`](crate::cyclic::PlaceOptions::check).
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
        CyclicFrame::new(model, estimate, &self.counter, cycle_step)
    }

    /// Writes the joints of `figure`, px, at the angles of an estimate; see
    /// [`FigurePlace::joints_px`]. All are missing where the tracker follows angles only.
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

impl<const N: usize> SavedState for CyclicTracker<N> {
    /// A state is for a tracker with the same options.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.filter.visit(visitor);
        self.counter.visit(visitor);
        if let Some(place) = &mut self.place {
            place.visit(visitor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::filter::FilterChoice;
    use crate::cyclic::{AngleMeasurement, KalmanOptions, PlaceOptions, synthetic};
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
}
