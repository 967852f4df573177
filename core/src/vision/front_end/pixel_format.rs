//! Pixel formats of 16 bits: RGB565, or luminance and alternating chrominance (YUYV).

use core::ops::RangeInclusive;

/// A coding of pixels in 16 bits, read in pairs of neighbours.
///
/// A colour's *key* is its place among the 65536 bits of a [`super::skin_table::SkinTable`].
///
/// ```
/// use sinew_core::vision::front_end::pixel_format::PixelFormat;
///
/// // A camera of your own: grey levels in the low byte.
/// struct Grey;
///
/// impl PixelFormat for Grey {
///     fn keys(pair: [u16; 2]) -> [u16; 2] {
///         pair.map(|pixel| pixel & 0xff)
///     }
///
///     fn luminances(pixels: &[u16; 8]) -> u32 {
///         u32::from_le_bytes([0, 2, 4, 6].map(|place| (pixels[place] & 0xff) as u8 / 2))
///     }
///
///     fn rgb(key: u16) -> [u8; 3] {
///         [key as u8; 3]
///     }
/// }
///
/// assert_eq!(
///     Grey::luminances(&[0, 9, 100, 9, 254, 9, 20, 9]).to_le_bytes(),
///     [0, 50, 127, 10]
/// );
/// ```
pub trait PixelFormat {
    /// The keys of two neighbours, the left one at an even column.
    fn keys(pair: [u16; 2]) -> [u16; 2];

    /// Luminances of every second one of eight pixels, from the first, a byte each and the first in
    /// the lowest.
    ///
    /// They lie from 0 to 127; black and white are 109 apart.
    fn luminances(pixels: &[u16; 8]) -> u32;

    /// The colour in the middle of a key's cell, R, G, B.
    fn rgb(key: u16) -> [u8; 3];

    /// The least and the greatest R, G and B of some keys; all colours where that takes long to
    /// say.
    fn range(_keys: RangeInclusive<u16>) -> ([u8; 3], [u8; 3]) {
        ([0; 3], [255; 3])
    }
}

/// Mask of the bits that remain when four bytes are halved at once.
const HALVES: u32 = 0x7f7f_7f7f;

/// 5 bits of red (the highest), 6 of green, 5 of blue; the key is the pixel.
///
/// ```
/// use sinew_core::vision::front_end::pixel_format::{PixelFormat, Rgb565};
///
/// assert_eq!(Rgb565::rgb(0b11111_000000_00000), [255, 0, 0]);
/// assert_eq!(Rgb565::rgb(0b00000_111111_11111), [0, 255, 255]);
/// // Of eight white pixels every second one counts: 109 of 127.
/// assert_eq!(Rgb565::luminances(&[0xffff; 8]).to_le_bytes(), [109; 4]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rgb565;

/// RGB565 with both bytes swapped, as cameras with an 8-bit port send it to a little-endian
/// processor.
///
/// ```
/// use sinew_core::vision::front_end::pixel_format::{PixelFormat, Rgb565, SwappedRgb565};
///
/// // Red, as the bytes f8 00 arrive and a little-endian processor reads them.
/// let red = u16::from_le_bytes([0xf8, 0x00]);
/// let [key, _] = SwappedRgb565::keys([red, red]);
/// assert_eq!(SwappedRgb565::rgb(key), [255, 0, 0]);
/// assert_ne!(Rgb565::rgb(red), [255, 0, 0], "the wrong format finds another colour");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SwappedRgb565;

/// Y in the low byte; in the high byte U of the pair in the left pixel, V in the right one (Rec.
/// 601).
///
/// The key holds 6 bits of V (the highest), 6 of U, 4 of Y.
///
/// ```
/// use sinew_core::vision::front_end::pixel_format::{PixelFormat, Yuyv};
///
/// // Grey: Y 128 in the low byte of both pixels, U and V 128 in the high bytes.
/// let pair = [u16::from_le_bytes([128, 128]); 2];
/// let [left, right] = Yuyv::keys(pair);
/// assert_eq!(left, right, "both have the pair's chrominance");
/// assert!(
///     Yuyv::rgb(left).iter().all(|channel| channel.abs_diff(128) < 14),
///     "the middle of a cell"
/// );
/// assert_eq!(Yuyv::luminances(&[pair[0]; 8]).to_le_bytes(), [64; 4], "half of Y");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Yuyv;

impl PixelFormat for Rgb565 {
    #[inline]
    fn keys(pair: [u16; 2]) -> [u16; 2] {
        pair
    }

    /// (2 R + 2 G + B) / 2 of R and B in 5 and G in 6 bits. It weighs them by 0.28, 0.58 and 0.14.
    #[inline]
    fn luminances(pixels: &[u16; 8]) -> u32 {
        let two = |first: usize| {
            // Two pixels at once, one in each half; the sums are below 128.
            let both = u32::from(pixels[first]) | u32::from(pixels[first + 4]) << 16;
            (both >> 11 & 0x001f_001f) + (both >> 5 & 0x003f_003f) + (both >> 1 & 0x000f_000f)
        };
        two(0) | two(2) << 8
    }

    fn rgb(key: u16) -> [u8; 3] {
        let (red, green, blue) = (key >> 11, key >> 5 & 0x3f, key & 0x1f);
        [red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2].map(|c| c as u8)
    }

    /// Exact where only blue differs.
    fn range(keys: RangeInclusive<u16>) -> ([u8; 3], [u8; 3]) {
        let (first, last) = (*keys.start(), *keys.end());
        if first >> 5 == last >> 5 { (Self::rgb(first), Self::rgb(last)) } else { ([0; 3], [255; 3]) }
    }
}

