//! How well a filter predicts what it sees, beside how well it once did: a filter that has lost its place predicts worse, and one
//! that knows it and still predicts badly was told of too little noise.

use crate::cyclic::coupled::phase_evidence::Judgement;
use crate::math::{clamp, min};
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};

/// Share of the newest frame in the recent misfit: about the last twenty frames.
const NEWEST: f32 = 0.05;
/// Greatest misfit that a single frame counts with.
const MOST: f32 = 9.0;
/// Share by which the least misfit follows the recent one upwards: about ten seconds at 60 Hz.
const RISE: f32 = 0.002;
/// The same for each frame of which the filter's place is known to be right: about the last fifty frames.
const AGREED_RISE: f32 = 0.02;
/// Times its least up to which the recent misfit is that of a filter that knows its place. On walks at nine tempos three in four
/// frames of such a filter have a misfit below 1.1; when it had to be sent elsewhere the median was 1.4.
const GOOD: f32 = 1.3;
/// Times its least from which the recent misfit is bad, whatever was said before.
const BAD: f32 = 1.6;
/// Greatest factor by which noise may be larger than told, variances.
const MOST_NOISE: f32 = 16.0;

/// Normalised innovation squared per angle, by the noise that was told, over the last frames and at its best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PredictionFit {
    recent: f32,
    least: f32,
    /// Frames since the place was last found.
    frames: f32,
}

impl SavedState for PredictionFit {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.recent, &NOT_NEGATIVE);
        visitor.real(&mut self.least, &NOT_NEGATIVE);
        visitor.real(&mut self.frames, &NOT_NEGATIVE);
    }
}

impl PredictionFit {
    /// Nothing seen: as it is on the mean where model and noise are right.
    pub(super) const fn new() -> Self {
        Self { recent: 1.0, least: 1.0, frames: 0.0 }
    }

    /// Factor of the noise variances with which the filter predicts as well as its covariances say: at least one.
    pub(super) fn noise_scale(&self) -> f32 {
        clamp(self.least, 1.0, MOST_NOISE)
    }

    /// Takes in a frame, `step_frames` after the last one.
    pub(super) fn see(&mut self, judgement: &Judgement, step_frames: f32) {
        self.frames += step_frames;
        if judgement.present > 0 {
            let misfit = judgement.noise_scale * min(judgement.squared / judgement.present as f32, MOST);
            self.recent += NEWEST * (misfit - self.recent);
            let share = if self.recent < self.least { NEWEST } else { RISE };
            self.least += share * (self.recent - self.least);
        }
    }

    /// Somebody else, who looks every `frames`, finds the filter's place right: what is left of the misfit is noise.
    pub(super) fn agree(&mut self, frames: f32) {
        if self.recent > self.least {
            self.least += min(AGREED_RISE * frames, 1.0) * (self.recent - self.least);
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
    pub(super) fn is_bad(&self) -> bool {
        self.recent > BAD * self.least
    }

    /// Whether the filter, for `least_frames` at one place, predicts about as well as it ever did.
    pub(super) fn is_good(&self, least_frames: f32) -> bool {
        self.frames > least_frames && self.recent < GOOD * self.least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judgement(squared: f32, present: usize, noise_scale: f32) -> Judgement {
        Judgement { log_likelihood: 0.0, squared, present, outlier: false, noise_scale }
    }

    /// Frames whose misfit by the noise told is `misfit`.
    fn seen(fit: &mut PredictionFit, misfit: f32, frames: usize) {
        for _ in 0..frames {
            let squared = 13.0 * misfit / fit.noise_scale();
            fit.see(&judgement(squared, 13, fit.noise_scale()), 1.0);
        }
    }

    #[test]
    fn noise_is_larger_than_told_where_a_right_place_predicts_badly() {
        let mut fit = PredictionFit::new();
        seen(&mut fit, 4.0, 60);
        assert!(fit.noise_scale() < 1.5, "it may be the place that is wrong");
        for _ in 0..60 {
            seen(&mut fit, 4.0, 3);
            fit.agree(3.0);
        }
        assert!((3.8..4.01).contains(&fit.noise_scale()), "{fit:?}");
        seen(&mut fit, 0.5, 200);
        assert!(fit.noise_scale() == 1.0, "never smaller than told");
    }

    #[test]
    fn a_filter_that_predicts_worse_than_it_did_is_not_good_until_it_is_used_to_it() {
        for usual in [0.02, 1.0, 3.0] {
            let mut fit = PredictionFit::new();
            seen(&mut fit, usual, 30);
            assert!(!fit.is_good(50.0), "too early");
            seen(&mut fit, usual, 3000);
            assert!(fit.is_good(50.0));
            seen(&mut fit, 1.2 * usual, 100);
            assert!(fit.is_good(50.0), "a little worse");
            seen(&mut fit, 2.0 * usual, 40);
            assert!(!fit.is_good(50.0), "lost");
            seen(&mut fit, 2.0 * usual, 3000);
            assert!(fit.is_good(50.0), "such is the person");
            fit.restart();
            assert!(!fit.is_good(50.0));
        }
    }

    #[test]
    fn frames_without_a_measurement_tell_nothing() {
        let mut fit = PredictionFit::new();
        let before = fit;
        fit.see(&judgement(0.0, 0, 1.0), 7.0);
        assert_eq!(fit, PredictionFit { frames: 7.0, ..before });
    }
}
