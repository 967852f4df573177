//! Parameters and frames out of bytes.

use sinew_core::math::Vec3;

/// Sizes at the ends of `f32`.
const CORNERS: [f32; 13] = [
    0.0,
    1.0e-45,
    1.0e-39,
    f32::MIN_POSITIVE,
    1.0e-6,
    1.0,
    1.0e3,
    1.0e10,
    1.0e19,
    1.0e35,
    f32::MAX,
    f32::INFINITY,
    f32::NAN,
];

/// Takes numbers from bytes. Zeros, and what lies beyond the end, give the clean ones.
#[derive(Debug, Clone)]
pub struct Numbers<'a> {
    left: &'a [u8],
}

impl<'a> Numbers<'a> {
    /// The numbers that `bytes` give.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { left: bytes }
    }

    /// Whether all bytes were used.
    #[must_use]
    pub fn is_at_end(&self) -> bool {
        self.left.is_empty()
    }

    /// What no number was made of.
    #[must_use]
    pub fn rest(&self) -> &'a [u8] {
        self.left
    }

    /// A byte, 0 beyond the end.
    pub fn byte(&mut self) -> u8 {
        let Some((byte, left)) = self.left.split_first() else { return 0 };
        self.left = left;
        *byte
    }

    /// Eight bytes as a whole number.
    pub fn long(&mut self) -> u64 {
        u64::from_le_bytes(std::array::from_fn(|_| self.byte()))
    }

    /// A whole number below `count`, which is at most 256.
    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// Yes or no.
    pub fn flag(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// `clean`, one near it, a corner of `f32`, or any number.
    pub fn number(&mut self, clean: f32) -> f32 {
        match self.byte() {
            0..=159 => clean,
            160..=215 => clean * (1.0 + f32::from(self.byte().cast_signed()) / 64.0),
            216..=239 => {
                let corner = CORNERS[self.below(CORNERS.len())];
                if self.flag() { -corner } else { corner }
            }
            _ => f32::from_bits(u32::from_le_bytes(std::array::from_fn(|_| self.byte()))),
        }
    }

    /// The same for each coordinate.
    pub fn place(&mut self, clean: Vec3) -> Vec3 {
        clean.map(|coordinate| self.number(coordinate))
    }

    /// The same for each number, in place.
    pub fn change(&mut self, numbers: &mut [&mut f32]) {
        for number in numbers {
            **number = self.number(**number);
        }
    }

    /// `clean`, or any time.
    pub fn time_us(&mut self, clean: u64) -> u64 {
        match self.byte() {
            0..=223 => clean,
            224..=239 => clean.wrapping_add(u64::from(self.byte()) << self.below(64)),
            _ => self.long(),
        }
    }
}

/// Seeds for what is made of numbers: zeros, and two fixed mixtures.
#[must_use]
pub fn seeds(bytes: usize) -> Vec<Vec<u8>> {
    let mixed = |number| {
        let mut random = crate::random::Random::new(7, number);
        (0..bytes).map(|_| if random.one_in(3) { random.bits() as u8 } else { 0 }).collect()
    };
    vec![vec![0; bytes], mixed(1), mixed(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_and_missing_bytes_are_clean() {
        let mut numbers = Numbers::new(&[0, 0, 0, 0, 0]);
        assert_eq!(numbers.place(Vec3::new(1.0, 2.0, 3.0)), Vec3::new(1.0, 2.0, 3.0));
        assert_eq!((numbers.number(4.0), numbers.time_us(5), numbers.time_us(6)), (4.0, 5, 6));
        assert!(numbers.is_at_end() && !numbers.flag());
        let mut numbers = Numbers::new(&[220, 11, 1, 240, 1, 0, 0, 0, 160, 64]);
        let found = [numbers.number(1.0), numbers.number(1.0), numbers.number(1.0)];
        assert_eq!(found, [f32::NEG_INFINITY, f32::from_bits(1), 2.0]);
    }
}
