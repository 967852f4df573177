//! The surface of a pose: the capsules of all bones, as one camera sees them (PIK paper, section 6.2, eq. 26).

use super::capsule::Capsule;
use crate::kinematics::forward::Posture;
use crate::math::{Vec3, max, unit};
use heapless::Vec;

/// A capsule with what is the same for all points of a cloud: v of eq. (28) is constant along a bone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenCapsule {
    /// The capsule.
    pub capsule: Capsule,
    /// The bone whose flesh it is.
    pub bone: usize,
    /// From its start to its end, metres.
    pub along_m: Vec3,
    /// 1 over the squared length; zero for a sphere.
    pub per_squared_length: f32,
    /// Unit vector across both the bone and the line of sight; zero where they are the same line.
    pub across: Vec3,
    /// 1 over the squared distances of start and end from the camera.
    pub per_squared_sight: [f32; 2],
}

/// The capsules of one pose, at most one a bone.
#[derive(Debug, Clone, PartialEq)]
pub struct BodySurface<const BONES: usize> {
    /// Camera centre c, metres.
    pub camera_m: Vec3,
    /// Capsules of the bones with flesh, in the bones' order.
    pub capsules: Vec<SeenCapsule, BONES>,
}

impl<const BONES: usize> BodySurface<BONES> {
    /// The surface of `posture`; `radii_m` has the radius of each bone's capsule, zero for a bone without flesh.
    #[must_use]
    pub fn new<const ANGLES: usize>(posture: &Posture<BONES, ANGLES>, radii_m: &[f32; BONES], camera_m: Vec3) -> Self {
        let mut capsules = Vec::new();
        for bone in 0..BONES {
            if !(radii_m[bone] > 0.0) {
                continue;
            }
            let capsule = Capsule { start_m: posture.joints[bone], end_m: posture.ends[bone], radius_m: radii_m[bone] };
            // At most one a bone, so it always fits.
            let _ = capsules.push(SeenCapsule::new(capsule, bone, &camera_m));
        }
        Self { camera_m, capsules }
    }

    /// Distance of `point_m` from the skin of the nearest bone, whole capsules, either side: D of eq. (34), metres.
    #[must_use]
    pub fn skin_distance_m(&self, point_m: &Vec3) -> f32 {
        let mut least = f32::INFINITY;
        for seen in &self.capsules {
            least = crate::math::min(least, seen.capsule.skin_distance_m(point_m));
        }
        least
    }
}

impl SeenCapsule {
    fn new(capsule: Capsule, bone: usize, camera_m: &Vec3) -> Self {
        let along_m = capsule.end_m - capsule.start_m;
        let squared = along_m.dot(&along_m);
        let sights = [camera_m - capsule.start_m, camera_m - capsule.end_m];
        Self {
            capsule,
            bone,
            along_m,
            per_squared_length: if squared > 1.0e-12 { 1.0 / squared } else { 0.0 },
            across: unit(sights[0].cross(&along_m)).unwrap_or_default(),
            per_squared_sight: sights.map(|sight| 1.0 / max(sight.dot(&sight), 1.0e-6)),
        }
    }

    /// The point p of the axis nearest to `point_m`, and where it lies: 0 at the start, 1 at the end.
    #[inline]
    #[must_use]
    pub fn axis_point(&self, point_m: &Vec3) -> (Vec3, f32) {
        let share = (point_m - self.capsule.start_m).dot(&self.along_m) * self.per_squared_length;
        let share = crate::math::clamp(share, 0.0, 1.0);
        (self.capsule.start_m + self.along_m * share, share)
    }
}
