//! Monitor of the normalised innovation squared (NIS) per angle: recent mean and running minimum.
//!
//! A recent NIS far above its minimum means that the phase is lost. A high NIS at a phase that the
//! grid confirms means that the noise is larger than stated. NIS: Bar-Shalom, Li and Kirubarajan,
//! Estimation with Applications to Tracking and Navigation (2001), section 5.4.

use crate::cyclic::coupled::evidence::FrameInnovation;
use crate::cyclic::saved_ranges::VARIANCE;
use crate::math::min;
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};

/// Gain of the recent NIS in a frame. Chosen: a mean over about twenty frames.
const RECENT_GAIN: f32 = 0.05;
/// Largest NIS per angle that a frame counts with. Chosen: three standard deviations of an angle.
const MAX_FRAME_NIS: f32 = 9.0;
/// Gain by which the floor follows a higher recent NIS. Chosen: about ten seconds at 60 Hz.
const FLOOR_RISE: f32 = 0.002;
/// The same in a frame in which the grid confirms the phase. Chosen: about fifty frames.
const AGREED_FLOOR_RISE: f32 = 0.02;
/// Recent NIS over its floor up to which the phase counts as right.
///
/// Measured on eight walks at nine tempos: 0.9 to 1.1 at a jump away from the right phase, and a
/// median of 1.4 at a needed jump (`docs/cyclic_coupled.md`).
const MAX_GOOD_RATIO: f32 = 1.3;
/// Recent NIS over its floor above which the phase counts as lost, also where the motion runs
/// backwards. Chosen: above the median of 1.4 at a needed jump.
const MIN_LOST_RATIO: f32 = 1.6;

/// NIS per angle by the stated noise: recent mean and running minimum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NisMonitor {
    /// Mean over about twenty frames.
    recent: f32,
    /// Running minimum, which rises slowly.
    floor: f32,
    /// Frames since the start or the last relock.
    frames: f32,
}

impl SavedState for NisMonitor {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.recent, &VARIANCE);
        visitor.real(&mut self.floor, &VARIANCE);
        visitor.real(&mut self.frames, &NOT_NEGATIVE);
    }
}

impl NisMonitor {
    /// Before the first frame: a NIS of 1, the expected value of a consistent filter.
    pub(super) const fn new() -> Self {
        Self { recent: 1.0, floor: 1.0, frames: 0.0 }
    }

    /// Adds a frame's NIS, `step_frames` after the last one. A frame without angles changes only
    /// the time.
    pub(super) fn update(&mut self, innovation: &FrameInnovation, step_frames: f32) {
        self.frames += step_frames;
        if innovation.present > 0 {
            let nis = min(innovation.squared / innovation.present as f32, MAX_FRAME_NIS);
            self.recent += RECENT_GAIN * (nis - self.recent);
            let gain = if self.recent < self.floor { RECENT_GAIN } else { FLOOR_RISE };
            self.floor += gain * (self.recent - self.floor);
        }
    }

    /// Raises the floor towards the recent NIS: the grid, updated `frames` ago, confirms the phase,
    /// so the excess is noise.
    pub(super) fn raise_floor(&mut self, frames: f32) {
        if self.recent > self.floor {
            self.floor += min(AGREED_FLOOR_RISE * frames, 1.0) * (self.recent - self.floor);
        }
    }

    /// Restarts the count of frames after a relock.
    pub(super) const fn restart(&mut self) {
        self.frames = 0.0;
    }

    /// Whether the start or the last relock was less than `frames` ago.
    pub(super) fn is_new(&self, frames: f32) -> bool {
        self.frames < frames
    }

    /// Whether the recent NIS exceeds [`MIN_LOST_RATIO`] times its floor.
    pub(super) fn is_lost(&self) -> bool {
        self.recent > MIN_LOST_RATIO * self.floor
    }

    /// Whether the recent NIS is below [`MAX_GOOD_RATIO`] times its floor, at least `min_frames`
    /// after the last relock.
    pub(super) fn is_good(&self, min_frames: f32) -> bool {
        self.frames > min_frames && self.recent < MAX_GOOD_RATIO * self.floor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn innovation(squared: f32, present: usize) -> FrameInnovation {
        FrameInnovation { log_likelihood: 0.0, squared, present, outlier: false }
    }

    /// Adds `frames` whose NIS per angle is `nis`.
    fn seen(monitor: &mut NisMonitor, nis: f32, frames: usize) {
        (0..frames).for_each(|_| monitor.update(&innovation(13.0 * nis, 13), 1.0));
    }

    #[test]
    fn a_high_nis_at_a_confirmed_phase_raises_the_floor() {
        let mut monitor = NisMonitor::new();
        seen(&mut monitor, 4.0, 60);
        assert!(monitor.is_lost(), "the phase may be wrong");
        for _ in 0..60 {
            seen(&mut monitor, 4.0, 3);
            monitor.raise_floor(3.0);
        }
        assert!(monitor.is_good(50.0), "{monitor:?}");
    }

    #[test]
    fn a_filter_whose_nis_rises_is_not_good_until_the_floor_has_followed() {
        for floor in [0.02, 1.0, 3.0] {
            let mut monitor = NisMonitor::new();
            seen(&mut monitor, floor, 30);
            assert!(!monitor.is_good(50.0), "too early");
            seen(&mut monitor, floor, 3000);
            assert!(monitor.is_good(50.0));
            seen(&mut monitor, 1.2 * floor, 100);
            assert!(monitor.is_good(50.0), "a little worse");
            seen(&mut monitor, 2.0 * floor, 40);
            assert!(!monitor.is_good(50.0), "lost");
            seen(&mut monitor, 2.0 * floor, 3000);
            assert!(monitor.is_good(50.0), "the floor has followed");
            monitor.restart();
            assert!(!monitor.is_good(50.0));
        }
    }

    #[test]
    fn frames_without_a_measurement_leave_the_nis_unchanged() {
        let mut monitor = NisMonitor::new();
        let before = monitor;
        monitor.update(&innovation(0.0, 0), 7.0);
        assert_eq!(monitor, NisMonitor { frames: 7.0, ..before });
    }
}
