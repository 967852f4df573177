//! Likelihood of each limb, given a frame's points and the expected rest of the body.
//!
//! The likelihood PIK (24) of a whole pose is barely sensitive to one limb among thirty
//! coordinates. How much nearer a limb brings the skin to the points than the expected skin of all
//! others is evidence about that limb alone. It takes as long as PIK (24).

use super::body_surface::BodySurface;
use super::point_cloud::{BLOCK_POINTS, PointBlock};
use super::point_likelihood::{NearCapsules, PointLikelihood, lower_to};
use crate::math::{max, min, sqrt};
use crate::skeleton::limbs::{Limbs, MAX_GROUPS, TRUNK_GROUP};
use heapless::Vec;

/// Blocks of points that are used; of a larger cloud every n-th is, with n times the weight.
pub const MAX_BLOCKS: usize = 256;
/// An owner that is no group.
const NO_GROUP: u32 = u32::MAX;

/// Log-weights of one pose: the whole body's likelihood in the trunk's place, then each limb's own.
///
/// ```
/// use sinew_core::observation::limb_likelihood::GroupLogs;
/// use sinew_core::skeleton::limbs::{MAX_GROUPS, TRUNK_GROUP};
///
/// // Without limbs, the whole body's weight stands in the trunk's place and all others are zero.
/// let mut logs: GroupLogs = [0.0; MAX_GROUPS];
/// logs[TRUNK_GROUP] = -3.5;
/// assert_eq!(logs.iter().sum::<f32>(), -3.5);
/// ```
pub type GroupLogs = [f32; MAX_GROUPS];

/// The expected skin about a block of points.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ExpectedSkin {
    /// Squared distances from the nearest group's skin, at most tau, square metres; zero for
    /// invalid points.
    nearest: [f32; BLOCK_POINTS],
    /// The same from the nearest skin of any other group.
    other: [f32; BLOCK_POINTS],
    /// The nearest group; as wide as a distance, so that loops over points are loops over vectors.
    owner: [u32; BLOCK_POINTS],
    /// For each group the greatest distance of a point from all others' skin, metres: beyond it the
    /// group adds nothing.
    reach_m: [f32; MAX_GROUPS],
}

/// The expected body about all points of a frame.
///
/// ```
/// use sinew_core::observation::limb_likelihood::ExpectedBody;
/// use sinew_core::pik::motion::BodyScene;
/// use sinew_core::skeleton::Limbs;
/// use sinew_core::skeleton::arm::FOREARM;
/// # use sinew_core::math::Vec3;
/// # use sinew_core::observation::{point_cloud::PointCloud, point_likelihood::PointLikelihood};
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let likelihood = PointLikelihood { std_m: 0.05, outlier_m: 0.15 };
/// # let camera_m = Vec3::new(0.0, 0.0, -2.0);
/// # let radii_m = [0.05, 0.04];
/// # let scene =
/// #     BodyScene { skeleton, radii_m, camera_m, likelihood, self_penetration: None };
/// # let points_of = |pose: &[f32; 4]| {
/// #     let surface = scene.surface(&scene.posture(pose));
/// #     let mut points_m = core::array::from_fn::<Vec3, 32, _>(|i| {
/// #         let bone = &surface.capsules[i % 2].capsule;
/// #         let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 32.0);
/// #         bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
/// #     });
/// #     let mut cloud = PointCloud::<2>::new();
/// #     let _ = cloud.set(&mut points_m, &scene.camera_m);
/// #     cloud
/// # };
///
/// // An elbow was expected at 1.0 rad, the points show it at 1.4 rad.
/// let [expected, shown] = [1.0, 1.4].map(|elbow_rad| [0.5, 0.1, 0.1, elbow_rad]);
/// let cloud = points_of(&shown);
/// let surface_of = |pose| scene.surface(&scene.posture(pose));
/// let mut body = ExpectedBody::new(Limbs::of(&scene.skeleton));
/// body.expect(&scene.likelihood, &surface_of(&expected), cloud.blocks());
/// // The forearm is a limb of its own: a pose that has it where the points are gains by it.
/// let forearm = body.limbs().group(FOREARM);
/// let gain = |pose| {
///     body.log_weights(&scene.likelihood, &surface_of(pose), cloud.blocks())[forearm]
/// };
/// assert!(gain(&shown) > gain(&expected) + 1.0, "{} {}", gain(&shown), gain(&expected));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ExpectedBody<const BONES: usize> {
    limbs: Limbs<BONES>,
    skins: Vec<ExpectedSkin, MAX_BLOCKS>,
    stride: usize,
}

