//! The surface of a pose: the capsules of all bones, as one camera sees them; PIK (26).

use super::capsule::Capsule;
use crate::kinematics::forward::Posture;
use crate::math::{Vec3, max, sqrt_branch_free, unit};
use heapless::Vec;

/// A capsule with terms that are equal for all points of a cloud: v of PIK (28) is constant along a
/// bone.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::body_surface::BodySurface;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // An arm that hangs two metres before the camera: where along its forearm does a point lie?
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.40)?.skeleton()?;
/// let hanging = posture(&arm, &Vec3::new(0.0, 0.0, 2.0), &[0.0; 4]);
/// let surface = BodySurface::new(&hanging, &[0.05, 0.04], Vec3::zeros());
/// let forearm =
///     surface.capsules.iter().find(|seen| seen.bone == FOREARM).expect("it has flesh");
/// let (place_m, share) = forearm.axis_point(&Vec3::new(0.1, 0.4, 1.9));
/// assert!((share - 0.25).abs() < 1e-5, "a quarter of the way from the elbow");
/// assert!((place_m - Vec3::new(0.0, 0.4, 2.0)).norm() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenCapsule {
    /// The capsule.
    pub capsule: Capsule,
    /// Index of its bone.
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
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::body_surface::BodySurface;
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{BODY_ANGLES, body_radii_m, full_body};
///
/// let measures = BodyMeasures::of_height(1.75)?;
/// let standing =
///     posture(&full_body(&measures)?, &Vec3::new(0.0, 0.0, 3.0), &[0.0; BODY_ANGLES]);
/// let surface = BodySurface::new(&standing, &body_radii_m(&measures), Vec3::zeros());
/// assert_eq!(surface.capsules.len(), 16, "all bones but the pelvis");
/// // A marker on the chest, ten centimetres before the skin: the trunk is 12.5 cm thick.
/// assert!((surface.skin_distance_m(&Vec3::new(0.0, -0.2, 2.775)) - 0.1).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BodySurface<const BONES: usize> {
    /// Camera centre c, metres.
    pub camera_m: Vec3,
    /// Capsules of the bones with flesh, in the bones' order.
    pub capsules: Vec<SeenCapsule, BONES>,
    /// The same, as arrays by number.
    lanes: CapsuleLanes<BONES>,
}

/// Capsules as arrays by number, so that a loop over them is a loop over vectors.
#[derive(Debug, Clone, PartialEq)]
struct CapsuleLanes<const BONES: usize> {
    start: [[f32; BONES]; 3],
    along: [[f32; BONES]; 3],
    per_squared_length: [f32; BONES],
    radius: [f32; BONES],
}

/// Bounds of the distances from a ball to each capsule's visible skin, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DistanceBounds<const BONES: usize> {
    /// No point of the ball is nearer, metres.
    pub min_m: [f32; BONES],
    /// No point of the ball is farther than the root of this, square metres.
    pub max_squared_m2: [f32; BONES],
}

impl<const BONES: usize> BodySurface<BONES> {
    /// The surface of `posture`; `radii_m` has the radius of each bone's capsule, zero for a bone
    /// without flesh.
    #[must_use]
    pub fn new<const ANGLES: usize>(posture: &Posture<BONES, ANGLES>, radii_m: &[f32; BONES], camera_m: Vec3) -> Self {
        let mut capsules: Vec<SeenCapsule, BONES> = Vec::new();
        let nothing = [0.0; BONES];
        let mut lanes =
            CapsuleLanes { start: [nothing; 3], along: [nothing; 3], per_squared_length: nothing, radius: nothing };
        for bone in 0..BONES {
            if !(radii_m[bone] > 0.0) {
                continue;
            }
            let capsule = Capsule { start_m: posture.joints[bone], end_m: posture.ends[bone], radius_m: radii_m[bone] };
            let seen = SeenCapsule::new(capsule, bone, &camera_m);
            let lane = capsules.len();
            if lane >= BONES {
                break;
            }
            let (start, along) = (capsule.start_m, seen.along_m);
            for (axis, (start, along)) in
                [(start.x, along.x), (start.y, along.y), (start.z, along.z)].into_iter().enumerate()
            {
                lanes.start[axis][lane] = start;
                lanes.along[axis][lane] = along;
            }
            lanes.per_squared_length[lane] = seen.per_squared_length;
            lanes.radius[lane] = capsule.radius_m;
            // At most one a bone, so it always fits.
            let _ = capsules.push(seen);
        }
        Self { camera_m, capsules, lanes }
    }

    /// Bounds of the distances from the points of a ball to the visible skin of each capsule.
    ///
    /// Entries beyond the last capsule are undefined.
    ///
    /// D is the distance of the ball's centre from a bone, R the ball's radius and r the bone's. No
    /// point is nearer than D - R - r or r - D - R. None is farther than the root of
    /// (D + R)^2 + r^2, the hidden case.
    #[must_use]
    pub(crate) fn distance_bounds(&self, centre_m: &Vec3, radius_m: f32) -> DistanceBounds<BONES> {
        let lanes = &self.lanes;
        let mut bounds = DistanceBounds { min_m: [0.0; BONES], max_squared_m2: [0.0; BONES] };
        // Whole vectors, where the list ends with one.
        let lanes_used = self.capsules.len().next_multiple_of(4).min(BONES);
        for i in 0..lanes_used {
            let (x, y, z) =
                (centre_m.x - lanes.start[0][i], centre_m.y - lanes.start[1][i], centre_m.z - lanes.start[2][i]);
            let (u, v, w) = (lanes.along[0][i], lanes.along[1][i], lanes.along[2][i]);
            let t = crate::math::min(max((x * u + y * v + z * w) * lanes.per_squared_length[i], 0.0), 1.0);
            let (x, y, z) = (x - t * u, y - t * v, z - t * w);
            let distance = sqrt_branch_free(x * x + y * y + z * z);
            let r = lanes.radius[i];
            let (inner, outer) = (distance - radius_m, distance + radius_m);
            bounds.min_m[i] = max(inner - r, r - outer);
            bounds.max_squared_m2[i] = outer * outer + r * r;
        }
        bounds
    }

    /// Distance of `point_m` from the skin of the nearest bone, whole capsules, either side: D of
    /// PIK (34), metres.
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

    /// The point p of the axis nearest to `point_m`, and where it lies: 0 at the start, 1 at the
    /// end.
    #[inline]
    #[must_use]
    pub fn axis_point(&self, point_m: &Vec3) -> (Vec3, f32) {
        let share = (point_m - self.capsule.start_m).dot(&self.along_m) * self.per_squared_length;
        let share = crate::math::clamp(share, 0.0, 1.0);
        (self.capsule.start_m + self.along_m * share, share)
    }
}
