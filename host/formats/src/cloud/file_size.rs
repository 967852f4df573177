//! How large the file of one frame may be.

/// Largest file that is read, and largest content of a compressed one.
pub const MAX_FILE_BYTES: u64 = 1 << 30;
