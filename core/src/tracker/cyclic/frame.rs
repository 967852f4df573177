//! Input frame of the cyclic tracker: angles, root position and segment lengths.

use crate::cyclic::AngleMeasurement;
use crate::error::ParameterError;
use crate::math::max;
use crate::ranges::{ANGLE_STD_RAD, is_pixel};
use crate::skeleton::stick_figure::{ImagePoint, StickFigure};
use core::f32::consts::{PI, SQRT_2};

/// Measurements of a frame.
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
    /// From the joints of `figure` as a picture shows them, each coordinate with a standard
    /// deviation of `keypoint_std_px`, one frame after the last.
    ///
    /// An angle's standard deviation is sqrt(2) times that over the segment's length, at most pi
    /// and at least that of [`ANGLE_STD_RAD`]. A segment longer than
    /// [`MAX_PX`](crate::ranges::MAX_PX) is missing.
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
            if let Some(segment) = figure.segment(joints_px, index).filter(|segment| is_pixel(segment.length_px)) {
                angles_rad[index] = segment.angle_rad;
                lengths_px[index] = Some(segment.length_px);
                if segment.length_px * PI > SQRT_2 * keypoint_std_px {
                    std_rad[index] = max(SQRT_2 * keypoint_std_px / segment.length_px, *ANGLE_STD_RAD.start());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::stick_figure::{HUMAN, HUMAN_JOINTS};

    #[test]
    fn a_short_segment_gives_a_noisy_angle_and_a_missing_joint_none() {
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
