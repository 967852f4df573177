//! Substeps of a step of any length.
//!
//! They are at most one frame long, for which the noise of cyclic (9) and cyclic (10) is defined.
//! They are longer where their number is limited.

use crate::cyclic::measurement::MAX_STEP_FRAMES;
use crate::math::{clamp, max, min};

/// Substeps: equal ones first, then the remainder.
///
/// ```
/// use sinew_core::cyclic::substeps::Substeps;
///
/// assert!(Substeps::of(2.5).eq([1.0, 1.0, 0.5]));
/// // A gap of twelve frames in six parts at most: the work has a limit.
/// assert!(Substeps::few(12.0, 6).eq([2.0; 6]));
/// assert!(Substeps::few(2.5, 6).eq([1.0, 1.0, 0.5]), "fewer frames than parts");
/// ```
#[derive(Debug, Clone)]
pub struct Substeps {
    left_frames: f32,
    part_frames: f32,
}

impl Substeps {
    /// The parts of `step_frames`, which is cut to 0..=600: one frame each, so at most 600.
    #[inline]
    #[must_use]
    pub fn of(step_frames: f32) -> Self {
        let left_frames = if step_frames.is_finite() { clamp(step_frames, 0.0, MAX_STEP_FRAMES) } else { 0.0 };
        Self { left_frames, part_frames: 1.0 }
    }

    /// As [`Self::of`], but no more than `parts` (at least one), all alike: beyond so many frames
    /// each part is longer than a frame.
    #[inline]
    #[must_use]
    pub fn few(step_frames: f32, parts: u8) -> Self {
        let whole = Self::of(step_frames);
        let part_frames = max(whole.left_frames / f32::from(parts.max(1)), 1.0);
        Self { part_frames, ..whole }
    }
}

/// Shortest substep, frames. Chosen: a shorter remainder is rounding of the longest step.
const MIN_STEP_FRAMES: f32 = 1.0e-3;

impl Iterator for Substeps {
    type Item = f32;

    #[inline]
    fn next(&mut self) -> Option<f32> {
        if self.left_frames < MIN_STEP_FRAMES {
            return None;
        }
        let step = min(self.left_frames, self.part_frames);
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

    #[test]
    fn few_parts_are_frames_until_there_are_too_many() {
        assert_eq!(Substeps::few(2.5, 8).collect::<Vec<_>>(), [1.0, 1.0, 0.5]);
        assert_eq!(Substeps::few(12.0, 8).collect::<Vec<_>>(), [1.5; 8]);
        for frames in [8.5, 10.1, 33.3, 511.7, 599.9, 1.0e9] {
            let parts: Vec<_> = Substeps::few(frames, 8).collect();
            assert!(parts.len() <= 8, "{frames}: {parts:?}");
            assert!((parts.iter().sum::<f32>() - frames.min(600.0)).abs() < 2.0e-3, "{frames}: {parts:?}");
        }
    }
}
