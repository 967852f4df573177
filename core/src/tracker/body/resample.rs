//! Resampling limb by limb: a new particle has its trunk from one particle of the last set and each
//! limb from another.
//!
//! A limb that the points like lives on whatever became of the particle's other limbs. So a hundred
//! particles hold a hundred guesses about each of them. What is lost is how a limb's angles go
//! together with its trunk's: after the root is fitted to the points trunks differ little.

use super::state::BodyTracker;
use crate::particle::resampling::{permute, systematic};
use crate::pik::motion::{BodyParticle, BodyScene};
use crate::random::Stream;
use crate::skeleton::limbs::TRUNK_GROUP;
use crate::skeleton::{Limbs, Skeleton};

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// Takes the coordinates of one group over into the next set, by the present weights. The order
    /// is shuffled, so that no two limbs go together because of their places in the set. What the
    /// motion model keeps goes with the trunk.
    pub(super) fn resample_group(
        &mut self,
        skeleton: &Skeleton<BONES, ANGLES>,
        (limbs, group): (&Limbs<BONES>, usize),
        stream: &mut Stream,
    ) {
        systematic(self.weights.normalised(), stream.uniform(), &mut self.ancestors);
        permute(&mut self.ancestors, stream);
        let particles = self.particles.as_ref();
        for (slot, &ancestor) in self.next.as_mut().iter_mut().zip(&self.ancestors) {
            let Some(ancestor) = particles.get(usize::from(ancestor)) else { continue };
            for angle in 0..ANGLES {
                if limbs.group(skeleton.bone_of_angle(angle)) == group {
                    slot.angles_rad[angle] = ancestor.angles_rad[angle];
                }
            }
            if group == TRUNK_GROUP {
                slot.memory = ancestor.memory;
            }
        }
    }

    /// The next set becomes the particles, all alike in weight.
    pub(super) fn join_groups(&mut self, scene: &BodyScene<BONES, ANGLES>) {
        for particle in self.next.as_mut() {
            particle.ends_m = scene.posture(&particle.angles_rad).ends;
        }
        core::mem::swap(&mut self.particles, &mut self.next);
        self.weights.reset();
    }
}
