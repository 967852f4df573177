//! Scale of a person's spread: how much more this person differs from the mean cycle than the
//! people of the training do.
//!
//! Innovations of a model that fits are white, and their normalised squares (NIS) have a mean of
//! one. Those of a model that does not fit keep their sign over many frames. The mean NIS then
//! exceeds one, and the mean product of two innovations in a row exceeds zero, by about the same
//! share e of the innovation's variance. Each alone has another cause. Noise larger than stated
//! raises the NIS only, and noise that moves slowly raises the product only. So e is the smaller of
//! both, where the product is beyond its gate. The prior variances of the person's deviation then
//! grow until the innovations are white. This is the test by NIS and autocorrelation over time of
//! Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation (2001),
//! section 5.4, with the covariance matching of Mehra 1972.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::constants::{
    FORGETTING, GATE_SIGMAS, GROWTH, MAX_DEFENDED_SCALE, MAX_FITTING_SCALE, MAX_SQUARE,
};
use crate::math::{clamp, max, min, sqrt};
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};

/// Largest scale of spread and noise: the standard deviation is then as large as the gate.
pub(crate) const MAX_SCALE: f32 = GATE_SIGMAS * GATE_SIGMAS;

/// Scale of the prior variances of a person's deviation, at least one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpreadScale {
    scale: f32,
    /// Frames with a measurement since the start.
    frames: f32,
    /// Mean NIS of an angle, less one.
    nis_excess: f32,
    /// Mean normalised product of an angle's innovations in two frames in a row.
    product: f32,
    /// Variance of that mean, were the innovations white.
    product_variance: f32,
}

/// Sums over the angles of a frame.
pub(crate) struct FrameProducts {
    squares: f32,
    products: f32,
    count: f32,
}

impl FrameProducts {
    /// Without angles.
    pub(crate) const NONE: Self = Self { squares: 0.0, products: 0.0, count: 0.0 };

    /// Adds an angle's innovation in this frame and the last one, rad, with its variance, rad^2.
    #[inline]
    pub(crate) fn add(&mut self, [innovation_rad, last_rad]: [f32; 2], variance: f32) {
        let share = innovation_rad / variance;
        self.squares += min(share * innovation_rad, MAX_SQUARE);
        self.products += clamp(share * last_rad, -MAX_SQUARE, MAX_SQUARE);
        self.count += 1.0;
    }
}

impl SavedState for SpreadScale {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.scale, &(1.0..=MAX_SCALE));
        visitor.real(&mut self.frames, &NOT_NEGATIVE);
        visitor.real(&mut self.nis_excess, &(-1.0..=MAX_SQUARE));
        visitor.real(&mut self.product, &(-MAX_SQUARE..=MAX_SQUARE));
        visitor.real(&mut self.product_variance, &(0.0..=1.0));
    }
}

impl SpreadScale {
    /// As in the training.
    pub(crate) const fn new() -> Self {
        Self { scale: 1.0, ..Self::zero() }
    }

    /// Zeros, for a hypothesis that has not begun.
    pub(crate) const fn zero() -> Self {
        Self { scale: 0.0, frames: 0.0, nis_excess: 0.0, product: 0.0, product_variance: 0.0 }
    }

    /// Factor of the prior variances, in [1, [`MAX_SCALE`]].
    pub(crate) const fn scale(&self) -> f32 {
        self.scale
    }

    /// Whether the motion differs from the mean cycle by more than a person does.
    pub(crate) fn is_misfit(&self) -> bool {
        self.scale > MAX_FITTING_SCALE
    }

    /// Whether the deviations are so free that they follow any motion.
    pub(crate) fn is_doubtful(&self) -> bool {
        self.scale > MAX_DEFENDED_SCALE
    }

