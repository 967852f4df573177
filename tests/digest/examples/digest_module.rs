//! The digests as a function of a WebAssembly module without a standard library:
//! `cargo build --release -p sinew-digest --example digest_module --target wasm32-unknown-unknown`.

#![cfg_attr(target_arch = "wasm32", no_std)]

use sinew_digest::Subject;

/// Digest of subject number `index` over `frames` frames; zero where there is no such subject.
// An exported name cannot clash here: the module has nothing else.
#[allow(unsafe_code)]
#[unsafe(no_mangle)]
pub extern "C" fn digest(index: u32, frames: u32) -> u64 {
    Subject::ALL.get(index as usize).and_then(|subject| subject.digest(frames).ok()).unwrap_or(0)
}

#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn stop(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
