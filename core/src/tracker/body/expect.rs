//! Where the body is expected before any particle is drawn.

use super::state::BodyTracker;
use crate::observation::point_cloud::PointBlock;
use crate::pik::motion::{BodyParticle, BodyScene};
use crate::pik::root::RootProcess;
use crate::skeleton::Limbs;
use crate::skeleton::limbs::TRUNK_GROUP;

/// Share of the estimate's velocity with which the body is expected to go on: between staying and
/// going on. Chosen: the middle of both.
const EXPECTED_PERSISTENCE: f32 = 0.5;

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// Where the body is expected: it goes on as it moved, and where the root is aligned that pose
    /// is fitted to the points. The root of every particle sets out from there; limbs are
    /// weighed by what they explain beside it.
    pub(super) fn expected_pose(
        &self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        root: &RootProcess,
        blocks: &[PointBlock],
        dt_s: f32,
    ) -> [f32; ANGLES] {
        let velocity_per_s = self.velocity.expected(0.0, dt_s).angles_per_s;
        let root_change = root.expected_change(&velocity_per_s, dt_s);
        let mut expected_rad = self.before.angles_rad;
        for (index, angle) in expected_rad.iter_mut().enumerate() {
            *angle += if index < scene.skeleton.root_coordinates() {
                root_change.get(index).copied().unwrap_or(0.0)
            } else {
                EXPECTED_PERSISTENCE * velocity_per_s[index] * dt_s
            };
        }
        let expected_rad = scene.skeleton.clamp(expected_rad);
        let Some(mut alignment) = self.options.alignment else { return expected_rad };
        alignment.coarse_to_fine &= self.noise.is_any_fast(limbs.count());
        let unseen = core::array::from_fn(|i| self.noise.is_let_loose(limbs.group(scene.skeleton.bone_of_angle(i))));
        alignment.fit_root(scene, blocks, (&expected_rad, &unseen), dt_s)
    }

    /// What every particle's root changes by, and its trunk where that is fitted to the points.
    pub(super) fn shared_change(
        &self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        expected_rad: &[f32; ANGLES],
    ) -> [Option<f32>; ANGLES] {
        let skeleton = &scene.skeleton;
        let fit_trunk = self.options.alignment.is_some_and(|alignment| alignment.fit_trunk);
        core::array::from_fn(|index| {
            let is_trunk = limbs.group(skeleton.bone_of_angle(index)) == TRUNK_GROUP;
            let is_shared = index < skeleton.root_coordinates() || (fit_trunk && is_trunk);
            is_shared.then(|| expected_rad[index] - self.before.angles_rad[index])
        })
    }
}
