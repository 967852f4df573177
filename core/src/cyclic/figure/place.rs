//! Root position and segment lengths of the figure, filtered beside the pose (cyclic paper, section
//! 2.2), and its joints.
//!
//! ```
//! use sinew_core::cyclic::{FigurePlace, PlaceOptions};
//!
//! // A person whose trunk is 100 px long, half a centimetre a pixel, angles known to 0.1 rad, 30 frames a second.
//! let options = PlaceOptions::of_person(100.0, 0.005, 0.1, 30.0)?;
//! let mut place = FigurePlace::<1>::new(options)?;
//! for frame in 0..30 {
//!     // Three pixels a frame to the right; every fifth frame is missing.
//!     let root_px = (frame % 5 != 4).then_some([300.0 + 3.0 * frame as f32, 200.0]);
//!     place.step(1.0, root_px, &[Some(80.0)]);
//! }
//! let [x, y] = place.root_px().expect("it was seen a moment ago");
//! assert!((x - 387.0).abs() < 6.0 && (y - 200.0).abs() < 1.0, "{x}, {y}");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::cyclic::figure::image_filter::ScalarFilter;
use crate::error::{ParameterError, positive};
use crate::math::sqrt;
use crate::ranges::is_pixel;
use crate::saved_state::{SavedState, StateVisitor};
use crate::skeleton::stick_figure::{ImagePoint, StickFigure};
use core::f32::consts::SQRT_2;

/// Acceleration of the root. Derived: 0.025 (4 pi)^2 m/s^2 of a walker's hips, which rise and sink
/// by 2.5 cm twice a second.
const ROOT_ACCELERATION_M_PER_S2: f32 = 4.0;
/// Random walk of a segment's length in the image, relative to it, in a second. Chosen: limbs leave
/// the image plane.
const LENGTH_WALK_PER_S: f32 = 0.1;
/// Standard deviation of the root, in lengths of the trunk, above which its position counts as
/// unknown. Chosen: half a trunk, about the length of a segment.
const ROOT_LOST_TRUNKS: f32 = 0.5;

/// How root and lengths are filtered; `px` stands for any unit of the picture's plane.
///
/// ```
/// use sinew_core::cyclic::PlaceOptions;
///
/// // Pictures of 20 frames a second instead of 30: the root's acceleration a frame grows with the square.
/// let slow = PlaceOptions::of_person(100.0, 0.005, 0.1, 20.0)?;
/// let quick = PlaceOptions::of_person(100.0, 0.005, 0.1, 30.0)?;
/// assert!((slow.root_acceleration_px / quick.root_acceleration_px - 2.25).abs() < 1e-4);
/// assert!((slow.keypoint_std_px - 7.07).abs() < 0.01, "an angle that is 0.1 rad off, at a trunk of 100 px");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaceOptions {
    /// Standard deviation of each coordinate of a keypoint, px.
    pub keypoint_std_px: f32,
    /// White acceleration of the root, px per frame^2.
    pub root_acceleration_px: f32,
    /// Part of itself by which a length walks in a frame.
    pub length_walk: f32,
    /// Standard deviation beyond which the root's place counts as not known, px.
    pub lost_std_px: f32,
}

impl PlaceOptions {
    /// For a person whose trunk is `trunk_px` long, a pixel `metres_per_px`, at `rate_hz` frames a
    /// second.
    ///
    /// The noise of a keypoint follows from that of an angle, `sigma_rad`. An angle that is off by
    /// sigma is that of a segment whose ends are off by sigma times its length / sqrt(2) each. The
    /// trunk gives the scale.
    ///
    /// # Errors
    /// All four have to be positive.
    pub fn of_person(trunk_px: f32, metres_per_px: f32, sigma_rad: f32, rate_hz: f32) -> Result<Self, ParameterError> {
        positive("trunk_px", trunk_px)?;
        positive("metres_per_px", metres_per_px)?;
        positive("sigma_rad", sigma_rad)?;
        positive("rate_hz", rate_hz)?;
        Ok(Self {
            keypoint_std_px: sigma_rad * trunk_px / SQRT_2,
            root_acceleration_px: ROOT_ACCELERATION_M_PER_S2 / metres_per_px / (rate_hz * rate_hz),
            length_walk: LENGTH_WALK_PER_S / sqrt(rate_hz),
            lost_std_px: ROOT_LOST_TRUNKS * trunk_px,
        })
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// Each has to be positive.
    pub fn check(&self) -> Result<(), ParameterError> {
        positive("keypoint_std_px", self.keypoint_std_px)?;
        positive("root_acceleration_px", self.root_acceleration_px)?;
        positive("length_walk", self.length_walk)?;
        positive("lost_std_px", self.lost_std_px)?;
        Ok(())
    }
}

/// Root and segment lengths over time, each with its own filter. `None` before the first
/// measurement.
///
/// ```
/// use sinew_core::cyclic::{FigurePlace, PlaceOptions};
///
/// let options = PlaceOptions::of_person(100.0, 0.005, 0.1, 30.0)?;
/// let mut place = FigurePlace::<2>::new(options)?;
/// place.step(1.0, Some([300.0, 200.0]), &[Some(80.0), None]);
/// assert_eq!(place.lengths_px(), [Some(80.0), None], "the second segment was never seen");
/// // After a second behind a pillar the root is unknown. Segments keep their length.
/// place.step(30.0, None, &[None; 2]);
/// assert_eq!(place.root_px(), None);
/// assert!(place.lengths_px()[0].is_some());
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FigurePlace<const N: usize> {
    options: PlaceOptions,
    root: Option<[ScalarFilter; 2]>,
    lengths: [Option<ScalarFilter>; N],
}

impl<const N: usize> FigurePlace<N> {
    /// Without measurements.
    ///
    /// # Errors
    /// Those of [`PlaceOptions::check`].
    pub fn new(options: PlaceOptions) -> Result<Self, ParameterError> {
        options.check()?;
        Ok(Self { options, root: None, lengths: [None; N] })
    }

