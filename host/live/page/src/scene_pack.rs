//! The built-in scene as the page holds it: a still picture and, for each frame, the rectangle that
//! differs, as JPEG.

use crate::builtin::{BuiltinScene, RATE_HZ};
use crate::recording::{RecordedFrame, recorded};
use crate::rounding::{hundredths, tenths};
use anyhow::{Context, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::jpeg::JpegEncoder;
use image::{RgbImage, imageops};
use rayon::prelude::*;
use serde::Serialize;

/// Quality of the pictures, 1 to 100.
const QUALITY: u8 = 70;
/// JPEG works in squares of so many pixels; a rectangle begins at one.
const SQUARE_PX: u32 = 8;

/// Everything that the page knows of the scene.
#[derive(Debug, Serialize)]
pub struct ScenePack {
    width: u32,
    height: u32,
    frames_per_second: f32,
    /// Pixel of the right shoulder.
    shoulder: [f32; 2],
    /// How far away it is, metres.
    distance: f32,
    /// JPEG in base64.
    still: String,
    frames: Vec<PackedFrame>,
}

/// One frame: what differs from the still picture, where the hand is, and what the tracker made of
/// it.
#[derive(Debug, Serialize)]
struct PackedFrame {
    x: u32,
    y: u32,
    jpeg: String,
    hand: [f32; 2],
    #[serde(flatten)]
    recorded: RecordedFrame,
}

/// Packs the scene.
///
/// # Errors
/// None in practice: a frame that JPEG refuses.
pub fn packed(scene: &BuiltinScene) -> Result<ScenePack> {
    let still = median(&scene.frames)?;
    let patches: Vec<Result<(u32, u32, String)>> = scene.frames.par_iter().map(|frame| patch(frame, &still)).collect();
    let hands = scene.hands()?;
    let (shoulder, distance) = scene.shoulder()?;
    let frames = patches.into_iter().zip(hands).zip(recorded(scene, scene.placed_shoulder()?)?).map(
        |((patch, hand), recorded)| {
            let (x, y, jpeg) = patch?;
            Ok(PackedFrame { x, y, jpeg, hand: tenths([hand.u_px, hand.v_px]), recorded })
        },
    );
    let (width, height) = scene.size_px();
    Ok(ScenePack {
        width,
        height,
        frames_per_second: RATE_HZ,
        shoulder: tenths([shoulder.u_px, shoulder.v_px]),
        distance: hundredths(distance),
        still: jpeg(&still)?,
        frames: frames.collect::<Result<_>>()?,
    })
}

/// The median of each byte over all frames: mostly what does not move.
fn median(frames: &[RgbImage]) -> Result<RgbImage> {
    let first = frames.first().context("the scene has no frames")?;
    let bytes = (0..first.as_raw().len()).into_par_iter().map(|at| {
        let mut values: Vec<u8> = frames.iter().map(|frame| frame.as_raw()[at]).collect();
        values.sort_unstable();
        values[values.len() / 2]
    });
    RgbImage::from_raw(first.width(), first.height(), bytes.collect()).context("the frames differ in size")
}

/// Place and JPEG of the smallest rectangle of whole squares that holds what differs; one square
/// where nothing does.
fn patch(frame: &RgbImage, still: &RgbImage) -> Result<(u32, u32, String)> {
    let differs = frame.enumerate_pixels().zip(still.pixels()).filter(|((.., here), there)| here != there);
    let bounds = differs.fold(None, |bounds, ((x, y, _), _)| {
        let (left, top, right, bottom) = bounds.unwrap_or((x, y, x, y));
        Some((left.min(x), top.min(y), right.max(x), bottom.max(y)))
    });
    let (left, top, right, bottom) = bounds.unwrap_or_default();
    let (x, y) = (left / SQUARE_PX * SQUARE_PX, top / SQUARE_PX * SQUARE_PX);
    let cut = imageops::crop_imm(frame, x, y, right + 1 - x, bottom + 1 - y).to_image();
    Ok((x, y, jpeg(&cut)?))
}

fn jpeg(image: &RgbImage) -> Result<String> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode_image(image)?;
    Ok(STANDARD.encode(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    fn with_square(left: u32) -> RgbImage {
        RgbImage::from_fn(64, 48, |x, y| Rgb(if x >= left && x < left + 5 && y == 20 { [255; 3] } else { [9; 3] }))
    }

    #[test]
    fn the_median_holds_what_does_not_move() {
        let frames: Vec<RgbImage> = [3, 13, 30].map(with_square).to_vec();
        assert!(median(&frames).unwrap().pixels().all(|pixel| pixel.0 == [9; 3]));
    }

    #[test]
    fn a_patch_holds_what_differs_and_begins_at_a_square() {
        let still = RgbImage::from_pixel(64, 48, Rgb([9; 3]));
        let (x, y, text) = patch(&with_square(13), &still).unwrap();
        assert_eq!((x, y), (8, 16));
        let image = image::load_from_memory(&STANDARD.decode(text).unwrap()).unwrap();
        assert_eq!((image.width(), image.height()), (10, 5));
        let (x, y, text) = patch(&still, &still).unwrap();
        let image = image::load_from_memory(&STANDARD.decode(text).unwrap()).unwrap();
        assert_eq!((x, y, image.width(), image.height()), (0, 0, 1, 1));
    }
}
