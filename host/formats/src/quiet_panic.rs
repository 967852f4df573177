//! Calls of other crates that may panic on a damaged file.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static IS_QUIET: Cell<bool> = const { Cell::new(false) };
}

static HOOK: Once = Once::new();

/// The result of `call`, or `None` if it panics. Nothing is printed of such a panic; those of other
/// threads are reported by the program's hook as ever.
pub(crate) fn catch_quietly<T>(call: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let report = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_QUIET.get() {
                report(panic);
            }
        }));
    });
    let before = IS_QUIET.replace(true);
    let result = catch_unwind(AssertUnwindSafe(call));
    IS_QUIET.set(before);
    result.ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn panics_are_caught_and_silent_on_the_calling_thread_only() {
        let call = || (IS_QUIET.get(), thread::spawn(|| IS_QUIET.get()).join().unwrap());
        assert_eq!(catch_quietly(call), Some((true, false)));
        assert_eq!(catch_quietly(|| assert!(catch_quietly(|| panic!("inner")).is_none() && IS_QUIET.get())), Some(()));
        assert!(!IS_QUIET.get());
    }
}
