//! Section `[camera]`.

use crate::error::{Result, bail};
use serde::{Deserialize, Serialize};
use sinew_core::camera::{Camera, Distortion, Pixel};
use sinew_core::error::{ParameterError, finite, positive, within};

/// A pinhole camera; what is not given follows from the images' size and the field of view.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CameraConfig {
    /// Horizontal field of view, degrees; used where no focal length is given.
    pub horizontal_field_of_view_deg: f32,
    /// Width of the images that the other values belong to, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_px: Option<u32>,
    /// Height of the images that the other values belong to, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_px: Option<u32>,
    /// Horizontal focal length, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focal_u_px: Option<f32>,
    /// Vertical focal length, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focal_v_px: Option<f32>,
    /// Column of the principal point, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre_u_px: Option<f32>,
    /// Row of the principal point, pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre_v_px: Option<f32>,
    /// Distortion k1, k2, p1, p2, k3 (`OpenCV`'s order).
    pub distortion: [f32; 5],
}

impl Default for CameraConfig {
    fn default() -> Self {
        Self {
            horizontal_field_of_view_deg: 60.0,
            width_px: None,
            height_px: None,
            focal_u_px: None,
            focal_v_px: None,
            centre_u_px: None,
            centre_v_px: None,
            distortion: [0.0; 5],
        }
    }
}

impl CameraConfig {
    pub(super) fn set_all(&mut self) {
        (self.width_px, self.height_px) = (Some(1), Some(1));
        (self.focal_u_px, self.focal_v_px) = (Some(1.0), Some(1.0));
        (self.centre_u_px, self.centre_v_px) = (Some(1.0), Some(1.0));
    }

    pub(super) fn check(&self) -> Result<(), ParameterError> {
        within("horizontal_field_of_view_deg", self.horizontal_field_of_view_deg, 1.0, 175.0)?;
        for (name, value) in [("focal_u_px", self.focal_u_px), ("focal_v_px", self.focal_v_px)] {
            value.map_or(Ok(0.0), |value| positive(name, value))?;
        }
        for (name, value) in [("centre_u_px", self.centre_u_px), ("centre_v_px", self.centre_v_px)] {
            value.map_or(Ok(0.0), |value| finite(name, value))?;
        }
        for value in self.distortion {
            finite("distortion", value)?;
        }
        Ok(())
    }

    /// The camera for images of this size.
    ///
    /// # Errors
    /// The size has to be the configured one, where one is configured.
    pub fn build(&self, width_px: u32, height_px: u32) -> Result<Camera> {
        for (name, wanted, found) in [("width_px", self.width_px, width_px), ("height_px", self.height_px, height_px)] {
            if let Some(wanted) = wanted.filter(|&wanted| wanted != found) {
                bail!(
                    "the images are {width_px} x {height_px} pixels, but the configuration's camera.{name} is {wanted}; \
                     give the configuration of this camera, or leave the size out"
                );
            }
        }
        let guess = Camera::from_field_of_view(width_px, height_px, self.horizontal_field_of_view_deg.to_radians())?;
        let focal_u_px = self.focal_u_px.or(self.focal_v_px).unwrap_or(guess.focal_px());
        let focal_v_px = self.focal_v_px.unwrap_or(focal_u_px);
        let centre = Pixel::new(
            self.centre_u_px.unwrap_or(guess.centre().u_px),
            self.centre_v_px.unwrap_or(guess.centre().v_px),
        );
        let camera = Camera::new(focal_u_px, focal_v_px, centre)?;
        let [k1, k2, p1, p2, k3] = self.distortion;
        if self.distortion == [0.0; 5] {
            return Ok(camera);
        }
        Ok(camera.with_distortion(Distortion { k1, k2, k3, p1, p2 })?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_that_is_not_the_images_is_refused() {
        let config = CameraConfig { width_px: Some(640), ..CameraConfig::default() };
        assert!(config.build(640, 480).is_ok());
        assert!(config.build(320, 240).unwrap_err().to_string().contains("camera.width_px"));
    }

    #[test]
    fn one_focal_length_serves_both_directions() {
        let config = CameraConfig { focal_u_px: Some(500.0), ..CameraConfig::default() };
        assert_eq!(config.build(640, 480).unwrap().focal_px(), 500.0);
    }
}
