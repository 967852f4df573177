//! A pixel that is on an edge and moves.

/// Place of a temporal edge pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EdgePixel {
    /// Column.
    pub u: u16,
    /// Row.
    pub v: u16,
}
