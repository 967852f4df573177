//! What the picture and the view from above draw of an arm, and the sizes and lines that they
//! share.

use super::colour::SHADE;
use super::lettering::Lettering;
use super::stroke::{Stroke, line};
use image::{Rgb, RgbImage};
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;

/// Smallest side of an image that gets letters, pixels.
const SMALLEST_LETTERED_PX: u32 = 120;

/// What is drawn of one arm.
#[derive(Debug, Clone, PartialEq)]
pub struct OverlayArm {
    /// The person's own side; gives the colour.
    pub side: Side,
    /// Solid lines where tracking, thin dashes where predicted, only a note and the particles'
    /// hands where lost.
    pub status: Status,
    /// Images of shoulder, elbow and hand.
    pub joints_px: Option<[Pixel; 3]>,
    /// Shoulder, elbow and hand, metres in camera axes: for the view from above.
    pub joints_m: Option<[Vec3; 3]>,
    /// Hand and weight of each particle; only ratios of weights matter.
    pub particle_hands: Vec<(Pixel, f32)>,
    /// Shoulder, elbow and hand of the heaviest particles.
    pub best_arms: Vec<[Pixel; 3]>,
    /// Two points of the ray through the carrying blob, metres in camera axes, the nearer one
    /// first.
    pub ray: Option<[Vec3; 2]>,
}

/// Sizes that follow the image: 1 at 240 pixels (the smaller side), growing with the square root.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    pub factor: f64,
    pub letters: Option<Lettering>,
}

impl Scale {
    pub fn of(image: &RgbImage) -> Self {
        let smaller = image.width().min(image.height());
        let factor = (f64::from(smaller) / 240.0).sqrt().clamp(0.35, 4.0);
        let size_px = (11.5 * factor).max(10.0) as f32;
        let letters = if smaller >= SMALLEST_LETTERED_PX { Lettering::new(size_px) } else { None };
        Self { factor, letters }
    }
}

/// A chain of lines on a darker, wider one, so that it shows on any background.
pub(super) fn outlined(image: &mut RgbImage, points: &[Pixel], stroke: Stroke, shade_width_px: f64) {
    let shade = stroke.with_colour_and_width(SHADE, shade_width_px).with_opacity(0.6);
    points.windows(2).for_each(|pair| line(image, pair[0], pair[1], &shade));
    points.windows(2).for_each(|pair| line(image, pair[0], pair[1], &stroke));
}

/// A third of the way to white: letters and thin lines need it on a dark plate.
pub(super) fn lighter(colour: Rgb<u8>) -> Rgb<u8> {
    Rgb(colour.0.map(|channel| channel + (255 - channel) / 3))
}
