//! A digest of numbers' bits.

use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;

/// Whatever a tracker calls a NaN: its sign and payload differ between processors and mean nothing.
const NAN: u32 = 0x7fc0_0000;

/// FNV-1a (Fowler, Noll and Vo) of 64 bits, fed with words of 32.
#[derive(Debug, Clone, Copy)]
pub struct Bits(u64);

impl Bits {
    /// The digest of nothing.
    pub const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// The digest so far.
    pub const fn digest(self) -> u64 {
        self.0
    }

    /// Takes a whole number.
    pub fn word(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Takes an index or a count.
    pub fn count(&mut self, count: usize) {
        self.word(count as u32);
    }

    /// Takes a number's bits.
    pub fn number(&mut self, value: f32) {
        self.word(if value.is_nan() { NAN } else { value.to_bits() });
    }

    /// Takes numbers in order.
    pub fn numbers(&mut self, values: &[f32]) {
        values.iter().for_each(|&value| self.number(value));
    }

    /// Takes what may be missing.
    pub fn present(&mut self, present: bool) {
        self.word(u32::from(present));
    }

    /// Takes a point in space.
    pub fn vector(&mut self, vector: &Vec3) {
        self.numbers(&[vector.x, vector.y, vector.z]);
    }

    /// Takes a point of an image.
    pub fn pixel(&mut self, pixel: Pixel) {
        self.numbers(&[pixel.u_px, pixel.v_px]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_is_the_published_one() {
        let mut bits = Bits::new();
        assert_eq!(bits.digest(), 0xcbf2_9ce4_8422_2325);
        bits.word(u32::from_le_bytes(*b"foob"));
        // FNV-1a of "foob" is a step before the published 0x85944171f73967e8 of "foobar".
        let mut digest = bits.digest();
        for byte in *b"ar" {
            digest = (digest ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        assert_eq!(digest, 0x8594_4171_f739_67e8);
    }

    #[test]
    fn nans_are_alike_and_zeros_are_not() {
        let of = |value: f32| {
            let mut bits = Bits::new();
            bits.number(value);
            bits.digest()
        };
        assert_eq!(of(f32::NAN), of(-f32::NAN));
        assert_ne!(of(0.0), of(-0.0));
    }
}
