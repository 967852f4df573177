//! Smooth thick lines and discs, clipped before they are drawn.
//!
//! A line is the set of points within half its width of a segment. A pixel's share of the colour
//! falls off linearly over one pixel across the rim. `imageproc` draws smooth or thick lines, but
//! not both, and no dashes.

use image::{Rgb, RgbImage};
use sinew_core::camera::Pixel;

/// How a line looks.
#[derive(Debug, Clone, Copy)]
pub struct Stroke {
    colour: Rgb<u8>,
    width_px: f64,
    opacity: f64,
    dash_px: Option<f64>,
}

impl Stroke {
    /// An opaque, unbroken line.
    pub fn new(colour: Rgb<u8>, width_px: f64) -> Self {
        Self { colour, width_px, opacity: 1.0, dash_px: None }
    }

    /// The same with `opacity` in 0..=1; NaN counts as 0.
    pub fn with_opacity(self, opacity: f64) -> Self {
        Self { opacity: if opacity > 0.0 { opacity.min(1.0) } else { 0.0 }, ..self }
    }

    /// The same in another colour and width, with the same dashes along the line.
    pub fn with_colour_and_width(self, colour: Rgb<u8>, width_px: f64) -> Self {
        Self { colour, width_px, ..self }
    }

    /// The same with dashes if `dashed`: three widths of line, four of gap (the round ends take one
    /// of them).
    pub fn with_dashes(self, dashed: bool) -> Self {
        Self { dash_px: dashed.then_some((3.0 * self.width_px).max(1.0)), ..self }
    }
}

type Point = (f64, f64);

/// Draws the line between `from` and `to` (pixel axes) as far as it lies in the image; nothing if
/// either is not finite.
pub fn line(image: &mut RgbImage, from: Pixel, to: Pixel, stroke: &Stroke) {
    let (a, b) = (point(from), point(to));
    let reach = 0.5 * stroke.width_px + 1.0;
    let Some((first, last)) = clip(a, b, reach, image) else { return };
    let Some(dash_px) = stroke.dash_px else { return capsule(image, first, last, stroke) };
    let period_px = 7.0 / 3.0 * dash_px;
    let length_px = distance(first, last);
    let mut start_px = -(distance(a, first) % period_px);
    while start_px < length_px {
        let end_px = (start_px + dash_px).min(length_px);
        if end_px > 0.0 {
            let at = |s_px: f64| between(first, last, s_px / length_px);
            capsule(image, at(start_px.max(0.0)), at(end_px), stroke);
        }
        start_px += period_px;
    }
}

/// Draws a filled disc about `centre`; nothing if it is not finite.
pub fn disc(image: &mut RgbImage, centre: Pixel, radius_px: f64, colour: Rgb<u8>, opacity: f64) {
    line(image, centre, centre, &Stroke::new(colour, 2.0 * radius_px).with_opacity(opacity));
}

/// Mixes `colour` into the pixel at column `x` and row `y`; nothing outside of the image.
pub fn tint(image: &mut RgbImage, x: u32, y: u32, colour: Rgb<u8>, opacity: f64) {
    if let Some(pixel) = image.get_pixel_mut_checked(x, y) {
        for (old, new) in pixel.0.iter_mut().zip(colour.0) {
            *old = (f64::from(*old) + opacity * (f64::from(new) - f64::from(*old)) + 0.5) as u8;
        }
    }
}

/// Mixes `colour` into the rectangle of `size` at `corner`, as far as it lies in the image.
pub fn tint_rectangle(image: &mut RgbImage, corner: (u32, u32), size: (u32, u32), colour: Rgb<u8>, opacity: f64) {
    for y in corner.1..corner.1.saturating_add(size.1).min(image.height()) {
        for x in corner.0..corner.0.saturating_add(size.0).min(image.width()) {
            tint(image, x, y, colour, opacity);
        }
    }
}

fn point(pixel: Pixel) -> Point {
    (f64::from(pixel.u_px), f64::from(pixel.v_px))
}

fn between(a: Point, b: Point, t: f64) -> Point {
    (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))
}

fn distance(a: Point, b: Point) -> f64 {
    ((a.0 - b.0) * (a.0 - b.0) + (a.1 - b.1) * (a.1 - b.1)).sqrt()
}

/// The part of the segment within `reach` of the image, cut at one border after the other. Ends lie
/// exactly on the borders, however far away they were.
fn clip(mut a: Point, mut b: Point, reach: f64, image: &RgbImage) -> Option<(Point, Point)> {
    if !(a.0 + a.1 + b.0 + b.1).is_finite() || image.width() == 0 || image.height() == 0 {
        return None;
    }
    let right = f64::from(image.width()) - 1.0 + reach;
    let bottom = f64::from(image.height()) - 1.0 + reach;
    let swap = |p: Point| (p.1, p.0);
    (a, b) = clip_first(a, b, -reach, right)?;
    (a, b) = clip_first(swap(a), swap(b), -reach, bottom)?;
    Some((swap(a), swap(b)))
}

