//! Short texts on pictures, in the font that comes with the program.

use super::colour::SHADE;
use super::stroke::tint_rectangle;
use ab_glyph::{Font, FontRef, GlyphId, OutlinedGlyph, PxScale, ScaleFont, point};
use epaint_default_fonts::HACK_REGULAR;
use image::{Pixel, Rgb, RgbImage};
use std::sync::OnceLock;

/// Letters of one size.
#[derive(Debug, Clone, Copy)]
pub struct Lettering {
    size_px: f32,
}

impl Lettering {
    /// Letters of `size_px` pixels; `None` where they would be too small to read.
    pub fn new(size_px: f32) -> Option<Self> {
        (size_px >= 10.0).then_some(Self { size_px })
    }

    /// Distance between two lines, pixels.
    pub fn line_height_px(self) -> u32 {
        (1.25 * self.size_px) as u32 + 1
    }

    /// Width of `text`, pixels.
    pub fn width_px(self, text: &str) -> u32 {
        self.lay_out(text, |_| {})
    }

    /// `text` cut with an ellipsis where it is wider than `room_px`.
    pub fn fit(self, text: &str, room_px: u32) -> String {
        if self.width_px(text) <= room_px {
            return text.to_owned();
        }
        let mut kept: Vec<char> = text.chars().take(1000).collect();
        while kept.pop().is_some() {
            let shorter: String = kept.iter().chain(&['…']).collect();
            if self.width_px(&shorter) <= room_px {
                return shorter;
            }
        }
        String::new()
    }

    /// Draws `text` with its top left corner at (x, y), cut off at the image's rim.
    pub fn draw(self, image: &mut RgbImage, (x, y): (i32, i32), text: &str, colour: Rgb<u8>) {
        self.lay_out(text, |glyph| {
            let bounds = glyph.px_bounds();
            let (left, top) = (x + bounds.min.x.round() as i32, y + bounds.min.y.round() as i32);
            glyph.draw(|glyph_x, glyph_y, coverage| {
                let (Ok(x), Ok(y)) = (u32::try_from(glyph_x as i32 + left), u32::try_from(glyph_y as i32 + top)) else {
                    return;
                };
                if let Some(pixel) = image.get_pixel_mut_checked(x, y) {
                    let share = coverage.clamp(0.0, 1.0);
                    pixel.apply2(&colour, |below, ink| {
                        (f32::from(below) * (1.0 - share) + f32::from(ink) * share) as u8
                    });
                }
            });
        });
    }

    /// Gives `draw` each glyph of `text` at its place beside the ones before it; returns the width
    /// of all, pixels.
    fn lay_out(self, text: &str, mut draw: impl FnMut(&OutlinedGlyph)) -> u32 {
        let Some(font) = font().filter(|_| !text.is_empty()) else { return 0 };
        let scale = PxScale::from(self.size_px);
        let scaled = font.as_scaled(scale);
        let (mut width, mut before): (f32, Option<GlyphId>) = (0.0, None);
        for letter in text.chars() {
            let id = scaled.glyph_id(letter);
            let glyph = id.with_scale_and_position(scale, point(width, scaled.ascent()));
            width += scaled.h_advance(id);
            if let Some(outlined) = scaled.outline_glyph(glyph) {
                width += before.map_or(0.0, |before| scaled.kern(id, before));
                before = Some(id);
                draw(&outlined);
            }
        }
        1 + width.ceil() as u32
    }

    /// Draws `text` on a dark plate, moved so that all of it lies inside of the image if it can.
    pub fn draw_on_plate(self, image: &mut RgbImage, (x, y): (i32, i32), text: &str, colour: Rgb<u8>) {
        let size = (self.width_px(text) + 5, self.line_height_px());
        let x = x.min(image.width() as i32 - size.0 as i32).max(0);
        let y = y.min(image.height() as i32 - size.1 as i32).max(0);
        tint_rectangle(image, (x as u32, y as u32), size, SHADE, 0.75);
        self.draw(image, (x + 2, y + 1), text, colour);
    }
}

fn font() -> Option<&'static FontRef<'static>> {
    static FONT: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    FONT.get_or_init(|| FontRef::try_from_slice(HACK_REGULAR).ok()).as_ref()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fitted_text_is_never_wider_than_its_room() {
        let letters = Lettering::new(14.0).unwrap();
        let text = "frame 0001, 2 blobs, 1.5 ms, effective sample size 41";
        assert_eq!(letters.fit(text, 10_000), text);
        for room_px in [0, 5, 40, 200] {
            let fitted = letters.fit(text, room_px);
            assert!(letters.width_px(&fitted) <= room_px && fitted.len() < text.len(), "{room_px}: {fitted}");
        }
        assert!(letters.fit(text, 200).starts_with("frame"));
    }

    #[test]
    fn letters_too_small_to_read_are_not_offered() {
        assert!(Lettering::new(5.0).is_none());
        assert!(Lettering::new(f32::NAN).is_none());
    }

    #[test]
    fn a_plate_stays_inside_of_the_image() {
        let mut image = RgbImage::from_pixel(120, 40, Rgb([200, 200, 200]));
        Lettering::new(12.0).unwrap().draw_on_plate(&mut image, (5000, 5000), "0.87", Rgb([255, 0, 0]));
        assert!(image.pixels().filter(|pixel| pixel[0] > pixel[1].saturating_add(60)).count() > 20);
        assert!(image.get_pixel(119, 39)[0] < 100 && image.get_pixel(0, 0)[0] == 200);
    }
}
