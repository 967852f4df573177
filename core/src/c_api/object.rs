//! From pointers to references, after checking what can be checked.
//!
//! An object is its seal, its content, and a mark behind it. The seal is read alone and first, so
//! memory that is no object, or a smaller one of another kind, is not read any further.

use super::status::{Answer, SinewStatus, VERSION};
use core::ffi::c_void;
use core::marker::PhantomData;
use core::mem::MaybeUninit;
use core::ops::{Deref, DerefMut};
use core::sync::atomic::{AtomicU32, Ordering};

/// First word of every object, `SNOB`.
const MARK: u32 = u32::from_le_bytes(*b"SNOB");

/// Header of an object, before its content.
#[derive(Debug)]
#[repr(C)]
struct Seal {
    mark: u32,
    /// Four letters that name the kind.
    kind: u32,
    /// Size and version of the library: memory that outlives an update is no object.
    layout: u32,
    /// Not zero while a call uses the object.
    in_use: AtomicU32,
    /// Where the object was made; a copy lies elsewhere.
    address: usize,
}

/// An object in the caller's memory.
#[derive(Debug)]
#[repr(C)]
pub(super) struct Object<C> {
    seal: Seal,
    content: C,
    /// Depends on the address; what runs over the content's end breaks it.
    end: u32,
}

/// The type that C sees of an object.
///
/// # Safety
/// It is an [`Object`] of the content and nothing else.
pub(super) unsafe trait Handle: Sized {
    /// What the object holds.
    type Content;
    /// Names the kind.
    const KIND: [u8; 4];
    /// See [`Seal::layout`].
    const LAYOUT: u32 = size_of::<Object<Self::Content>>() as u32 ^ VERSION.rotate_left(16);
}

/// The mark behind the content of an object at `address`.
const fn end_mark(address: usize) -> u32 {
    !(address as u32) ^ MARK
}

/// Whether `count` elements from `pointer` on have a byte in common with the object at `object`.
fn overlaps<C, T>(object: *const Object<C>, pointer: *const T, count: usize) -> bool {
    let (start, bytes) = (pointer.addr(), count.saturating_mul(size_of::<T>()));
    let (first, size) = (object.addr(), size_of::<Object<C>>());
    bytes > 0 && first < start.saturating_add(bytes) && start < first.saturating_add(size)
}

/// An object during a call; other calls are refused until it is dropped.
pub(super) struct InUse<'a, C> {
    object: *mut Object<C>,
    content: PhantomData<&'a mut C>,
}

impl<C> InUse<'_, C> {
    /// Refuses `count` elements that lie within the object's own memory.
    pub fn is_apart<T>(&self, pointer: *const T, count: usize) -> Answer {
        if overlaps(self.object, pointer, count) { Err(SinewStatus::Overlap) } else { Ok(()) }
    }
}

impl<C> Deref for InUse<'_, C> {
    type Target = C;

    fn deref(&self) -> &C {
        // SAFETY: `object` checked it, and no other call has it at the same time.
        unsafe { &(*self.object).content }
    }
}

impl<C> DerefMut for InUse<'_, C> {
    fn deref_mut(&mut self) -> &mut C {
        // SAFETY: `object` checked it, and no other call has it at the same time.
        unsafe { &mut (*self.object).content }
    }
}

impl<C> Drop for InUse<'_, C> {
    fn drop(&mut self) {
        // SAFETY: `object` checked it; the flag is shared with other calls, which only load and
        // store it.
        unsafe { (*self.object).seal.in_use.store(0, Ordering::Release) }
    }
}

/// Whether the object was free; it is in use then.
#[cfg(target_has_atomic = "32")]
fn enter(in_use: &AtomicU32) -> bool {
    in_use.swap(1, Ordering::Acquire) == 0
}

