//! A recording is turned and shifted as a whole, so that a camera sees the person.

use super::joints::BodyJoints;
use sinew_core::math::{Mat3, Vec3, axis_rotation, unit};
use sinew_core::skeleton::full_body::{FEET, HIPS, PELVIS, SHANKS};

/// Where a recorded person is put before a level camera.
///
/// One rigid motion for all frames. The person faces the camera on the mean of the frames; where
/// the headings of a person who turns cancel out, in the first frame. The floor is where the lowest
/// foot of the recording stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Mean distance of the pelvis, metres; larger where the other limits need it.
    pub mean_distance_m: f32,
    /// Smallest distance of the pelvis, metres.
    pub least_distance_m: f32,
    /// Camera above the floor, metres.
    pub camera_height_m: f32,
    /// Half the picture's width and height over the focal length: every joint is kept inside.
    pub half_view: [f32; 2],
    /// Turn of the person about the vertical: 0 faces the camera, a positive one turns to the
    /// person's left. Radians.
    pub heading_rad: f32,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            mean_distance_m: 3.0,
            least_distance_m: 2.0,
            camera_height_m: 1.0,
            half_view: crate::stereo::StereoCamera::default().half_view(),
            heading_rad: 0.0,
        }
    }
}

/// Flesh around a joint, metres: kept in view with it.
const FLESH_M: f32 = 0.1;
/// From the joints of a foot down to its sole, metres.
const SOLE_M: f32 = 0.042;
/// A mean heading shorter than this share of one is none: the person turns.
const MIN_HEADING: f32 = 0.3;

/// A turn, then a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion {
    turn: Mat3,
    shift: Vec3,
}

impl RigidMotion {
    /// Where `point` comes to lie.
    #[must_use]
    pub fn apply(&self, point: &Vec3) -> Vec3 {
        self.turn * point + self.shift
    }
}

impl Placement {
    /// Puts `frames` before the camera; `up` is the file's vertical, a unit vector. `false` if no
    /// frame shows the pelvis and where the person faces: then nothing is changed.
    #[must_use]
    pub fn place(&self, frames: &mut [BodyJoints], up: Vec3) -> bool {
        let Some(motion) = self.motion(frames, up) else { return false };
        for joint in frames.iter_mut().flatten().flatten() {
            *joint = motion.apply(joint);
        }
        true
    }

    /// What puts `frames` before the camera, as [`Self::place`] does.
    #[must_use]
    pub fn motion(&self, frames: &[BodyJoints], up: Vec3) -> Option<RigidMotion> {
        let front = mean_front(frames, up)?;
        let left = up.cross(&front);
        // Rows: x = left, y = down, z = back, as of a person who faces the camera.
        let facing = Mat3::from_rows(&[left.transpose(), -up.transpose(), -front.transpose()]);
        let turn = axis_rotation(&-Vec3::y(), self.heading_rad) * facing;
        let turned: Vec<BodyJoints> =
            frames.iter().map(|joints| joints.map(|joint| joint.map(|joint| turn * joint))).collect();
        Some(RigidMotion { turn, shift: self.shift(&turned)? })
    }

    /// From where the turned recording is to where the camera sees it.
    fn shift(&self, frames: &[BodyJoints]) -> Option<Vec3> {
        let pelvis: Vec<Vec3> = frames.iter().filter_map(|joints| joints[PELVIS]).collect();
        let mean = pelvis.iter().sum::<Vec3>() / pelvis.len().max(1) as f32;
        let nearest = pelvis.iter().map(|place| place.z).reduce(f32::min)?;
        let feet = [FEET, SHANKS].concat();
        let lowest = frames.iter().flat_map(|joints| feet.iter().filter_map(|&bone| joints[bone])).map(|place| place.y);
        let floor = lowest.reduce(f32::max).map_or(mean.y + self.camera_height_m, |y| y + SOLE_M);
        let mut shift = Vec3::new(-mean.x, self.camera_height_m - floor, 0.0);
        shift.z = (self.mean_distance_m - mean.z).max(self.least_distance_m - nearest);
        for place in frames.iter().flatten().flatten() {
            for axis in 0..2 {
                let needed_m = ((place[axis] + shift[axis]).abs() + FLESH_M) / self.half_view[axis];
                shift.z = shift.z.max(needed_m - place.z);
            }
        }
        Some(shift)
    }
}

