//! One angle's deviation from the mean cycle in the phase-coupled filter: five coefficients given
//! (c, v).
//!
//! Three of the five are a, p, q of `a + p cos 2 pi c + q sin 2 pi c`. The other two are the rest d
//! and its slope per cycle. Their density given z = (c, v) is normal with mean
//! `mean + regression (z - z_mean)` and covariance `covariance`. Angles are independent of each
//! other given z, so no covariance between angles is stored.

use crate::cyclic::saved_ranges::NUMBER;
use crate::math::{abs, exp, max, sin_cos};
use crate::numeric::semi_definite::{packed_index, packed_len};
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::TAU;

/// Numbers of a block.
pub const PARTS: usize = 5;
const REST: usize = 3;
const SLOPE: usize = 4;

/// Relative increase of each variance in every step. Derived: rounding changes entry (i, j) by at
/// most 2^-23 of the root of both variances. Five times that on the diagonal of five rows keeps the
/// matrix positive semi-definite.
const ROUNDING: f32 = 5.0 / 8_388_608.0;

/// Direction in which an angle depends on its parts at a cycle position.
///
/// ```
/// use sinew_core::cyclic::coupled::person::block::Basis;
///
/// // An offset of 0.1 rad and a swing of 0.2 rad: they add up at a quarter of a cycle.
/// let parts = [0.1, 0.0, 0.2, 0.0, 0.0];
/// let basis = Basis::at(0.25);
/// let deviation_rad: f32 = basis.value.iter().zip(parts).map(|(value, part)| value * part).sum();
/// assert!((deviation_rad - 0.3).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Basis {
    /// (1, cos, sin, 1, 0).
    pub value: [f32; PARTS],
    /// Its derivative by c.
    pub slope: [f32; PARTS],
}

impl Basis {
    /// At cycle position `position`.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[must_use]
    pub fn at(position: f32) -> Self {
        let (sine, cosine) = sin_cos(TAU * position);
        Self { value: [1.0, cosine, sine, 1.0, 0.0], slope: [0.0, -TAU * sine, TAU * cosine, 0.0, 0.0] }
    }

    /// `first` plus the product of `value` and `parts`.
    #[inline(always)]
    fn along(&self, first: f32, parts: &[f32; PARTS]) -> f32 {
        first + parts[0] + self.value[1] * parts[1] + self.value[2] * parts[2] + parts[REST]
    }
}

/// Stationary spread of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spread {
    /// Variance of a, rad^2.
    pub(crate) offset: f32,
    /// Variance of p, rad^2.
    pub(crate) cosine: f32,
    /// Variance of q, rad^2.
    pub(crate) sine: f32,
    /// Variance of d, rad^2.
    pub(crate) rest: f32,
    /// Rate of d per cycle.
    pub(crate) rate: f32,
}

impl Spread {
    /// With the variances multiplied by `factor`.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn scaled(&self, factor: f32) -> Self {
        Self {
            offset: factor * self.offset,
            cosine: factor * self.cosine,
            sine: factor * self.sine,
            rest: factor * self.rest,
            rate: self.rate,
        }
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn diagonal(&self) -> [f32; PARTS] {
        [self.offset, self.cosine, self.sine, self.rest, self.rest * self.rate * self.rate]
    }
}

/// Prediction of a measured angle: its derivative by z and its covariances given z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AnglePrediction {
    /// Derivative of the angle by (c, v).
    pub(crate) gradient: [f32; 2],
    /// Covariance of the parts with the angle, given z.
    pub(crate) column: [f32; PARTS],
    /// Variance of the angle given z, rad^2.
    pub(crate) variance: f32,
}

impl AnglePrediction {
    /// The same where the offset's variance is inflated by `variance`, rad^2.
    pub(crate) fn inflate_offset(&mut self, variance: f32) {
        self.column[0] += variance;
        self.variance += variance;
    }
}

/// Five parts given z.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// # use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
/// # let model = WALKING.model()?;
/// # let with_offset = |frame: u8| {
/// #     let mut pose_rad = model.mean_pose_rad::<13>(model.point(f32::from(frame) * model.mean_cycle_velocity()));
/// #     pose_rad[0] += 0.1;
/// #     AngleMeasurement::new(&pose_rad.map(Some), 0.05)
/// # };
/// # let mut filter = CoupledFilter::new(&model, &with_offset(0)?, Some(0.0), None)?;
/// // Four seconds of a person whose first angle is always 0.1 rad above the mean.
/// for frame in 1..=240 {
///     filter.step(&model, &with_offset(frame)?);
/// }
/// let block = &filter.blocks()[0];
/// assert!((block.mean[0] - 0.1).abs() < 0.03, "the offset is learned");
/// assert!(block.mean[1].abs() < 0.03 && block.mean[2].abs() < 0.03, "and there is no swing of its own");
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleBlock {
    /// Means at the mean of z.
    pub mean: [f32; PARTS],
    /// Change of the means with (c, v).
    pub regression: [[f32; 2]; PARTS],
    /// Covariance given z: the packed lower triangle.
    covariance: [f32; PACKED],
}