impl PixelFormat for SwappedRgb565 {
    #[inline]
    fn keys(pair: [u16; 2]) -> [u16; 2] {
        pair.map(u16::swap_bytes)
    }

    #[inline]
    fn luminances(pixels: &[u16; 8]) -> u32 {
        Rgb565::luminances(&pixels.map(u16::swap_bytes))
    }

    fn rgb(key: u16) -> [u8; 3] {
        Rgb565::rgb(key)
    }

    fn range(keys: RangeInclusive<u16>) -> ([u8; 3], [u8; 3]) {
        Rgb565::range(keys)
    }
}

impl PixelFormat for Yuyv {
    #[inline]
    fn keys([left, right]: [u16; 2]) -> [u16; 2] {
        let chrominance = right & 0xfc00 | (left & 0xfc00) >> 6;
        [left, right].map(|pixel| chrominance | pixel >> 4 & 0xf)
    }

    /// Half of Y: black and white of video range (16 to 235) are 109 apart, those of full range
    /// 127.
    #[inline]
    fn luminances(pixels: &[u16; 8]) -> u32 {
        let both = |first: usize| u32::from(pixels[first]) & 0xff | (u32::from(pixels[first + 4]) & 0xff) << 16;
        (both(0) | both(2) << 8) >> 1 & HALVES
    }

    fn rgb(key: u16) -> [u8; 3] {
        let middle = |bits: u16, step: i32| i32::from(bits) * step + step / 2;
        let (y, u, v) = (middle(key & 0xf, 16), middle(key >> 4 & 0x3f, 4) - 128, middle(key >> 10, 4) - 128);
        // Rec. 601, full range, in 1/1024.
        let channels = [y * 1024 + 1436 * v, y * 1024 - 352 * u - 731 * v, y * 1024 + 1815 * u];
        channels.map(|c| ((c + 512) >> 10).clamp(0, 255) as u8)
    }
}

/// The pair whose left pixel is the last one of a line of odd length: its chrominance comes from
/// its left neighbour.
#[inline]
pub(super) fn odd_pair(line: &[u16]) -> Option<[u16; 2]> {
    match line {
        [.., before, last] if line.len() % 2 == 1 => Some([*last, *before]),
        [only] => Some([*only, *only]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pixel565([r, g, b]: [u8; 3]) -> u16 {
        u16::from(r >> 3) << 11 | u16::from(g >> 2) << 5 | u16::from(b >> 3)
    }

    /// Two equal pixels in YUYV.
    fn yuyv([r, g, b]: [u8; 3]) -> [u16; 2] {
        let [r, g, b] = [r, g, b].map(f32::from);
        let y = 0.299 * r + 0.587 * g + 0.114 * b;
        let byte = |value: f32| value.round().clamp(0.0, 255.0) as u16;
        [(b - y) / 1.772, (r - y) / 1.402].map(|chrominance| byte(y) | byte(chrominance + 128.0) << 8)
    }

    proptest! {
        #[test]
        fn a_key_names_a_colour_near_the_pixels(rgb in any::<[u8; 3]>()) {
            let pixel = pixel565(rgb);
            let near = |key: u16, format: fn(u16) -> [u8; 3], most: i16| {
                format(key).into_iter().zip(rgb).all(|(a, b)| (i16::from(a) - i16::from(b)).abs() <= most)
            };
            prop_assert!(near(Rgb565::keys([pixel; 2])[0], Rgb565::rgb, 7));
            prop_assert!(near(SwappedRgb565::keys([pixel.swap_bytes(); 2])[1], SwappedRgb565::rgb, 7));
            prop_assert!(near(Yuyv::keys(yuyv(rgb))[0], Yuyv::rgb, 14), "{:?}", Yuyv::rgb(Yuyv::keys(yuyv(rgb))[0]));
        }

        #[test]
        fn luminances_of_all_formats_agree_and_leave_a_bit_free(rgb in any::<[[u8; 3]; 4]>(), noise in any::<[u16; 8]>()) {
            let line = |pair: &dyn Fn([u8; 3]) -> [u16; 2]| -> [u16; 8] {
                let pairs: Vec<u16> = rgb.iter().flat_map(|&colour| pair(colour)).collect();
                pairs.try_into().unwrap()
            };
            let plain = Rgb565::luminances(&line(&|colour| [pixel565(colour); 2]));
            let video = Yuyv::luminances(&line(&yuyv)).to_le_bytes();
            prop_assert_eq!(plain, SwappedRgb565::luminances(&line(&|colour| [pixel565(colour).swap_bytes(); 2])));
            for ([r, g, b], (plain, video)) in rgb.iter().zip(plain.to_le_bytes().into_iter().zip(video)) {
                let wanted = 0.299 * f32::from(*r) + 0.587 * f32::from(*g) + 0.114 * f32::from(*b);
                prop_assert!((f32::from(plain) - wanted * 109.0 / 255.0).abs() < 6.5);
                prop_assert!((f32::from(video) - wanted / 2.0).abs() < 1.1);
            }
            prop_assert_eq!((Rgb565::luminances(&noise) | Yuyv::luminances(&noise)) & 0x8080_8080, 0);
        }

        #[test]
        fn every_second_pixel_counts(pixels in any::<[u16; 8]>()) {
            let of = |pixel: u16| (u32::from((pixel >> 11) + (pixel >> 5 & 0x3f)) * 2 + u32::from(pixel & 0x1f)) / 2;
            let plain = Rgb565::luminances(&pixels).to_le_bytes();
            let video = Yuyv::luminances(&pixels).to_le_bytes();
            for i in 0..4 {
                prop_assert_eq!(u32::from(plain[i]), of(pixels[2 * i]));
                prop_assert_eq!(u16::from(video[i]), (pixels[2 * i] & 0xff) / 2);
            }
        }
    }
}