/// Where the person faces on the mean, a level unit vector.
fn mean_front(frames: &[BodyJoints], up: Vec3) -> Option<Vec3> {
    let front = |joints: &BodyJoints| {
        let [left, right] = HIPS.map(|hip| joints[hip]);
        let across = left? - right?;
        // Of a person who lies on the back the hips alone would do; the trunk says the same where
        // it is upright.
        unit(across.cross(&up))
    };
    let fronts: Vec<Vec3> = frames.iter().filter_map(front).collect();
    let mean = fronts.iter().sum::<Vec3>() / fronts.len().max(1) as f32;
    if mean.norm() > MIN_HEADING { unit(mean) } else { fronts.first().copied() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sinew_core::skeleton::full_body::{BODY_BONES, TRUNK};

    fn walker(direction_rad: f32, frames: usize) -> Vec<BodyJoints> {
        let turn = axis_rotation(&Vec3::z(), direction_rad);
        let mut all = vec![[None; BODY_BONES]; frames];
        for (frame, joints) in all.iter_mut().enumerate() {
            let along = Vec3::new(0.3 * frame as f32, 4.0, 2.0);
            // Looks along x, left is y, up is z.
            for (bone, at) in [
                (PELVIS, [0.0, 0.0, 0.9]),
                (HIPS[0], [0.0, 0.1, 0.9]),
                (HIPS[1], [0.0, -0.1, 0.9]),
                (TRUNK, [0.0, 0.0, 1.4]),
                (FEET[0], [0.15, 0.1, 0.0]),
                (FEET[1], [0.15, -0.1, 0.1]),
            ] {
                joints[bone] = Some(turn * (Vec3::from(at) + along));
            }
        }
        all
    }

    proptest! {
        #[test]
        fn a_walker_comes_to_the_camera_and_stays_in_view(direction in -3.0_f32..3.0, frames in 1_usize..20) {
            let mut placed = walker(direction, frames);
            let placement = Placement::default();
            prop_assert!(placement.place(&mut placed, Vec3::z()));
            let (first, last) = (placed[0], placed[frames - 1]);
            prop_assert!(first[HIPS[0]].unwrap().x > first[HIPS[1]].unwrap().x + 0.19);
            prop_assert!(first[TRUNK].unwrap().y < first[PELVIS].unwrap().y - 0.49);
            prop_assert!((first[FEET[0]].unwrap().y - (1.0 - SOLE_M)).abs() < 1.0e-4);
            prop_assert!((first[PELVIS].unwrap().z - last[PELVIS].unwrap().z - 0.3 * (frames - 1) as f32).abs() < 1.0e-3);
            prop_assert!(last[PELVIS].unwrap().z >= 2.0 - 1.0e-4);
            for place in placed.iter().flatten().flatten() {
                for axis in 0..2 {
                    prop_assert!(place[axis].abs() <= place.z * placement.half_view[axis]);
                }
            }
        }
    }

    #[test]
    fn who_shows_no_hips_is_not_placed() {
        let mut frames = vec![[None; BODY_BONES]; 3];
        assert!(!Placement::default().place(&mut frames, Vec3::y()));
    }

    #[test]
    fn the_heading_turns_the_person_to_their_left() {
        let mut placed = walker(0.3, 1);
        let placement = Placement { heading_rad: core::f32::consts::FRAC_PI_2, ..Placement::default() };
        assert!(placement.place(&mut placed, Vec3::z()));
        let (left, right) = (placed[0][HIPS[0]].unwrap(), placed[0][HIPS[1]].unwrap());
        assert!(left.z > right.z + 0.19, "looks to the picture's right: the left hip is farther");
    }
}
