//! Pictures as a camera of at most 320 x 240 pixels would send them: lines of RGB565.

use crate::pixels::{Picture, Pixels};
use image::{Rgb, RgbImage};
use sinew_record::LINE_PIXELS;

/// Most lines.
const MAX_LINES: u32 = 240;

/// Side of the blocks whose means are the pixels of such a camera.
#[must_use]
pub fn block_of((width, height): (u32, u32)) -> u32 {
    width.div_ceil(LINE_PIXELS as u32).max(height.div_ceil(MAX_LINES)).max(1)
}

/// Means of blocks of `block` x `block` pixels; what is left at the right and at the bottom is cut
/// off.
#[must_use]
pub fn of_blocks(image: &Picture<impl Pixels>, block: u32) -> RgbImage {
    RgbImage::from_fn(image.width() / block, image.height() / block, |u, v| {
        let mut sum = [0_u32; 3];
        for dv in 0..block {
            for du in 0..block {
                let pixel = image.get_pixel(block * u + du, block * v + dv);
                sum.iter_mut().zip(pixel.0).for_each(|(sum, channel)| *sum += u32::from(channel));
            }
        }
        Rgb(sum.map(|sum| ((sum + block * block / 2) / (block * block)) as u8))
    })
}

/// The lines of a picture, from the top.
pub fn lines(image: &RgbImage) -> impl Iterator<Item = impl Iterator<Item = u16>> {
    image.rows().map(|pixels| pixels.map(|pixel| rgb565(pixel.0)))
}

fn rgb565([red, green, blue]: [u8; 3]) -> u16 {
    u16::from(red >> 3) << 11 | u16::from(green >> 2) << 5 | u16::from(blue >> 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_as_small_as_a_camera_allows() {
        let sizes = [(320, 240), (321, 240), (640, 480), (240, 320), (1, 1), (1920, 1080)];
        assert_eq!(sizes.map(block_of), [1, 2, 2, 2, 1, 6]);
    }

    #[test]
    fn a_pixel_is_the_mean_of_its_block() {
        let image = RgbImage::from_fn(5, 4, |u, v| Rgb([if (u + v) % 2 == 0 { 200 } else { 101 }, 8, 255]));
        let small = of_blocks(&image, 2);
        assert_eq!((small.dimensions(), small.get_pixel(1, 1).0), ((2, 2), [151, 8, 255]));
        let pixels: Vec<u16> = lines(&small).flatten().collect();
        assert_eq!(pixels, [18 << 11 | 2 << 5 | 31; 4]);
    }
}