    /// With first lengths, px, that have the variance of one measurement.
    ///
    /// # Errors
    /// As [`Self::new`]; each length positive.
    pub fn with_lengths(options: PlaceOptions, lengths_px: &[f32; N]) -> Result<Self, ParameterError> {
        let mut place = Self::new(options)?;
        for (filter, &length_px) in place.lengths.iter_mut().zip(lengths_px) {
            positive("segment length", length_px)?;
            *filter = place.options.length_filter(length_px);
        }
        Ok(place)
    }

    /// One step of `step_frames` (frames of the rate that the options are for). Missing values and
    /// those out of range ([`crate::ranges`]) are bridged.
    pub fn step(&mut self, step_frames: f32, root_px: Option<ImagePoint>, lengths_px: &[Option<f32>; N]) {
        let options = self.options;
        let root_px = root_px.filter(|root| root.iter().all(|coordinate_px| is_pixel(*coordinate_px)));
        if let Some(filters) = &mut self.root {
            let seen = root_px.map_or([None; 2], |root| root.map(Some));
            for (filter, seen) in filters.iter_mut().zip(seen) {
                filter.step(step_frames, seen, options.keypoint_std_px);
            }
        } else if let Some([x, y]) = root_px {
            self.root = options.root_filter(x).zip(options.root_filter(y)).map(|(x, y)| [x, y]);
        }
        for (filter, &seen) in self.lengths.iter_mut().zip(lengths_px) {
            let seen = seen.filter(|length_px| *length_px > 0.0 && is_pixel(*length_px));
            match (filter.as_mut(), seen) {
                (Some(filter), seen) => filter.step(step_frames, seen, SQRT_2 * options.keypoint_std_px),
                (None, Some(first)) => *filter = options.length_filter(first),
                (None, None) => {}
            }
        }
    }

    /// The root, px; `None` before its first measurement and where its standard deviation exceeds
    /// [`PlaceOptions::lost_std_px`].
    #[must_use]
    pub fn root_px(&self) -> Option<ImagePoint> {
        let filters = self.root?;
        let known = filters.iter().all(|filter| sqrt(filter.variance()) <= self.options.lost_std_px);
        known.then(|| filters.map(|filter| filter.value()))
    }

    /// Length of each segment, px.
    #[must_use]
    pub fn lengths_px(&self) -> [Option<f32>; N] {
        self.lengths.map(|filter| filter.map(|filter| filter.value()))
    }

    /// Writes the joints of `figure` at these angles, px. A joint is missing without the root or a
    /// length on the way to it; places in `joints_px` beyond the figure's joints are left
    /// alone.
    pub fn joints_px(&self, figure: &StickFigure<'_>, angles_rad: &[f32; N], joints_px: &mut [Option<ImagePoint>]) {
        for (index, joint) in figure.joints().iter().enumerate() {
            let place = match joint.parent {
                None => self.root_px(),
                Some(parent) => self.end_px(index, joints_px.get(usize::from(parent)).copied().flatten(), angles_rad),
            };
            if let Some(joint_px) = joints_px.get_mut(index) {
                *joint_px = place;
            }
        }
    }

    /// The end of the segment to the joint `index`, whose parent lies at `start`.
    fn end_px(&self, index: usize, start: Option<ImagePoint>, angles_rad: &[f32; N]) -> Option<ImagePoint> {
        let [x, y] = start?;
        let angle = index.checked_sub(1)?;
        let length_px = (*self.lengths.get(angle)?)?.value();
        let (sine, cosine) = crate::math::sin_cos(*angles_rad.get(angle)?);
        Some([x + length_px * cosine, y + length_px * sine])
    }
}

impl<const N: usize> SavedState for FigurePlace<N> {
    /// A state is for a place with the same options.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visit_optional(&mut self.root, [ScalarFilter::ZERO; 2], visitor, |axes, visitor| {
            axes.iter_mut().for_each(|axis| axis.visit(visitor));
        });
        for length in &mut self.lengths {
            visit_optional(length, ScalarFilter::ZERO, visitor, ScalarFilter::visit);
        }
    }
}

