//! Which bones make up a limb: chains that branch off the trunk.

use super::tree::Skeleton;

/// Largest number of groups of bones: the trunk and seven limbs. Limbs beyond that count as trunk.
pub const MAX_GROUPS: usize = 8;
/// The group of the bones that are in no limb.
pub const TRUNK_GROUP: usize = 0;

/// The group of each bone: 0 for the trunk, then one for each chain that ends without branching.
///
/// The trunk is the root and every bone from which chains branch off; the chains are arms, legs, a
/// head.
///
/// ```
/// use sinew_core::skeleton::full_body::{FEET, FOREARMS, HEAD, THIGHS, TRUNK, full_body};
/// use sinew_core::skeleton::limbs::TRUNK_GROUP;
/// use sinew_core::skeleton::{BodyMeasures, Limbs};
///
/// let limbs = Limbs::of(&full_body(&BodyMeasures::of_height(1.75)?)?);
/// assert_eq!(limbs.count(), 6, "the trunk, a head, two arms, two legs");
/// assert_eq!(limbs.group(THIGHS[0]), limbs.group(FEET[0]), "a leg from hip to toe");
/// assert_ne!(limbs.group(FOREARMS[0]), limbs.group(HEAD));
/// assert_eq!(limbs.group(TRUNK), TRUNK_GROUP);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limbs<const BONES: usize> {
    group_of: [u8; BONES],
    count: usize,
}

impl<const BONES: usize> Limbs<BONES> {
    /// No limbs: every bone belongs to the trunk.
    #[must_use]
    pub const fn none() -> Self {
        Self { group_of: [TRUNK_GROUP as u8; BONES], count: 1 }
    }

    /// The limbs of `skeleton`.
    #[must_use]
    pub fn of<const ANGLES: usize>(skeleton: &Skeleton<BONES, ANGLES>) -> Self {
        let mut limbs = Self::none();
        let branches = branches(skeleton);
        // Parents come first.
        for (index, bone) in skeleton.bones().iter().enumerate() {
            let Some(parent) = bone.parent.map(usize::from) else { continue };
            let begins = branches.get(parent).copied().unwrap_or(false)
                || skeleton.bones().get(parent).is_some_and(|parent| parent.parent.is_none());
            let is_chain = !branches.get(index).copied().unwrap_or(true);
            let group = limbs.group(parent) as u8;
            let Some(group_of) = limbs.group_of.get_mut(index) else { continue };
            if is_chain && begins && limbs.count < MAX_GROUPS {
                *group_of = limbs.count as u8;
                limbs.count += 1;
            } else if is_chain && !begins {
                *group_of = group;
            }
        }
        limbs
    }

    /// The group of `bone`.
    #[inline]
    #[must_use]
    pub fn group(&self, bone: usize) -> usize {
        self.group_of.get(bone).map_or(TRUNK_GROUP, |&group| usize::from(group))
    }

    /// How many groups there are, the trunk's included.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.count
    }
}

/// Whether any bone from each bone on has more than one child.
fn branches<const BONES: usize, const ANGLES: usize>(skeleton: &Skeleton<BONES, ANGLES>) -> [bool; BONES] {
    let mut branches = [false; BONES];
    let mut has_child = [false; BONES];
    for (index, bone) in skeleton.bones().iter().enumerate().rev() {
        let below = branches[index];
        if let Some(parent) = bone.parent.map(usize::from)
            && let (Some(branches), Some(has_child)) = (branches.get_mut(parent), has_child.get_mut(parent))
        {
            *branches |= below || *has_child;
            *has_child = true;
        }
    }
    branches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::skeleton::full_body::{COLLARS, FEET, FOREARMS, HEAD, PELVIS, SHANKS, THIGHS, TRUNK, full_body};
    use crate::skeleton::upper_body::upper_body;
    use crate::skeleton::{BodyMeasures, Bone, Joint, Limit};

    #[test]
    fn a_body_has_a_head_two_arms_and_two_legs() {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let limbs = Limbs::of(&full_body(&measures).unwrap());
        assert_eq!(limbs.count(), 6);
        assert_eq!([PELVIS, TRUNK].map(|bone| limbs.group(bone)), [TRUNK_GROUP; 2]);
        let whole = [[COLLARS[0], FOREARMS[0]], [COLLARS[1], FOREARMS[1]], [THIGHS[0], FEET[0]], [SHANKS[1], FEET[1]]];
        for [first, last] in whole {
            assert_eq!(limbs.group(first), limbs.group(last));
        }
        let ends = [HEAD, FOREARMS[0], FOREARMS[1], FEET[0], FEET[1]].map(|bone| limbs.group(bone));
        for (index, group) in ends.iter().enumerate() {
            assert!(*group != TRUNK_GROUP && !ends[..index].contains(group), "{ends:?}");
        }
        assert_eq!(Limbs::of(&upper_body(&measures).unwrap()).count(), 4);
    }

    #[test]
    fn a_single_chain_is_a_root_and_one_limb_and_too_many_limbs_are_trunk() {
        let bone = |parent| Bone { parent, joint: Joint::Hinge(Vec3::z()), offset_m: Vec3::x() };
        let limits = [Limit::from_degrees(-90.0, 90.0); 4];
        let chain = Skeleton::new([None, Some(0), Some(1), Some(2)].map(bone), limits).unwrap();
        let limbs = Limbs::of(&chain);
        assert_eq!([0, 1, 2, 3].map(|bone| limbs.group(bone)), [0, 1, 1, 1]);
        let star: [Bone; 12] = core::array::from_fn(|index| bone((index > 0).then_some(0)));
        let limbs = Limbs::of(&Skeleton::new(star, [Limit::from_degrees(-90.0, 90.0); 12]).unwrap());
        assert_eq!(limbs.count(), MAX_GROUPS);
        assert_eq!(limbs.group(7), 7);
        assert_eq!(limbs.group(8), TRUNK_GROUP);
        assert_eq!(Limbs::<12>::none().count(), 1);
    }
}
