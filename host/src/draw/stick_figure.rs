//! The stick figure of the cyclic tracker, on a picture of the person or alone.

use super::arm_marks::{lighter, outlined};
use super::colour::{INK, LEFT, RIGHT, SHADE};
use super::lettering::Lettering;
use super::stroke::{Stroke, disc, line};
use image::{Rgb, RgbImage};
use sinew_core::camera::Pixel;
use sinew_core::skeleton::stick_figure::HUMAN;

/// Joints in pixels in the order of the stick figure; `None` where one is not known.
pub type FigureJoints = [Option<Pixel>; 14];

/// How a figure looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureStyle {
    /// Thick, in the colours of the sides, with a dark rim that shows on any picture.
    OnPicture,
    /// Thick, in the colours of the sides, for a light canvas.
    OnCanvas,
    /// Thin and grey: what stands behind another figure.
    Faint,
}

/// Trunk of a figure on a light canvas.
const DARK: Rgb<u8> = Rgb([60, 60, 66]);
/// A faint figure.
const GREY: Rgb<u8> = Rgb([150, 150, 156]);
/// Joints that begin with the left and the right arm and leg, in the order of [`HUMAN`].
const LIMBS: [(std::ops::Range<usize>, Rgb<u8>); 4] = [(2..5, LEFT), (8..11, LEFT), (5..8, RIGHT), (11..14, RIGHT)];

/// Draws `joints`: left limbs first, then the trunk, right limbs last. A segment with an end that
/// is not known is left out.
pub fn draw_figure(image: &mut RgbImage, joints: &FigureJoints, style: FigureStyle) {
    let smaller = f64::from(image.width().min(image.height()));
    let factor = (smaller / 240.0).sqrt().clamp(0.35, 4.0);
    let width_px = if style == FigureStyle::Faint { 1.6 } else { 3.0 } * factor;
    let trunk = if style == FigureStyle::OnPicture { INK } else { DARK };
    let [left_arm, left_leg, right_arm, right_leg] = LIMBS;
    for (joint, colour) in left_arm.0.chain(left_leg.0).map(|joint| (joint, LEFT)) {
        segment(image, joints, joint, style, colour, width_px);
    }
    segment(image, joints, 1, style, trunk, width_px);
    for (joint, colour) in right_arm.0.chain(right_leg.0).map(|joint| (joint, RIGHT)) {
        segment(image, joints, joint, style, colour, width_px);
    }
}

/// The segment that ends at `joint`, with its end as a dot.
fn segment(
    image: &mut RgbImage,
    joints: &FigureJoints,
    joint: usize,
    style: FigureStyle,
    colour: Rgb<u8>,
    width_px: f64,
) {
    let parent = HUMAN.joints()[joint].parent.map_or(0, usize::from);
    let Some(end) = joints[joint] else { return };
    let colour = if style == FigureStyle::Faint { GREY } else { colour };
    let stroke = Stroke::new(colour, width_px);
    if let Some(start) = joints[parent] {
        match style {
            FigureStyle::OnPicture => outlined(image, &[start, end], stroke, 1.5 * width_px),
            FigureStyle::OnCanvas => line(image, start, end, &stroke),
            FigureStyle::Faint => line(image, start, end, &stroke.with_opacity(0.8)),
        }
    }
    if style == FigureStyle::OnPicture {
        disc(image, end, 1.1 * width_px, SHADE, 0.7);
    }
    disc(image, end, 0.8 * width_px, colour, 1.0);
}

/// Writes `lines` on dark plates in the upper left corner: the first on any picture with sides of
/// 120 pixels or more, the others where they take less than a third of its height.
pub fn caption(image: &mut RgbImage, lines: &[String]) {
    let smaller = image.width().min(image.height());
    let size_px = (11.5 * (f64::from(smaller) / 240.0).sqrt()).clamp(10.0, 46.0) as f32;
    let Some(letters) = Lettering::new(size_px).filter(|_| smaller >= 120) else { return };
    let step_px = letters.line_height_px();
    let fits = 3 * step_px * lines.len() as u32 <= image.height();
    for (line, top_px) in lines.iter().zip((0..).step_by(step_px as usize)).take(if fits { lines.len() } else { 1 }) {
        let text = letters.fit(line, image.width().saturating_sub(8));
        letters.draw_on_plate(image, (0, top_px), &text, lighter(INK));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Rgb<u8> = Rgb([255; 3]);

    /// Neck above the hips, left knee to the left, right knee to the right; the right ankle is not
    /// known.
    fn figure() -> FigureJoints {
        let mut joints = [None; 14];
        let mut set = |joint: usize, u: f32, v: f32| joints[joint] = Some(Pixel::new(u, v));
        set(0, 60.0, 60.0);
        set(1, 60.0, 20.0);
        set(8, 58.0, 60.0);
        set(9, 30.0, 90.0);
        set(11, 62.0, 60.0);
        set(12, 90.0, 90.0);
        joints
    }

    fn drawn(style: FigureStyle) -> RgbImage {
        let mut image = RgbImage::from_pixel(120, 110, WHITE);
        draw_figure(&mut image, &figure(), style);
        image
    }

    #[test]
    fn sides_have_their_colours_and_what_is_not_known_is_not_drawn() {
        let image = drawn(FigureStyle::OnCanvas);
        assert_eq!((*image.get_pixel(44, 75), *image.get_pixel(76, 75)), (LEFT, RIGHT));
        assert_eq!(*image.get_pixel(60, 40), DARK);
        let far = image.enumerate_pixels().filter(|(x, y, pixel)| **pixel != WHITE && (*y > 96 || *x < 24 || *x > 96));
        assert_eq!(far.count(), 0);
    }

    #[test]
    fn a_faint_figure_is_thin_and_grey() {
        let (solid, faint) = (drawn(FigureStyle::OnPicture), drawn(FigureStyle::Faint));
        let inked = |image: &RgbImage| image.pixels().filter(|pixel| **pixel != WHITE).count();
        assert!(inked(&faint) > 100 && 2 * inked(&faint) < inked(&solid) + inked(&faint));
        assert!(faint.pixels().all(|p| p[0].abs_diff(p[1]) < 8 && p[1].abs_diff(p[2]) < 8));
    }
}
