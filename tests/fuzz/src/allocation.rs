//! An allocator that counts.
//!
//! A program that measures makes it its own:
//!
//! ```
//! use sinew_fuzz::allocation::{Counting, peak_during};
//!
//! #[global_allocator]
//! static ALLOCATOR: Counting = Counting;
//!
//! let (_, bytes) = peak_during(|| vec![0_u8; 1000]);
//! assert!((1000..10_000).contains(&bytes));
//! ```
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Largest memory in all, bytes. What asks for more ends the program: a refused request cannot be
/// caught. Chosen: far over the limit of a target, and within any machine.
const MAX_BYTES: usize = 2 << 30;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static AT_REFUSAL: OnceLock<fn(usize)> = OnceLock::new();

/// The system's allocator, with a count of the bytes that are held.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counting;

/// The result of `call`, and by how many bytes the memory of all threads grew at most.
pub fn peak_during<T>(call: impl FnOnce() -> T) -> (T, usize) {
    let before = HELD.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let result = call();
    (result, PEAK.load(Ordering::Relaxed).saturating_sub(before))
}

/// What is called with the size of a request that is refused, before the program aborts. The first
/// call of this function counts.
pub fn at_refusal(call: fn(usize)) {
    AT_REFUSAL.get_or_init(|| call);
}

/// Counts a request; false if it is refused.
fn admit(size: usize) -> bool {
    let held = HELD.fetch_add(size, Ordering::Relaxed).saturating_add(size);
    if held <= MAX_BYTES {
        PEAK.fetch_max(held, Ordering::Relaxed);
        return true;
    }
    HELD.fetch_sub(size, Ordering::Relaxed);
    if let Some(call) = AT_REFUSAL.get() {
        call(size);
    }
    false
}

// SAFETY: every request goes to the system's allocator as it is, or is refused with a null pointer.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if admit(layout.size()) { unsafe { System.alloc(layout) } } else { std::ptr::null_mut() }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if admit(layout.size()) { unsafe { System.alloc_zeroed(layout) } } else { std::ptr::null_mut() }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if !admit(size) {
            return std::ptr::null_mut();
        }
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}