/// The part of the segment whose first coordinate lies in `low..=high`.
fn clip_first(a: Point, b: Point, low: f64, high: f64) -> Option<(Point, Point)> {
    if a.0.min(b.0) > high || a.0.max(b.0) < low {
        return None;
    }
    let cut = |end: Point| {
        let border = end.0.clamp(low, high);
        if border == end.0 { end } else { (border, a.1 + (border - a.0) / (b.0 - a.0) * (b.1 - a.1)) }
    };
    Some((cut(a), cut(b)))
}

/// Draws all points within half the width of a segment, row by row.
fn capsule(image: &mut RgbImage, a: Point, b: Point, stroke: &Stroke) {
    let reach = 0.5 * stroke.width_px + 0.5;
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let squared_length = dx * dx + dy * dy;
    for y in rows(a.1.min(b.1) - reach, a.1.max(b.1) + reach, image.height()) {
        let row = f64::from(y);
        let (mut s0, mut s1) = (0.0, 1.0);
        if dy != 0.0 {
            let (above, below) = ((row - reach - a.1) / dy, (row + reach - a.1) / dy);
            (s0, s1) = (above.min(below).clamp(0.0, 1.0), above.max(below).clamp(0.0, 1.0));
        }
        let (x0, x1) = (a.0 + s0 * dx, a.0 + s1 * dx);
        for x in rows(x0.min(x1) - reach, x0.max(x1) + reach, image.width()) {
            let p = (f64::from(x), row);
            let along = (p.0 - a.0) * dx + (p.1 - a.1) * dy;
            let t = if squared_length > 0.0 { (along / squared_length).clamp(0.0, 1.0) } else { 0.0 };
            let cover = (reach - distance(p, between(a, b, t))).clamp(0.0, 1.0);
            if cover > 0.0 {
                tint(image, x, y, stroke.colour, cover * stroke.opacity);
            }
        }
    }
}

/// Whole numbers in `low..=high` that are indices below `count`.
fn rows(low: f64, high: f64, count: u32) -> std::ops::Range<u32> {
    let first = low.ceil().max(0.0).min(f64::from(count));
    let last = (high.floor() + 1.0).max(first).min(f64::from(count));
    first as u32..last as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const WHITE: Rgb<u8> = Rgb([255, 255, 255]);

    #[test]
    fn a_line_of_one_pixel_covers_its_pixels_and_no_other() {
        let mut image = RgbImage::new(9, 5);
        line(&mut image, Pixel::new(2.0, 2.0), Pixel::new(6.0, 2.0), &Stroke::new(WHITE, 1.0));
        for (x, y, pixel) in image.enumerate_pixels() {
            let on_line = y == 2 && (2..=6).contains(&x);
            assert_eq!(pixel[0], if on_line { 255 } else { 0 }, "({x}, {y})");
        }
    }

    #[test]
    fn a_line_whose_ends_are_far_outside_still_crosses_the_image() {
        let mut image = RgbImage::new(20, 20);
        line(&mut image, Pixel::new(-3.0e30, 10.0), Pixel::new(3.0e30, 10.0), &Stroke::new(WHITE, 3.0));
        assert!((0..20).all(|x| image.get_pixel(x, 10)[0] == 255 && image.get_pixel(x, 5)[0] == 0));
    }

    #[test]
    fn dashes_leave_gaps() {
        let mut image = RgbImage::new(100, 7);
        let stroke = Stroke::new(WHITE, 2.0).with_dashes(true);
        line(&mut image, Pixel::new(0.0, 3.0), Pixel::new(99.0, 3.0), &stroke);
        let lit = (0..100).filter(|x| image.get_pixel(*x, 3)[0] > 127).count();
        assert!((50..85).contains(&lit), "{lit} of 100 pixels are lit");
    }

    #[test]
    fn a_disc_has_the_area_of_a_disc() {
        let mut image = RgbImage::new(64, 64);
        disc(&mut image, Pixel::new(31.3, 32.6), 20.0, WHITE, 1.0);
        let area: f64 = image.pixels().map(|p| f64::from(p[0]) / 255.0).sum();
        let exact = std::f64::consts::PI * 400.0;
        assert!((area / exact - 1.0).abs() < 0.01, "area {area}, exact {exact}");
    }

    proptest! {
        #[test]
        fn pixels_beyond_the_width_stay_untouched(
            ends in [-40.0_f32..80.0, -40.0..80.0, -40.0..80.0, -40.0..80.0], width_px in 0.5_f64..9.0, dashed: bool,
        ) {
            let mut image = RgbImage::new(40, 30);
            let (a, b) = (Pixel::new(ends[0], ends[1]), Pixel::new(ends[2], ends[3]));
            line(&mut image, a, b, &Stroke::new(WHITE, width_px).with_dashes(dashed));
            for (x, y, pixel) in image.enumerate_pixels() {
                let p = (f64::from(x), f64::from(y));
                let away = (0..=400).map(|i| distance(p, between(point(a), point(b), f64::from(i) / 400.0)));
                let away = away.fold(f64::INFINITY, f64::min);
                prop_assert!(pixel[0] == 0 || away <= 0.5 * width_px + 1.0, "({}, {}) is {} px away", x, y, away);
                if !dashed && away <= 0.5 * width_px - 0.6 {
                    prop_assert_eq!(pixel[0], 255);
                }
            }
        }
    }
}
