//! From pointers to references, after checking what can be checked.

use super::status::{Answer, SinewStatus};
use core::ffi::c_void;
use core::mem::MaybeUninit;

/// What marks an object that was initialised: the kind, and its complement, which no forgotten
/// memory has by chance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub(super) struct Seal {
    kind: u32,
    complement: u32,
}

impl Seal {
    /// The seal of nothing.
    pub const BROKEN: Self = Self { kind: 0, complement: 0 };

    /// The seal of objects whose kind has four letters.
    pub const fn of(kind: [u8; 4]) -> Self {
        let kind = u32::from_le_bytes(kind);
        Self { kind, complement: !kind }
    }
}

/// An object with a [`Seal`].
///
/// # Safety
/// A field of the type [`Seal`] lies at [`Self::SEAL_AT`].
pub(super) unsafe trait Sealed {
    /// The seal of this type.
    const SEAL: Seal;
    /// Bytes before it.
    const SEAL_AT: usize;
}

/// A structure that is read from the caller's memory.
///
/// # Errors
/// A pointer that is null or misaligned.
///
/// # Safety
/// If not refused, `pointer` points at a `T` that no code changes for `'a`; any bits make a `T`.
pub(super) unsafe fn given<'a, T>(pointer: *const T) -> Result<&'a T, SinewStatus> {
    check(pointer)?;
    // SAFETY: checked above, and the caller's duty.
    Ok(unsafe { &*pointer })
}

/// A structure that is written into the caller's memory, whatever was there.
///
/// # Errors
/// A pointer that is null or misaligned.
///
/// # Safety
/// If not refused, `pointer` points at room for a `T` that no other code uses for `'a`.
pub(super) unsafe fn room<'a, T>(pointer: *mut T) -> Result<&'a mut MaybeUninit<T>, SinewStatus> {
    check(pointer)?;
    // SAFETY: checked above, and the caller's duty; a MaybeUninit needs no value.
    Ok(unsafe { &mut *pointer.cast() })
}

/// A list; of zero elements, `pointer` may be anything.
///
/// # Errors
/// A pointer that is null or misaligned, `len` beyond what an address space holds.
///
/// # Safety
/// If not refused, `pointer` points at `len` elements that no code changes for `'a`; any bits make
/// a `T`.
pub(super) unsafe fn list<'a, T>(pointer: *const T, len: usize) -> Result<&'a [T], SinewStatus> {
    if len == 0 {
        return Ok(&[]);
    }
    check(pointer)?;
    if len > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(SinewStatus::OverCapacity);
    }
    // SAFETY: checked above, and the caller's duty.
    Ok(unsafe { core::slice::from_raw_parts(pointer, len) })
}

/// Bytes to write into.
///
/// # Errors
/// A null pointer, `len` beyond what an address space holds.
///
/// # Safety
/// If not refused, `pointer` points at `len` bytes that no other code uses for `'a`.
pub(super) unsafe fn bytes_mut<'a>(pointer: *mut u8, len: usize) -> Result<&'a mut [u8], SinewStatus> {
    if len == 0 {
        return Ok(&mut []);
    }
    check(pointer)?;
    if len > isize::MAX as usize {
        return Err(SinewStatus::OverCapacity);
    }
    // SAFETY: checked above, and the caller's duty. Bytes of a C program count as initialised.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, len) })
}

/// An object that was initialised.
///
/// # Errors
/// A pointer that is null or misaligned, or memory without the type's seal.
///
/// # Safety
/// If not refused, `pointer` points at a `T` that no other code uses for `'a`.
pub(super) unsafe fn object<'a, T: Sealed>(pointer: *mut T) -> Result<&'a mut T, SinewStatus> {
    check(pointer)?;
    // SAFETY: aligned, and by the caller's duty memory of at least a T, which has a Seal there; any
    // bits make a Seal.
    let seal = unsafe { pointer.byte_add(T::SEAL_AT).cast::<Seal>().read_volatile() };
    if seal != T::SEAL {
        return Err(SinewStatus::NotInitialised);
    }
    // SAFETY: only `place` writes the seal, behind a whole T.
    Ok(unsafe { &mut *pointer })
}

/// Memory in which an object may be made: large enough and aligned.
///
/// # Errors
/// A pointer that is null or misaligned, too few bytes.
///
/// # Safety
/// If not refused, `memory` points at `bytes` bytes that no other code uses for `'a`.
pub(super) unsafe fn place<'a, T>(memory: *mut c_void, bytes: usize) -> Result<&'a mut MaybeUninit<T>, SinewStatus> {
    let pointer: *mut T = memory.cast();
    check(pointer)?;
    if bytes < size_of::<T>() {
        return Err(SinewStatus::TooSmall);
    }
    // SAFETY: checked above, and the caller's duty; a MaybeUninit needs no value.
    Ok(unsafe { &mut *pointer.cast() })
}

fn check<T>(pointer: *const T) -> Answer {
    if pointer.is_null() {
        return Err(SinewStatus::NullPointer);
    }
    if pointer.is_aligned() { Ok(()) } else { Err(SinewStatus::Misaligned) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unusable_pointers_have_different_statuses() {
        let words = [7_u32; 4];
        let inside = words.as_ptr().cast::<u8>().wrapping_add(1).cast::<u32>();
        // SAFETY: the pointers are null, misaligned, or point at `words`.
        unsafe {
            assert_eq!(given::<u32>(core::ptr::null()), Err(SinewStatus::NullPointer));
            assert_eq!(given(inside), Err(SinewStatus::Misaligned));
            assert_eq!(given(words.as_ptr()), Ok(&7));
            assert_eq!(list(inside, 0), Ok(&[][..]));
            assert_eq!(list(inside, 1), Err(SinewStatus::Misaligned));
            assert_eq!(list(words.as_ptr(), usize::MAX), Err(SinewStatus::OverCapacity));
            assert_eq!(list(words.as_ptr(), 4), Ok(&words[..]));
        }
    }
}
