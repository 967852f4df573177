//! Standard normal draws from a table of cubics: the quantile of one uniform number without
//! logarithm, root or branch.
//!
//! The size of a draw is the quantile of a tail probability x / 2^32 with x in [0.5, 2^31]. The
//! upper bits of the floating-point number x choose one of four parts of one of 32 octaves. The
//! other bits are the argument of that part's cubic. The table is computed at compile time from the
//! rational approximation of [`super::normal`], 2 KiB.

use super::normal::{NEAR_MIDDLE, quantile_in_tail, quantile_near_middle};
use super::stream::LANES;
use core::f32::consts::LN_2;

/// Largest difference between the table and the exact quantile, standard deviations. Measured:
/// asserted by a test.
pub const NORMAL_TABLE_MAX_ERROR: f32 = 2.0e-5;

/// Parts of an octave.
const PARTS: usize = 4;
/// Octaves of x, from [0.5, 1) on.
const OCTAVES: usize = 32;
/// Bits of a float below those that choose the part.
const ARGUMENT_BITS: u32 = 21;
const ARGUMENT_MASK: u32 = (1 << ARGUMENT_BITS) - 1;
/// Upper bits of 0.5.
const FIRST_PART: u32 = 0.5_f32.to_bits() >> ARGUMENT_BITS;
/// Largest `f32` below 2^31, where the last part ends.
const LAST: f32 = 2_147_483_520.0;

/// Coefficients of each part's cubic, constant first, of its argument in 0..2^21.
static CUBICS: [[f32; 4]; PARTS * OCTAVES] = cubics();

/// Draws from uniform bits: bit 0 is the sign, the others the tail probability.
#[inline(always)]
pub(super) fn from_bits(bits: &[u32; LANES]) -> [f32; LANES] {
    let mut index = [0; LANES];
    let mut argument = [0.0; LANES];
    for lane in 0..LANES {
        let x = (bits[lane] >> 1) as i32 as f32 + 0.5;
        let x = if x < LAST { x } else { LAST };
        index[lane] = (x.to_bits() >> ARGUMENT_BITS).wrapping_sub(FIRST_PART);
        argument[lane] = (x.to_bits() & ARGUMENT_MASK) as i32 as f32;
    }
    let mut draws = [0.0; LANES];
    for lane in 0..LANES {
        let [a, b, c, d] = CUBICS[index[lane] as usize % (PARTS * OCTAVES)];
        let t = argument[lane];
        let size = ((d * t + c) * t + b) * t + a;
        draws[lane] = f32::from_bits(size.to_bits() ^ (bits[lane] << 31));
    }
    draws
}

const fn cubics() -> [[f32; 4]; PARTS * OCTAVES] {
    let mut all = [[0.0; 4]; PARTS * OCTAVES];
    let mut index = 0;
    while index < all.len() {
        all[index] = cubic(index);
        index += 1;
    }
    all
}

/// The cubic through four points of part `index`, near Chebyshev's, by Newton's divided
/// differences.
const fn cubic(index: usize) -> [f32; 4] {
    // Chosen: the Chebyshev nodes of [0, 1] for four points, rounded to 1/128.
    const NODES: [f32; 4] = [0.0390625, 0.3125, 0.6875, 0.9609375];
    let low = f32::from_bits((index as u32 + FIRST_PART) << ARGUMENT_BITS);
    let width = f32::from_bits((index as u32 + 1 + FIRST_PART) << ARGUMENT_BITS) - low;
    let mut difference = [0.0; 4];
    let mut i = 0;
    while i < 4 {
        difference[i] = quantile((low + NODES[i] * width) * (0.5 / 2_147_483_648.0));
        i += 1;
    }
    let mut order = 1;
    while order < 4 {
        let mut i = 3;
        while i >= order {
            difference[i] = (difference[i] - difference[i - 1]) / (NODES[i] - NODES[i - order]);
            i -= 1;
        }
        order += 1;
    }
    let [p, q, r, _] = NODES;
    let [f0, f1, f2, f3] = difference;
    let scale = 1.0 / (ARGUMENT_MASK + 1) as f32;
    [
        f0 - f1 * p + f2 * p * q - f3 * p * q * r,
        (f1 - f2 * (p + q) + f3 * (p * q + p * r + q * r)) * scale,
        (f2 - f3 * (p + q + r)) * scale * scale,
        f3 * scale * scale * scale,
    ]
}

/// z with upper tail probability `tail` in (0, 0.5], at compile time.
const fn quantile(tail: f32) -> f32 {
    let q = 0.5 - tail;
    if q <= NEAR_MIDDLE { quantile_near_middle(q) } else { quantile_in_tail(constant_sqrt(-constant_ln(tail))) }
}

/// Natural logarithm by the series of 2 atanh((m - 1) / (m + 1)) of the mantissa m.
const fn constant_ln(x: f32) -> f32 {
    let exponent = (x.to_bits() >> 23) as i32 - 127;
    let mantissa = f32::from_bits((x.to_bits() & 0x007F_FFFF) | 1.0_f32.to_bits());
    let y = (mantissa - 1.0) / (mantissa + 1.0);
    let mut sum = 0.0;
    let mut k = 17;
    while k >= 1 {
        sum = sum * y * y + 1.0 / k as f32;
        k -= 2;
    }
    exponent as f32 * LN_2 + 2.0 * y * sum
}

/// Square root of a number in 1..100 by Newton's iteration.
const fn constant_sqrt(x: f32) -> f32 {
    let mut root = 0.5 * (x + 1.0);
    let mut i = 0;
    while i < 12 {
        root = 0.5 * (root + x / root);
        i += 1;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::super::normal::upper_quantile;
    use super::*;

    fn size_of_draw(bits: u32) -> f32 {
        from_bits(&[bits; LANES])[LANES - 1]
    }

    #[test]
    fn the_table_is_the_quantile() {
        let mut worst = 0.0_f32;
        let mut tail_bits = 1_u64;
        while tail_bits < 1 << 31 {
            for step in 0..64 {
                let x = ((tail_bits + tail_bits * step / 64) as u32).min((1 << 31) - 1);
                let exact = upper_quantile(((x as f32 + 0.5) * (0.5 / 2_147_483_648.0)).min(0.5));
                worst = worst.max((size_of_draw(x << 1) - exact).abs());
                assert_eq!(size_of_draw(x << 1), -size_of_draw((x << 1) | 1));
            }
            tail_bits *= 2;
        }
        assert!(worst < NORMAL_TABLE_MAX_ERROR && worst > 0.1 * NORMAL_TABLE_MAX_ERROR, "{worst:e}");
        assert!((6.2..6.4).contains(&size_of_draw(0)), "the end of the tail: {}", size_of_draw(0));
        assert!(size_of_draw(u32::MAX).abs() < 1.0e-4);
    }
}
