//! The device: camera, vision and tracker, one call a frame.

use crate::camera::{FRAME_US, HEIGHT, LINE_BYTES, SHOULDER_M, SyntheticCamera, WIDTH};
use crate::front_end::FrontEnd;
use sinew_core::error::ParameterError;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::{ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker};

/// Particles of the tracker.
pub const PARTICLES: usize = 50;

/// All memory that tracking takes.
#[derive(Debug)]
pub struct Device {
    camera: SyntheticCamera,
    model: ArmModel,
    front_end: FrontEnd,
    tracker: ArmTracker<PARTICLES>,
    line: [u8; LINE_BYTES],
    frame: u64,
}

impl Device {
    /// A device that has seen nothing yet.
    ///
    /// # Errors
    /// None with the constants of this crate.
    pub fn new(seed: u64) -> Result<Self, ParameterError> {
        let camera = SyntheticCamera::new(seed)?;
        let geometry = ArmGeometry::new(Side::Left, 0.30, 0.33)?;
        let options = ArmOptions { particles: PARTICLES, ..ArmOptions::default() };
        let model = ArmModel::new(camera.geometry(), (WIDTH as u32, HEIGHT as u32), geometry, options)?;
        let tracker = ArmTracker::new(&model, SHOULDER_M, seed)?;
        Ok(Self { camera, model, front_end: FrontEnd::new()?, tracker, line: [0; LINE_BYTES], frame: 0 })
    }

    /// The camera's geometry and the arm.
    #[must_use]
    pub fn model(&self) -> &ArmModel {
        &self.model
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &SyntheticCamera {
        &self.camera
    }

    /// Reads and tracks the next frame.
    ///
    /// # Errors
    /// None with the constants of this crate.
    pub fn step(&mut self) -> Result<ArmEstimate, ParameterError> {
        let scene = self.camera.scene(&self.model, self.frame);
        let image = if let Some(scene) = scene {
            for v in 0..HEIGHT {
                self.camera.line(&scene, v, &mut self.line);
                self.front_end.line(v, &self.line);
            }
            let (candidates, edges) = self.front_end.end_frame()?;
            Some(ArmImage { candidates, edges })
        } else {
            self.front_end.forget_last_frame();
            None
        };
        let timestamp_us = self.frame * FRAME_US;
        self.frame += 1;
        Ok(self.tracker.step(&self.model, &ArmFrame { timestamp_us, image, shoulder_m: SHOULDER_M }))
    }
}