/// Numbers of a packed covariance.
const PACKED: usize = packed_len(PARTS);
/// Covariance that rounding may leave between parts without variance. Chosen: a hundred times the
/// resolution of the greatest variances that steps give.
const MAX_ROUNDING: f32 = 1.0e-4;

impl SavedState for AngleBlock {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.mean, &NUMBER);
        visitor.reals(self.regression.as_flattened_mut(), &NUMBER);
        visitor.reals(&mut self.covariance, &NUMBER);
        if !is_plausible(&self.covariance) {
            visitor.refuse();
        }
    }
}

/// Whether no variance is negative, and no covariance beyond what the variances allow: at most
/// their mean, and twice that leaves room for rounding.
fn is_plausible(packed: &[f32; PACKED]) -> bool {
    // Row i has i + 1 entries, the last of which is its variance.
    let mut entries = packed.iter();
    let variances: [f32; PARTS] = core::array::from_fn(|i| entries.nth(i).copied().unwrap_or(0.0));
    let mut entries = packed.iter();
    variances.iter().enumerate().all(|(i, variance)| {
        let row = variances.iter().take(i + 1).zip(entries.by_ref());
        *variance >= 0.0 && row.fold(true, |all, (other, entry)| all && abs(*entry) <= variance + other + MAX_ROUNDING)
    })
}

