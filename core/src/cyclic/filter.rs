//! The phase-coupled filter and the Kalman filter behind one type.

use crate::cyclic::{
    AngleMeasurement, CoupledFilter, CycleStart, CyclicEstimate, KalmanFilter, KalmanOptions, MotionModel,
};
use crate::error::ParameterError;
use crate::saved_state::{SavedState, StateVisitor};

/// Choice of filter with its options.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::filter::FilterChoice;
/// use sinew_core::cyclic::{AngleMeasurement, KalmanOptions, model::walking::WALKING};
/// use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
///
/// // The paper's filter in place of the default.
/// let filter = FilterChoice::Kalman(KalmanOptions::default());
/// let options = CyclicTrackerOptions { filter, ..CyclicTrackerOptions::default() };
/// let (model, unseen) = (WALKING.model()?, AngleMeasurement::nothing().into());
/// let mut tracker = CyclicTracker::<13>::new(&model, options, &unseen, FirstPhase::default())?;
/// // Its speed stays the first one. The default estimates it from the angles.
/// assert_eq!(tracker.step(&model, &unseen).estimate.cycle_velocity_per_frame, model.mean_cycle_velocity());
/// assert_ne!(FilterChoice::default(), filter);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum FilterChoice {
    /// The phase-coupled filter (`coupled`).
    #[default]
    Coupled,
    /// The cyclic paper's filter in one of its readings (`paper`, `paper-cut`).
    Kalman(KalmanOptions),
}

/// State of one of the filters for models of up to `N` angles.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::filter::{CyclicFilter, FilterChoice};
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::{AngleMeasurement, KalmanOptions};
///
/// // Both filters, one after the other, on half a second of the mean cycle.
/// let model = WALKING.model()?;
/// let pose_rad = |frame: u8| model.mean_pose_rad::<13>(model.point(f32::from(frame) * model.mean_cycle_velocity()));
/// let seen = |frame| AngleMeasurement::new(&pose_rad(frame).map(Some), 0.1);
/// for choice in [FilterChoice::Coupled, FilterChoice::Kalman(KalmanOptions::default())] {
///     let mut filter = CyclicFilter::new(&model, &choice, &seen(0)?, Some(0.0), None)?;
///     for frame in 1..30 {
///         filter.step(&model, &choice, &seen(frame)?);
///     }
///     let estimate = filter.step(&model, &choice, &seen(30)?);
///     assert!((estimate.angles_rad[0] - pose_rad(30)[0]).abs() < 0.05);
/// }
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is no allocator, and at 13 angles both variants are of like size")]
pub enum CyclicFilter<const N: usize> {
    /// Of [`FilterChoice::Coupled`].
    Coupled(CoupledFilter<N>),
    /// Of [`FilterChoice::Kalman`].
    Kalman(KalmanFilter<N>),
}

const _: () = assert!(size_of::<CyclicFilter<13>>() <= 4096, "the state has to fit 4 KiB");

impl<const N: usize> CyclicFilter<N> {
    /// The standard start: the angles of the first row. Where absent, the position in the cycle
    /// follows by best match and the velocity (cycles a frame of the model) by the model's mean.
    ///
    /// # Errors
    /// Those of the filter's own `new`.
    pub fn new(
        model: &MotionModel<'_>,
        choice: &FilterChoice,
        first: &AngleMeasurement<N>,
        position: Option<f32>,
        velocity: Option<f32>,
    ) -> Result<Self, ParameterError> {
        match choice {
            FilterChoice::Coupled => CoupledFilter::new(model, first, position, velocity).map(Self::Coupled),
            FilterChoice::Kalman(options) => {
                let start = CycleStart::standard(model, first.angles_rad(), position, velocity)?;
                KalmanFilter::new(model, options, &start).map(Self::Kalman)
            }
        }
    }

    /// One frame: predict over the measurement's step, then correct. `choice` is that of
    /// [`Self::new`]; the options of another filter are ignored.
    pub fn step(
        &mut self,
        model: &MotionModel<'_>,
        choice: &FilterChoice,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        match (self, choice) {
            (Self::Coupled(filter), _) => filter.step(model, measurement),
            (Self::Kalman(filter), FilterChoice::Kalman(options)) => filter.step(model, options, measurement),
            (Self::Kalman(filter), FilterChoice::Coupled) => filter.step(model, &KalmanOptions::default(), measurement),
        }
    }

    /// Position in the cycle, [0, 1).
    #[must_use]
    pub const fn cycle_position(&self) -> f32 {
        match self {
            Self::Coupled(filter) => filter.cycle().position,
            Self::Kalman(filter) => filter.cycle().position,
        }
    }
}

impl<const N: usize> SavedState for CyclicFilter<N> {
    /// A state is for the same choice of filter.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let is_kalman = matches!(self, Self::Kalman(_));
        let mut read = is_kalman;
        visitor.flag(&mut read);
        if read != is_kalman {
            visitor.refuse();
        }
        match self {
            Self::Coupled(filter) => filter.visit(visitor),
            Self::Kalman(filter) => filter.visit(visitor),
        }
    }
}
