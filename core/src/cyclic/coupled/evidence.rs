//! What the angles of a frame say about the cycle's state in the phase-coupled filter, and how well they fit its prediction.

use crate::cyclic::coupled::cycle_pair::{CyclePair, Information};
use crate::cyclic::coupled::noise_scale::NoiseScore;
use crate::numeric::chi_square::{DEFAULT_GATE_SIGMAS, is_outlier};
use crate::numeric::log_product::LogProduct;
use core::f32::consts::TAU;

/// Angles deviate together, so that thirteen of them say less about the phase than thirteen independent ones would.
const TEMPERING: f32 = 2.5;
/// No angle tells the phase better than this, rad: between people the shape of the mean cycle is not the same to the last degree,
/// and an exact measurement of somebody else's shape would drag position and speed along.
const SHAPE_STD_RAD: f32 = 0.08;
/// The same of a motion in which an angle goes round: that swings four to five times as far as the limbs of walkers, and so do the
/// differences of its shape.
const WINDING_SHAPE_STD_RAD: f32 = 0.3;

/// Residuals of the angles seen, with their derivatives by (c, v).
pub(super) struct PhaseEvidence {
    /// Of all angles, as it is: for the likelihood.
    all: Information,
    /// Of the angles within the gate, tempered: for the correction.
    pub(super) trusted: Information,
    /// What they say about the noise.
    pub(super) noise: NoiseScore,
    /// Sum of squared residuals over their variance given (c, v).
    squares: f32,
    /// Product of those variances times 2 pi.
    volume: LogProduct,
    count: usize,
    /// Squared residuals over their whole variance, and number, of the angles that are judged each by itself.
    apart: (f32, usize),
    /// Variance, rad^2, below which no angle tells the phase.
    shape_rad2: f32,
}

/// How a measurement fitted its prediction.
pub(super) struct Judgement {
    /// ln of the density of all angles together.
    pub(super) log_likelihood: f32,
    /// Normalised innovation squared of the angles that wind as the mean cycle does.
    pub(super) squared: f32,
    /// Number of them.
    pub(super) present: usize,
    /// Whether the innovation lies beyond the gate.
    pub(super) outlier: bool,
    /// Times the noise variances told by which it was judged.
    pub(super) noise_scale: f32,
}

impl PhaseEvidence {
    /// No angle yet, of a motion in which angles go round, or none does; `noise` says nothing yet either.
    pub(super) const fn none(winds: bool, noise: NoiseScore) -> Self {
        let shape_std_rad = if winds { WINDING_SHAPE_STD_RAD } else { SHAPE_STD_RAD };
        Self {
            all: Information::NONE,
            trusted: Information::NONE,
            noise,
            squares: 0.0,
            volume: LogProduct::one(),
            count: 0,
            apart: (0.0, 0),
            shape_rad2: shape_std_rad * shape_std_rad,
        }
    }

    /// Counts an angle for the likelihood; `variance` is that of the residual given (c, v).
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn add(&mut self, gradient: &[f32; 2], variance: f32, residual: f32) {
        self.all.add(gradient, 1.0 / variance, residual);
        self.squares += residual * residual / variance;
        self.volume.multiply(TAU * variance);
        self.count += 1;
    }

    /// Counts an angle that winds otherwise than the mean cycle: by itself, for the likelihood and as an outlier only; `variance` is
    /// that of the residual.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn add_apart(&mut self, variance: f32, residual: f32) {
        let (squares, count) = &mut self.apart;
        *squares += residual * residual / variance;
        *count += 1;
        self.volume.multiply(TAU * variance);
    }

    /// Lets an angle correct the phase.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn trust(&mut self, gradient: &[f32; 2], variance: f32, residual: f32) {
        let weight = 1.0 / (TEMPERING * variance + self.shape_rad2);
        self.trusted.add(gradient, weight, residual);
    }

    /// Judges all angles together, by `noise_scale` times the noise variances told; `pair` is what was known of (c, v) before.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn judge(&self, pair: &CyclePair, noise_scale: f32) -> Judgement {
        let (explained, log_growth) = pair.explained(&self.all);
        let squared = crate::math::max(self.squares - explained, 0.0);
        Judgement {
            log_likelihood: -0.5 * (squared + self.apart.0 + self.volume.ln() + log_growth),
            squared,
            present: self.count,
            outlier: is_outlier(squared + self.apart.0, self.count + self.apart.1, DEFAULT_GATE_SIGMAS),
            noise_scale,
        }
    }
}
