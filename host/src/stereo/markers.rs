//! Virtual markers: fixed places on the skin of the true capsules, for the error measure (34) of
//! the PIK paper.

use crate::body::BodyJoints;
use sinew_core::math::{Vec3, unit};
use sinew_core::skeleton::full_body::{
    BODY_BONES, BODY_PARENTS, COLLARS, FOREARMS, HEAD, HIPS, PELVIS, SHANKS, THIGHS, TRUNK, UPPER_ARMS,
};

/// A direction in body axes: outward, up, front.
type BodyDirection = [f32; 3];

const OUT: BodyDirection = [1.0, 0.0, 0.0];
const INWARD: BodyDirection = [-1.0, 0.0, 0.0];
const UP: BodyDirection = [0.0, 1.0, 0.0];
const DOWN: BodyDirection = [0.0, -1.0, 0.0];
const FRONT: BodyDirection = [0.0, 0.0, 1.0];
const BACK: BodyDirection = [0.0, 0.0, -1.0];

/// Share of the way along the bone, and where the skin faces when the bone lies in its rest
/// direction.
type Place = (f32, BodyDirection);

/// Arms are at rest when stretched out to the sides, legs when hanging: directions that lie
/// opposite are out of reach.
const UPPER_ARM: [Place; 3] = [(0.35, UP), (0.6, FRONT), (0.6, BACK)];
const FOREARM: [Place; 3] = [(0.3, UP), (0.6, FRONT), (0.8, BACK)];
const THIGH: [Place; 3] = [(0.35, FRONT), (0.55, OUT), (0.7, BACK)];
const SHANK: [Place; 3] = [(0.3, FRONT), (0.5, OUT), (0.75, BACK)];
const HEAD_PLACES: [Place; 2] = [(0.9, FRONT), (0.9, BACK)];
const TRUNK_PLACES: [Place; 4] = [(0.75, FRONT), (0.75, BACK), (0.4, OUT), (0.4, INWARD)];

/// Number of markers.
pub const MARKERS: usize = 30;

/// Bone, side (0 left or middle, 1 right), rest direction and place of all markers.
fn layout() -> impl Iterator<Item = (usize, usize, BodyDirection, Place)> {
    let sides = (0..2).flat_map(|side| {
        let limbs = [
            (UPPER_ARMS[side], OUT, UPPER_ARM),
            (FOREARMS[side], OUT, FOREARM),
            (THIGHS[side], DOWN, THIGH),
            (SHANKS[side], DOWN, SHANK),
        ];
        limbs.into_iter().flat_map(move |(bone, rest, places)| places.map(|place| (bone, side, rest, place)))
    });
    let head = HEAD_PLACES.map(|place| (HEAD, 0, UP, place));
    let trunk = TRUNK_PLACES.map(|place| (TRUNK, 0, UP, place));
    sides.chain(head).chain(trunk)
}

/// Markers of one frame, metres: three on each upper arm, forearm, thigh and shank (left limbs
/// first), two on the head, four on the trunk. `None` where a joint that a marker needs was not
/// recorded.
///
/// A marker's direction turns with its bone by the smallest rotation from the bone's rest
/// direction. The frame is that of the trunk's axis and the line of the shoulders (of the hips for
/// legs).
#[must_use]
pub fn markers(joints: &BodyJoints, radii_m: &[f32; BODY_BONES]) -> Vec<Option<Vec3>> {
    let [upper, lower] = [COLLARS, HIPS].map(|pair| axes(joints, pair));
    let marker = |(bone, side, rest, (share, direction)): (usize, usize, BodyDirection, Place)| {
        if !(radii_m[bone] > 0.0) {
            return None;
        }
        let is_leg = THIGHS.contains(&bone) || SHANKS.contains(&bone);
        let [left, up, front] = if is_leg { lower } else { upper }?;
        let outward = if side == 0 { left } else { -left };
        let in_space = |[o, u, f]: BodyDirection| outward * o + up * u + front * f;
        let start = joints[usize::from(BODY_PARENTS[bone]?)]?;
        let along = joints[bone]? - start;
        let skin = carried(&in_space(rest), &unit(along)?, &in_space(direction))?;
        Some(start + along * share + skin * radii_m[bone])
    };
    layout().map(marker).collect()
}

