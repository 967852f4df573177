//! What the recordings of all trackers show: colours, pictures, curves and particles.

use super::numbers::Numbers;
use super::recording::{Moment, Recording};
use crate::error::Result;
use crate::report::document::Colour;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use re_sdk_types::archetypes::{Points3D, Scalars};
use std::collections::BTreeMap;

/// What a file shows.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Shown {
    /// Number of frames.
    pub frames: usize,
    /// What it does not show, and why.
    pub notes: Vec<String>,
}

/// Quality of the pictures as JPEG.
const QUALITY: u8 = 85;

/// Radius of a particle that has all of the weight, metres.
const PARTICLE_RADIUS_M: f64 = 0.03;

/// Red, green, blue, opacity of a side or of a joint whose name begins with one: left orange, right
/// blue, as in the report.
pub(super) fn colour(word: &str) -> u32 {
    match Colour::of_side(word) {
        Colour::Left => 0xe6_7e_22_ff,
        Colour::Right => 0x1e_88_e5_ff,
        _ => 0xb0_b0_b0_ff,
    }
}

pub(super) fn jpeg(image: &RgbImage) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode_image(image)?;
    Ok(bytes)
}

/// A curve.
pub(super) fn scalars(
    recording: &mut Recording<'_>,
    entity: &str,
    values: impl IntoIterator<Item = (Moment, f64)>,
) -> Result<()> {
    recording.rows(entity, values.into_iter().map(|(moment, value)| (moment, Ok(Scalars::new([value])))))
}

/// Places of a joint over the particles; the ball's volume goes with the weight.
pub(super) fn weighted_points(
    particles: &Numbers,
    joint: &str,
    frames: &BTreeMap<i64, Moment>,
    recording: &mut Recording<'_>,
) -> Result<()> {
    let by_frame = particles.by_frame();
    for side in particles.distinct_sides() {
        let rows = frames.iter().map(|(frame, &moment)| {
            let of_side = by_frame.get(frame).into_iter().flatten().filter(|&&row| particles.side(row) == side);
            let seen = of_side.filter_map(|&row| {
                let place = particles.place(row, joint, ["x_m", "y_m", "z_m"])?;
                let weight = particles.get(row, "weight").unwrap_or(0.0).clamp(0.0, 1.0);
                Some((place, (PARTICLE_RADIUS_M * weight.cbrt()) as f32))
            });
            let (places, radii): (Vec<_>, Vec<_>) = seen.unzip();
            let word = if side.is_empty() { joint } else { &side };
            (moment, Ok(Points3D::new(places).with_radii(radii).with_colors([colour(word)])))
        });
        let word = if side.is_empty() { joint } else { &side };
        recording.rows(&format!("world/particles/{word}"), rows)?;
    }
    Ok(())
}
