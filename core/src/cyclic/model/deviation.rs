//! How the pose of a person differs from the mean cycle: a constant, a swing with the cycle, and a smooth rest.
//!
//! What differs between people lasts: their trunk leans otherwise, their arms swing wider or earlier. So the deviation of
//! an angle at cycle position c is `a + p cos 2 pi c + q sin 2 pi c + d`, with a, p and q that hardly change while a
//! person moves on, and a rest d that follows a smooth random process along the cycle (Matern, order 3/2).

/// Spread of the deviation's parts, as the phase-coupled filter needs it. Borrowed, like the whole model; n numbers each.
///
/// A model without it (empty slices) still serves the other filters.
///
/// ```
/// use sinew_core::cyclic::Deviation;
/// use sinew_core::math::exp;
///
/// // One angle: people hold it about 5 degrees otherwise, and swing it 3 degrees wider or less.
/// let deviation = Deviation {
///     offset_std_rad: &[0.08],
///     swing_std_rad: &[0.05],
///     rest_std_rad: &[0.03],
///     rest_rate_per_cycle: &[6.0],
/// };
/// assert!(!deviation.is_absent() && Deviation::default().is_absent());
/// // What is left over is half forgotten after a quarter of a cycle.
/// let scaled = deviation.rest_rate_per_cycle[0] * 0.25;
/// assert!(((1.0 + scaled) * exp(-scaled) - 0.56).abs() < 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation<'a> {
    /// Standard deviation of the constant a, radians.
    pub offset_std_rad: &'a [f32],
    /// Standard deviation of p, and of q, radians.
    pub swing_std_rad: &'a [f32],
    /// Standard deviation of the rest d, radians.
    pub rest_std_rad: &'a [f32],
    /// Rate of the rest per cycle: its correlation after a part x of a cycle is (1 + rate x) exp(-rate x).
    pub rest_rate_per_cycle: &'a [f32],
}

impl Deviation<'_> {
    /// Whether the model says nothing about the deviation.
    #[must_use]
    pub const fn is_absent(&self) -> bool {
        self.offset_std_rad.is_empty()
            && self.swing_std_rad.is_empty()
            && self.rest_std_rad.is_empty()
            && self.rest_rate_per_cycle.is_empty()
    }
}