impl AngleBlock {
    /// The prior: the spread between people.
    #[must_use]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(crate) fn unknown(spread: &Spread) -> Self {
        let mut covariance = [0.0; PACKED];
        for (i, variance) in spread.diagonal().into_iter().enumerate() {
            if let Some(entry) = covariance.get_mut(packed_index(i, i)) {
                *entry = variance;
            }
        }
        Self { mean: [0.0; PARTS], regression: [[0.0; 2]; PARTS], covariance }
    }

    /// No deviation, with zero covariance.
    #[must_use]
    pub(crate) const fn zero() -> Self {
        Self { mean: [0.0; PARTS], regression: [[0.0; 2]; PARTS], covariance: [0.0; PACKED] }
    }

    /// The whole covariance given z.
    #[must_use]
    pub fn covariance_matrix(&self) -> [[f32; PARTS]; PARTS] {
        core::array::from_fn(|i| core::array::from_fn(|j| self.covariance(i, j)))
    }

    /// Covariance of parts `i` and `j` given z; 0 beyond the parts.
    #[inline]
    #[must_use]
    pub fn covariance(&self, i: usize, j: usize) -> f32 {
        self.covariance.get(packed_index(i, j)).copied().unwrap_or(0.0)
    }

    /// Multiplies all variances by `factor`.
    #[inline]
    pub(crate) fn inflate(&mut self, factor: f32) {
        self.covariance.iter_mut().for_each(|value| *value *= factor);
    }

    /// Adds `variance`, rad^2, to that of the offset.
    pub(crate) fn inflate_offset(&mut self, variance: f32) {
        self.covariance[0] += variance;
    }

    /// Propagates by `phase` cycles: a, p, q decay by `memory`, d follows its Matern process.
    /// `z_map` is the regression of the old z on the new one, `z_rest` (cc, cv, vv) its residual
    /// covariance.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn advance(
        &mut self,
        spread: &Spread,
        phase: f32,
        memory: f32,
        z_map: &[[f32; 2]; 2],
        z_rest: &[f32; 3],
    ) {
        let scaled = spread.rate * phase;
        let decay = exp(-scaled);
        let rest_map =
            [[decay * (1.0 + scaled), decay * phase], [-decay * spread.rate * scaled, decay * (1.0 - scaled)]];
        let apply = |v: [f32; PARTS]| -> [f32; PARTS] {
            [
                memory * v[0],
                memory * v[1],
                memory * v[2],
                rest_map[0][0] * v[REST] + rest_map[0][1] * v[SLOPE],
                rest_map[1][0] * v[REST] + rest_map[1][1] * v[SLOPE],
            ]
        };
        self.add_unexplained(z_rest);
        self.propagate_covariance(memory, &rest_map);
        self.add_process_noise(spread, memory, &rest_map);
        self.mean = apply(self.mean);
        let b = &self.regression;
        let column = |k: usize| -> [f32; PARTS] { core::array::from_fn(|i| b[i][k]) };
        let moved = [apply(column(0)), apply(column(1))];
        self.regression =
            core::array::from_fn(|i| core::array::from_fn(|k| moved[0][i] * z_map[0][k] + moved[1][i] * z_map[1][k]));
    }

    /// Adds the covariance due to the residual `z_rest` (cc, cv, vv) of the old z given the new
    /// one.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn add_unexplained(&mut self, z_rest: &[f32; 3]) {
        let b = &self.regression;
        for i in 0..PARTS {
            let left = [b[i][0] * z_rest[0] + b[i][1] * z_rest[1], b[i][0] * z_rest[1] + b[i][1] * z_rest[2]];
            let row = self.covariance.iter_mut().skip(packed_index(i, 0));
            for (entry, right) in row.zip(b.iter().take(i + 1)) {
                *entry += left[0] * right[0] + left[1] * right[1];
            }
        }
    }

    /// Phi C Phi' for the lower triangle: the first three coefficients are scaled, d and its slope
    /// mixed.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn propagate_covariance(&mut self, memory: f32, rest_map: &[[f32; 2]; 2]) {
        let [[a, b], [c, d]] = *rest_map;
        self.covariance.iter_mut().take(packed_len(REST)).for_each(|entry| *entry *= memory * memory);
        for i in 0..REST {
            let (rest, slope) = (memory * self.covariance(REST, i), memory * self.covariance(SLOPE, i));
            self.covariance[packed_index(REST, i)] = a * rest + b * slope;
            self.covariance[packed_index(SLOPE, i)] = c * rest + d * slope;
        }
        let (rr, rs, ss) = (self.covariance(REST, REST), self.covariance(SLOPE, REST), self.covariance(SLOPE, SLOPE));
        let (rest, slope) = ([a * rr + b * rs, a * rs + b * ss], [c * rr + d * rs, c * rs + d * ss]);
        self.covariance[packed_index(REST, REST)] = a * rest[0] + b * rest[1];
        self.covariance[packed_index(SLOPE, REST)] = c * rest[0] + d * rest[1];
        self.covariance[packed_index(SLOPE, SLOPE)] = c * slope[0] + d * slope[1];
    }

    /// Adds the process noise that keeps the spread stationary.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn add_process_noise(&mut self, spread: &Spread, memory: f32, rest_map: &[[f32; 2]; 2]) {
        let stationary = spread.diagonal();
        let forget = 1.0 - memory * memory;
        for i in 0..REST {
            self.covariance[packed_index(i, i)] += forget * stationary[i];
        }
        let (p, r) = (stationary[REST], stationary[SLOPE]);
        let m = rest_map;
        let kept = |i: usize, j: usize| m[i][0] * m[j][0] * p + m[i][1] * m[j][1] * r;
        self.covariance[packed_index(REST, REST)] += max(p - kept(0, 0), 0.0);
        self.covariance[packed_index(SLOPE, REST)] -= kept(0, 1);
        self.covariance[packed_index(SLOPE, SLOPE)] += max(r - kept(1, 1), 0.0);
        for i in 0..PARTS {
            self.covariance[packed_index(i, i)] *= 1.0 + ROUNDING;
        }
    }

    /// Deviation at a basis, radians.
    #[inline]
    #[must_use]
    pub fn deviation(&self, basis: &Basis) -> f32 {
        basis.along(0.0, &self.mean)
    }

    /// Prediction of the angle; `mean_slope` is that of the mean cycle, rad per cycle.
    #[inline]
    #[must_use]
    pub(crate) fn predict_angle(&self, basis: &Basis, mean_slope: f32) -> AnglePrediction {
        let own_slope = mean_slope + (basis.slope[1] * self.mean[1] + basis.slope[2] * self.mean[2]);
        let own = self.regression.map(|[own, _]| own);
        let other = self.regression.map(|[_, other]| other);
        let gradient = [basis.along(own_slope, &own), basis.along(0.0, &other)];
        let column = core::array::from_fn(|i| basis.along(0.0, &core::array::from_fn(|j| self.covariance(i, j))));
        AnglePrediction { gradient, column, variance: max(basis.along(0.0, &column), 0.0) }
    }

    /// Kalman update by an angle with innovation `residual`, rad; `shift` is the update of z.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn correct(
        &mut self,
        prediction: &AnglePrediction,
        noise_variance: f32,
        residual: f32,
        shift: [f32; 2],
    ) {
        let inverse = 1.0 / (prediction.variance + noise_variance);
        let g = &prediction.gradient;
        let rest = residual - g[0] * shift[0] - g[1] * shift[1];
        for i in 0..PARTS {
            let gain = prediction.column[i] * inverse;
            self.mean[i] += gain * rest;
            self.regression[i][0] -= gain * g[0];
            self.regression[i][1] -= gain * g[1];
            let rounding = ROUNDING * self.covariance(i, i);
            let row = self.covariance.iter_mut().skip(packed_index(i, 0));
            for (entry, column) in row.zip(prediction.column.iter().take(i + 1)) {
                *entry -= prediction.column[i] * column * inverse;
            }
            let variance = &mut self.covariance[packed_index(i, i)];
            *variance = max(*variance + rounding, 1.0e-10);
        }
    }

    /// Moves the means by their regression on the update `shift` of z.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn follow(&mut self, shift: [f32; 2]) {
        for i in 0..PARTS {
            self.mean[i] += self.regression[i][0] * shift[0] + self.regression[i][1] * shift[1];
        }
    }
}
