//! Entry points for the link-time proof of `prove-no-panic`: decoding and encoding of records. In
//! no other library.
#![allow(missing_docs, unsafe_code, improper_ctypes_definitions, reason = "only linked, never called")]

use crate::{ArmInput, ArmSetup, CameraLine, CyclicInput, CyclicResult, Record, RecordError, decode, encode};

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_decode<'a>(bytes: &&'a [u8], record: &mut Result<(Record<'a>, usize), RecordError>) {
    *record = decode(bytes);
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_read(
    record: &Record<'_>,
    cyclic: &mut Result<CyclicInput, RecordError>,
    setup: &mut Result<ArmSetup, RecordError>,
    arm: &mut Result<ArmInput, RecordError>,
    line: &mut Result<CameraLine, RecordError>,
) {
    *cyclic = record.read();
    *setup = record.read();
    *arm = record.read();
    *line = record.read();
}

#[unsafe(no_mangle)]
pub extern "C" fn sinew_proof_encode(
    result: &CyclicResult,
    bytes: &mut &mut [u8],
    len: &mut Result<usize, RecordError>,
) {
    *len = encode(result, bytes);
}
