//! A place in a picture that may be a hand, and what speaks for it.

/// A place that may be a hand. Lengths are in widths of the face's box, positions relative to its
/// centre, x to the right and y down.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct HandPlace {
    /// Where it is.
    pub position: [f32; 2],
    /// Number of the connected object that it lies in.
    pub object: u8,
    /// Half the thickness of the object here.
    pub thickness: f32,
    /// Share of skin around it, 0 to 1.
    pub fill: f32,
    /// Share of its surroundings that moves, 0 to 1.
    pub moving: f32,
    /// Share of its skin that is new, 0 to 1.
    pub new: f32,
    /// The end of an arm that it is, if it is one.
    pub end: Option<ArmEnd>,
}

/// An end of an elongated object.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct ArmEnd {
    /// Length of the object along its inside.
    pub length: f32,
    /// Where its other end is.
    pub other: [f32; 2],
}
