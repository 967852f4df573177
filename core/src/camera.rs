//! Pinhole camera with optional radial-tangential distortion.
//!
//! Camera axes: x to the right of the image, y down, z along the line of sight; metres. Pixel axes:
//! u right, v down, (0, 0) at the centre of the top left pixel. All trackers work in camera axes,
//! so the camera centre is the origin.
//!
//! ```
//! use sinew_core::camera::Camera;
//! use sinew_core::math::Vec3;
//!
//! let camera = Camera::from_field_of_view(640, 480, 1.05)?;
//! let hand_m = Vec3::new(0.2, 0.1, 1.5);
//! let pixel = camera.project(&hand_m).expect("the hand is in front of the camera");
//! assert!(pixel.u_px > 319.5 && pixel.v_px > 239.5, "right of the middle, and below it");
//!
//! // A pixel is a ray; the nearest of its points to the hand is the hand.
//! let ray = camera.back_project(pixel);
//! assert!((ray.project(&hand_m) - hand_m).norm() < 1e-4);
//! assert!(camera.project(&-hand_m).is_none(), "behind the camera is no image");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::error::{ParameterError, Rule, finite, positive, within};
use crate::math::{Vec3, sin_cos, unit};
use crate::ranges::{MAX_FOCAL_PX, MAX_PX, length};

/// Fixed-point steps that undo the distortion; the bound of the work.
const UNDISTORT_STEPS: usize = 12;

/// A point of the image, pixels.
///
/// ```
/// use sinew_core::camera::Pixel;
///
/// let (thumb, wrist) = (Pixel::new(320.0, 200.0), Pixel::new(350.0, 240.0));
/// assert_eq!(thumb.distance_px(wrist), 50.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct Pixel {
    /// Column, to the right.
    pub u_px: f32,
    /// Row, downwards.
    pub v_px: f32,
}

impl Pixel {
    /// The point at column `u_px` and row `v_px`.
    #[must_use]
    pub const fn new(u_px: f32, v_px: f32) -> Self {
        Self { u_px, v_px }
    }

    /// Euclidean distance to `other`, pixels.
    #[must_use]
    pub fn distance_px(self, other: Self) -> f32 {
        let (du, dv) = (self.u_px - other.u_px, self.v_px - other.v_px);
        crate::math::sqrt(du * du + dv * dv)
    }
}

/// Radial (`k1..k3`) and tangential (`p1`, `p2`) distortion, the Brown-Conrady model in OpenCV's
/// order of terms.
///
/// ```
/// use sinew_core::camera::{Camera, Distortion};
/// use sinew_core::math::Vec3;
///
/// // A wide lens draws what lies at the edge towards the middle; `undistort` puts it back.
/// let pinhole = Camera::from_field_of_view(640, 480, 1.4)?;
/// let lens = pinhole.with_distortion(Distortion { k1: -0.2, ..Distortion::default() })?;
/// let hand_m = Vec3::new(0.8, 0.0, 1.2);
/// let (ideal, seen) = (pinhole.project(&hand_m).unwrap(), lens.project(&hand_m).unwrap());
/// assert!(ideal.u_px - seen.u_px > 20.0);
/// assert!(lens.undistort(seen).distance_px(ideal) < 0.1);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distortion {
    /// Radial coefficient of r^2.
    pub k1: f32,
    /// Radial coefficient of r^4.
    pub k2: f32,
    /// Radial coefficient of r^6.
    pub k3: f32,
    /// First tangential coefficient.
    pub p1: f32,
    /// Second tangential coefficient.
    pub p2: f32,
}

/// A half line from the camera: `origin + s * direction`, s >= 0.
///
/// ```
/// use sinew_core::camera::{Camera, Pixel};
///
/// // A pixel gives the ray of a hand; a metre away it is here.
/// let camera = Camera::from_field_of_view(640, 480, 1.05)?;
/// let ray = camera.back_project(Pixel::new(400.0, 300.0));
/// let hand_m = ray.origin + ray.direction;
/// assert!((ray.project(&hand_m) - hand_m).norm() < 1e-6);
/// assert!(
///     camera
///         .project(&hand_m)
///         .is_some_and(|seen| seen.distance_px(Pixel::new(400.0, 300.0)) < 1e-3)
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Camera centre, metres (P of the arm paper).
    pub origin: Vec3,
    /// Unit direction (F of the arm paper).
    pub direction: Vec3,
}

