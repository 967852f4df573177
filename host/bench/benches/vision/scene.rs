//! Pairs of frames on end: rendered, or read.

use image::RgbImage;
use sinew_core::vision::skin::GaussianSkin;

/// Two frames of one size, the second a little later.
pub struct FramePair {
    /// What the frames are, for the table.
    pub name: String,
    /// Width, pixels.
    pub width: usize,
    /// Height, pixels.
    pub height: usize,
    /// The frame before.
    pub before: RgbImage,
    /// The frame to be analysed.
    pub now: RgbImage,
}

/// The classifier of both chains: a Gaussian of about what skin has in daylight.
pub fn skin() -> GaussianSkin {
    GaussianSkin::new(0.45, 0.315, [0.0017, 0.0, 0.000_25], 2.5, 60).expect("the constants are in range")
}

impl FramePair {
    /// A person at a desk: face, two open hands that move, skin-coloured specks, camera noise.
    pub fn rendered(width: usize, height: usize) -> Self {
        let name = "rendered".to_owned();
        Self { name, width, height, before: render(width, height, 0.0), now: render(width, height, 0.02) }
    }

    /// Two image files, with a comma between their names.
    pub fn read(names: &str) -> Option<Self> {
        let (before, now) = names.split_once(',')?;
        let open = |name: &str| image::open(name.trim()).ok().map(|image| image.to_rgb8());
        let (before, now) = (open(before)?, open(now)?);
        let (width, height) = (now.width() as usize, now.height() as usize);
        (before.dimensions() == now.dimensions()).then_some(Self {
            name: "read".to_owned(),
            width,
            height,
            before,
            now,
        })
    }
}

/// A palm with five spread fingers; all lengths as parts of the image's width.
fn is_hand(u: f32, v: f32, (cu, cv): (f32, f32), radius: f32) -> bool {
    (u - cu).hypot(v - cv) <= radius
        || (0..5).any(|i| {
            let (s, c) = ((i as f32 - 2.0) * 0.42).sin_cos();
            let (x, y) = (c * (u - cu) + s * (v - cv), s * (u - cu) - c * (v - cv));
            x.abs() <= 0.2 * radius && (0.0..=2.3 * radius).contains(&y)
        })
}

fn render(width: usize, height: usize, moved: f32) -> RgbImage {
    let mut state = 0x9e37_79b9_u32 ^ moved.to_bits();
    let mut noise = move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        ((state >> 24) as i32 - 128) / 24
    };
    RgbImage::from_fn(width as u32, height as u32, |x, y| {
        let (u, v) = (x as f32 / width as f32, y as f32 / width as f32);
        let face = ((u - 0.5) / 0.08).hypot((v - 0.16) / 0.11) <= 1.0;
        let hands = is_hand(u, v, (0.25 + moved, 0.45), 0.05) || is_hand(u, v, (0.72 - moved, 0.5 - moved), 0.045);
        let specks = (x / 5 * 7919 + y / 5 * 104_729) % 211 == 0 && v < 0.3;
        let base = if face || hands || specks {
            [206, 148, 112]
        } else if v > 0.55 {
            [30, 28, 34]
        } else {
            [(90.0 + 80.0 * u) as i32, (100.0 + 80.0 * u) as i32, (120.0 + 90.0 * v) as i32]
        };
        image::Rgb(base.map(|level: i32| (level + noise()).clamp(0, 255) as u8))
    })
}
