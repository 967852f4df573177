//! Where a face is, by the crate `rustface`, and the colour of its skin.
//!
//! The detector is SeetaFace's funnel of boosted cascades: Wu, Kan, He, Shan, Chen,
//! "Funnel-structured cascade for multi-view face detection with alignment-awareness",
//! Neurocomputing 221, 2017.

use rustface::{ImageData, Model, Rectangle};
use sinew_core::vision::objects::head::HeadBox;
use sinew_core::vision::objects::person_colour::PersonColour;
use std::fmt::{Debug, Formatter};
use std::io;

/// The model's numbers, see `THIRD_PARTY_NOTICES.md`.
const MODEL: &[u8] = include_bytes!("../models/seeta_fd_frontal_v1.0.bin");
/// Longer side of the picture that is searched, pixels. A face of 48 pixels in 640 is found.
const SEARCHED_PX: u32 = 320;
/// Least side of a face there, pixels.
const MIN_FACE_PX: u32 = 24;
/// Least score of a face: the library's example, which finds all faces of the clips in `video/asl`.
const MIN_SCORE: f64 = 2.0;
/// Rows and columns of the face's middle whose pixels are looked at.
const SAMPLES: u32 = 32;
/// Parts of the box that are skin, columns and rows: below the hair, above the chin.
const SKIN: [[f32; 2]; 2] = [[0.2, 0.8], [0.25, 0.85]];

/// A face that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoundFace {
    /// Its box.
    pub head: HeadBox,
    /// The colour of its skin, if enough of it is alike.
    pub colour: Option<PersonColour>,
}

impl FoundFace {
    /// A face in a box of a picture: interleaved RGB, and its width and height in pixels.
    #[must_use]
    pub fn at(rgb: &[u8], size_px: (u32, u32), head: HeadBox) -> Self {
        Self { head, colour: PersonColour::of_face(&skin_pixels(rgb, size_px, &head)) }
    }
}

/// Finds faces.
///
/// ```
/// use sinew_face::FaceDetector;
///
/// let detector = FaceDetector::new()?;
/// let wall = [90; 3 * 320 * 240];
/// assert_eq!(detector.find(&wall, (320, 240)), None);
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone)]
pub struct FaceDetector {
    model: Model,
}

impl Debug for FaceDetector {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("FaceDetector").finish_non_exhaustive()
    }
}

impl FaceDetector {
    /// A detector with the shipped model.
    ///
    /// # Errors
    /// None with that model.
    pub fn new() -> io::Result<Self> {
        Ok(Self { model: rustface::read_model(MODEL)? })
    }

    /// The likeliest face of a picture: interleaved RGB, and its width and height in pixels. Where
    /// there is none, the picture is brightened and searched again. None where there are too few
    /// bytes.
    #[must_use]
    pub fn find(&self, rgb: &[u8], size_px: (u32, u32)) -> Option<FoundFace> {
        let (width, height) = size_px;
        let step = width.max(height).div_ceil(SEARCHED_PX).max(1);
        let (columns, rows) = (width / step, height / step);
        if columns.min(rows) < MIN_FACE_PX || rgb.len() < 3 * width as usize * height as usize {
            return None;
        }
        let grey = shrunk(rgb, size_px, step);
        let found =
            self.likeliest(&grey, columns, rows).or_else(|| self.likeliest(&brightened(grey), columns, rows))?;
        let place = |at: i32, length: u32| (at as f32 + 0.5 * length as f32) * step as f32;
        let head = HeadBox {
            centre_px: [place(found.x(), found.width()), place(found.y(), found.height())],
            width_px: (found.width() * step) as f32,
        };
        Some(FoundFace::at(rgb, size_px, head))
    }

    /// Box of the likeliest face in levels of grey.
    fn likeliest(&self, grey: &[u8], columns: u32, rows: u32) -> Option<Rectangle> {
        let mut detector = rustface::create_detector_with_model(self.model.clone());
        detector.set_min_face_size(MIN_FACE_PX);
        detector.set_score_thresh(MIN_SCORE);
        detector.set_pyramid_scale_factor(0.8);
        detector.set_slide_window_step(4, 4);
        let faces = detector.detect(&ImageData::new(grey, columns, rows));
        let best = faces.iter().reduce(|best, face| if face.score() > best.score() { face } else { best })?;
        Some(*best.bbox())
    }
}

