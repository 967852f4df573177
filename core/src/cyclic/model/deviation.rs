//! Deviation of a person's pose from the mean cycle: an offset, a swing with the cycle, and a
//! smooth residual.
//!
//! Differences between people last: the inclination of the trunk, a wider or earlier swing of the
//! arms. So the deviation of an angle at cycle position c is `a + p cos 2 pi c + q sin 2 pi c + d`.
//! The offset a and the swing p, q hardly change within a person. The residual d follows a Matern
//! process of order 3/2 along the cycle (Rasmussen and Williams, Gaussian Processes for Machine
//! Learning, (4.17)).

/// Spread of the deviation's parts, for the phase-coupled filter. Borrowed, like the whole model; n
/// numbers each.
///
/// A model without it (empty slices) serves the other filters only.
///
/// ```
/// use sinew_core::cyclic::Deviation;
/// use sinew_core::math::exp;
///
/// // One angle: offsets of about 5 degrees between people, and a swing that differs by 3 degrees.
/// let deviation = Deviation {
///     offset_std_rad: &[0.08],
///     cosine_std_rad: &[0.05],
///     sine_std_rad: &[0.05],
///     rest_std_rad: &[0.03],
///     rest_rate_per_cycle: &[6.0],
/// };
/// assert!(!deviation.is_absent() && Deviation::default().is_absent());
/// // The residual's correlation is about a half after a quarter of a cycle.
/// let scaled = deviation.rest_rate_per_cycle[0] * 0.25;
/// assert!(((1.0 + scaled) * exp(-scaled) - 0.56).abs() < 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation<'a> {
    /// Standard deviation of the constant a, radians.
    pub offset_std_rad: &'a [f32],
    /// Standard deviation of p, radians.
    pub cosine_std_rad: &'a [f32],
    /// Standard deviation of q, radians.
    pub sine_std_rad: &'a [f32],
    /// Standard deviation of the rest d, radians.
    pub rest_std_rad: &'a [f32],
    /// Rate of the rest per cycle: its correlation after a part x of a cycle is (1 + rate x)
    /// exp(-rate x).
    pub rest_rate_per_cycle: &'a [f32],
}

impl Deviation<'_> {
    /// Whether the model has no deviation.
    #[must_use]
    pub const fn is_absent(&self) -> bool {
        self.offset_std_rad.is_empty()
            && self.cosine_std_rad.is_empty()
            && self.sine_std_rad.is_empty()
            && self.rest_std_rad.is_empty()
            && self.rest_rate_per_cycle.is_empty()
    }
}
