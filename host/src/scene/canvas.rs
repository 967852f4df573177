//! A picture with depth: shaded shapes are drawn into it, then it goes through a lens blur and
//! sensor noise.

use super::palette::{Rgb, encode};
use super::shape::{NEAREST_DEPTH_M, Shape};
use image::RgbImage;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::math::{Vec3, abs, max, min, sin_cos, sqrt};
use sinew_core::random::Stream;

/// Levels of the picture are kept in this many parts of one level of 255.
pub const FINE: i16 = 64;
const ENCODING_STEPS: usize = 4096;
/// Noise values that are drawn once for a scene; each row of each frame starts somewhere else in
/// them.
const NOISE_VALUES: usize = 1 << 16;

/// How a surface looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// One colour.
    Plain(Rgb),
    /// Cloth: bright and dark folds across a capsule or ellipsoid.
    Folded {
        /// Mean colour.
        colour: Rgb,
        /// Folds a metre (capsule) or over half an ellipsoid.
        folds: f32,
        /// Share by which folds change brightness.
        depth: f32,
        /// Where the first fold is, radians.
        phase_rad: f32,
    },
    /// A head; the ellipsoid's own axes are left, up, front.
    Head {
        /// Face.
        skin: Rgb,
        /// Hair and brows.
        hair: Rgb,
    },
}

impl Surface {
    fn reflectance(&self, place: &Vec3) -> Rgb {
        match *self {
            Self::Plain(colour) => colour,
            Self::Folded { colour, folds, depth, phase_rad } => {
                let wave = sin_cos(core::f32::consts::TAU * folds * (place.x + 0.7 * place.y) + phase_rad).0;
                colour * (1.0 + depth * wave)
            }
            Self::Head { skin, hair } => {
                let within = |x: f32, y: f32, half: [f32; 2]| {
                    let (dx, dy) = ((abs(place.x) - x) / half[0], (place.y - y) / half[1]);
                    dx * dx + dy * dy < 1.0
                };
                if place.y > 0.55 - 0.25 * place.x * place.x || place.z < 0.25 {
                    hair
                } else if within(0.38, 0.12, [0.13, 0.055]) {
                    hair * 0.6
                } else if within(0.38, 0.30, [0.20, 0.035]) {
                    hair
                } else if within(0.0, -0.50, [0.30, 0.05]) {
                    Rgb::new(skin.x * 0.75, skin.y * 0.45, skin.z * 0.5)
                } else {
                    skin
                }
            }
        }
    }
}

/// The light of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Unit direction towards the lamp, camera axes.
    pub direction: Vec3,
    /// Colour times exposure.
    pub colour: Rgb,
    /// Share of light that comes from all sides.
    pub ambient: f32,
}

/// Colour and depth of every pixel, row by row.
#[derive(Debug, Clone)]
pub struct Canvas {
    width: usize,
    height: usize,
    /// Encoded red, green, blue, in 1 / [`FINE`] levels.
    colour: Vec<i16>,
    depth_m: Vec<f32>,
}

/// Turns linear light into encoded levels by a table.
#[derive(Debug, Clone)]
pub struct Encoding(Vec<i16>);

impl Encoding {
    /// The sRGB curve.
    #[must_use]
    pub fn srgb() -> Self {
        let level = |index: usize| encode(index as f32 / (ENCODING_STEPS - 1) as f32) * 255.0 * f32::from(FINE);
        Self((0..ENCODING_STEPS).map(|index| (level(index) + 0.5) as i16).collect())
    }

    #[inline]
    fn level(&self, linear: f32) -> i16 {
        // The conversion saturates, so that light above 1 is white.
        self.0[((linear * (ENCODING_STEPS - 1) as f32 + 0.5) as usize).min(ENCODING_STEPS - 1)]
    }
}

impl Canvas {
    /// A canvas of black pixels, infinitely far away.
    #[must_use]
    pub fn new(width_px: u32, height_px: u32) -> Self {
        let (width, height) = (width_px as usize, height_px as usize);
        Self { width, height, colour: vec![0; 3 * width * height], depth_m: vec![f32::INFINITY; width * height] }
    }

    /// Width and height, pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Paints one pixel at infinite depth.
    pub fn paint(&mut self, encoding: &Encoding, x: usize, y: usize, linear: &Rgb) {
        let at = 3 * (y * self.width + x);
        for channel in 0..3 {
            self.colour[at + channel] = encoding.level(linear[channel]);
        }
    }

    /// Draws the parts of `shape` that are nearer than what is there.
    pub fn draw(&mut self, camera: &Camera, encoding: &Encoding, light: &Light, shape: &Shape, surface: &Surface) {
        let Some([left, top, right, bottom]) = self.bounds(camera, shape) else { return };
        let prepared = shape.prepare();
        let (centre, per_px) = (camera.centre(), 1.0 / camera.focal_px());
        for y in top..bottom {
            let direction_y = (y as f32 - centre.v_px) * per_px;
            for x in left..right {
                let direction = Vec3::new((x as f32 - centre.u_px) * per_px, direction_y, 1.0);
                let Some(hit) = prepared.hit(&direction) else { continue };
                let at = y * self.width + x;
                if hit.depth_m < self.depth_m[at] {
                    self.depth_m[at] = hit.depth_m;
                    let lamp = max(hit.normal.dot(&light.direction), 0.0);
                    let shade = light.ambient + (1.0 - light.ambient) * lamp;
                    let linear = surface.reflectance(&hit.place).component_mul(&light.colour) * shade;
                    self.paint(encoding, x, y, &linear);
                }
            }
        }
    }

