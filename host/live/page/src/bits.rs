//! Some frames and what this machine answers to them, so that the module's answers can be compared
//! with it bit for bit.

use crate::builtin::BuiltinScene;
use crate::recording::Player;
use anyhow::Result;
use serde::Serialize;
use sinew::output::OutputDir;

/// Frames that are compared.
const FRAMES: usize = 20;
/// Time between two of them, microseconds.
const STEP_US: u64 = 33_333;

/// The answers, each number as its bits.
#[derive(Debug, Serialize)]
struct Bits {
    step_us: u64,
    /// Pixel of the right shoulder and its distance, as they are given to the module.
    shoulder: [f32; 3],
    answers: Vec<Vec<u32>>,
    /// All blobs, seven numbers each.
    blobs: Vec<Vec<u32>>,
}

/// Writes `frames.rgba` and `bits.json`.
///
/// # Errors
/// A file that cannot be written.
pub fn write(scene: &BuiltinScene, out: &OutputDir) -> Result<()> {
    let (pixel, distance_m) = scene.shoulder()?;
    let mut player = Player::new(scene, scene.placed_shoulder()?)?;
    let mut bits = Bits {
        step_us: STEP_US,
        shoulder: [pixel.u_px, pixel.v_px, distance_m],
        answers: Vec::new(),
        blobs: Vec::new(),
    };
    out.write("frames.rgba", |writer| {
        for (number, image) in scene.frames.iter().take(FRAMES).enumerate() {
            let session = player
                .play(image, number as u64 * STEP_US)
                .map_err(|error| sinew::Error::Invalid(format!("{error:#}")))?;
            bits.answers.push(session.answer.map(f32::to_bits).to_vec());
            let numbers = session.candidates.iter().flat_map(|blob| {
                let [uu, uv, vv] = blob.moments_px2;
                [blob.centre.u_px, blob.centre.v_px, uu, uv, vv, blob.area_px, blob.likelihood]
            });
            bits.blobs.push(numbers.map(f32::to_bits).collect());
            writer.write_all(player.rgba(image))?;
        }
        Ok(())
    })?;
    Ok(out.write("bits.json", |writer| Ok(serde_json::to_writer(writer, &bits)?))?)
}