impl<const BONES: usize> ExpectedBody<BONES> {
    /// A body with these limbs, without an expected pose.
    #[must_use]
    pub const fn new(limbs: Limbs<BONES>) -> Self {
        Self { limbs, skins: Vec::new(), stride: 1 }
    }

    /// The limbs.
    #[must_use]
    pub const fn limbs(&self) -> &Limbs<BONES> {
        &self.limbs
    }

    /// Other limbs, from the next [`Self::expect`] on.
    pub const fn set_limbs(&mut self, limbs: Limbs<BONES>) {
        self.limbs = limbs;
    }

    /// Sets `surface` as the expected body about `blocks`.
    pub fn expect(&mut self, likelihood: &PointLikelihood, surface: &BodySurface<BONES>, blocks: &[PointBlock]) {
        self.stride = blocks.len().div_ceil(MAX_BLOCKS).max(1);
        self.skins.clear();
        for block in blocks.iter().step_by(self.stride) {
            // The stride was taken so that all fit.
            let _ = self.skins.push(ExpectedSkin::about(block, surface, likelihood.outlier_m, &self.limbs));
        }
    }

    /// The log-weights of the pose with `surface` on the blocks of [`Self::expect`].
    ///
    /// First the log-likelihood of the pose, up to its constant. Then, for each limb, how much it
    /// raises the log-likelihood of the other groups' expected skin.
    #[must_use]
    pub fn log_weights(
        &self,
        likelihood: &PointLikelihood,
        surface: &BodySurface<BONES>,
        blocks: &[PointBlock],
    ) -> GroupLogs {
        let tau = likelihood.outlier_m * likelihood.outlier_m;
        let mut sums = [0.0; MAX_GROUPS];
        let mut near = NearCapsules::new();
        for (block, skin) in blocks.iter().step_by(self.stride).zip(&self.skins) {
            near.find_or_within(surface, block, likelihood.outlier_m, |bone| skin.reach_of(self.limbs.group(bone)));
            let mut all = [tau; BLOCK_POINTS];
            let mut left = self.groups_of(&near, surface);
            while left != 0 {
                let group = left.trailing_zeros() as usize;
                left &= left - 1;
                let own = self.squared_m(group, &near, surface, block, tau);
                for i in 0..BLOCK_POINTS {
                    all[i] = min(all[i], own[i]);
                }
                if group != TRUNK_GROUP {
                    add(&mut sums, group, skin.gain(group, &own));
                }
            }
            let sum: f32 = all.iter().take(usize::from(block.count)).sum();
            add(&mut sums, TRUNK_GROUP, -sum);
        }
        let scale = self.stride as f32 / (2.0 * likelihood.std_m * likelihood.std_m);
        sums.map(|sum| sum * scale)
    }

    /// The groups of the capsules in `near`, a bit each.
    #[inline]
    fn groups_of(&self, near: &NearCapsules, surface: &BodySurface<BONES>) -> u32 {
        let mut groups = 0;
        for index in near.indices() {
            if let Some(seen) = surface.capsules.get(index) {
                groups |= 1 << self.limbs.group(seen.bone);
            }
        }
        groups
    }

