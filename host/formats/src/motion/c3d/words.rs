//! Numbers in the byte orders of C3D files.

/// Which processor's numbers a file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Words {
    /// Little endian.
    Intel,
    /// Little endian; reals as of a VAX.
    Dec,
    /// Big endian.
    Mips,
}

impl Words {
    /// The processor of this number in the parameter section's header.
    pub const fn of(number: u8) -> Option<Self> {
        match number {
            84 => Some(Self::Intel),
            85 => Some(Self::Dec),
            86 => Some(Self::Mips),
            _ => None,
        }
    }

    /// The number of 16 bits at `at`, without sign.
    pub fn u16(self, bytes: &[u8], at: usize) -> Option<u16> {
        let two = bytes.get(at..)?.first_chunk()?;
        Some(if self == Self::Mips { u16::from_be_bytes(*two) } else { u16::from_le_bytes(*two) })
    }

    /// The real at `at`.
    pub fn f32(self, bytes: &[u8], at: usize) -> Option<f32> {
        let [a, b, c, d] = *bytes.get(at..)?.first_chunk()?;
        Some(match self {
            Self::Intel => f32::from_le_bytes([a, b, c, d]),
            // Its exponent has an offset of 128 before a fraction from 0.5: 4 times the IEEE
            // number.
            Self::Dec => f32::from_le_bytes([c, d, a, b]) / 4.0,
            Self::Mips => f32::from_be_bytes([a, b, c, d]),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_one_in_each_order() {
        for (number, two, one) in
            [(84, [2, 0], [0, 0, 0x80, 0x3f]), (85, [2, 0], [0x80, 0x40, 0, 0]), (86, [0, 2], [0x3f, 0x80, 0, 0])]
        {
            let words = Words::of(number).unwrap();
            assert_eq!((words.u16(&two, 0), words.f32(&one, 0)), (Some(2), Some(1.0)));
            assert_eq!((words.u16(&two, 1), words.u16(&two, 9), words.f32(&one, 1)), (None, None, None));
        }
        assert_eq!(Words::of(0), None);
    }
}
