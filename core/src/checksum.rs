//! CRC-32 (ISO 3309, polynomial 0x04C11DB7 reflected): detects data changed by a memory or a wire.
//!
//! ```
//! use sinew_core::checksum::{Crc32, crc32};
//!
//! assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
//! let in_pieces = b"123456789".iter().fold(Crc32::new(), |crc, &byte| crc.and(byte));
//! assert_eq!(in_pieces.value(), crc32(b"123456789"));
//! ```

/// Remainders of the 16 values of half a byte: small enough for any flash.
const HALF_BYTES: [u32; 16] = half_bytes();

const fn half_bytes() -> [u32; 16] {
    let mut table = [0; 16];
    let mut value = 0;
    while value < 16 {
        let mut remainder = value as u32;
        let mut bit = 0;
        while bit < 4 {
            remainder = if remainder & 1 == 1 { remainder >> 1 ^ 0xEDB8_8320 } else { remainder >> 1 };
            bit += 1;
        }
        table[value] = remainder;
        value += 1;
    }
    table
}

/// A checksum that grows byte by byte.
///
/// ```
/// use sinew_core::checksum::{Crc32, crc32};
///
/// // Byte by byte as they arrive; a word stands for its four bytes, the lowest first.
/// let received = Crc32::new().and(b'a').and_word(u32::from_le_bytes(*b"bcde"));
/// assert_eq!(received.value(), crc32(b"abcde"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crc32 {
    remainder: u32,
}

impl Default for Crc32 {
    fn default() -> Self {
        Self::new()
    }
}

impl Crc32 {
    /// Of no bytes.
    #[must_use]
    pub const fn new() -> Self {
        Self { remainder: u32::MAX }
    }

    /// With one more byte.
    #[inline]
    #[must_use]
    pub const fn and(self, byte: u8) -> Self {
        let low = self.remainder ^ byte as u32;
        let half = low >> 4 ^ HALF_BYTES[(low & 15) as usize];
        Self { remainder: half >> 4 ^ HALF_BYTES[(half & 15) as usize] }
    }

    /// With four more bytes, the lowest first.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    #[must_use]
    pub const fn and_word(self, word: u32) -> Self {
        let [a, b, c, d] = word.to_le_bytes();
        self.and(a).and(b).and(c).and(d)
    }

    /// The checksum.
    #[must_use]
    pub const fn value(self) -> u32 {
        !self.remainder
    }
}

/// Checksum of `bytes`.
///
/// ```
/// use sinew_core::checksum::crc32;
///
/// // Computed when the program is built: nothing of it is left at run time.
/// const BANNER: u32 = crc32(b"sinew");
/// assert_eq!(BANNER, crc32(b"sinew"));
/// assert_ne!(BANNER, crc32(b"sinev"), "one wrong bit is found");
/// ```
#[must_use]
pub const fn crc32(bytes: &[u8]) -> u32 {
    let mut sum = Crc32::new();
    let mut rest = bytes;
    while let Some((&byte, tail)) = rest.split_first() {
        sum = sum.and(byte);
        rest = tail;
    }
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_value_of_the_standard_comes_out() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
        assert_eq!(crc32(b""), 0);
        assert_eq!(Crc32::new().and_word(u32::from_le_bytes(*b"1234")).value(), crc32(b"1234"));
    }

    #[test]
    fn a_changed_bit_changes_the_sum() {
        let mut bytes = [0x5A; 64];
        let sum = crc32(&bytes);
        for bit in 0..512 {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(crc32(&bytes), sum, "bit {bit}");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
    }
}
