//! Depth images as clouds: a point for each pixel that has a depth.

use super::depth_camera::DepthCamera;
use super::point_cloud::PointCloud;
use crate::limits::{MAX_DEPTH_PIXELS, MAX_SIDE_PX};
use image::{DynamicImage, ImageDecoder, ImageReader, Limits};
use std::io::Cursor;

/// The points of an image's content. A pixel of zero has no depth, and is no point.
///
/// # Errors
/// The rule that the content breaks.
pub fn parse(bytes: &[u8], camera: &DepthCamera) -> Result<PointCloud, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIDE_PX), Some(MAX_SIDE_PX));
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > u64::from(MAX_DEPTH_PIXELS) {
        return Err(format!("a depth image has at most {MAX_DEPTH_PIXELS} pixels, and it has {width} x {height}"));
    }
    let image = match DynamicImage::from_decoder(decoder).map_err(|error| error.to_string())? {
        DynamicImage::ImageLuma16(image) => image,
        other => {
            let bits = other.color().bits_per_pixel() / u16::from(other.color().channel_count());
            let channels = other.color().channel_count();
            return Err(format!("a depth image has one channel of 16 bits, and it has {channels} of {bits}"));
        }
    };
    if let Some([w, h]) = camera.size_px
        && (w, h) != (width, height)
    {
        return Err(format!("its camera takes images of {w} x {h} pixels, and it has {width} x {height}"));
    }
    let seen = image.enumerate_pixels().filter(|(.., depth)| depth.0[0] > 0);
    Ok(PointCloud::from_points(seen.map(|(u, v, depth)| camera.point_m((u, v), depth.0[0]))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageBuffer, ImageFormat, Luma};

    const CAMERA: DepthCamera =
        DepthCamera { focal_px: [100.0; 2], centre_px: [1.0, 0.0], unit_m: 0.001, size_px: Some([3, 2]) };

    fn bytes(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn each_pixel_with_a_depth_is_a_point() {
        let image: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_vec(3, 2, vec![0, 2000, 0, 0, 0, 4000]).unwrap();
        for format in [ImageFormat::Png, ImageFormat::Pnm] {
            let cloud = parse(&bytes(&image.clone().into(), format), &CAMERA).unwrap();
            let points: Vec<[f32; 3]> = cloud.points_m.iter().map(|&point_m| point_m.into()).collect();
            assert_eq!(points, [[0.0, 0.0, 2.0], [0.04, 0.04, 4.0]]);
            assert_eq!(cloud.skipped, 0);
        }
    }

    #[test]
    fn another_picture_is_refused() {
        let grey = DynamicImage::new_luma8(3, 2);
        let found = parse(&bytes(&grey, ImageFormat::Png), &CAMERA).unwrap_err();
        assert!(found.contains("one channel of 16 bits, and it has 1 of 8"), "{found}");
        let large = DynamicImage::new_luma16(4, 2);
        let found = parse(&bytes(&large, ImageFormat::Png), &CAMERA).unwrap_err();
        assert!(found.contains("images of 3 x 2 pixels, and it has 4 x 2"), "{found}");
        assert!(parse(b"no picture", &CAMERA).is_err());
        let found = parse(b"P5\n4096 2048\n65535\n", &CAMERA).unwrap_err();
        assert!(found.contains("at most 4194304 pixels, and it has 4096 x 2048"), "{found}");
    }
}
