//! Changes of pictures that stand for other people, other light and other places.

use image::{Rgb, RgbImage, imageops};

/// Red, green and blue of a bulb of 3000 K beside those of daylight, linear, half of the way on a
/// logarithmic scale: a camera balances the rest.
///
/// Source: Planck's law at 3000 K in linear sRGB is (1, 0.46, 0.15).
const WARM_GAINS: [f32; 3] = [1.0, 0.68, 0.39];
/// Light that is left of a dim room. Chosen: one and a half stops.
const DIM_GAIN: f32 = 0.35;
/// Light that dark skin reflects beside light skin.
///
/// Source: reflectances of skin of types VI and II at 550 to 650 nm are about 0.1 and 0.4.
const DARK_SKIN_GAIN: f32 = 0.25;
/// Chroma is skin's within this of the face's, levels of Cr and Cb. Chosen: the scatter of a face.
const SKIN_CHROMA_STD: f32 = 8.0;
/// Of the picture's height, what a camera on a desk sees of somebody who sits. Chosen: from the top
/// to below the elbows; hands that rest are out of view.
pub const SEATED_SHARE: f32 = 0.7;

/// A change of every picture of a clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// As it was recorded.
    None,
    /// The light of a bulb.
    Warm,
    /// Little light.
    Dim,
    /// What has the colour of the face reflects less.
    DarkSkin,
    /// Both of the last.
    DarkSkinInWarmLight,
    /// The lower part is cut away.
    Seated,
}

fn linear(level: u8) -> f32 {
    let x = f32::from(level) / 255.0;
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn level(linear: f32) -> u8 {
    let x = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * x).round().clamp(0.0, 255.0) as u8
}

/// Cr and Cb of a colour, levels about zero, ITU-R BT.601.
fn chroma(Rgb([r, g, b]): Rgb<u8>) -> [f32; 2] {
    let [r, g, b] = [r, g, b].map(f32::from);
    [0.5 * r - 0.4187 * g - 0.0813 * b, -0.1687 * r - 0.3313 * g + 0.5 * b]
}

/// Mean chroma of a square about the middle of the face, whose half side is `radius_px`.
#[must_use]
pub fn chroma_about(image: &RgbImage, (u, v): (u32, u32), radius_px: u32) -> [f32; 2] {
    let (mut sum, mut count) = ([0.0; 2], 0.0_f32);
    for y in v.saturating_sub(radius_px)..(v + radius_px).min(image.height()) {
        for x in u.saturating_sub(radius_px)..(u + radius_px).min(image.width()) {
            let [cr, cb] = chroma(*image.get_pixel(x, y));
            sum = [sum[0] + cr, sum[1] + cb];
            count += 1.0;
        }
    }
    sum.map(|sum| sum / count.max(1.0))
}

impl Change {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::None, Self::Warm, Self::Dim, Self::DarkSkin, Self::DarkSkinInWarmLight, Self::Seated];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "as recorded",
            Self::Warm => "warm light",
            Self::Dim => "dim light",
            Self::DarkSkin => "dark skin",
            Self::DarkSkinInWarmLight => "dark skin in warm light",
            Self::Seated => "cut below the elbows",
        }
    }

    /// The changed picture; `face_chroma` is that of the recorded face.
    #[must_use]
    pub fn of(self, image: &RgbImage, face_chroma: [f32; 2]) -> RgbImage {
        let gains = match self {
            Self::Warm | Self::DarkSkinInWarmLight => WARM_GAINS,
            Self::Dim => [DIM_GAIN; 3],
            Self::None | Self::DarkSkin | Self::Seated => [1.0; 3],
        };
        let dark = matches!(self, Self::DarkSkin | Self::DarkSkinInWarmLight);
        match self {
            Self::None => image.clone(),
            Self::Seated => {
                let height = (SEATED_SHARE * image.height() as f32) as u32;
                imageops::crop_imm(image, 0, 0, image.width(), height).to_image()
            }
            _ => {
                let mut changed = image.clone();
                for pixel in changed.pixels_mut() {
                    let skin = if dark { DARK_SKIN_GAIN.powf(skin_share(*pixel, face_chroma)) } else { 1.0 };
                    pixel.0 = core::array::from_fn(|c| level(linear(pixel.0[c]) * gains[c] * skin));
                }
                changed
            }
        }
    }
}

/// How much a colour is that of the face, 0 to 1.
fn skin_share(colour: Rgb<u8>, face_chroma: [f32; 2]) -> f32 {
    let [cr, cb] = chroma(colour);
    let (off_cr, off_cb) = (cr - face_chroma[0], cb - face_chroma[1]);
    (-0.5 * (off_cr * off_cr + off_cb * off_cb) / (SKIN_CHROMA_STD * SKIN_CHROMA_STD)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_scaled_where_it_is_linear() {
        let grey = RgbImage::from_pixel(4, 2, Rgb([188; 3]));
        assert_eq!(level(linear(188)), 188);
        let Rgb([r, g, b]) = *Change::Warm.of(&grey, [0.0; 2]).get_pixel(0, 0);
        assert!(r == 188 && g < r && b < g, "{r} {g} {b}");
        let share = linear(b) / linear(188);
        assert!((share - WARM_GAINS[2]).abs() < 0.01, "{share}");
        assert_eq!(Change::Seated.of(&grey, [0.0; 2]).dimensions(), (4, 1));
    }

    #[test]
    fn only_skin_is_darker_of_dark_skin() {
        let mut image = RgbImage::from_pixel(2, 1, Rgb([200, 150, 120]));
        image.put_pixel(1, 0, Rgb([90, 120, 200]));
        let changed = Change::DarkSkin.of(&image, chroma_about(&image, (0, 0), 1));
        assert!((linear(changed.get_pixel(0, 0).0[0]) / linear(200) - DARK_SKIN_GAIN).abs() < 0.02);
        assert_eq!(changed.get_pixel(1, 0), image.get_pixel(1, 0));
    }
}
