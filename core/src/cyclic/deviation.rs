//! How the pose of a person differs from the mean cycle: a constant, a swing with the cycle, and a smooth rest.
//!
//! What differs between people lasts: their trunk leans otherwise, their arms swing wider or earlier. So the deviation of
//! an angle at cycle position c is `a + p cos 2 pi c + q sin 2 pi c + d`, with a, p and q that hardly change while a
//! person moves on, and a rest d that follows a smooth random process along the cycle (Matern, order 3/2).

/// Spread of the deviation's parts, as the phase-coupled filter needs it. Borrowed, like the whole model; n numbers each.
///
/// A model without it (empty slices) still serves the other filters.
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
