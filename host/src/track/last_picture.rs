//! What the next frame is compared with, as text.

use crate::error::{Error, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{GrayImage, Rgb, RgbImage};
use serde::{Deserialize, Serialize};

/// A picture in base64: a byte a pixel if it is grey, else three.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct LastPicture {
    size_px: (u32, u32),
    pixels: String,
}

impl LastPicture {
    /// A picture of which brightness alone counts.
    pub fn grey(picture: &GrayImage) -> Self {
        Self { size_px: picture.dimensions(), pixels: STANDARD.encode(picture.as_raw()) }
    }

    /// A picture with its colours.
    pub fn coloured(picture: &RgbImage) -> Self {
        Self { size_px: picture.dimensions(), pixels: STANDARD.encode(picture.as_raw()) }
    }

    /// The picture; one that is grey has the same brightness.
    ///
    /// # Errors
    /// The text is no picture of its size.
    pub fn picture(&self) -> Result<RgbImage> {
        let (width, height) = self.size_px;
        let bytes = STANDARD.decode(&self.pixels).map_err(Error::invalid)?;
        let area = (width as usize).saturating_mul(height as usize);
        let picture = match bytes.len() {
            count if count == area => {
                let grey = GrayImage::from_raw(width, height, bytes);
                grey.map(|grey| RgbImage::from_fn(width, height, |u, v| Rgb([grey.get_pixel(u, v).0[0]; 3])))
            }
            count if count == area.saturating_mul(3) => RgbImage::from_raw(width, height, bytes),
            _ => None,
        };
        picture.ok_or_else(|| Error::Invalid(format!("the last picture is not one of {width}x{height} pixels")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Luma;
    use sinew_core::vision::edges::luminance_line;

    #[test]
    fn a_picture_comes_back_with_its_brightness() {
        let coloured = RgbImage::from_fn(5, 3, |u, v| Rgb([40 * u as u8, 60 * v as u8, 7]));
        assert_eq!(LastPicture::coloured(&coloured).picture().unwrap(), coloured);
        let grey = GrayImage::from_fn(64, 4, |u, v| Luma([(64 * v + u) as u8]));
        let back = LastPicture::grey(&grey).picture().unwrap();
        let mut levels = vec![0; 256];
        luminance_line(back.as_raw(), &mut levels);
        assert_eq!(&levels, grey.as_raw(), "all levels");
    }

    #[test]
    fn text_that_is_no_picture_is_refused() {
        let picture = LastPicture::grey(&GrayImage::new(5, 3));
        for size_px in [(5, 4), (u32::MAX, u32::MAX), (0, 3)] {
            let message = LastPicture { size_px, ..picture.clone() }.picture().unwrap_err().to_string();
            assert!(message.contains("the last picture"), "{message}");
        }
        assert!(LastPicture { pixels: "?".to_owned(), ..picture }.picture().is_err());
    }
}
