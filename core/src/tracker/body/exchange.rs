//! Limbs of a pair exchanged as in a mirror: another explanation of the same points.

use super::velocity::EstimateVelocity;
use crate::pik::motion::BodyParticle;
use crate::skeleton::{Limbs, Skeleton};
use heapless::Vec;

/// Pairs of limbs that are exchanged: arms, then legs.
pub(super) const MAX_PAIRS: usize = 2;

/// Groups of limbs that have the same joints, two by two.
pub(super) fn pairs<const BONES: usize, const ANGLES: usize>(
    skeleton: &Skeleton<BONES, ANGLES>,
    limbs: &Limbs<BONES>,
) -> Vec<[usize; 2], MAX_PAIRS> {
    let joints = |group: usize| {
        let bones = skeleton.bones().iter().enumerate().filter(move |(bone, _)| limbs.group(*bone) == group);
        bones.map(|(_, bone)| bone.joint.angle_count())
    };
    let mut pairs = Vec::new();
    for first in 1..limbs.count() {
        if let Some(second) = (first + 1..limbs.count()).find(|&second| joints(first).eq(joints(second))) {
            // A pair beyond the capacity is not exchanged.
            let _ = pairs.push([first, second]);
        }
    }
    pairs
}

/// Exchanges the limbs of a pair in a pose, and their velocities.
pub(super) fn exchange<const BONES: usize, const ANGLES: usize>(
    (skeleton, limbs): (&Skeleton<BONES, ANGLES>, &Limbs<BONES>),
    pose: &mut BodyParticle<BONES, ANGLES>,
    velocity: &mut EstimateVelocity<BONES, ANGLES>,
    [left, right]: [usize; 2],
) {
    let angles = |group| (0..ANGLES).filter(move |&angle| limbs.group(skeleton.bone_of_angle(angle)) == group);
    let bones = |group| (0..BONES).filter(move |&bone| limbs.group(bone) == group);
    for velocity in [&mut velocity.last, &mut velocity.change] {
        for (l, r) in angles(left).zip(angles(right)) {
            velocity.angles_per_s.swap(l, r);
        }
        for (l, r) in bones(left).zip(bones(right)) {
            velocity.ends_m_per_s.swap(l, r);
        }
    }
    for (l, r) in angles(left).zip(angles(right)) {
        pose.angles_rad.swap(l, r);
    }
    pose.angles_rad = skeleton.clamp(pose.angles_rad);
    pose.reshape(skeleton);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::upper_body::upper_body;

    #[test]
    fn an_upper_body_has_one_pair() {
        let skeleton = upper_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap();
        assert_eq!(pairs(&skeleton, &Limbs::of(&skeleton)).len(), 1);
    }
}
