//! What tests need for each object, and what holds for every kind of them.

use super::cyclic_particles::SINEW_CYCLIC_PARTICLES_STATE_MAX_BYTES;
use super::object::{Handle, object};
use super::status::SinewStatus;
use crate::checksum::crc32;
use core::ffi::c_void;
use core::mem::MaybeUninit;

/// Memory of one object, which keeps its place where it is moved: a `Box` would claim it anew.
pub(super) struct Memory(*mut [MaybeUninit<u64>]);

impl Memory {
    pub(super) fn new(bytes: usize) -> Self {
        assert_eq!(bytes % 8, 0);
        Self(Box::into_raw(Box::new_uninit_slice(bytes / 8)))
    }

    pub(super) fn start(&mut self) -> *mut c_void {
        self.0.cast()
    }

    pub(super) fn bytes(&self) -> usize {
        8 * self.0.len()
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: it came from a box, and nothing else frees it.
        drop(unsafe { Box::from_raw(self.0) });
    }
}

/// What a function that was answered with OK wrote.
pub(super) fn written<T>(call: impl FnOnce(*mut T) -> SinewStatus) -> T {
    let mut room = MaybeUninit::uninit();
    assert_eq!(call(room.as_mut_ptr()), SinewStatus::Ok);
    // SAFETY: the status says that it was written.
    unsafe { room.assume_init() }
}

/// Bytes that suffice for the state of every object.
const MAX_STATE_BYTES: usize = SINEW_CYCLIC_PARTICLES_STATE_MAX_BYTES;

/// The functions that every object has.
pub(super) struct StateFunctions<T> {
    pub(super) save: unsafe extern "C" fn(*mut T, *mut u8, usize, *mut usize) -> SinewStatus,
    pub(super) restore: unsafe extern "C" fn(*mut T, *const u8, usize) -> SinewStatus,
    pub(super) reset: unsafe extern "C" fn(*mut T) -> SinewStatus,
}

impl<T> StateFunctions<T> {
    /// The state.
    pub(super) fn saved(&self, object: *mut T) -> Vec<u8> {
        let mut state = vec![0; MAX_STATE_BYTES];
        // SAFETY: the object was initialised, the buffer has the size that is said.
        let bytes = written(|bytes| unsafe { (self.save)(object, state.as_mut_ptr(), state.len(), bytes) });
        state.truncate(bytes);
        state
    }

    /// The answer to a state.
    pub(super) fn restore(&self, object: *mut T, state: &[u8]) -> SinewStatus {
        // SAFETY: memory of an object, the state has the size that is said.
        unsafe { (self.restore)(object, state.as_ptr(), state.len()) }
    }

    /// Brings `other` to the state of `object`.
    pub(super) fn copy(&self, object: *mut T, other: *mut T) {
        let state = self.saved(object);
        assert_eq!(self.restore(other, &state), SinewStatus::Ok);
        assert_eq!(self.saved(other), state);
    }

    pub(super) fn reset(&self, object: *mut T) {
        assert_eq!(self.try_reset(object), SinewStatus::Ok);
    }

    fn try_reset(&self, object: *mut T) -> SinewStatus {
        // SAFETY: memory of an object.
        unsafe { (self.reset)(object) }
    }
}

impl<T: Handle> StateFunctions<T> {
    /// Everything that a program may do wrong with the object of any kind is refused, and leaves it
    /// as it was.
    pub(super) fn refuse_misuse(&self, object: *mut T) {
        let state = self.saved(object);
        self.refuse_a_call_within_a_call(object, &state);
        self.refuse_what_is_no_object(object);
        self.refuse_memory_of_the_object(object);
        self.refuse_other_states(object, &state);
        assert_eq!(self.saved(object), state, "as before");
    }

    fn refuse_a_call_within_a_call(&self, pointer: *mut T, state: &[u8]) {
        // SAFETY: the object was initialised.
        let running = unsafe { object(pointer) };
        assert!(running.is_ok());
        let mut room = [0; 16];
        // SAFETY: as above, and the buffer is there.
        let saved = unsafe { (self.save)(pointer, room.as_mut_ptr(), room.len(), &mut 0) };
        let answers = [saved, self.restore(pointer, state), self.try_reset(pointer)];
        assert_eq!(answers, [SinewStatus::Busy; 3]);
    }

    /// A copy, memory of zeros, and an object of another kind.
    fn refuse_what_is_no_object(&self, object: *mut T) {
        let bytes = size_of::<T>();
        let mut memory = Memory::new(bytes);
        let copy: *mut T = memory.start().cast();
        // SAFETY: both are memories of that size.
        unsafe { copy.cast::<u8>().copy_from_nonoverlapping(object.cast(), bytes) };
        assert_eq!(self.try_reset(copy), SinewStatus::Moved);
        // The seal: a magic word, then the kind.
        // SAFETY: bytes within the memory.
        unsafe { copy.cast::<u8>().wrapping_add(4).write(0) };
        assert_eq!(self.try_reset(copy), SinewStatus::NotInitialised);
        // SAFETY: as many bytes as the memory has.
        unsafe { copy.cast::<u8>().write_bytes(0, bytes) };
        assert_eq!(self.try_reset(copy), SinewStatus::NotInitialised);
    }

    fn refuse_memory_of_the_object(&self, object: *mut T) {
        let inside: *mut u8 = object.cast::<u8>().wrapping_add(512);
        // SAFETY: the object was initialised, the pointers point into its memory.
        unsafe {
            assert_eq!((self.save)(object, inside, 64, &mut 0), SinewStatus::Overlap);
            assert_eq!((self.save)(object, [0; 4].as_mut_ptr(), 4, inside.cast()), SinewStatus::Overlap);
            assert_eq!((self.restore)(object, inside, 64), SinewStatus::Overlap);
        }
    }

    /// States of another version, with a wrong checksum, and cut off.
    fn refuse_other_states(&self, object: *mut T, state: &[u8]) {
        let end = state.len() - 4;
        let mut older = state.to_vec();
        let version = u16::from_le_bytes([older[6], older[7]]);
        older[6..8].copy_from_slice(&(version - 1).to_le_bytes());
        assert_eq!(self.restore(object, &older), SinewStatus::BadState, "a wrong checksum");
        let sum = crc32(&older[..end]);
        older[end..].copy_from_slice(&sum.to_le_bytes());
        assert_eq!(self.restore(object, &older), SinewStatus::StateVersion);
        assert_eq!(self.restore(object, &state[..end]), SinewStatus::BadState);
    }
}
