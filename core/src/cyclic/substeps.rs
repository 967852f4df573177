//! A step of any length as steps of at most one frame: the noise of eqs. (9) and (10) is defined for those.

use super::measurement::MAX_STEP_FRAMES;
use crate::math::clamp;

/// The parts of a step: whole frames first, then what is left. At most 600.
#[derive(Debug, Clone)]
pub struct Substeps {
    left_frames: f32,
}

impl Substeps {
    /// The parts of `step_frames`, which is cut to 0..=600.
    #[inline]
    #[must_use]
    pub fn of(step_frames: f32) -> Self {
        Self { left_frames: if step_frames.is_finite() { clamp(step_frames, 0.0, MAX_STEP_FRAMES) } else { 0.0 } }
    }
}

/// What is left below this part of a frame is rounding.
const LEAST_STEP_FRAMES: f32 = 1.0e-4;

impl Iterator for Substeps {
    type Item = f32;

    #[inline]
    fn next(&mut self) -> Option<f32> {
        if self.left_frames < LEAST_STEP_FRAMES {
            return None;
        }
        let step = crate::math::min(self.left_frames, 1.0);
        self.left_frames -= step;
        Some(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_whole_frames_and_a_rest() {
        assert_eq!(Substeps::of(1.0).collect::<Vec<_>>(), [1.0]);
        assert_eq!(Substeps::of(2.5).collect::<Vec<_>>(), [1.0, 1.0, 0.5]);
        assert_eq!(Substeps::of(1.0e9).count(), 600);
        assert_eq!(Substeps::of(f32::NAN).count(), 0);
    }
}
