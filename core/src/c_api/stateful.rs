//! What all objects have in common, from one definition: size, alignment, reset, save and restore.

use super::object::{Handle, bytes_mut, list, object, room};
use super::status::{Answer, SinewStatus, status};
use crate::saved_state::{SavedState, StateError, StateKind, restore, save, saved_bytes};

/// The content of an object, whose memory can be saved.
pub(super) trait Stateful {
    /// What is saved.
    type Memory: SavedState;
    /// The kind that its saved states name.
    const KIND: StateKind;

    /// A checksum of the configuration that a saved state belongs to.
    fn fingerprint(&self) -> u32;

    /// What is saved.
    fn memory(&mut self) -> &mut Self::Memory;

    /// Forgets all frames.
    fn reset(&mut self) -> Answer;

    /// Fills the memory as in a new object.
    fn begin(&mut self) -> Answer {
        self.reset()
    }

    /// Brings the memory into a state that can be saved.
    fn before_save(&mut self) {}

    /// Makes what a saved state is read into, where it is not there yet.
    fn before_restore(&mut self) -> Answer {
        Ok(())
    }

    /// Adapts the rest of the object to a memory that was restored.
    fn after_restore(&mut self) {}
}

/// See `state_functions`.
///
/// # Safety
/// `pointer` comes from the object's `init`, or cannot be used.
pub(super) unsafe fn reset_object<T: Handle<Content: Stateful>>(pointer: *mut T) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe { object(pointer) }.and_then(|mut object| object.reset()))
}

/// See `state_functions`.
///
/// # Safety
/// `pointer` comes from the object's `init`, or cannot be used; `buffer` has `buffer_bytes` bytes.
pub(super) unsafe fn save_object<T: Handle<Content: Stateful>>(
    pointer: *mut T,
    buffer: *mut u8,
    buffer_bytes: usize,
    written: *mut usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut object = object(pointer)?;
            object.is_apart(buffer, buffer_bytes)?;
            object.is_apart(written, 1)?;
            let (buffer, written) = (bytes_mut(buffer, buffer_bytes)?, room(written)?);
            let fingerprint = object.fingerprint();
            object.before_save();
            written.write(saved_bytes(object.memory()));
            save(T::Content::KIND, fingerprint, object.memory(), buffer)?;
            Ok(())
        })()
    })
}

/// See `state_functions`.
///
/// # Safety
/// `pointer` comes from the object's `init`, or cannot be used; `state` has `state_bytes` bytes.
pub(super) unsafe fn restore_object<T: Handle<Content: Stateful>>(
    pointer: *mut T,
    state: *const u8,
    state_bytes: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut object = object(pointer)?;
            object.is_apart(state, state_bytes)?;
            let state = list(state, state_bytes)?;
            let fingerprint = object.fingerprint();
            object.before_restore()?;
            let answer = restore(T::Content::KIND, fingerprint, object.memory(), state);
            if answer == Err(StateError::Illegal) {
                object.begin()?;
            }
            answer?;
            object.after_restore();
            Ok(())
        })()
    })
}

/// The functions that give an object's size and alignment.
macro_rules! size_functions {
    ($Object:ident, $size:ident, $align:ident) => {
        /// Bytes that this object takes on this target; the constant MAX_BYTES of its kind at most.
        #[unsafe(no_mangle)]
        pub extern "C" fn $size() -> usize {
            size_of::<$Object>()
        }

        /// Alignment that the memory of this object needs; `SINEW_ALIGN` at most.
        #[unsafe(no_mangle)]
        pub extern "C" fn $align() -> usize {
            align_of::<$Object>()
        }
    };
}

/// The functions that reset, save and restore an object.
macro_rules! state_functions {
    ($Object:ident, $object:ident, $reset:ident, $save:ident, $restore:ident) => {
        /// Forgets all frames, as after the object's `init` with the same configuration. A front
        /// end keeps its skin table.
        ///
        /// # Safety
        /// `$object` comes from the object's `init`.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $reset($object: *mut $Object) -> SinewStatus {
            // SAFETY: the caller's duty.
            unsafe { $crate::c_api::stateful::reset_object($object) }
        }

        /// Writes the state into `buffer`. An object of the same kind and configuration can go on
        /// from it, on this processor or another. The object's type says what is saved, and which
        /// of its configuration may differ.
        ///
        /// Writes into `written` how many bytes the state takes, also where the buffer is too
        /// small. The object is not changed.
        ///
        /// # Safety
        /// `$object` comes from the object's `init`, `buffer` has the size that is said.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $save(
            $object: *mut $Object,
            buffer: *mut u8,
            buffer_bytes: usize,
            written: *mut usize,
        ) -> SinewStatus {
            // SAFETY: the caller's duty.
            unsafe { $crate::c_api::stateful::save_object($object, buffer, buffer_bytes, written) }
        }

        /// Goes on from a state that was saved, all of `state_bytes`.
        ///
        /// A state that is not whole, of another version or configuration is refused, and the
        /// object is as before. A whole state may hold a number that cannot be
        /// (SINEW_STATUS_BAD_STATE too). Its object begins anew, a front end with the skin table of
        /// its configuration.
        ///
        /// # Safety
        /// `$object` comes from the object's `init`, `state` has the size that is said.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $restore($object: *mut $Object, state: *const u8, state_bytes: usize) -> SinewStatus {
            // SAFETY: the caller's duty.
            unsafe { $crate::c_api::stateful::restore_object($object, state, state_bytes) }
        }
    };
}

pub(super) use {size_functions, state_functions};
