//! Evidence of a frame's angles for (c, v) in the phase-coupled filter, and the frame's innovation.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::constants::{TEMPERING, WINDING_SHAPE_STD_RAD};
use crate::cyclic::coupled::phase::cycle_pair::{CyclePair, Information};
use crate::numeric::chi_square::{DEFAULT_GATE_SIGMAS, is_outlier};
use crate::numeric::log_product::LogProduct;
use core::f32::consts::TAU;

/// Innovations of the measured angles with their derivatives by (c, v).
pub(crate) struct PhaseEvidence {
    /// Of all angles, not tempered: for the likelihood.
    all: Information,
    /// Of the angles within the gate, tempered: for the correction.
    pub(crate) gated: Information,
    /// Sum of squared innovations over their variance given (c, v).
    squares: f32,
    /// Product of those variances times 2 pi.
    volume: LogProduct,
    count: usize,
    /// NIS and number of the angles that are excluded from the phase's evidence.
    excluded: (f32, usize),
    /// Variance of a person's cycle shape, rad^2: what the tempered variance is increased by.
    shape_rad2: f32,
}

/// Innovation of a frame: its likelihood and the gate.
pub(crate) struct FrameInnovation {
    /// ln of the density of all angles together.
    pub(crate) log_likelihood: f32,
    /// Whether the innovation lies beyond the gate.
    pub(crate) outlier: bool,
}

impl PhaseEvidence {
    /// Without angles so far, in a motion in which some angle winds or none does.
    pub(crate) fn none(winds: bool) -> Self {
        let shape_std_rad = if winds && is_on(Part::WindingShape) { WINDING_SHAPE_STD_RAD } else { 0.0 };
        Self {
            all: Information::NONE,
            gated: Information::NONE,
            squares: 0.0,
            volume: LogProduct::one(),
            count: 0,
            excluded: (0.0, 0),
            shape_rad2: shape_std_rad * shape_std_rad,
        }
    }

    /// Adds an angle to the likelihood; `variance`, rad^2, is the innovation's given (c, v).
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn add(&mut self, gradient: &[f32; 2], variance: f32, residual: f32) {
        self.all.add(gradient, 1.0 / variance, residual);
        self.squares += residual * residual / variance;
        self.volume.multiply(TAU * variance);
        self.count += 1;
    }

    /// Adds an angle that does not inform the phase to likelihood and gate only; `variance`, rad^2,
    /// is that of the innovation.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn add_excluded(&mut self, variance: f32, residual: f32) {
        let (squares, count) = &mut self.excluded;
        *squares += residual * residual / variance;
        *count += 1;
        self.volume.multiply(TAU * variance);
    }

    /// Adds an angle within the gate to the correction of (c, v), tempered.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn add_gated(&mut self, gradient: &[f32; 2], variance: f32, residual: f32) {
        let tempering = if is_on(Part::Tempering) { TEMPERING } else { 1.0 };
        let weight = 1.0 / (tempering * variance + self.shape_rad2);
        self.gated.add(gradient, weight, residual);
    }

    /// Innovation of all angles; `pair` is the prior of (c, v).
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn innovation(&self, pair: &CyclePair) -> FrameInnovation {
        let (explained, log_growth) = pair.explained(&self.all);
        let squared = crate::math::max(self.squares - explained, 0.0);
        FrameInnovation {
            log_likelihood: -0.5 * (squared + self.excluded.0 + self.volume.ln() + log_growth),
            outlier: is_outlier(squared + self.excluded.0, self.count + self.excluded.1, DEFAULT_GATE_SIGMAS),
        }
    }
}
