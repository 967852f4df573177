//! How large a picture may be.

/// Largest width or height that is decoded, pixels: what a mask of the core can hold.
pub const MAX_SIDE_PX: u32 = sinew_core::vision::mask::MAX_SIDE_PX as u32;
