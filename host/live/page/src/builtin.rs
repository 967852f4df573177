//! The built-in scene: somebody in a hood who reaches about with the right arm for eight seconds.

use anyhow::{Context, Result};
use image::RgbImage;
use rayon::prelude::*;
use sinew::motion::{ArmSide, reach};
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew_core::camera::Pixel;
use sinew_live::person::Shoulder;

/// Frames in a second.
pub const RATE_HZ: f32 = 30.0;
/// Frames.
pub const FRAMES: usize = 240;
/// Standard deviation of the fake camera's noise, levels of 255; the page's own frames have none,
/// which keeps them small.
pub const CAMERA_NOISE_STD: f32 = 2.5;
/// Seed of motion and looks. Its frames make a small file.
const SEED: u64 = 5;

/// The scene with its frames.
#[derive(Debug)]
pub struct BuiltinScene {
    scene: Scene,
    /// All frames.
    pub frames: Vec<RgbImage>,
}

impl BuiltinScene {
    /// Renders it with that much noise.
    ///
    /// # Errors
    /// None with the constants above.
    pub fn new(noise_std: f32) -> Result<Self> {
        let motion = reach::random_reaches(SEED, RATE_HZ, FRAMES)?;
        let options = SceneOptions {
            frames: FRAMES,
            frames_per_second: RATE_HZ,
            seed: SEED,
            sides: Sides::One(ArmSide::Right),
            false_blob_fraction: 0.0,
            hidden_fraction: 0.0,
            noise_std,
            ..SceneOptions::default()
        };
        let scene = Scene::new(&motion, &options)?;
        let frames = (0..FRAMES).into_par_iter().map(|frame| scene.render(frame)).collect();
        Ok(Self { scene, frames })
    }

    /// Width and height, pixels.
    pub fn size_px(&self) -> (u32, u32) {
        (self.scene.options().width_px, self.scene.options().height_px)
    }

    /// The pixel of the right shoulder, and how far away it is, metres along the line of sight.
    pub fn shoulder(&self) -> Result<(Pixel, f32)> {
        let place_m = self.scene.body().shoulder_m(ArmSide::Right);
        let pixel = self.scene.camera().project(&place_m).context("the shoulder lies behind the camera")?;
        Ok((pixel, place_m.z))
    }

    /// The same as the page's tracker takes it.
    pub fn placed_shoulder(&self) -> Result<Shoulder> {
        let (pixel, distance_m) = self.shoulder()?;
        Ok(Shoulder::At { pixel, distance_m })
    }

    /// Pixel of the middle of the hand in every frame.
    pub fn hands(&self) -> Result<Vec<Pixel>> {
        let hand = |frame| {
            let truth = self.scene.truth(frame);
            truth.sides.first().and_then(|side| side.hand_px(&self.scene.camera())).context("there is no hand")
        };
        (0..FRAMES).map(hand).collect()
    }
}
