//! How the pose of a cycle differs from the mean cycle: slowly, so that it is a process of its own.

/// Spread of the pose about the mean cycle, as the phase-coupled filter needs it. Borrowed, like the whole model.
///
/// A model without it (empty slices) still serves the other filters.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviation<'a> {
    /// Standard deviation of each angle about the mean cycle at each position, radians: l rows of n, or empty.
    pub std_rad: &'a [f32],
    /// Time in which the deviation of each angle falls to 1/e of its correlation, frames at the model's rate: n, or empty.
    pub correlation_time_frames: &'a [f32],
}

impl Deviation<'_> {
    /// Whether the model says nothing about the deviation.
    #[must_use]
    pub const fn is_absent(&self) -> bool {
        self.std_rad.is_empty() && self.correlation_time_frames.is_empty()
    }
}
