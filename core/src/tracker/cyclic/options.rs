//! Options of the cyclic tracker, and its first phase.

use crate::cyclic::PlaceOptions;
use crate::cyclic::filter::FilterChoice;

/// Options of the cyclic tracker.
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

/// First position and velocity in the cycle; where absent the position fits best and the velocity
/// is the model's mean.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::example::swing_pose_rad;
/// use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
/// # let table = sinew_core::cyclic::example::swing_table();
/// # let model = table.model().expect("the numbers agree");
///
/// // The first frame shows one joint only, and where in the cycle it stands is known: by a switch on the treadmill.
/// let first = AngleMeasurement::new(&[Some(swing_pose_rad(0.3)[0]), None], 0.05)?.into();
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