    /// Adds a frame, `cycles` of the mean cycle after the last one. Returns the factor by which the
    /// scale grew.
    pub(crate) fn update(&mut self, frame: &FrameProducts, cycles: f32) -> f32 {
        if frame.count < 1.0 {
            return 1.0;
        }
        self.frames += 1.0;
        // The mean over all frames, later over the last cycle.
        let gain = min(max(cycles, 1.0 / self.frames), 1.0);
        self.nis_excess += gain * (frame.squares / frame.count - 1.0 - self.nis_excess);
        self.product += gain * (frame.products / frame.count - self.product);
        self.product_variance = (1.0 - gain) * (1.0 - gain) * self.product_variance + gain * gain / frame.count;
        let excess = min(self.nis_excess, self.product);
        // White innovations with the variance 1 + e have products with that standard deviation.
        let white_std = (1.0 + max(self.nis_excess, 0.0)) * sqrt(self.product_variance);
        if excess > GATE_SIGMAS * white_std && is_on(Part::SpreadScale) {
            let before = self.scale;
            self.scale = min(before * (1.0 + min(GROWTH * cycles * excess, 1.0)), MAX_SCALE);
            return self.scale / before;
        }
        self.scale -= min(FORGETTING * cycles, 1.0) * (self.scale - 1.0);
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    const CYCLES: f32 = 1.0 / 60.0;

    /// The scale after each of `frames` of 13 innovations: of each, `slow` is its variance that
    /// keeps 0.9 from frame to frame, `white` the rest, and `assumed` what the filter takes both
    /// for.
    fn scales([slow, white, assumed]: [f32; 3], frames: u64) -> [f32; 3] {
        let (mut scale, mut kept, mut last) = (SpreadScale::new(), [0.0; 13], [0.0; 13]);
        let mut found = [1.0; 3];
        for frame in 0..frames {
            let mut stream = Stream::new(7, frame, 0);
            let mut products = FrameProducts::NONE;
            for i in 0..13 {
                kept[i] = 0.9 * kept[i] + sqrt((1.0 - 0.81) * slow) * stream.normal();
                let innovation = kept[i] + sqrt(white) * stream.normal();
                products.add([innovation, last[i]], assumed);
                last[i] = innovation;
            }
            let before = scale.scale();
            let growth = scale.update(&products, CYCLES);
            assert!(growth >= 1.0 && (growth == 1.0 || (scale.scale() - before * growth).abs() < 1.0e-3));
            found = [scale.scale(), scale.nis_excess, scale.product];
        }
        found
    }

    #[test]
    fn white_innovations_leave_the_scale_at_one() {
        for seconds in [1, 10, 60] {
            let [scale, excess, product] = scales([0.0, 0.04, 0.04], 60 * seconds);
            assert!((1.0..1.2).contains(&scale) && excess.abs() < 0.15 && product.abs() < 0.1, "{scale} {excess}");
        }
    }

    #[test]
    fn a_motion_unlike_the_model_raises_it_within_two_cycles() {
        let [scale, ..] = scales([0.02, 0.04, 0.04], 60);
        assert!((2.5..16.0).contains(&scale), "{scale}");
        let [scale, ..] = scales([0.2, 0.04, 0.04], 120);
        assert!((15.0..=16.0).contains(&scale), "{scale}");
    }

    #[test]
    fn noise_larger_than_stated_or_slow_is_no_other_motion() {
        let [larger, excess, _] = scales([0.0, 0.12, 0.04], 300);
        assert!(larger < 1.2 && excess > 1.5, "{larger} {excess}");
        let [slow, _, product] = scales([0.03, 0.0, 0.04], 300);
        assert!(slow < 1.2 && product > 0.4, "{slow} {product}");
    }

    #[test]
    fn the_scale_returns_when_the_innovations_are_white_again() {
        let mut scale = SpreadScale { scale: 12.0, ..SpreadScale::new() };
        assert!(scale.is_misfit());
        let mut white = FrameProducts::NONE;
        white.add([0.1, 0.0], 0.01);
        (0..60 * 60).for_each(|_| assert!(scale.update(&white, CYCLES) <= 1.0));
        assert!((3.0..6.0).contains(&scale.scale()) && !scale.is_misfit(), "{scale:?}");
        assert!(scale.update(&FrameProducts::NONE, CYCLES) <= 1.0);
    }
}
