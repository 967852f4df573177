//! What stands behind the person: a wall, things of random colours at it, uneven light and grain.

use super::canvas::{Canvas, Encoding, Light};
use super::options::BackgroundStyle;
use super::palette::{self, Rgb};
use sinew_core::math::{clamp, sin_cos};
use sinew_core::random::Stream;

/// A rectangle at the wall, pixels, with stripes or a gradient across it.
#[derive(Debug, Clone, Copy)]
struct Thing {
    left: f32,
    top: f32,
    right: f32,
    bottom: f32,
    colour: Rgb,
    gradient: f32,
    stripes: Option<(f32, f32)>,
}

impl Thing {
    fn random(stream: &mut Stream, [width, height]: [f32; 2]) -> Self {
        let size = [0.06 + 0.32 * stream.uniform(), 0.08 + 0.45 * stream.uniform()];
        let left = (stream.uniform() * 1.2 - 0.2) * width;
        let top = (stream.uniform() * 1.2 - 0.2) * height;
        let colour = palette::furniture(stream);
        let gradient = 0.5 * (stream.uniform() - 0.5);
        let stripes = (stream.below(3) == 0).then(|| (0.15 + 0.5 * stream.uniform(), 0.15 + 0.35 * stream.uniform()));
        Self { left, top, right: left + size[0] * width, bottom: top + size[1] * height, colour, gradient, stripes }
    }

    fn colour_at(&self, x: f32, y: f32) -> Option<Rgb> {
        if x < self.left || y < self.top || x > self.right || y > self.bottom {
            return None;
        }
        let across = (x - self.left) / (self.right - self.left);
        let mut brightness = 1.0 + self.gradient * (across - 0.5) * 2.0;
        if let Some((per_px, depth)) = self.stripes
            && sin_cos(per_px * x).0 > 0.3
        {
            brightness *= 1.0 - depth;
        }
        Some(self.colour * brightness)
    }
}

/// Paints the background; returns the wall's mean colour.
pub fn paint(
    canvas: &mut Canvas,
    encoding: &Encoding,
    light: &Light,
    style: BackgroundStyle,
    stream: &mut Stream,
) -> Rgb {
    let [width, height] = canvas.size();
    let wall = palette::wall(stream);
    let size = [width as f32, height as f32];
    let things: Vec<Thing> = match style {
        BackgroundStyle::Cluttered => {
            let count = 7 + stream.below(9);
            (0..count).map(|_| Thing::random(stream, size)).collect()
        }
        BackgroundStyle::Plain => Vec::new(),
    };
    let slopes = [0.35 * (stream.uniform() - 0.5), 0.35 * (stream.uniform() - 0.5)];
    for y in 0..height {
        for x in 0..width {
            let (fx, fy) = (x as f32, y as f32);
            let colour = things.iter().rev().find_map(|thing| thing.colour_at(fx, fy)).unwrap_or(wall);
            let grain = 0.04 * (stream.uniform() + stream.uniform() - 1.0);
            let even = 1.0 + slopes[0] * (fx / size[0] - 0.5) + slopes[1] * (fy / size[1] - 0.5) + grain;
            let linear = colour.component_mul(&light.colour) * (0.85 * clamp(even, 0.2, 2.0));
            canvas.paint(encoding, x, y, &linear);
        }
    }
    wall
}
