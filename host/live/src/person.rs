//! Camera, arm and options before anything is known of them: those of `sinew track arm` without a
//! configuration file.

use sinew_core::camera::{Camera, Pixel};
use sinew_core::error::{ParameterError, finite, positive};
use sinew_core::math::Vec3;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::options::AreaCue;
use sinew_core::tracker::arm::{ArmModel, ArmOptions};

/// Horizontal field of view of a webcam, degrees.
const FIELD_OF_VIEW_DEG: f32 = 60.0;
/// Height of the person, metres.
const HEIGHT_M: f32 = 1.75;
/// Shoulder to elbow over the height (Drillis and Contini 1966).
const UPPER_ARM: f32 = 0.186;
/// Elbow to the middle of the hand over the height: forearm and half a hand.
const ELBOW_TO_HAND_CENTRE: f32 = 0.146 + 0.5 * 0.108;
/// Area of a half-open hand's image at one metre, over squared height.
const HAND_AREA: f32 = 0.00632;
/// Distance of a seated adult's shoulders from a laptop's camera, metres.
pub const DISTANCE_M: f32 = 0.9;
/// Sideways place of the left shoulder of somebody who sits in the middle, at the height of the
/// camera, metres.
const LEFT_SHOULDER_X_M: f32 = 0.2;

/// Where a shoulder is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shoulder {
    /// Not said: that of somebody who sits in the middle, so far away (metres along the line of
    /// sight).
    Guessed {
        /// Distance, metres.
        distance_m: f32,
    },
    /// At a pixel of the picture, so far away (metres along the line of sight).
    At {
        /// Its image.
        pixel: Pixel,
        /// Distance, metres.
        distance_m: f32,
    },
}

impl Shoulder {
    /// The shoulder of a person's own `side` in camera axes, metres.
    #[must_use]
    pub fn place_m(&self, camera: &Camera, side: Side) -> Vec3 {
        let x = if side == Side::Left { LEFT_SHOULDER_X_M } else { -LEFT_SHOULDER_X_M };
        match self {
            Self::Guessed { distance_m } => Vec3::new(x, 0.0, *distance_m),
            Self::At { pixel, distance_m } => {
                let direction = camera.back_project(*pixel).direction;
                direction * (*distance_m / direction.z)
            }
        }
    }
}

/// An arm before a camera with images of `size_px` (width, height), and where its shoulder is,
/// metres.
///
/// # Errors
/// Sizes, the number of particles and the distance have to be greater than zero, the shoulder's
/// pixel finite.
pub fn arm(
    size_px: (u32, u32),
    side: Side,
    particles: usize,
    shoulder: Shoulder,
) -> Result<(ArmModel, Vec3), ParameterError> {
    let camera = Camera::from_field_of_view(size_px.0, size_px.1, FIELD_OF_VIEW_DEG.to_radians())?;
    let geometry = ArmGeometry::new(side, UPPER_ARM * HEIGHT_M, ELBOW_TO_HAND_CENTRE * HEIGHT_M)?;
    let defaults = ArmOptions::default();
    let hand_area_m2 = HAND_AREA * HEIGHT_M * HEIGHT_M;
    let area_cue = defaults.area_cue.map(|cue| AreaCue { hand_area_m2, ..cue });
    let is_known = matches!(shoulder, Shoulder::At { .. });
    let options = ArmOptions { particles, area_cue, ..defaults }.for_shoulder(is_known);
    let (Shoulder::Guessed { distance_m } | Shoulder::At { distance_m, .. }) = shoulder;
    positive("distance_m", distance_m)?;
    if let Shoulder::At { pixel, .. } = shoulder {
        finite("shoulder", pixel.u_px + pixel.v_px)?;
    }
    Ok((ArmModel::new(camera, size_px, geometry, options)?, shoulder.place_m(&camera, side)))
}