impl Ray {
    /// Foot of the perpendicular from `point` on the whole line: P + ((H - P).F) F (arm paper,
    /// section 3.2).
    #[must_use]
    pub fn project(&self, point: &Vec3) -> Vec3 {
        self.origin + self.direction * (point - self.origin).dot(&self.direction)
    }
}

/// Intrinsic parameters of a pinhole camera.
///
/// ```
/// use sinew_core::camera::{Camera, Pixel};
/// use sinew_core::math::Vec3;
///
/// // Calibrated: focal lengths and principal point. Half a metre away, 10 cm are a fifth of a
/// // focal length.
/// let camera = Camera::new(600.0, 600.0, Pixel::new(320.0, 240.0))?;
/// assert_eq!(camera.project(&Vec3::new(0.1, 0.0, 0.5)), Some(Pixel::new(440.0, 240.0)));
/// // Not calibrated: the field of view from the data sheet has to do.
/// let webcam = Camera::from_field_of_view(640, 480, 60.0_f32.to_radians())?;
/// assert!((webcam.focal_px() - 554.3).abs() < 0.1);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    focal_u_px: f32,
    focal_v_px: f32,
    centre: Pixel,
    distortion: Option<Distortion>,
}

impl Camera {
    /// A camera with focal lengths and principal point in pixels.
    ///
    /// # Errors
    /// Focal lengths have to be positive and at most [`MAX_FOCAL_PX`], the principal point within
    /// [`MAX_PX`].
    pub fn new(focal_u_px: f32, focal_v_px: f32, centre: Pixel) -> Result<Self, ParameterError> {
        Ok(Self {
            focal_u_px: length("focal_u_px", focal_u_px, MAX_FOCAL_PX)?,
            focal_v_px: length("focal_v_px", focal_v_px, MAX_FOCAL_PX)?,
            centre: Pixel::new(
                within("centre_u_px", centre.u_px, -MAX_PX, MAX_PX)?,
                within("centre_v_px", centre.v_px, -MAX_PX, MAX_PX)?,
            ),
            distortion: None,
        })
    }

    /// A camera with square pixels, its principal point in the middle of a `width_px` x `height_px`
    /// image.
    ///
    /// # Errors
    /// The field of view has to lie strictly between 0 and pi, the size above zero.
    pub fn from_field_of_view(
        width_px: u32,
        height_px: u32,
        horizontal_field_of_view_rad: f32,
    ) -> Result<Self, ParameterError> {
        let name = "horizontal_field_of_view_rad";
        if !(finite(name, horizontal_field_of_view_rad)? > 0.0 && horizontal_field_of_view_rad < core::f32::consts::PI)
        {
            return Err(ParameterError::new(name, Rule::Within { low: 0.0, high: core::f32::consts::PI }));
        }
        let (width, height) = (positive("width_px", width_px as f32)?, positive("height_px", height_px as f32)?);
        let (s, c) = sin_cos(0.5 * horizontal_field_of_view_rad);
        let focal_px = 0.5 * width * c / s;
        Self::new(focal_px, focal_px, Pixel::new(0.5 * (width - 1.0), 0.5 * (height - 1.0)))
    }

    /// The same camera with a distorting lens.
    ///
    /// # Errors
    /// Every coefficient has to be finite.
    pub fn with_distortion(self, distortion: Distortion) -> Result<Self, ParameterError> {
        finite("k1", distortion.k1)?;
        finite("k2", distortion.k2)?;
        finite("k3", distortion.k3)?;
        finite("p1", distortion.p1)?;
        finite("p2", distortion.p2)?;
        Ok(Self { distortion: Some(distortion), ..self })
    }

    /// The camera of a picture whose pixels are the means of blocks of `block` x `block` pixels.
    #[must_use]
    pub fn of_blocks(self, block: u32) -> Self {
        if block <= 1 {
            return self;
        }
        let scale = 1.0 / block as f32;
        let middle = |at: f32| (at + 0.5) * scale - 0.5;
        Self {
            focal_u_px: self.focal_u_px * scale,
            focal_v_px: self.focal_v_px * scale,
            centre: Pixel::new(middle(self.centre.u_px), middle(self.centre.v_px)),
            ..self
        }
    }

    /// Mean of both focal lengths, pixels.
    #[must_use]
    pub fn focal_px(&self) -> f32 {
        0.5 * (self.focal_u_px + self.focal_v_px)
    }

    /// Principal point, pixels.
    #[must_use]
    pub fn centre(&self) -> Pixel {
        self.centre
    }

