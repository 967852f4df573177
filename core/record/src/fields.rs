//! Numbers of a payload, one after the other.

use crate::error::RecordError;

/// Bits of the one NaN that records hold: which NaN an operation gives differs from processor to
/// processor.
const NAN_BITS: u32 = 0x7fc0_0000;

/// Writes fields into a slice; what finds no room is left out and [`Self::finish`] says so.
///
/// ```
/// use sinew_record::FieldWriter;
///
/// let mut bytes = [0; 8];
/// let mut fields = FieldWriter::new(&mut bytes);
/// fields.u16(0x0102);
/// fields.optional_f32(None);
/// assert_eq!(fields.finish(), Some(2 + 1 + 4));
/// assert_eq!(bytes[..2], [2, 1], "the lowest byte first");
///
/// let mut fields = FieldWriter::new(&mut bytes);
/// fields.f32s(&[0.0; 3]);
/// assert_eq!(fields.finish(), None, "twelve bytes do not fit eight");
/// ```
#[derive(Debug)]
pub struct FieldWriter<'a> {
    bytes: &'a mut [u8],
    used: usize,
    fits: bool,
}

impl<'a> FieldWriter<'a> {
    /// Writes from the start of `bytes` on.
    pub fn new(bytes: &'a mut [u8]) -> Self {
        Self { bytes, used: 0, fits: true }
    }

    fn put<const N: usize>(&mut self, field: [u8; N]) {
        match self.bytes.get_mut(self.used..).and_then(|rest| rest.first_chunk_mut::<N>()) {
            Some(place) => {
                *place = field;
                self.used += N;
            }
            None => self.fits = false,
        }
    }

    /// A byte.
    pub fn u8(&mut self, value: u8) {
        self.put([value]);
    }

    /// Two bytes.
    pub fn u16(&mut self, value: u16) {
        self.put(value.to_le_bytes());
    }

    /// Four bytes.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn u32(&mut self, value: u32) {
        self.put(value.to_le_bytes());
    }

    /// Eight bytes.
    pub fn u64(&mut self, value: u64) {
        self.put(value.to_le_bytes());
    }

    /// Four bytes; every NaN becomes the same one.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn f32(&mut self, value: f32) {
        self.u32(if value.is_nan() { NAN_BITS } else { value.to_bits() });
    }

    /// Numbers, four bytes each.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn f32s(&mut self, values: &[f32]) {
        values.iter().for_each(|&value| self.f32(value));
    }

    /// A byte that says whether there is a number, and the number or zero.
    pub fn optional_f32(&mut self, value: Option<f32>) {
        self.u8(u8::from(value.is_some()));
        self.f32(value.unwrap_or(0.0));
    }

    /// Number of bytes written, if all fields found room.
    #[must_use]
    pub fn finish(self) -> Option<usize> {
        self.fits.then_some(self.used)
    }
}

/// Reads fields from a slice.
///
/// ```
/// use sinew_record::{FieldReader, RecordError};
///
/// let mut fields = FieldReader::new(&[2, 1, 7]);
/// assert_eq!(fields.u16()?, 0x0102);
/// assert_eq!(fields.clone().flag("side"), Err(RecordError::Value { field: "side" }), "7 is no flag");
/// assert_eq!(fields.u8()?, 7);
/// assert_eq!(fields.u8(), Err(RecordError::WrongLength), "nothing is left");
/// # Ok::<(), RecordError>(())
/// ```
#[derive(Debug, Clone)]
pub struct FieldReader<'a> {
    bytes: &'a [u8],
}

impl<'a> FieldReader<'a> {
    /// Reads from the start of `bytes` on.
    #[must_use]
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], RecordError> {
        let (field, rest) = self.bytes.split_first_chunk::<N>().ok_or(RecordError::WrongLength)?;
        self.bytes = rest;
        Ok(*field)
    }

    /// A byte.
    ///
    /// # Errors
    /// [`RecordError::WrongLength`] where there is none; so with all others.
    pub fn u8(&mut self) -> Result<u8, RecordError> {
        self.take::<1>().map(|[byte]| byte)
    }

    /// A byte of which only 0 and 1 are allowed.
    ///
    /// # Errors
    /// [`RecordError::Value`] naming `field` otherwise.
    pub fn flag(&mut self, field: &'static str) -> Result<bool, RecordError> {
        match self.u8()? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(RecordError::Value { field }),
        }
    }

    /// Two bytes.
    ///
    /// # Errors
    /// See [`Self::u8`].
    pub fn u16(&mut self) -> Result<u16, RecordError> {
        self.take().map(u16::from_le_bytes)
    }

    /// Four bytes.
    ///
    /// # Errors
    /// See [`Self::u8`].
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn u32(&mut self) -> Result<u32, RecordError> {
        self.take().map(u32::from_le_bytes)
    }

    /// Eight bytes.
    ///
    /// # Errors
    /// See [`Self::u8`].
    pub fn u64(&mut self) -> Result<u64, RecordError> {
        self.take().map(u64::from_le_bytes)
    }

    /// A number, which may be NaN or infinite.
    ///
    /// # Errors
    /// See [`Self::u8`].
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn f32(&mut self) -> Result<f32, RecordError> {
        self.take().map(f32::from_le_bytes)
    }

    /// Numbers.
    ///
    /// # Errors
    /// See [`Self::u8`].
    pub fn f32s<const N: usize>(&mut self) -> Result<[f32; N], RecordError> {
        let mut values = [0.0; N];
        self.fill(&mut values)?;
        Ok(values)
    }

    /// One function for all lengths.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn fill(&mut self, values: &mut [f32]) -> Result<(), RecordError> {
        for value in values {
            *value = self.f32()?;
        }
        Ok(())
    }

    /// A number that may be absent.
    ///
    /// # Errors
    /// See [`Self::flag`].
    pub fn optional_f32(&mut self, field: &'static str) -> Result<Option<f32>, RecordError> {
        let there = self.flag(field)?;
        let value = self.f32()?;
        Ok(there.then_some(value))
    }

    /// The fields that are left, as bytes.
    #[must_use]
    pub const fn rest(&self) -> &'a [u8] {
        self.bytes
    }

    /// Nothing may be left.
    ///
    /// # Errors
    /// [`RecordError::WrongLength`] otherwise.
    pub fn finish(&self) -> Result<(), RecordError> {
        if self.bytes.is_empty() { Ok(()) } else { Err(RecordError::WrongLength) }
    }
}
