//! Images whose pixels are their own or borrowed, as an array of another program's is.

use image::{ImageBuffer, Rgb};
use std::ops::Deref;

/// Why nothing is found in a picture without colours, and the remedy.
pub(crate) const GREY: &str = "skin is found by its colour; give pictures of a camera in colour";

/// Where the bytes of an image are.
pub trait Pixels: Deref<Target = [u8]> {}

impl<T: Deref<Target = [u8]>> Pixels for T {}

/// An image of 8-bit RGB, lines from the top without gaps: an [`image::RgbImage`], or a
/// [`PictureView`].
pub type Picture<P> = ImageBuffer<Rgb<u8>, P>;

/// An image whose pixels are borrowed: `PictureView::from_raw(width, height, bytes)` makes one
/// without a copy, and gives `None` where there are too few bytes.
pub type PictureView<'a> = Picture<&'a [u8]>;

/// Whether red, green and blue are the same in all pixels, as in a picture of one channel.
#[must_use]
pub fn is_grey(image: &Picture<impl Pixels>) -> bool {
    image.pixels().all(|pixel| pixel.0.iter().all(|level| *level == pixel.0[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::RgbImage;

    #[test]
    fn one_pixel_with_a_colour_makes_a_picture_in_colour() {
        let mut image = RgbImage::from_fn(5, 4, |u, v| Rgb([(40 * u + v) as u8; 3]));
        assert!(is_grey(&image));
        image.put_pixel(4, 3, Rgb([9, 9, 8]));
        assert!(!is_grey(&image));
    }
}