    /// Image of a `point` in metres; `None` where it lies in or behind the camera's plane.
    #[must_use]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn project(&self, point: &Vec3) -> Option<Pixel> {
        if !(point.z > 1.0e-6) {
            return None;
        }
        let (x, y) = self.distort(point.x / point.z, point.y / point.z);
        Some(Pixel::new(self.focal_u_px * x + self.centre.u_px, self.focal_v_px * y + self.centre.v_px))
    }

    /// Where an ideal pinhole camera with the same focal lengths would see what the lens shows at
    /// `pixel`.
    #[must_use]
    pub fn undistort(&self, pixel: Pixel) -> Pixel {
        let (x, y) = self.normalised(pixel);
        Pixel::new(self.focal_u_px * x + self.centre.u_px, self.focal_v_px * y + self.centre.v_px)
    }

    /// The ray of all points that are seen at `pixel`.
    #[must_use]
    pub fn back_project(&self, pixel: Pixel) -> Ray {
        let (x, y) = self.normalised(pixel);
        let direction = unit(Vec3::new(x, y, 1.0)).unwrap_or(Vec3::z());
        Ray { origin: Vec3::zeros(), direction }
    }

    fn distort(&self, x: f32, y: f32) -> (f32, f32) {
        let Some(d) = self.distortion else { return (x, y) };
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
        (
            x * radial + 2.0 * d.p1 * x * y + d.p2 * (r2 + 2.0 * x * x),
            y * radial + d.p1 * (r2 + 2.0 * y * y) + 2.0 * d.p2 * x * y,
        )
    }

    /// Undistorted coordinates on the plane z = 1, by fixed-point iteration with a fixed number of
    /// steps.
    fn normalised(&self, pixel: Pixel) -> (f32, f32) {
        let seen_x = (pixel.u_px - self.centre.u_px) / self.focal_u_px;
        let seen_y = (pixel.v_px - self.centre.v_px) / self.focal_v_px;
        let (mut x, mut y) = (seen_x, seen_y);
        if self.distortion.is_some() {
            for _ in 0..UNDISTORT_STEPS {
                let (dx, dy) = self.distort(x, y);
                x += seen_x - dx;
                y += seen_y - dy;
            }
        }
        (x, y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lens() -> Camera {
        Camera::from_field_of_view(640, 480, 1.05)
            .and_then(|c| c.with_distortion(Distortion { k1: -0.12, k2: 0.03, k3: 0.0, p1: 0.001, p2: -0.0005 }))
            .unwrap()
    }

    #[test]
    fn a_picture_of_blocks_shows_the_same_directions() {
        let camera = Camera::from_field_of_view(640, 480, 1.0).unwrap();
        assert_eq!(camera.of_blocks(2), Camera::from_field_of_view(320, 240, 1.0).unwrap());
        let point = Vec3::new(0.3, -0.2, 1.0);
        let [whole, blocks] = [camera, camera.of_blocks(2)].map(|camera| camera.project(&point).unwrap());
        // Pixel u of the blocks has the pixels 2 u and 2 u + 1.
        assert!((whole.u_px - (2.0 * blocks.u_px + 0.5)).abs() < 1.0e-3);
    }

    proptest! {
        #[test]
        fn a_back_projected_ray_passes_through_the_point(x in -0.4_f32..0.4, y in -0.3_f32..0.3, z in 0.3_f32..3.0) {
            let point = Vec3::new(x * z, y * z, z);
            let ray = lens().back_project(lens().project(&point).unwrap());
            prop_assert!((ray.project(&point) - point).norm() < 2.0e-4 * z);
        }
    }

    #[test]
    fn a_point_behind_the_camera_has_no_image() {
        assert_eq!(lens().project(&Vec3::new(0.0, 0.0, -1.0)), None);
        assert_eq!(lens().project(&Vec3::zeros()), None);
    }

    #[test]
    fn the_middle_of_the_image_looks_straight_ahead() {
        let camera = Camera::from_field_of_view(641, 481, 1.0).unwrap();
        assert_eq!(camera.back_project(Pixel::new(320.0, 240.0)).direction, Vec3::z());
    }

    #[test]
    fn a_focal_length_of_zero_is_refused_by_name() {
        let error = Camera::new(0.0, 1.0, Pixel::default()).unwrap_err();
        assert_eq!(error, ParameterError::new("focal_u_px", Rule::Positive));
    }
}