/// Left, up and front: up along the trunk, left along a pair of joints.
fn axes(joints: &BodyJoints, pair: [usize; 2]) -> Option<[Vec3; 3]> {
    let up = unit(joints[TRUNK]? - joints[PELVIS]?)?;
    let across = joints[pair[0]]? - joints[pair[1]]?;
    let left = unit(across - up * across.dot(&up))?;
    Some([left, up, left.cross(&up)])
}

/// `direction`, square to `from`, after the smallest rotation that turns `from` into `to`; `None`
/// where they are opposite.
fn carried(from: &Vec3, to: &Vec3, direction: &Vec3) -> Option<Vec3> {
    let room = 1.0 + from.dot(to);
    if room < 1.0e-4 {
        return None;
    }
    unit(direction - (from + to) * (to.dot(direction) / room))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stereo::visible::capsules;
    use sinew_core::kinematics::forward::posture;
    use sinew_core::random::Stream;
    use sinew_core::skeleton::BodyMeasures;
    use sinew_core::skeleton::full_body::{BODY_ANGLES, body_radii_m, full_body};

    #[test]
    fn markers_lie_on_the_skin_of_their_bones_and_face_both_ways() {
        let measures = BodyMeasures::of_height(1.7).unwrap();
        let (skeleton, radii_m) = (full_body(&measures).unwrap(), body_radii_m(&measures));
        let mut stream = Stream::new(9, 0, 0);
        let (mut towards, mut away) = (0, 0);
        for _ in 0..50 {
            let mut angles = [0.0; BODY_ANGLES];
            for (angle, limit) in angles.iter_mut().zip(skeleton.limits()).skip(3) {
                *angle = limit.clamp(stream.normal() * 0.5);
            }
            let joints = posture(&skeleton, &Vec3::new(0.0, 0.0, 3.0), &angles).ends.map(Some);
            let skins = capsules(&joints, &radii_m);
            for (marker, bone) in markers(&joints, &radii_m).into_iter().zip(layout().map(|(bone, ..)| bone)) {
                let skin = skins.iter().find(|skin| skin.bone == bone).unwrap();
                assert!(skin.distance_m(&marker.unwrap()).abs() < 1.0e-4, "bone {bone}");
                let middle = 0.5 * (skin.start_m + skin.end_m);
                if marker.unwrap().norm() < middle.norm() { towards += 1 } else { away += 1 }
            }
        }
        assert!(towards > 400 && away > 400, "{towards} {away}");
    }

    #[test]
    fn a_small_turn_moves_a_marker_little() {
        let measures = BodyMeasures::of_height(1.7).unwrap();
        let (skeleton, radii_m) = (full_body(&measures).unwrap(), body_radii_m(&measures));
        let at = |angle: f32| {
            let mut angles = [0.3; BODY_ANGLES];
            angles[12] = angle;
            markers(&posture(&skeleton, &Vec3::zeros(), &angles).ends.map(Some), &radii_m)
        };
        for step in 0..100 {
            let angle = step as f32 * 0.025;
            for (now, next) in at(angle).iter().zip(at(angle + 0.01)) {
                assert!((now.unwrap() - next.unwrap()).norm() < 0.01 * 1.5);
            }
        }
    }

    #[test]
    fn a_missing_wrist_takes_the_markers_of_its_forearm() {
        let measures = BodyMeasures::of_height(1.7).unwrap();
        let skeleton = full_body(&measures).unwrap();
        let mut joints = posture(&skeleton, &Vec3::zeros(), &[0.1; BODY_ANGLES]).ends.map(Some);
        joints[FOREARMS[1]] = None;
        let found = markers(&joints, &body_radii_m(&measures));
        assert_eq!(found.len(), MARKERS);
        assert_eq!(found.iter().filter(|marker| marker.is_none()).count(), 3);
    }
}