/// A part that may be missing; a reader begins it as `fill`.
fn visit_optional<T, V: StateVisitor>(part: &mut Option<T>, fill: T, visitor: &mut V, visit: impl Fn(&mut T, &mut V)) {
    let mut is_there = part.is_some();
    visitor.flag(&mut is_there);
    *part = is_there.then(|| part.take().unwrap_or(fill));
    if let Some(part) = part {
        visit(part, visitor);
    }
}

impl PlaceOptions {
    fn root_filter(&self, first_px: f32) -> Option<ScalarFilter> {
        ScalarFilter::new(first_px, self.keypoint_std_px, 0.0, self.root_acceleration_px).ok()
    }

    fn length_filter(&self, first_px: f32) -> Option<ScalarFilter> {
        ScalarFilter::new(first_px, SQRT_2 * self.keypoint_std_px, self.length_walk * first_px, 0.0).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use crate::skeleton::stick_figure::{HUMAN, HUMAN_ANGLES, HUMAN_JOINTS};

    fn options() -> PlaceOptions {
        PlaceOptions::of_person(100.0, 0.005, 0.05, 60.0).unwrap()
    }

    #[test]
    fn joints_of_a_walker_are_nearer_than_the_keypoints_and_a_lost_root_is_unknown() {
        let angles: [f32; HUMAN_ANGLES] = core::array::from_fn(|i| 0.4 * i as f32 - 2.0);
        let lengths = [40.0_f32; HUMAN_ANGLES];
        let mut place = FigurePlace::<HUMAN_ANGLES>::new(options()).unwrap();
        let (mut stream, mut truth, mut found) = (Stream::new(3, 0, 0), [[0.0; 2]; HUMAN_JOINTS], [None; HUMAN_JOINTS]);
        let (std, mut sum) = (options().keypoint_std_px, 0.0);
        for frame in 0..300_u16 {
            let root = [2.0 * f32::from(frame), 200.0];
            let seen = root.map(|value| value + std * stream.normal());
            place.step(1.0, Some(seen), &lengths.map(|length| Some(length + SQRT_2 * std * stream.normal())));
            HUMAN.joint_positions(root, &lengths, &angles, &mut truth);
            place.joints_px(&HUMAN, &angles, &mut found);
            if frame >= 100 {
                let off = |(truth, found): (&ImagePoint, &Option<ImagePoint>)| {
                    let found = found.unwrap();
                    (truth[0] - found[0]).powi(2) + (truth[1] - found[1]).powi(2)
                };
                sum += truth.iter().zip(&found).map(off).sum::<f32>() / (200.0 * 14.0 * 2.0);
            }
        }
        let error = sum.sqrt();
        assert!(error > 0.1 * std && error < 0.8 * std, "{error} px beside {std}");
        place.step(5.0, None, &[None; HUMAN_ANGLES]);
        assert!(place.root_px().is_some(), "a short gap is bridged");
        place.step(120.0, Some([f32::NAN, 0.0]), &[Some(f32::INFINITY); HUMAN_ANGLES]);
        assert!(place.root_px().is_none() && place.lengths_px().iter().all(|length| length.unwrap().is_finite()));
        place.joints_px(&HUMAN, &angles, &mut found);
        assert_eq!(found, [None; HUMAN_JOINTS]);
    }

    #[test]
    fn joints_behind_an_unknown_length_are_missing() {
        let mut place = FigurePlace::<HUMAN_ANGLES>::new(options()).unwrap();
        let mut lengths = [Some(30.0); HUMAN_ANGLES];
        lengths[8] = None;
        place.step(1.0, Some([0.0, 0.0]), &lengths);
        let mut joints = [None; HUMAN_JOINTS];
        place.joints_px(&HUMAN, &[0.0; HUMAN_ANGLES], &mut joints);
        let missing: Vec<usize> = (0..HUMAN_JOINTS).filter(|&joint| joints[joint].is_none()).collect();
        assert_eq!(missing, [9, 10], "left knee and ankle");
        assert!((joints[1].unwrap()[0] - 30.0).abs() < 1.0e-4);
    }

    #[test]
    fn options_that_are_not_positive_are_refused() {
        assert_eq!(PlaceOptions::of_person(0.0, 1.0, 1.0, 1.0).unwrap_err().parameter, "trunk_px");
        assert_eq!(PlaceOptions::of_person(1.0, 1.0, f32::NAN, 1.0).unwrap_err().parameter, "sigma_rad");
        let bad = PlaceOptions { lost_std_px: -1.0, ..options() };
        assert_eq!(FigurePlace::<2>::new(bad).unwrap_err().parameter, "lost_std_px");
        assert!(FigurePlace::<2>::with_lengths(options(), &[1.0, 0.0]).is_err());
    }
}