    /// Squared distances of a block's points from one group's skin, at most tau.
    #[inline]
    fn squared_m(
        &self,
        group: usize,
        near: &NearCapsules,
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        tau: f32,
    ) -> [f32; BLOCK_POINTS] {
        let mut own = [tau; BLOCK_POINTS];
        for index in near.indices() {
            let Some(seen) = surface.capsules.get(index) else { continue };
            if self.limbs.group(seen.bone) == group {
                lower_to(&mut own, seen, surface, block);
            }
        }
        own
    }
}

/// Squared distances of a block's points from the skin of each group of bones, at most `most`;
/// square metres.
pub(crate) fn squared_by_group<const BONES: usize>(
    surface: &BodySurface<BONES>,
    limbs: &Limbs<BONES>,
    block: &PointBlock,
    most: f32,
) -> [[f32; BLOCK_POINTS]; MAX_GROUPS] {
    let mut squared_m = [[most; BLOCK_POINTS]; MAX_GROUPS];
    for seen in &surface.capsules {
        if let Some(least) = squared_m.get_mut(limbs.group(seen.bone)) {
            lower_to(least, seen, surface, block);
        }
    }
    squared_m
}

fn add(sums: &mut GroupLogs, group: usize, value: f32) {
    if let Some(sum) = sums.get_mut(group) {
        *sum += value;
    }
}

impl ExpectedSkin {
    fn about<const BONES: usize>(
        block: &PointBlock,
        surface: &BodySurface<BONES>,
        outlier_m: f32,
        limbs: &Limbs<BONES>,
    ) -> Self {
        let tau = outlier_m * outlier_m;
        let everywhere = [tau; BLOCK_POINTS];
        let mut skin = Self {
            nearest: everywhere,
            other: everywhere,
            owner: [NO_GROUP; BLOCK_POINTS],
            reach_m: [0.0; MAX_GROUPS],
        };
        for (group, own) in squared_by_group(surface, limbs, block, tau).iter().enumerate().take(limbs.count()) {
            for i in 0..BLOCK_POINTS {
                let is_nearest = own[i] < skin.nearest[i];
                skin.other[i] = if is_nearest { skin.nearest[i] } else { min(skin.other[i], own[i]) };
                skin.nearest[i] = min(skin.nearest[i], own[i]);
                skin.owner[i] = if is_nearest { group as u32 } else { skin.owner[i] };
            }
        }
        for i in usize::from(block.count)..BLOCK_POINTS {
            (skin.nearest[i], skin.other[i]) = (0.0, 0.0);
        }
        for group in 0..limbs.count() {
            let greatest = skin.others(group).into_iter().fold(0.0, max);
            if let Some(reach_m) = skin.reach_m.get_mut(group) {
                *reach_m = sqrt(greatest);
            }
        }
        skin
    }

    /// Squared distances from the skin of all groups but one.
    #[inline]
    fn others(&self, group: usize) -> [f32; BLOCK_POINTS] {
        let mut others = self.nearest;
        for i in 0..BLOCK_POINTS {
            others[i] = if self.owner[i] == group as u32 { self.other[i] } else { others[i] };
        }
        others
    }

    /// Largest distance at which a group's skin adds something, metres; the trunk is weighted with
    /// the whole pose.
    #[inline]
    fn reach_of(&self, group: usize) -> f32 {
        if group == TRUNK_GROUP { 0.0 } else { self.reach_m.get(group).copied().unwrap_or(0.0) }
    }

    /// By how much squared distances `own` of one group lie below those of all others, summed over
    /// the block's points.
    #[inline]
    fn gain(&self, group: usize, own: &[f32; BLOCK_POINTS]) -> f32 {
        let mut nearer = self.others(group);
        for i in 0..BLOCK_POINTS {
            nearer[i] = max(nearer[i] - own[i], 0.0);
        }
        nearer.iter().sum()
    }
}

#[cfg(test)]
#[path = "limb_likelihood_tests.rs"]
mod tests;
