//! Where rivals of the leading mode begin: limbs of a pair exchanged, the pelvis turned.

use super::super::exchange::{MAX_PAIRS, exchange, pairs};
use super::state::BodyMode;
use crate::skeleton::tree::{FREE_ROOT_COORDINATES, SHIFTS};
use crate::skeleton::{Limbs, Skeleton};
use heapless::Vec;

/// Rivals that begin in a frame at most: each pair exchanged, both, and either turn of the pelvis
/// with the last pair as it is and exchanged.
pub(super) const MAX_RIVALS: usize = MAX_PAIRS + 1 + 4;

/// The rivals of `leader`; where `turn_rad` is zero, none with a turned pelvis.
pub(super) fn rivals<const BONES: usize, const ANGLES: usize>(
    (skeleton, limbs): (&Skeleton<BONES, ANGLES>, &Limbs<BONES>),
    leader: &BodyMode<BONES, ANGLES>,
    turn_rad: f32,
) -> Vec<BodyMode<BONES, ANGLES>, MAX_RIVALS> {
    let body = (skeleton, limbs);
    let (pairs, mut rivals) = (pairs(skeleton, limbs), Vec::new());
    // There is room for all.
    let mut add = |rival| {
        let _ = rivals.push(BodyMode { is_rival: true, ..rival });
    };
    for &pair in &pairs {
        add(exchanged(body, leader, pair));
    }
    if let [arms, legs] = pairs[..] {
        add(exchanged(body, &exchanged(body, leader, arms), legs));
    }
    if turn_rad > 0.0 && skeleton.root_coordinates() == FREE_ROOT_COORDINATES {
        for turn_rad in [turn_rad, -turn_rad] {
            let turned = turned(skeleton, leader, turn_rad);
            add(turned);
            if let Some(&legs) = pairs.last() {
                add(exchanged(body, &turned, legs));
            }
        }
    }
    rivals
}

/// The limbs of a pair exchanged as in a mirror, with their velocities.
fn exchanged<const BONES: usize, const ANGLES: usize>(
    body: (&Skeleton<BONES, ANGLES>, &Limbs<BONES>),
    mode: &BodyMode<BONES, ANGLES>,
    pair: [usize; 2],
) -> BodyMode<BONES, ANGLES> {
    let mut other = *mode;
    exchange(body, &mut other.pose, &mut other.velocity, pair);
    other
}

/// The root turned about its first axis.
fn turned<const BONES: usize, const ANGLES: usize>(
    skeleton: &Skeleton<BONES, ANGLES>,
    mode: &BodyMode<BONES, ANGLES>,
    turn_rad: f32,
) -> BodyMode<BONES, ANGLES> {
    let mut other = *mode;
    if let Some(turn) = other.pose.angles_rad.get_mut(SHIFTS) {
        *turn += turn_rad;
    }
    other.pose.angles_rad = skeleton.clamp(other.pose.angles_rad);
    other.pose.reshape(skeleton);
    other
}

#[cfg(test)]
mod tests {
    use super::super::options::DEFAULT_MODE_OPTIONS;
    use super::super::state::ModeTracker;
    use super::*;
    use crate::math::Vec3;
    use crate::pik::motion::BodyParticle;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{BODY_ANGLES, FOREARMS, HEAD, SHANKS, THIGHS, full_body};

    #[test]
    fn exchanged_legs_are_mirrored_with_their_velocities_and_the_rest_stays() {
        let skeleton = full_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap();
        let limbs = Limbs::of(&skeleton);
        let mut pose = [0.0; BODY_ANGLES];
        // The left leg is ahead, abducted and bent.
        (pose[2], pose[20], pose[21], pose[23]) = (3.0, 0.6, 0.2, 0.9);
        let tracker = ModeTracker::new(&BodyParticle::at(&skeleton, pose), DEFAULT_MODE_OPTIONS, 1).unwrap();
        let mut mode = tracker.modes[0];
        mode.velocity.last.angles_per_s[20] = 4.0;
        mode.velocity.last.ends_m_per_s[SHANKS[0]] = Vec3::z();
        let [arms, legs] = pairs(&skeleton, &limbs)[..] else { panic!("a body has two pairs of limbs") };
        assert_eq!(arms.map(|group| limbs.group(FOREARMS[0]) == group), [true, false]);
        let other = exchanged((&skeleton, &limbs), &mode, legs);
        for (left, right) in [THIGHS, SHANKS].map(|[left, right]| (left, right)) {
            for (from, to) in [(left, right), (right, left)] {
                let (was_m, is_m) = (mode.pose.ends_m[from], other.pose.ends_m[to]);
                assert!((Vec3::new(-was_m.x, was_m.y, was_m.z) - is_m).norm() < 1.0e-5, "{was_m} {is_m}");
            }
        }
        assert_eq!(other.velocity.last.angles_per_s[25], 4.0);
        assert_eq!(other.velocity.last.ends_m_per_s[SHANKS[1]], Vec3::z());
        assert_eq!(other.pose.ends_m[HEAD], mode.pose.ends_m[HEAD]);
        assert_eq!(exchanged((&skeleton, &limbs), &other, legs), mode, "twice is not at all");
    }
}
