//! Legs that are in view of an upper body, which has no skin for them: their points would draw its
//! pelvis and trunk down.

use crate::math::{Vec3, unit};
use crate::observation::capsule::Capsule;
use crate::skeleton::full_body::{FOREARMS, PELVIS, TRUNK, UPPER_ARMS};
use crate::skeleton::upper_body::UPPER_BONES;

/// Where the points of an upper body's legs are: below the pelvis, and at no forearm.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{FOREARMS, HEAD, PELVIS};
/// use sinew_core::skeleton::upper_body::{UPPER_ANGLES, upper_body, upper_radii_m};
/// use sinew_core::tracker::body::Legs;
///
/// // Somebody who stands two metres before the camera, arms hanging.
/// let measures = BodyMeasures::of_height(1.75)?;
/// let mut pose = [0.0; UPPER_ANGLES];
/// pose[2] = 2.0;
/// let ends_m = posture(&upper_body(&measures)?, &Vec3::zeros(), &pose).ends;
/// let legs = Legs::of(&ends_m, &upper_radii_m(&measures), 0.08);
/// let knee_m = ends_m[PELVIS] + Vec3::new(0.1, 0.4, 0.0);
/// assert!(legs.hold(&knee_m));
/// assert!(!legs.hold(&ends_m[FOREARMS[0]]), "a hand that hangs beside the thigh");
/// assert!(!legs.hold(&ends_m[HEAD]));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Legs {
    pelvis_m: Vec3,
    up: Vec3,
    forearms: [Capsule; 2],
}

impl Legs {
    /// Those of the pose whose bones end at `ends_m`, with the capsules' `radii_m`; points within
    /// `reach_m` of a forearm's skin are the forearm's.
    #[must_use]
    pub fn of(ends_m: &[Vec3; UPPER_BONES], radii_m: &[f32; UPPER_BONES], reach_m: f32) -> Self {
        let pelvis_m = ends_m[PELVIS];
        let forearm = |start: usize, end: usize| Capsule {
            start_m: ends_m.get(start).copied().unwrap_or(pelvis_m),
            end_m: ends_m.get(end).copied().unwrap_or(pelvis_m),
            radius_m: radii_m.get(end).copied().unwrap_or(0.0) + reach_m,
        };
        let forearms = [forearm(UPPER_ARMS[0], FOREARMS[0]), forearm(UPPER_ARMS[1], FOREARMS[1])];
        Self { pelvis_m, up: unit(ends_m[TRUNK] - pelvis_m).unwrap_or(-Vec3::y()), forearms }
    }

    /// Whether `point_m` is a point of the legs.
    #[must_use]
    pub fn hold(&self, point_m: &Vec3) -> bool {
        (point_m - self.pelvis_m).dot(&self.up) < 0.0 && !self.forearms.iter().any(|forearm| forearm.holds(point_m))
    }

    /// The other points of `points_m`, brought to its front.
    pub fn leave_out<'p>(&self, points_m: &'p mut [Vec3]) -> &'p mut [Vec3] {
        let mut kept = 0;
        for index in 0..points_m.len() {
            let Some(point_m) = points_m.get(index).copied().filter(|point_m| !self.hold(point_m)) else { continue };
            let Some(slot) = points_m.get_mut(kept) else { continue };
            let other_m = core::mem::replace(slot, point_m);
            if let Some(slot) = points_m.get_mut(index) {
                *slot = other_m;
            }
            kept += 1;
        }
        points_m.get_mut(..kept).unwrap_or_default()
    }
}
