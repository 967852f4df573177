//! What does not change while an arm is tracked.

use super::options::{ArmOptions, DEFAULT_RADIUS_PER_FOCAL, EstimateRule};
use crate::camera::Camera;
use crate::correction::hand::ReachableShell;
use crate::error::ParameterError;
use crate::kinematics::forward::posture;
use crate::math::{Vec3, max, sin_cos, sqrt};
use crate::observation::limbs::ArmImagePoints;
use crate::skeleton::arm::{ARM_ANGLES, ARM_BONES, ArmAngles, ArmGeometry, FOREARM, UPPER_ARM, WIDE_ARM_LIMITS};
use crate::skeleton::{Side, Skeleton};
use crate::vision::candidate::HandCandidate;
#[cfg(feature = "c-api")]
use core::mem::MaybeUninit;

/// Camera, arm and options of one arm tracker; immutable.
///
/// ```
/// use sinew_core::camera::Camera;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side};
/// use sinew_core::tracker::arm::{ArmModel, ArmOptions};
///
/// let camera = Camera::from_field_of_view(640, 480, 1.05)?;
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
/// let model = ArmModel::new(camera, (640, 480), arm, ArmOptions::default())?;
/// // Geometry of the model: how far the hand can be from the shoulder, and where an elbow and a hand are in a pose.
/// let shoulder_m = Vec3::new(0.2, -0.1, 1.2);
/// assert!((model.reachable(&shoulder_m).outer_m - 0.65).abs() < 1e-5);
/// let (elbow_m, hand_m) = model.elbow_and_hand(&shoulder_m, &[0.0; 4]);
/// assert!(((hand_m - elbow_m) - Vec3::new(0.0, 0.35, 0.0)).norm() < 1e-5, "it hangs");
/// // A wrong option is refused here, by its name, not in the middle of a recording.
/// let none = ArmOptions { particles: 0, ..ArmOptions::default() };
/// assert_eq!(ArmModel::new(camera, (640, 480), arm, none).map_err(|error| error.parameter).err(), Some("particles"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ArmModel {
    camera: Camera,
    image_area_px: f32,
    geometry: ArmGeometry,
    skeleton: Skeleton<ARM_BONES, ARM_ANGLES>,
    options: ArmOptions,
}

impl ArmModel {
    /// Puts the parts together.
    ///
    /// `image_size_px` is (width, height).
    ///
    /// # Errors
    /// Names the first parameter that is out of its range.
    pub fn new(
        camera: Camera,
        image_size_px: (u32, u32),
        geometry: ArmGeometry,
        options: ArmOptions,
    ) -> Result<Self, ParameterError> {
        let (image_area_px, geometry, skeleton) = parts(image_size_px, &geometry, &options)?;
        Ok(Self { camera, image_area_px, geometry, skeleton, options })
    }

    /// Writes what [`Self::new`] gives where it stays, or only checks whether it would.
    #[cfg(feature = "c-api")]
    #[inline(never)]
    pub(crate) fn write_into(
        place: Option<&mut MaybeUninit<Self>>,
        camera: Camera,
        image_size_px: (u32, u32),
        geometry: &ArmGeometry,
        options: &ArmOptions,
    ) -> Result<(), ParameterError> {
        let (image_area_px, geometry, skeleton) = parts(image_size_px, geometry, options)?;
        if let Some(place) = place {
            place.write(Self { camera, image_area_px, geometry, skeleton, options: *options });
        }
        Ok(())
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Number of pixels of the image.
    #[must_use]
    pub fn image_area_px(&self) -> f32 {
        self.image_area_px
    }

    /// Lengths and limits of the arm.
    #[must_use]
    pub fn geometry(&self) -> &ArmGeometry {
        &self.geometry
    }

    /// The arm as a tree of bones.
    #[must_use]
    pub fn skeleton(&self) -> &Skeleton<ARM_BONES, ARM_ANGLES> {
        &self.skeleton
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &ArmOptions {
        &self.options
    }

    /// The person's own side.
    #[must_use]
    pub fn side(&self) -> Side {
        self.geometry.side
    }

    /// Elbow and hand of a pose, metres.
    #[must_use]
    pub fn elbow_and_hand(&self, shoulder_m: &Vec3, angles_rad: &ArmAngles) -> (Vec3, Vec3) {
        let there = posture(&self.skeleton, shoulder_m, angles_rad);
        (there.ends[UPPER_ARM], there.ends[FOREARM])
    }

    /// Images of shoulder, elbow and hand; `None` where one lies behind the camera.
    #[must_use]
    pub fn image_points(&self, shoulder_m: &Vec3, elbow_m: &Vec3, hand_m: &Vec3) -> Option<ArmImagePoints> {
        Some(ArmImagePoints {
            shoulder: self.camera.project(shoulder_m)?,
            elbow: self.camera.project(elbow_m)?,
            hand: self.camera.project(hand_m)?,
        })
    }

    /// Distance from a blob's centre within which a hand lies at that blob, pixels. It is the
    /// radius of the disc of its area, and at least [`Self::least_cluster_radius_px`].
    #[must_use]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn cluster_radius_px(&self, blob: &HandCandidate) -> f32 {
        max(self.least_cluster_radius_px(), sqrt(blob.area_px / core::f32::consts::PI))
    }

    /// The configured cluster radius, pixels.
    #[must_use]
    pub fn least_cluster_radius_px(&self) -> f32 {
        let radius_per_focal = match self.options.estimate {
            EstimateRule::Cluster => self.options.cluster_radius_per_focal,
            EstimateRule::Mean => DEFAULT_RADIUS_PER_FOCAL,
        };
        radius_per_focal * self.camera.focal_px()
    }

    /// Where the hand can be, given the elbow's limits.
    #[must_use]
    pub fn reachable(&self, shoulder_m: &Vec3) -> ReachableShell {
        let (upper, fore) = (self.geometry.upper_arm_m, self.geometry.forearm_m);
        let elbow = self.geometry.limits[3];
        let span = |flexion: f32| sqrt(upper * upper + fore * fore + 2.0 * upper * fore * sin_cos(flexion).1);
        ReachableShell { centre_m: *shoulder_m, inner_m: span(elbow.high_rad), outer_m: span(elbow.low_rad) }
    }

    /// The pose in which an arm waits to be seen: hands in front of the belly.
    #[must_use]
    pub fn waiting_pose(&self) -> ArmAngles {
        self.skeleton.clamp([0.5, 0.25, 0.3, 1.4])
    }
}

/// Pixels of the image, the arm with the limits that the options ask for, and its bones.
#[inline(always)]
fn parts(
    image_size_px: (u32, u32),
    geometry: &ArmGeometry,
    options: &ArmOptions,
) -> Result<(f32, ArmGeometry, Skeleton<ARM_BONES, ARM_ANGLES>), ParameterError> {
    options.check()?;
    let image_area_px = crate::error::positive("image_size_px", image_size_px.0 as f32 * image_size_px.1 as f32)?;
    let limits = if options.joint_limits { geometry.limits } else { WIDE_ARM_LIMITS };
    let geometry = ArmGeometry { limits, ..*geometry };
    let skeleton = geometry.skeleton()?;
    Ok((image_area_px, geometry, skeleton))
}
