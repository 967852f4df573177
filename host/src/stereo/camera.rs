//! The stereo camera: two pinholes side by side.

use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;

/// A level stereo camera; points are in the axes of its left, the reference, camera.
///
/// The default is like a Bumblebee2 with its wide lens: 640x480 pixels, 65 degrees across, 12 cm
/// between the cameras, disparities matched to a fifth of a pixel. So a depth of 3 m has a standard
/// deviation of 3 cm.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StereoCamera {
    /// Width of the picture, pixels.
    pub width_px: u32,
    /// Height of the picture, pixels.
    pub height_px: u32,
    /// Focal length, pixels.
    pub focal_px: f32,
    /// Distance of the two cameras, metres.
    pub baseline_m: f32,
    /// Standard deviation of a disparity, pixels.
    pub disparity_std_px: f32,
}

impl Default for StereoCamera {
    fn default() -> Self {
        Self { width_px: 640, height_px: 480, focal_px: 500.0, baseline_m: 0.12, disparity_std_px: 0.2 }
    }
}

impl StereoCamera {
    /// Half of the picture's width and height over the focal length.
    #[must_use]
    pub fn half_view(&self) -> [f32; 2] {
        [self.width_px, self.height_px].map(|size| 0.5 * (size as f32 - 1.0) / self.focal_px)
    }

    /// Middle of the picture.
    #[must_use]
    pub fn centre(&self) -> Pixel {
        Pixel::new(0.5 * (self.width_px as f32 - 1.0), 0.5 * (self.height_px as f32 - 1.0))
    }

    /// Direction through a pixel, with z = 1.
    #[must_use]
    pub fn direction(&self, pixel: Pixel) -> Vec3 {
        let centre = self.centre();
        Vec3::new((pixel.u_px - centre.u_px) / self.focal_px, (pixel.v_px - centre.v_px) / self.focal_px, 1.0)
    }

    /// Where a point is seen; `None` in or behind the camera's plane.
    #[must_use]
    pub fn project(&self, point_m: &Vec3) -> Option<Pixel> {
        let centre = self.centre();
        let at = |along: f32, middle: f32| self.focal_px * along / point_m.z + middle;
        (point_m.z > 1.0e-6).then(|| Pixel::new(at(point_m.x, centre.u_px), at(point_m.y, centre.v_px)))
    }

    /// Standard deviation of the depth of a point `z_m` away, metres: z^2 over focal length and
    /// baseline, times that of the disparity.
    #[must_use]
    pub fn depth_std_m(&self, z_m: f32) -> f32 {
        z_m * z_m * self.disparity_std_px / (self.focal_px * self.baseline_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_leads_back_to_its_pixel() {
        let camera = StereoCamera::default();
        let pixel = Pixel::new(100.0, 400.0);
        let back = camera.project(&(camera.direction(pixel) * 2.5)).unwrap();
        assert!(back.distance_px(pixel) < 1.0e-3);
        assert!(camera.project(&Vec3::new(0.0, 0.0, -1.0)).is_none());
        assert!((camera.depth_std_m(3.0) - 0.03).abs() < 1.0e-6);
        let degrees = 2.0 * camera.half_view()[0].atan().to_degrees();
        assert!((degrees - 65.0).abs() < 0.5, "{degrees}");
    }
}
