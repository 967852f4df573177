//! What the tracker makes of the built-in scene, for browsers that cannot run it.

use crate::builtin::{BuiltinScene, RATE_HZ};
use crate::rounding::{hundredths, tenths};
use anyhow::Result;
use image::RgbImage;
use serde::Serialize;
use sinew_core::skeleton::Side;
use sinew_live::frame::Frame;
use sinew_live::person::Shoulder;
use sinew_live::session::{Choice, Session};

/// Maximum number of blobs of a frame that are kept.
const BLOBS: usize = 4;
/// Particles and seed, the page's defaults.
const PARTICLES: usize = 50;
const SEED: u64 = 1;
/// How the page writes a status.
const STATUSES: [&str; 4] = ["tracking", "predicted", "lost", "uncertain"];

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

/// The page's session outside of a browser.
#[derive(Debug)]
pub struct Player {
    session: Session,
    frame: Box<Frame>,
}

impl Player {
    /// Before the scene's first frame.
    ///
    /// # Errors
    /// None in practice: a size that the session refuses.
    pub fn new(scene: &BuiltinScene, shoulder: Shoulder) -> Result<Self> {
        let (width, height) = scene.size_px();
        let size_px = (width as usize, height as usize);
        let choice = Choice { size_px, side: Side::Right, particles: PARTICLES, seed: SEED, shoulder };
        Ok(Self { session: Session::new(choice)?, frame: Frame::boxed() })
    }

    /// Shows a picture; the session with its answer.
    ///
    /// # Errors
    /// None in practice, as [`Session::see`].
    pub fn play(&mut self, image: &RgbImage, timestamp_us: u64) -> Result<&Session> {
        for (to, from) in self.frame.rgba.as_chunks_mut::<4>().0.iter_mut().zip(image.pixels()) {
            *to = [from.0[0], from.0[1], from.0[2], 255];
        }
        self.session.see(&mut self.frame)?;
        self.session.track(timestamp_us);
        Ok(&self.session)
    }

    /// The bytes of the picture that was shown last, which has the size of `image`.
    pub fn rgba(&self, image: &RgbImage) -> &[u8] {
        &self.frame.rgba[..(4 * image.width() * image.height()) as usize]
    }
}

/// The answers to all frames.
///
/// # Errors
/// As those of [`Player`].
pub fn recorded(scene: &BuiltinScene, shoulder: Shoulder) -> Result<Vec<RecordedFrame>> {
    let mut player = Player::new(scene, shoulder)?;
    let time_us = |number| (1.0e6 * number as f32 / RATE_HZ) as u64;
    let frames = scene.frames.iter().enumerate();
    frames.map(|(number, image)| Ok(answer(player.play(image, time_us(number))?))).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin::CAMERA_NOISE_STD;
    use sinew_core::camera::Pixel;
    use sinew_live::person::DISTANCE_M;

    /// 5 % of the width, as `docs/live.md` states it.
    const MAX_ERROR_PX: f32 = 32.0;

    /// Distance of the tracked hand from the true one in each frame, pixels.
    fn errors_px(scene: &BuiltinScene, shoulder: Shoulder) -> Vec<f32> {
        let (answers, hands) = (recorded(scene, shoulder).unwrap(), scene.hands().unwrap());
        assert_eq!((answers.len(), hands.len()), (240, 240));
        let distance = |(answer, hand): (&RecordedFrame, &Pixel)| {
            let [u, v] = answer.joints[2];
            (u - hand.u_px).hypot(v - hand.v_px)
        };
        answers.iter().zip(&hands).map(distance).collect()
    }

    #[test]
    fn the_recorded_hand_is_the_true_one() {
        let scene = BuiltinScene::new(0.0).unwrap();
        let shoulder = scene.placed_shoulder().unwrap();
        let greatest = errors_px(&scene, shoulder).into_iter().fold(0.0, f32::max);
        assert!((1.0..=MAX_ERROR_PX).contains(&greatest), "{greatest} pixels");
        let answers = recorded(&scene, shoulder).unwrap();
        let is_seen = |status: &str| matches!(status, "tracking" | "uncertain");
        assert!(answers.iter().all(|answer| is_seen(answer.status) && !answer.blobs.is_empty()));
    }

    /// What `docs/live.md` says of a shoulder that was not placed.
    #[test]
    fn a_guessed_shoulder_costs_frames_and_its_distance_wins_them_back() {
        let scene = BuiltinScene::new(CAMERA_NOISE_STD).unwrap();
        let distance_m = scene.shoulder().unwrap().1;
        let share_off = |shoulder| {
            let errors = errors_px(&scene, shoulder);
            errors.iter().filter(|&&error| error > MAX_ERROR_PX).count() as f32 / errors.len() as f32
        };
        let guessed = share_off(Shoulder::Guessed { distance_m: DISTANCE_M });
        let at_its_distance = share_off(Shoulder::Guessed { distance_m });
        println!("off by more than 5 %: {guessed} with the guess, {at_its_distance} with the distance");
        assert!((0.1..=0.3).contains(&guessed), "{guessed}");
        assert!(at_its_distance <= 0.02, "{at_its_distance}");
    }
}
