//! Covariance of cycle position and velocity (c, v) through prediction and correction.

use crate::cyclic::coupled::constants::TEMPORAL_STD;
use crate::cyclic::saved_ranges::VARIANCE;
use crate::math::{clamp, ln, max, min, sqrt};
use crate::saved_state::{SavedState, StateVisitor};

/// Covariance of (c, v), in cycles and frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CyclePair {
    /// Variance of c.
    pub(crate) cc: f32,
    /// Covariance of c and v.
    pub(crate) cv: f32,
    /// Variance of v.
    pub(crate) vv: f32,
}

impl SavedState for CyclePair {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.cc, &VARIANCE);
        visitor.real(&mut self.vv, &VARIANCE);
        // |cov| <= std std, up to rounding.
        let most = 1.001 * sqrt(self.cc) * sqrt(self.vv);
        visitor.real(&mut self.cv, &(-most..=most));
    }
}

/// Information on (c, v): the normal equations of the innovations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Information {
    /// Matrix: cc, cv, vv.
    matrix: [f32; 3],
    vector: [f32; 2],
}

impl Information {
    /// No information.
    pub(crate) const NONE: Self = Self { matrix: [0.0; 3], vector: [0.0; 2] };

    /// Adds a residual with derivatives `gradient` by (c, v).
    #[inline]
    pub(crate) fn add(&mut self, gradient: &[f32; 2], weight: f32, residual: f32) {
        let [g, h] = *gradient;
        self.matrix[0] += weight * g * g;
        self.matrix[1] += weight * g * h;
        self.matrix[2] += weight * h * h;
        self.vector[0] += weight * g * residual;
        self.vector[1] += weight * h * residual;
    }
}

impl CyclePair {
    /// Propagates by `step` frames, cyclic (4), cyclic (5) and cyclic (10). Returns the regression
    /// of the old (c, v) on the new one, and its residual covariance (cc, cv, vv).
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn advance(&mut self, step: f32) -> ([[f32; 2]; 2], [f32; 3]) {
        let Self { cc, cv, vv } = *self;
        let noise = TEMPORAL_STD * TEMPORAL_STD * step;
        let square = step * step;
        let moved_cc = min(cc + 2.0 * step * cv + square * vv + 0.25 * square * noise, 1.0);
        let moved_vv = min(vv + noise, 0.01);
        let bound = 0.999 * sqrt(moved_cc * moved_vv);
        *self = Self { cc: moved_cc, cv: clamp(cv + step * vv + 0.5 * step * noise, -bound, bound), vv: moved_vv };
        let cross = [[cc + step * cv, cv], [cv + step * vv, vv]];
        let [a, b, d] = self.inverse();
        let map: [[f32; 2]; 2] =
            core::array::from_fn(|i| [cross[i][0] * a + cross[i][1] * b, cross[i][0] * b + cross[i][1] * d]);
        let rest_cc = max(cc - map[0][0] * cross[0][0] - map[0][1] * cross[0][1], 0.0);
        let rest_vv = max(vv - map[1][0] * cross[1][0] - map[1][1] * cross[1][1], 0.0);
        let bound = sqrt(rest_cc * rest_vv);
        let rest_cv = clamp(cv - map[0][0] * cross[1][0] - map[0][1] * cross[1][1], -bound, bound);
        (map, [rest_cc, rest_cv, rest_vv])
    }

    /// Updates by `information`; returns the shift of (c, v).
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn correct(&mut self, information: &Information) -> [f32; 2] {
        let [x, y] = information.vector;
        *self = self.with(information);
        [self.cc * x + self.cv * y, self.cv * x + self.vv * y]
    }

    /// The covariance after `information`.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn with(&self, information: &Information) -> Self {
        let prior = self.inverse();
        let sum: [f32; 3] = core::array::from_fn(|i| prior[i] + information.matrix[i]);
        let [cc, cv, vv] = Self { cc: sum[0], cv: sum[1], vv: sum[2] }.inverse();
        Self { cc, cv, vv }
    }

    /// Part of the sum of squared innovations that (c, v) explains, and ln det(1 + covariance times
    /// information). By the latter the uncertainty of (c, v) widens the joint density of the
    /// innovations.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[must_use]
    pub(crate) fn explained(&self, information: &Information) -> (f32, f32) {
        let [x, y] = information.vector;
        let after = self.with(information);
        let explained = x * (after.cc * x + after.cv * y) + y * (after.cv * x + after.vv * y);
        let determinant = |pair: &Self| max(pair.cc * pair.vv - pair.cv * pair.cv, 1.0e-30);
        (explained, max(ln(determinant(self) / determinant(&after)), 0.0))
    }

    /// Variance along a gradient.
    #[inline]
    #[must_use]
    pub(crate) fn along(&self, gradient: &[f32; 2]) -> f32 {
        let [g, h] = *gradient;
        max(g * g * self.cc + 2.0 * g * h * self.cv + h * h * self.vv, 0.0)
    }

    /// Covariance of two quantities with the given `gradients` by (c, v).
    #[must_use]
    pub(crate) fn between(&self, [[g, h], [k, l]]: [&[f32; 2]; 2]) -> f32 {
        g * k * self.cc + (g * l + h * k) * self.cv + h * l * self.vv
    }

    /// Inverse (cc, cv, vv); the correlation is clamped to 0.999 so that it exists.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[must_use]
    pub(crate) fn inverse(&self) -> [f32; 3] {
        let (cc, vv) = (max(self.cc, 1.0e-14), max(self.vv, 1.0e-14));
        let root = sqrt(cc * vv);
        let correlation = clamp(self.cv / root, -0.999, 0.999);
        let scale = 1.0 / (1.0 - correlation * correlation);
        [scale / cc, -scale * correlation / root, scale / vv]
    }
}
