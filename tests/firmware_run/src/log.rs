//! defmt's bytes as lines of text, by the format strings in the image.

use anyhow::{Context, Result};
use defmt_decoder::{DecodeError, Table};

/// Lines of the log, each with its level.
///
/// # Errors
/// An image whose table cannot be read.
pub fn decode(elf: &[u8], serial: &[u8]) -> Result<Vec<String>> {
    let table = Table::parse(elf)?;
    let Some(table) = table.filter(|_| !serial.is_empty()) else { return Ok(Vec::new()) };
    let mut decoder = table.new_stream_decoder();
    decoder.received(serial);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let level = frame.level().map_or("PRINT", |level| level.as_str()).to_uppercase();
                lines.push(format!("{level:<5} {}", frame.display_message()));
            }
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) if table.encoding().can_recover() => lines.push("(a broken frame)".to_owned()),
            Err(error) => return Err(error).context("the log cannot be decoded"),
        }
    }
}