/// Whether the object was free; it is in use then. A call from an interrupt between the two
/// accesses has ended when the second comes.
#[cfg(not(target_has_atomic = "32"))]
fn enter(in_use: &AtomicU32) -> bool {
    let is_free = in_use.load(Ordering::Acquire) == 0;
    if is_free {
        in_use.store(1, Ordering::Release);
    }
    is_free
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

/// A configuration that is read from the caller's memory: its first word says its size.
///
/// # Errors
/// A pointer that is null or misaligned; another size than that of a `T`.
///
/// # Safety
/// If not refused, `pointer` points at a `T` that no code changes for `'a`; any bits make a `T`.
pub(super) unsafe fn given_config<'a, T>(pointer: *const T) -> Result<&'a T, SinewStatus> {
    check(pointer)?;
    // SAFETY: checked above; every configuration begins with this word, however long it is.
    let stated = unsafe { pointer.cast::<u32>().read() };
    if stated as usize != size_of::<T>() {
        return Err(SinewStatus::StructSize);
    }
    // SAFETY: checked above, and the caller's duty.
    Ok(unsafe { &*pointer })
}

/// Room for a configuration, of which the caller says the size.
///
/// # Errors
/// A pointer that is null or misaligned; another size than that of a `T`.
///
/// # Safety
/// If not refused, `pointer` points at room for a `T` that no other code uses for `'a`.
pub(super) unsafe fn config_room<'a, T>(pointer: *mut T, bytes: usize) -> Result<&'a mut MaybeUninit<T>, SinewStatus> {
    check(pointer)?;
    if bytes != size_of::<T>() {
        return Err(SinewStatus::StructSize);
    }
    // SAFETY: as the caller says.
    unsafe { room(pointer) }
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

/// A list that is changed; of zero elements, `pointer` may be anything.
///
/// # Errors
/// A pointer that is null or misaligned, `len` beyond what an address space holds.
///
/// # Safety
/// If not refused, `pointer` points at `len` elements that no other code uses for `'a`; any bits
/// make a `T`.
pub(super) unsafe fn list_mut<'a, T>(pointer: *mut T, len: usize) -> Result<&'a mut [T], SinewStatus> {
    if len == 0 {
        return Ok(&mut []);
    }
    check(pointer)?;
    if len > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(SinewStatus::OverCapacity);
    }
    // SAFETY: checked above, and the caller's duty.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer, len) })
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
/// A pointer that is null or misaligned, memory without the seal of this kind, an object that was
/// copied, overwritten at its end, or is used by another call.
///
/// # Safety
/// If not refused, `pointer` points at a `T` that only calls of this interface use for `'a`.
pub(super) unsafe fn object<'a, T: Handle>(pointer: *mut T) -> Result<InUse<'a, T::Content>, SinewStatus> {
    check(pointer)?;
    let object = pointer.cast::<Object<T::Content>>();
    // SAFETY: aligned, and by the caller's duty memory of at least an object of some kind, which
    // begins with a seal; any bits make its numbers. They are read one by one and not kept.
    let (mark, kind, layout, address) = unsafe {
        let seal = &raw const (*object).seal;
        (
            (&raw const (*seal).mark).read_volatile(),
            (&raw const (*seal).kind).read_volatile(),
            (&raw const (*seal).layout).read_volatile(),
            (&raw const (*seal).address).read_volatile(),
        )
    };
    if (mark, kind, layout) != (MARK, u32::from_le_bytes(T::KIND), T::LAYOUT) {
        return Err(SinewStatus::NotInitialised);
    }
    if address != pointer.addr() {
        return Err(SinewStatus::Moved);
    }
    // SAFETY: only `Place::install` writes this seal with this address, before a whole object.
    let (end, is_free) = unsafe { ((&raw const (*object).end).read_volatile(), enter(&(*object).seal.in_use)) };
    if !is_free {
        return Err(SinewStatus::Busy);
    }
    let in_use = InUse { object, content: PhantomData };
    if end == end_mark(address) { Ok(in_use) } else { Err(SinewStatus::NotInitialised) }
}

/// Memory in which an object may be made.
pub(super) struct Place<'a, T: Handle> {
    object: *mut Object<T::Content>,
    memory: PhantomData<&'a mut Object<T::Content>>,
}

/// Memory in which an object may be made: large enough and aligned.
///
/// # Errors
/// A pointer that is null or misaligned, too few bytes.
///
/// # Safety
/// If not refused, `memory` points at `bytes` bytes that no other code uses for `'a`.
pub(super) unsafe fn place<'a, T: Handle>(memory: *mut c_void, bytes: usize) -> Result<Place<'a, T>, SinewStatus> {
    let object: *mut Object<T::Content> = memory.cast();
    check(object)?;
    if bytes < size_of::<T>() {
        return Err(SinewStatus::TooSmall);
    }
    Ok(Place { object, memory: PhantomData })
}

impl<T: Handle> Place<'_, T> {
    /// Refuses `count` elements that lie within this memory.
    pub fn is_apart<P>(&self, pointer: *const P, count: usize) -> Answer {
        if overlaps(self.object, pointer, count) { Err(SinewStatus::Overlap) } else { Ok(()) }
    }

    /// Fills all with zeros, the seal of an object that was there included, and gives the content's
    /// place. So an object begins where it lies, and never stands on the stack.
    pub fn clear(&mut self) -> *mut T::Content {
        // SAFETY: `place` checked it; zeros need no value that was there.
        unsafe {
            self.object.write_bytes(0, 1);
            &raw mut (*self.object).content
        }
    }

    /// Begins the object by `begin`, seals it and hands it out. The seal comes last: an object that
    /// did not begin is none.
    ///
    /// # Safety
    /// After [`Self::clear`] all of the content's fields were written for which zeros are no legal
    /// value.
    pub unsafe fn install(
        self,
        handle: &mut MaybeUninit<*mut T>,
        begin: impl FnOnce(&mut T::Content) -> Answer,
    ) -> Answer {
        let address = self.object.addr();
        // SAFETY: zeros are legal for the seal, and by the caller's duty for the rest.
        let object = unsafe { &mut *self.object };
        begin(&mut object.content)?;
        object.end = end_mark(address);
        let in_use = AtomicU32::new(0);
        object.seal = Seal { mark: MARK, kind: u32::from_le_bytes(T::KIND), layout: T::LAYOUT, in_use, address };
        handle.write(self.object.cast());
        Ok(())
    }
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
