//! Images whose pixels are their own or borrowed, as an array of another program's is.

use image::{ImageBuffer, Rgb};
use std::ops::Deref;

/// Where the bytes of an image are.
pub trait Pixels: Deref<Target = [u8]> {}

impl<T: Deref<Target = [u8]>> Pixels for T {}

/// An image of 8-bit RGB, lines from the top without gaps: an [`image::RgbImage`], or a
/// [`PictureView`].
pub type Picture<P> = ImageBuffer<Rgb<u8>, P>;

/// An image whose pixels are borrowed: `PictureView::from_raw(width, height, bytes)` makes one
/// without a copy, and gives `None` where there are too few bytes.
pub type PictureView<'a> = Picture<&'a [u8]>;
