//! The built-in scene as a file that Chromium takes for a camera
//! (`--use-file-for-fake-video-capture`): YUV4MPEG2, 4:2:0, Rec. 601.
//!
//! The file runs to and fro, so that nothing jumps where it begins anew. A fake camera repeats and
//! drops frames, so each carries its number as squares along its upper edge. The first is white,
//! the second black. Eight bits of the number follow, the highest first, white for one.

use crate::builtin::{BuiltinScene, RATE_HZ};
use crate::rounding::tenths;
use anyhow::Result;
use image::{Rgb, RgbImage};
use rayon::prelude::*;
use serde::Serialize;
use sinew::output::OutputDir;

/// Width of a square of the code, pixels.
const CODE_WIDTH_PX: u32 = 16;
/// Height of the code, pixels.
const CODE_HEIGHT_PX: u32 = 8;
/// Bits of a number.
const CODE_BITS: u32 = 8;

/// What is true in the file's frames.
#[derive(Debug, Serialize)]
struct Truth {
    width: u32,
    code_width_px: u32,
    code_height_px: u32,
    /// Pixel of the right shoulder.
    shoulder: [f32; 2],
    /// How far away it is, metres.
    distance: f32,
    /// Pixel of the middle of the hand in every frame.
    hands: Vec<[f32; 2]>,
}

/// Writes `camera.y4m` and `camera.json`.
///
/// # Errors
/// A file that cannot be written.
pub fn write(scene: &BuiltinScene, out: &OutputDir) -> Result<()> {
    let (width, height) = scene.size_px();
    let frames: Vec<Vec<u8>> = scene
        .frames
        .par_iter()
        .enumerate()
        .map(|(number, frame)| planes(&coded(frame.clone(), number as u32)))
        .collect();
    out.write("camera.y4m", |writer| {
        writeln!(writer, "YUV4MPEG2 W{width} H{height} F{RATE_HZ}:1 Ip A1:1 C420jpeg")?;
        let back = frames.iter().rev().skip(1).take(frames.len().saturating_sub(2));
        for frame in frames.iter().chain(back) {
            writer.write_all(b"FRAME\n")?;
            writer.write_all(frame)?;
        }
        Ok(())
    })?;
    let (shoulder, distance) = scene.shoulder()?;
    let truth = Truth {
        width,
        code_width_px: CODE_WIDTH_PX,
        code_height_px: CODE_HEIGHT_PX,
        shoulder: [shoulder.u_px, shoulder.v_px],
        distance,
        hands: scene.hands()?.into_iter().map(|hand| tenths([hand.u_px, hand.v_px])).collect(),
    };
    Ok(out.write("camera.json", |writer| Ok(serde_json::to_writer(writer, &truth)?))?)
}

/// The frame with its number.
fn coded(mut frame: RgbImage, number: u32) -> RgbImage {
    let bits = (0..CODE_BITS).rev().map(|bit| number >> bit & 1 == 1);
    for (index, is_white) in [true, false].into_iter().chain(bits).enumerate() {
        let left = CODE_WIDTH_PX * index as u32;
        for (x, y) in (0..CODE_HEIGHT_PX).flat_map(|y| (left..left + CODE_WIDTH_PX).map(move |x| (x, y))) {
            frame.put_pixel(x, y, Rgb([if is_white { 255 } else { 0 }; 3]));
        }
    }
    frame
}

/// Luma of every pixel, then both chromas of every square of 2 x 2; studio range.
fn planes(frame: &RgbImage) -> Vec<u8> {
    let weighted = |[r, g, b]: [f32; 3], weights: [f32; 3], zero: f32| {
        ((r * weights[0] + g * weights[1] + b * weights[2]) / 255.0 + zero).round() as u8
    };
    let luma = frame.pixels().map(|pixel| weighted(pixel.0.map(f32::from), [65.481, 128.553, 24.966], 16.0));
    let mut bytes: Vec<u8> = luma.collect();
    for weights in [[-37.797, -74.203, 112.0], [112.0, -93.786, -18.214]] {
        for (x, y) in (0..frame.height() / 2).flat_map(|y| (0..frame.width() / 2).map(move |x| (2 * x, 2 * y))) {
            let mut mean = [0.0; 3];
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let pixel = frame.get_pixel(x + dx, y + dy).0;
                mean.iter_mut().zip(pixel).for_each(|(sum, channel)| *sum += f32::from(channel) / 4.0);
            }
            bytes.push(weighted(mean, weights, 128.0));
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_stands_along_the_upper_edge() {
        let frame = coded(RgbImage::from_pixel(200, 10, Rgb([100; 3])), 0b1010_0110);
        let squares: Vec<u8> = (0..10).map(|index| frame.get_pixel(16 * index + 8, 4).0[0]).collect();
        assert_eq!(squares, [255, 0, 255, 0, 255, 0, 0, 255, 255, 0]);
        assert_eq!(frame.get_pixel(8, 9).0, [100; 3]);
    }

    #[test]
    fn grey_has_no_chroma_and_red_has_its_own() {
        assert_eq!(planes(&RgbImage::from_pixel(2, 2, Rgb([255; 3]))), [235, 235, 235, 235, 128, 128]);
        assert_eq!(planes(&RgbImage::from_pixel(2, 2, Rgb([0; 3]))), [16, 16, 16, 16, 128, 128]);
        assert_eq!(planes(&RgbImage::from_pixel(2, 2, Rgb([255, 0, 0]))), [81, 81, 81, 81, 90, 240]);
    }
}
