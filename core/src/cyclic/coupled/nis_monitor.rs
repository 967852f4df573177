//! How well a filter predicts what it sees, beside how well it once did: a filter that has lost its place predicts worse, and one
//! that knows it and still predicts badly was told of too little noise.

use crate::cyclic::coupled::evidence::Judgement;
use crate::math::{clamp, min};
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};

/// Share of the newest frame in the recent misfit: about the last twenty frames.
const NEWEST_SHARE: f32 = 0.05;
/// Greatest misfit that a single frame counts with.
const MAX_FRAME_NIS: f32 = 9.0;
/// Share by which the least misfit follows the recent one upwards: about ten seconds at 60 Hz.
const FLOOR_RISE: f32 = 0.002;
/// The same for each frame of which the filter's place is known to be right: about the last fifty frames.
const AGREED_FLOOR_RISE: f32 = 0.02;
/// Times its least up to which the recent misfit is that of a filter that knows its place. On walks at nine tempos three in four
/// frames of such a filter have a misfit below 1.1; when it had to be sent elsewhere the median was 1.4.
const MAX_GOOD_RATIO: f32 = 1.3;
/// Times its least from which the recent misfit is bad, whatever was said before.
const MIN_LOST_RATIO: f32 = 1.6;
/// Greatest factor by which noise may be larger than told, variances.
const MAX_NOISE_SCALE: f32 = 16.0;

/// Normalised innovation squared per angle, by the noise that was told, over the last frames and at its best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NisMonitor {
    recent: f32,
    floor: f32,
    /// Frames since the place was last found.
    frames: f32,
}

impl SavedState for NisMonitor {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.recent, &NOT_NEGATIVE);
        visitor.real(&mut self.floor, &NOT_NEGATIVE);
        visitor.real(&mut self.frames, &NOT_NEGATIVE);
    }
}

impl NisMonitor {
    /// Nothing seen: as it is on the mean where model and noise are right.
    pub(super) const fn new() -> Self {
        Self { recent: 1.0, floor: 1.0, frames: 0.0 }
    }

    /// Factor of the noise variances with which the filter predicts as well as its covariances say: at least one.
    pub(super) fn noise_scale(&self) -> f32 {
        clamp(self.floor, 1.0, MAX_NOISE_SCALE)
    }

    /// Takes in a frame, `step_frames` after the last one.
    pub(super) fn see(&mut self, judgement: &Judgement, step_frames: f32) {
        self.frames += step_frames;
        if judgement.present > 0 {
            let misfit = judgement.noise_scale * min(judgement.squared / judgement.present as f32, MAX_FRAME_NIS);
            self.recent += NEWEST_SHARE * (misfit - self.recent);
            let share = if self.recent < self.floor { NEWEST_SHARE } else { FLOOR_RISE };
            self.floor += share * (self.recent - self.floor);
        }
    }

    /// Somebody else, who looks every `frames`, finds the filter's place right: what is left of the misfit is noise.
    pub(super) fn raise_floor(&mut self, frames: f32) {
        if self.recent > self.floor {
            self.floor += min(AGREED_FLOOR_RISE * frames, 1.0) * (self.recent - self.floor);
        }
    }

    /// The place was found anew: predictions are yet to be judged.
    pub(super) const fn restart(&mut self) {
        self.frames = 0.0;
    }

    /// Whether the place was found less than so many frames ago.
    pub(super) fn is_new(&self, frames: f32) -> bool {
        self.frames < frames
    }

    /// Whether the filter predicts far worse than it once did.
    pub(super) fn is_lost(&self) -> bool {
        self.recent > MIN_LOST_RATIO * self.floor
    }

    /// Whether the filter, for `least_frames` at one place, predicts about as well as it ever did.
    pub(super) fn is_good(&self, least_frames: f32) -> bool {
        self.frames > least_frames && self.recent < MAX_GOOD_RATIO * self.floor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judgement(squared: f32, present: usize, noise_scale: f32) -> Judgement {
        Judgement { log_likelihood: 0.0, squared, present, outlier: false, noise_scale }
    }

    /// Frames whose misfit by the noise told is `misfit`.
    fn seen(monitor: &mut NisMonitor, misfit: f32, frames: usize) {
        for _ in 0..frames {
            let squared = 13.0 * misfit / monitor.noise_scale();
            monitor.see(&judgement(squared, 13, monitor.noise_scale()), 1.0);
        }
    }

    #[test]
    fn noise_is_larger_than_told_where_a_right_place_predicts_badly() {
        let mut monitor = NisMonitor::new();
        seen(&mut monitor, 4.0, 60);
        assert!(monitor.noise_scale() < 1.5, "it may be the place that is wrong");
        for _ in 0..60 {
            seen(&mut monitor, 4.0, 3);
            monitor.raise_floor(3.0);
        }
        assert!((3.8..4.01).contains(&monitor.noise_scale()), "{monitor:?}");
        seen(&mut monitor, 0.5, 200);
        assert!(monitor.noise_scale() == 1.0, "never smaller than told");
    }

    #[test]
    fn a_filter_that_predicts_worse_than_it_did_is_not_good_until_it_is_used_to_it() {
        for usual in [0.02, 1.0, 3.0] {
            let mut monitor = NisMonitor::new();
            seen(&mut monitor, usual, 30);
            assert!(!monitor.is_good(50.0), "too early");
            seen(&mut monitor, usual, 3000);
            assert!(monitor.is_good(50.0));
            seen(&mut monitor, 1.2 * usual, 100);
            assert!(monitor.is_good(50.0), "a little worse");
            seen(&mut monitor, 2.0 * usual, 40);
            assert!(!monitor.is_good(50.0), "lost");
            seen(&mut monitor, 2.0 * usual, 3000);
            assert!(monitor.is_good(50.0), "such is the person");
            monitor.restart();
            assert!(!monitor.is_good(50.0));
        }
    }

    #[test]
    fn frames_without_a_measurement_tell_nothing() {
        let mut monitor = NisMonitor::new();
        let before = monitor;
        monitor.see(&judgement(0.0, 0, 1.0), 7.0);
        assert_eq!(monitor, NisMonitor { frames: 7.0, ..before });
    }
}
