//! What a function answers.

use crate::cyclic::ModelError;
use crate::error::{ParameterError, Rule};
use crate::saved_state::StateError;
use core::ffi::c_char;

/// What a function answers: zero if it did what it says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum SinewStatus {
    /// Done.
    Ok = 0,
    /// Nothing to do yet: no frame so far showed enough to begin with. No result was written.
    Waiting = 1,
    /// A pointer is null.
    NullPointer = -1,
    /// A pointer is not aligned as its type asks for.
    Misaligned = -2,
    /// The memory or buffer given is too small.
    TooSmall = -3,
    /// The object was not initialised, is of another kind, or its first or last bytes were
    /// overwritten.
    NotInitialised = -4,
    /// A number is NaN or infinite.
    NotFinite = -5,
    /// A number is out of its range.
    OutOfRange = -6,
    /// A list is longer than its capacity.
    OverCapacity = -7,
    /// A timestamp does not lie after that of the frame before. A counter of 32 bits wraps:
    /// `sinew_clock_us` extends it.
    OutOfOrder = -8,
    /// The bytes are no motion model that this library reads.
    BadModel = -9,
    /// The library was built without the model asked for.
    NoModel = -10,
    /// The saved state is cut, was changed, or belongs to another kind of object.
    BadState = -11,
    /// The state was saved by another version of the library.
    StateVersion = -12,
    /// The state was saved with another model or other options.
    ForeignState = -13,
    /// Lines were given before a frame was begun, or a frame ended that was not begun.
    NoFrame = -14,
    /// A calibration ended that was not begun, or nothing of its box was seen.
    NoSample = -15,
    /// Another call uses the object: one that an interrupt broke into, or one of another task.
    Busy = -16,
    /// The object lies elsewhere than where it was made: it was copied or moved.
    Moved = -17,
    /// A structure or buffer lies within the object's own memory.
    Overlap = -18,
    /// A configuration has not the size that this library knows: it was not filled by its default
    /// function, or the program was compiled with the header of another version.
    StructSize = -19,
}

/// A short English text for a status, for people; `status` may be any number.
///
/// The text is constant and ends with a zero byte.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_error_text(status: i32) -> *const c_char {
    const TEXTS: [&core::ffi::CStr; 20] = [
        c"done",
        c"a pointer is null",
        c"a pointer is not aligned as its type asks for",
        c"the memory or buffer is too small",
        c"the object was not initialised, or is of another kind",
        c"a number is NaN or infinite",
        c"a number is out of its range",
        c"a list is longer than its capacity",
        c"the timestamp does not lie after that of the frame before; sinew_clock_us extends 32 bits",
        c"the bytes are no motion model that this library reads",
        c"the library was built without this model",
        c"the saved state is cut, was changed, or belongs to another kind of object",
        c"the state was saved by another version of the library",
        c"the state was saved with another model or other options",
        c"no frame was begun",
        c"nothing was seen to calibrate with",
        c"another call uses the object",
        c"the object was copied or moved",
        c"a structure or buffer lies within the object's memory",
        c"a configuration was not filled by its default function, or is of another version's header",
    ];
    let text = match status {
        1 => Some(&c"no frame so far showed enough to begin with"),
        _ => usize::try_from(status.unsigned_abs()).ok().filter(|_| status <= 0).and_then(|index| TEXTS.get(index)),
    };
    text.unwrap_or(&c"an unknown status").as_ptr()
}

const fn number(text: &str) -> u32 {
    let (mut digits, mut value) = (text.as_bytes(), 0);
    while let Some((digit, rest)) = digits.split_first() {
        value = 10 * value + (*digit - b'0') as u32;
        digits = rest;
    }
    value
}

/// See [`sinew_version`].
pub(super) const VERSION: u32 = number(env!("CARGO_PKG_VERSION_MAJOR")) << 16
    | number(env!("CARGO_PKG_VERSION_MINOR")) << 8
    | number(env!("CARGO_PKG_VERSION_PATCH"));

/// Version of the library: major * 65536 + minor * 256 + patch.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_version() -> u32 {
    VERSION
}

/// What stands in for the status inside of the interface.
pub(super) type Answer = Result<(), SinewStatus>;

/// The status of an answer.
pub(super) fn status(answer: Answer) -> SinewStatus {
    match answer {
        Ok(()) => SinewStatus::Ok,
        Err(status) => status,
    }
}

impl From<ParameterError> for SinewStatus {
    fn from(error: ParameterError) -> Self {
        match error.rule {
            Rule::Finite => Self::NotFinite,
            Rule::Capacity { .. } => Self::OverCapacity,
            Rule::TimeGoesForward => Self::OutOfOrder,
            _ => Self::OutOfRange,
        }
    }
}

impl From<ModelError> for SinewStatus {
    fn from(_: ModelError) -> Self {
        Self::BadModel
    }
}

impl From<StateError> for SinewStatus {
    fn from(error: StateError) -> Self {
        match error {
            StateError::Room { .. } => Self::TooSmall,
            StateError::Corrupt | StateError::Illegal => Self::BadState,
            StateError::Version => Self::StateVersion,
            StateError::Foreign => Self::ForeignState,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    fn text(status: i32) -> String {
        // SAFETY: the texts are constants that end with a zero byte.
        unsafe { CStr::from_ptr(sinew_error_text(status)) }.to_str().unwrap().into()
    }

    #[test]
    fn each_status_has_its_own_text() {
        let texts: Vec<_> = (-19..=1).map(text).collect();
        for (index, text) in texts.iter().enumerate() {
            assert_ne!(text, "an unknown status", "{index}");
            assert!(!texts[..index].contains(text), "{text}");
        }
        assert!(
            text(SinewStatus::NoFrame as i32).contains("frame")
                && text(SinewStatus::NullPointer as i32).contains("null")
        );
        for unknown in [2, -20, i32::MIN, i32::MAX] {
            assert_eq!(text(unknown), "an unknown status");
        }
    }

    #[test]
    fn the_version_is_the_package_s() {
        let [_, major, minor, patch] = sinew_version().to_be_bytes();
        assert_eq!(format!("{major}.{minor}.{patch}"), env!("CARGO_PKG_VERSION"));
    }
}