/// Red, green and blue of a pixel; black where there is none.
fn pixel(rgb: &[u8], width: u32, (u, v): (u32, u32)) -> [u8; 3] {
    let index = v as usize * width as usize + u as usize;
    rgb.as_chunks::<3>().0.get(index).copied().unwrap_or_default()
}

/// Means of `step` x `step` pixels, grey.
fn shrunk(rgb: &[u8], (width, height): (u32, u32), step: u32) -> Vec<u8> {
    let mut grey = Vec::with_capacity((width / step * (height / step)) as usize);
    for row in 0..height / step {
        for column in 0..width / step {
            let mut sum = 0;
            for v in row * step..(row + 1) * step {
                for u in column * step..(column + 1) * step {
                    let [r, g, b] = pixel(rgb, width, (u, v)).map(u32::from);
                    sum += 77 * r + 150 * g + 29 * b;
                }
            }
            grey.push((sum / (256 * step * step)) as u8);
        }
    }
    grey
}

/// Square roots: in shadow and on dark skin a step of light then counts as elsewhere. Of the
/// powers 0.35, 0.5, 0.7 and 1 the first two found most faces on clips with skin made dark. With
/// one of them alone a face that is found anyway has another box, and hands were found no better.
fn brightened(mut grey: Vec<u8>) -> Vec<u8> {
    for level in &mut grey {
        *level = (u32::from(*level) * 255).isqrt() as u8;
    }
    grey
}

/// Pixels of the face's middle, in a grid.
fn skin_pixels(rgb: &[u8], (width, height): (u32, u32), head: &HeadBox) -> Vec<[u8; 3]> {
    let at = |[low, high]: [f32; 2], index: u32, centre_px: f32, end: u32| {
        let share = low + (high - low) * (index as f32 + 0.5) / SAMPLES as f32;
        ((centre_px + (share - 0.5) * head.width_px).max(0.0) as u32).min(end.saturating_sub(1))
    };
    let places = (0..SAMPLES).flat_map(|row| (0..SAMPLES).map(move |column| (column, row)));
    let colour = |(column, row)| {
        let u = at(SKIN[0], column, head.centre_px[0], width);
        let v = at(SKIN[1], row, head.centre_px[1], height);
        pixel(rgb, width, (u, v))
    };
    places.map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture((width, height): (u32, u32), pixel: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
        (0..height).flat_map(|v| (0..width).map(move |u| (u, v))).flat_map(|(u, v)| pixel(u, v)).collect()
    }

    #[test]
    fn a_picture_without_a_face_has_none() {
        let detector = FaceDetector::new().unwrap();
        for size in [(1, 1), (640, 480), (30, 400), (33, 33)] {
            let stripes = picture(size, |u, v| [(u * 7) as u8, (v * 5) as u8, 90]);
            assert_eq!(detector.find(&stripes, size), None, "{size:?}");
        }
        assert_eq!(detector.find(&[90; 100], (640, 480)), None, "too few bytes");
    }

    #[test]
    fn a_shrunk_picture_has_the_mean_grey_of_its_pixels() {
        let image = picture((5, 4), |u, v| [if (u + v) % 2 == 0 { 200 } else { 100 }; 3]);
        assert_eq!(shrunk(&image, (5, 4), 2), [150; 4]);
    }

    #[test]
    fn dark_levels_are_brightened_most() {
        assert_eq!(brightened(vec![0, 1, 64, 255]), [0, 15, 127, 255]);
    }

    #[test]
    fn pixels_of_a_face_at_the_border_are_within_the_picture() {
        let image = picture((20, 20), |_, _| [1, 2, 3]);
        let head = HeadBox { centre_px: [19.0, -5.0], width_px: 30.0 };
        assert_eq!(skin_pixels(&image, (20, 20), &head), vec![[1, 2, 3]; 1024]);
    }
}
