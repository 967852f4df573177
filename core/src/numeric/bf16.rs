//! bfloat16: a number in two bytes, for small states.

/// The upper half of an `f32`: its whole range, eight binary digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Bf16(u16);

impl Bf16 {
    /// The nearest one; a finite value within half a unit of the last digit of `f32::MAX` becomes
    /// infinite.
    #[inline]
    pub(crate) const fn new(value: f32) -> Self {
        Self((value.to_bits().wrapping_add(0x8000) >> 16) as u16)
    }

    #[inline]
    pub(crate) const fn get(self) -> f32 {
        f32::from_bits((self.0 as u32) << 16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rounding_changes_a_number_by_at_most_a_256th(value in prop_oneof![-1.0e30_f32..1.0e30, -1.0_f32..1.0, 1.0e-30_f32..1.0e-20]) {
            let kept = Bf16::new(value).get();
            prop_assert!((kept - value).abs() <= value.abs() / 256.0, "{value}, {kept}");
            prop_assert_eq!(Bf16::new(kept).get(), kept, "once rounded it stays");
        }
    }

    #[test]
    fn small_whole_numbers_are_exact() {
        for whole in [0.0, 1.0, 2.0, 3.0, 255.0, -7.0] {
            assert_eq!(Bf16::new(whole).get(), whole);
        }
    }
}
