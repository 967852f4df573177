//! Puts records one after the other.

use crate::error::{Context, Result};
use sinew_record::{End, HEADER_BYTES, Payload, encode};

/// A stream that grows.
#[derive(Debug, Clone, Default)]
pub struct StreamWriter {
    bytes: Vec<u8>,
    records: u32,
}

impl StreamWriter {
    /// Appends a record.
    ///
    /// # Errors
    /// None in practice: there is room for every payload.
    pub fn push<P: Payload>(&mut self, payload: &P) -> Result<()> {
        let start = self.bytes.len();
        self.bytes.resize(start + HEADER_BYTES + P::MAX_BYTES, 0);
        let length = encode(payload, &mut self.bytes[start..])?;
        self.bytes.truncate(start + length);
        self.records = self.records.checked_add(1).context("a stream has room for 4294967295 records")?;
        Ok(())
    }

    /// Number of records so far.
    #[must_use]
    pub const fn records(&self) -> u32 {
        self.records
    }

    /// The whole stream, its end included.
    ///
    /// # Errors
    /// Those of [`Self::push`].
    pub fn finish(mut self) -> Result<Vec<u8>> {
        self.push(&End { records: self.records })?;
        Ok(self.bytes)
    }
}
