//! What the tracker makes of the built-in scene, for browsers that cannot run it.

use crate::builtin::{BuiltinScene, RATE_HZ};
use crate::scene_pack::tenths;
use anyhow::Result;
use serde::Serialize;
use sinew_core::skeleton::Side;
use sinew_live::frame::Frame;
use sinew_live::person::Shoulder;
use sinew_live::session::{Choice, Session};

/// Most blobs of a frame that are kept.
const BLOBS: usize = 4;
/// Particles and seed, the page's defaults.
const PARTICLES: usize = 50;
const SEED: u64 = 1;
/// How the page writes a status.
const STATUSES: [&str; 3] = ["tracking", "predicted", "lost"];

/// One frame's answer.
#[derive(Debug, Clone, Serialize)]
pub struct RecordedFrame {
    status: &'static str,
    /// Pixels of shoulder, elbow and hand.
    pub joints: [[f32; 2]; 3],
    likelihood: f32,
    carrier: f32,
    /// Centre, moments, area and likelihood of the likeliest blobs.
    blobs: Vec<[f32; 7]>,
}

/// Runs the page's session over the scene.
///
/// # Errors
/// None in practice: a size that the session refuses.
pub fn recorded(scene: &BuiltinScene) -> Result<Vec<RecordedFrame>> {
    let (width, height) = scene.size_px();
    let (pixel, distance_m) = scene.shoulder()?;
    let mut session = Session::new(Choice {
        size_px: (width as usize, height as usize),
        side: Side::Right,
        particles: PARTICLES,
        seed: SEED,
        shoulder: Shoulder::At { pixel, distance_m },
    })?;
    let mut frame = Frame::boxed();
    let mut answers = Vec::new();
    for (number, image) in scene.frames.iter().enumerate() {
        for (to, from) in frame.rgba.as_chunks_mut::<4>().0.iter_mut().zip(image.pixels()) {
            *to = [from.0[0], from.0[1], from.0[2], 255];
        }
        session.see(&mut frame)?;
        session.track((1.0e6 * number as f32 / RATE_HZ) as u64);
        answers.push(answer(&session));
    }
    Ok(answers)
}

fn answer(session: &Session) -> RecordedFrame {
    let numbers = &session.answer;
    let pixel = |at: usize| tenths([numbers[at], numbers[at + 1]]);
    let blobs = session.candidates.iter().take(BLOBS).map(|blob| {
        let [uu, uv, vv] = blob.moments_px2;
        let numbers = tenths([blob.centre.u_px, blob.centre.v_px, uu, uv, vv, blob.area_px, 0.0]);
        [&numbers[..6], &[hundredths(blob.likelihood)]].concat().try_into().unwrap_or(numbers)
    });
    RecordedFrame {
        status: STATUSES.get(numbers[0] as usize).copied().unwrap_or("lost"),
        joints: [pixel(1), pixel(3), pixel(5)],
        likelihood: hundredths(numbers[12]),
        carrier: numbers[13],
        blobs: blobs.collect(),
    }
}

fn hundredths(number: f32) -> f32 {
    (100.0 * number).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The page's accuracy, as `docs/live.md` states it: 5 % of the width.
    const MAX_ERROR_PX: f32 = 32.0;

    #[test]
    fn the_recorded_hand_is_the_true_one() {
        let scene = BuiltinScene::new(0.0).unwrap();
        let (answers, hands) = (recorded(&scene).unwrap(), scene.hands().unwrap());
        assert_eq!((answers.len(), hands.len()), (240, 240));
        let errors = answers.iter().zip(&hands).map(|(answer, hand)| {
            let [u, v] = answer.joints[2];
            (u - hand.u_px).hypot(v - hand.v_px)
        });
        let greatest = errors.fold(0.0, f32::max);
        assert!((1.0..=MAX_ERROR_PX).contains(&greatest), "{greatest} pixels");
        assert!(answers.iter().all(|answer| answer.status == "tracking" && !answer.blobs.is_empty()));
    }
}
