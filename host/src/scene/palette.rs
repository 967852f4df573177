//! Colours: skin, garments, wall and furniture, light; linear RGB reflectances in [0, 1].

use sinew_core::math::{Vec3, clamp, exp, floor, ln};
use sinew_core::random::Stream;

/// Linear red, green, blue.
pub type Rgb = Vec3;

/// Diffuse reflectances `Skin1` and `Skin2`, measured by Jensen et al., "A practical model for
/// subsurface light transport" (2001), figure 5.
const MEASURED_SKIN: [[f32; 3]; 2] = [[0.44, 0.22, 0.13], [0.63, 0.44, 0.34]];
/// Absorption of melanin at 600, 540 and 450 nm relative to 600 nm: wavelength to the power of
/// -3.33 (Jacques, 1998).
const MELANIN: [f32; 3] = [1.0, 1.42, 2.61];
/// Maximum melanin that is added, as optical depth at 600 nm.
const MAX_MELANIN: f32 = 0.5;
/// Tries to draw a colour that differs enough from others.
const TRIES: usize = 48;

/// A random skin tone: between the two measured ones, darkened by a random amount of melanin.
pub fn skin(stream: &mut Stream) -> Rgb {
    let share = stream.uniform();
    let melanin = MAX_MELANIN * stream.uniform() * stream.uniform();
    Rgb::from_fn(|c, _| {
        let measured = MEASURED_SKIN[0][c] + (MEASURED_SKIN[1][c] - MEASURED_SKIN[0][c]) * share;
        measured * exp(-melanin * MELANIN[c])
    })
}

/// A random hair colour, from black over brown to fair and grey.
pub fn hair(stream: &mut Stream) -> Rgb {
    const SHADES: [[f32; 3]; 5] =
        [[0.01, 0.009, 0.008], [0.04, 0.022, 0.012], [0.10, 0.05, 0.025], [0.32, 0.22, 0.11], [0.30, 0.29, 0.28]];
    Rgb::from(SHADES[stream.below(5) as usize]) * (0.7 + 0.6 * stream.uniform())
}

/// A garment's colour that differs from all of `others` by at least 0.15 in encoded RGB where that
/// can be had.
///
/// Its hue lies from yellow-green over blue to purple, or it is nearly grey: no clothes have the
/// colour of skin.
pub fn garment(stream: &mut Stream, others: &[Rgb]) -> Rgb {
    let mut colour = Rgb::zeros();
    for _ in 0..TRIES {
        let hue_deg = 70.0 + 220.0 * stream.uniform();
        let saturation = if stream.uniform() < 0.3 { 0.08 * stream.uniform() } else { 0.25 + 0.6 * stream.uniform() };
        colour = from_hsv(hue_deg, saturation, 0.15 + 0.75 * stream.uniform());
        if others.iter().all(|other| (encoded(&colour) - encoded(other)).norm() >= 0.15) {
            break;
        }
    }
    colour
}

/// The wall's colour: any hue, pale.
pub fn wall(stream: &mut Stream) -> Rgb {
    from_hsv(360.0 * stream.uniform(), 0.18 * stream.uniform(), 0.35 + 0.5 * stream.uniform())
}

/// Colour of a thing at the wall; one in six is brown like wood.
pub fn furniture(stream: &mut Stream) -> Rgb {
    if stream.below(6) == 0 {
        from_hsv(18.0 + 22.0 * stream.uniform(), 0.4 + 0.35 * stream.uniform(), 0.25 + 0.45 * stream.uniform())
    } else {
        garment(stream, &[])
    }
}

/// Colour of the light (green = 1): what a camera's white balance leaves over.
pub fn light(stream: &mut Stream) -> Rgb {
    let warmth = 0.12 * (2.0 * stream.uniform() - 1.0);
    Rgb::new(1.0 + warmth, 1.0, 1.0 - warmth + 0.04 * (2.0 * stream.uniform() - 1.0))
}

/// Linear RGB of hue (degrees), saturation and value of sRGB.
fn from_hsv(hue_deg: f32, saturation: f32, value: f32) -> Rgb {
    let sector = hue_deg / 60.0;
    Rgb::from_fn(|c, _| {
        // Offsets 5, 3, 1 of the usual closed form of HSV to RGB.
        let k = sector + [5.0, 3.0, 1.0][c];
        let k = k - 6.0 * floor(k / 6.0);
        let ramp = clamp(if k < 4.0 - k { k } else { 4.0 - k }, 0.0, 1.0);
        decode(value * (1.0 - saturation * ramp))
    })
}

/// Linear intensity of an sRGB value in [0, 1] (IEC 61966-2-1).
fn decode(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { exp(2.4 * ln((value + 0.055) / 1.055)) }
}

/// sRGB value in [0, 1] of a linear intensity (IEC 61966-2-1).
#[must_use]
pub fn encode(linear: f32) -> f32 {
    let linear = clamp(linear, 0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * exp(ln(linear) / 2.4) - 0.055 }
}

fn encoded(colour: &Rgb) -> Rgb {
    colour.map(encode)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decoding_undoes_encoding() {
        for i in 0..=100 {
            let value = i as f32 / 100.0;
            assert!((encode(decode(value)) - value).abs() < 1.0e-5);
        }
    }

    #[test]
    fn hues_are_where_they_belong() {
        assert!((from_hsv(0.0, 1.0, 1.0) - Rgb::new(1.0, 0.0, 0.0)).norm() < 1.0e-5);
        assert!((from_hsv(120.0, 1.0, 1.0) - Rgb::new(0.0, 1.0, 0.0)).norm() < 1.0e-5);
        assert!((from_hsv(300.0, 1.0, 1.0) - Rgb::new(1.0, 0.0, 1.0)).norm() < 1.0e-5);
    }

    #[test]
    fn skin_is_reddish_at_every_draw_and_garments_are_not() {
        let mut stream = Stream::new(5, 0, 0);
        for _ in 0..500 {
            let tone = skin(&mut stream);
            assert!(tone.x > tone.y && tone.y > tone.z && tone.z > 0.01, "{tone:?}");
            let cloth = encoded(&garment(&mut stream, &[]));
            assert!(cloth.x <= cloth.y.max(cloth.z) + 1.0e-3 || cloth.max() - cloth.min() < 0.09, "{cloth:?}");
        }
    }
}
