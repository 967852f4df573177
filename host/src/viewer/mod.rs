//! A run for the Rerun viewer (rerun.io): its directory becomes one .rrd file. Feature `rerun`.
//!
//! Of Rerun only the crates that write the file are used, not its SDK with its server and its threads.

mod arm;
mod body;
mod cyclic;
pub mod numbers;
pub mod recording;

use crate::error::{Context, Result, bail};
use crate::output::write_atomically;
use crate::report::document::Colour;
use crate::report::folder::RunFolder;
use crate::report::kind::Kind;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use numbers::Numbers;
use re_sdk_types::archetypes::{Points3D, Scalars};
use recording::{Moment, Recording};
use serde_json::Value;
use sinew_core::checksum::crc32;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Quality of the pictures as JPEG.
const QUALITY: u8 = 85;
/// Radius of a particle that has all of the weight, metres.
const PARTICLE_RADIUS_M: f64 = 0.03;

/// What a file shows.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Shown {
    /// Number of frames.
    pub frames: usize,
    /// What it does not show, and why.
    pub notes: Vec<String>,
}

/// Writes the run in the directory `run` as the Rerun recording `file`.
///
/// # Errors
/// A directory without a finished run of `sinew track` or `sinew demo`, or a file that cannot be written.
pub fn write(run: &Path, file: &Path) -> Result<Shown> {
    let folder = RunFolder::new(run);
    let kind = Kind::of(&folder);
    let (record, table) = match kind {
        Some(Kind::Arm | Kind::Body) => ("run.json", "track.csv"),
        Some(Kind::Cyclic) => ("summary.json", "estimates.csv"),
        _ => bail!("`{}` holds no run of `sinew track` or `sinew demo`", run.display()),
    };
    let record = run.join(record);
    let inner = || -> Result<Value> { Ok(serde_json::from_slice(&fs::read(&record)?)?) };
    let report = inner().with_context(|| format!("`{}` cannot be read", record.display()))?;
    let mut shown = Shown::default();
    write_atomically(file, |writer| {
        // Two recordings of one name would be shown as one.
        let name = run.file_name().map_or_else(|| "run".to_owned(), |name| name.to_string_lossy().into_owned());
        let content = fs::read(run.join(table)).map_or(0, |bytes| crc32(&bytes));
        let mut recording = Recording::begin(&format!("{name}-{content:08x}"), writer)?;
        shown = match kind {
            Some(Kind::Arm) => arm::write(run, &report, &mut recording)?,
            Some(Kind::Body) => body::write(run, &report, &mut recording)?,
            _ => cyclic::write(run, &report, &mut recording)?,
        };
        recording.finish()
    })?;
    Ok(shown)
}

/// Red, green, blue, opacity of a side or of a joint whose name begins with one: left orange, right blue, as in the report.
fn colour(word: &str) -> u32 {
    match Colour::of_side(word) {
        Colour::Left => 0xe6_7e_22_ff,
        Colour::Right => 0x1e_88_e5_ff,
        _ => 0xb0_b0_b0_ff,
    }
}

fn jpeg(image: &RgbImage) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode_image(image)?;
    Ok(bytes)
}

/// A curve.
fn scalars(recording: &mut Recording<'_>, entity: &str, values: impl IntoIterator<Item = (Moment, f64)>) -> Result<()> {
    recording.rows(entity, values.into_iter().map(|(moment, value)| (moment, Ok(Scalars::new([value])))))
}

/// Places of a joint over the particles; the ball's volume goes with the weight.
fn weighted_points(
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
