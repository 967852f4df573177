//! Arbitrary calls of the interface for C: no panic, no result that is no number, and an object
//! that can be used on.
#![allow(unsafe_code)]

mod arm;
mod body;
mod cyclic;
mod cyclic_particles;
mod saved;
mod vision;

use proptest::prelude::*;
use sinew_core::c_api::status::SinewStatus;

/// Memory for an object, aligned to eight bytes.
struct Memory(Vec<u64>);

impl Memory {
    fn new(bytes: usize) -> Self {
        Self(vec![0; bytes.div_ceil(8)])
    }

    fn start(&mut self) -> *mut core::ffi::c_void {
        self.0.as_mut_ptr().cast()
    }
}

/// Any number: NaN, infinite and tiny ones too, most of them plausible.
fn real() -> impl Strategy<Value = f32> {
    prop_oneof![8 => -10.0_f32..10.0, 1 => any::<f32>(), 1 => Just(f32::NAN), 1 => -1.0e9_f32..1.0e9]
}

/// A number within the range, seldom another one.
fn mostly(range: std::ops::Range<f32>) -> impl Strategy<Value = f32> {
    prop_oneof![20 => range, 1 => real()]
}

fn is_finite(values: &[f32]) -> bool {
    values.iter().all(|value| value.is_finite())
}

/// What a call on an object that is sound may answer.
fn is_refusal(status: SinewStatus) -> bool {
    !matches!(
        status,
        SinewStatus::Ok | SinewStatus::NotInitialised | SinewStatus::NullPointer | SinewStatus::Misaligned
    )
}

/// So many cases, or as many as `PROPTEST_CASES` says.
fn cases(count: u32) -> ProptestConfig {
    match std::env::var_os("PROPTEST_CASES") {
        Some(_) => ProptestConfig::default(),
        None => ProptestConfig::with_cases(count),
    }
}