    /// Pixels that may show the shape: left, top, right, bottom (the last two excluded).
    fn bounds(&self, camera: &Camera, shape: &Shape) -> Option<[usize; 4]> {
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for (middle, radius) in shape.bounding_balls() {
            let nearest = middle.z - radius;
            if middle.z + radius < NEAREST_DEPTH_M {
                return None;
            }
            if nearest < NEAREST_DEPTH_M {
                return Some([0, 0, self.width, self.height]);
            }
            // Half angle of the cone round the ball, widened for its slant to the image plane.
            let centre = camera.project(&middle)?;
            let slant = middle.norm() / middle.z;
            let half_px = camera.focal_px() * radius * slant * slant / sqrt(max(nearest * middle.z, 1.0e-6)) + 1.5;
            for (axis, value) in [centre.u_px, centre.v_px].into_iter().enumerate() {
                low[axis] = min(low[axis], value - half_px);
                high[axis] = max(high[axis], value + half_px);
            }
        }
        let cut = |value: f32, size: usize| (max(value, 0.0) as usize).min(size);
        let bounds = [
            cut(low[0], self.width),
            cut(low[1], self.height),
            cut(high[0] + 1.0, self.width),
            cut(high[1] + 1.0, self.height),
        ];
        (bounds[0] < bounds[2] && bounds[1] < bounds[3]).then_some(bounds)
    }

    /// Whether something at the pixel of `point` is nearer than `point`, or the point has no pixel.
    #[must_use]
    pub fn hides(&self, pixel: Pixel, depth_m: f32) -> bool {
        let (x, y) = (pixel.u_px + 0.5, pixel.v_px + 0.5);
        if !(x >= 0.0 && y >= 0.0 && x < self.width as f32 && y < self.height as f32) {
            return true;
        }
        self.depth_m[y as usize * self.width + x as usize] < depth_m
    }

    /// The picture as a camera gives it: each channel blurred by (1, 2, 1)/4 along rows and
    /// columns, with noise.
    #[must_use]
    pub fn developed(&self, noise: &Noise, stream: &mut Stream) -> RgbImage {
        let row_length = 3 * self.width;
        let mut bytes = vec![0_u8; row_length * self.height];
        let mut sums = vec![0_i32; row_length + 6];
        for (y, out) in bytes.chunks_exact_mut(row_length).enumerate() {
            let row = |y: usize| &self.colour[y * row_length..(y + 1) * row_length];
            let (above, here, below) = (row(y.saturating_sub(1)), row(y), row((y + 1).min(self.height - 1)));
            for (sum, ((&a, &b), &c)) in sums[3..].iter_mut().zip(above.iter().zip(here).zip(below)) {
                *sum = i32::from(a) + 2 * i32::from(b) + i32::from(c);
            }
            for channel in 0..3 {
                sums[channel] = sums[channel + 3];
                sums[row_length + 3 + channel] = sums[row_length + channel];
            }
            let noise = noise.values(stream, row_length);
            let neighbours = sums.iter().zip(&sums[3..]).zip(&sums[6..]);
            for ((out, ((left, middle), right)), &grain) in out.iter_mut().zip(neighbours).zip(noise) {
                let blurred = (left + 2 * middle + right) >> 4;
                let level = (blurred + i32::from(grain) + i32::from(FINE) / 2) >> FINE.trailing_zeros();
                *out = level.clamp(0, 255) as u8;
            }
        }
        RgbImage::from_raw(self.width as u32, self.height as u32, bytes)
            .unwrap_or_else(|| RgbImage::new(self.width as u32, self.height as u32))
    }
}

/// Gaussian noise in 1 / [`FINE`] levels.
#[derive(Debug, Clone)]
pub struct Noise(Vec<i16>);

impl Noise {
    /// Noise of standard deviation `std_levels` (of 255) for rows of up to `row_length` values.
    #[must_use]
    pub fn new(stream: &mut Stream, std_levels: f32, row_length: usize) -> Self {
        let scale = std_levels * f32::from(FINE);
        let mut values: Vec<i16> = (0..NOISE_VALUES).map(|_| (stream.normal() * scale) as i16).collect();
        for index in 0..row_length {
            values.push(values[index % NOISE_VALUES]);
        }
        Self(values)
    }

    fn values(&self, stream: &mut Stream, row_length: usize) -> &[i16] {
        let start = stream.below((self.0.len() - row_length) as u32) as usize;
        &self.0[start..start + row_length]
    }
}
