//! What each limb explains of a frame's points while the rest of the body is where it is expected.
//!
//! The likelihood (24) of a whole pose hardly sees one limb among thirty coordinates. How much nearer a limb brings the skin to the points
//! than the expected skin of all others does is evidence about that limb alone, at the cost of the likelihood itself.

use super::body_surface::BodySurface;
use super::point_cloud::{BLOCK_POINTS, PointBlock};
use super::point_likelihood::{NearCapsules, PointLikelihood, lower_to};
use crate::math::{max, min, sqrt};
use crate::skeleton::limbs::{Limbs, MAX_GROUPS, TRUNK_GROUP};
use heapless::Vec;

/// Blocks of points that are looked at; of a larger cloud every n-th is, and counts n times.
pub const MAX_BLOCKS: usize = 256;
/// An owner that is no group.
const NOBODY: u8 = u8::MAX;

/// Log-weights of one pose: the whole body's likelihood in the trunk's place, then what each limb adds.
pub type GroupLogs = [f32; MAX_GROUPS];

/// The expected skin about a block of points.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ExpectedSkin {
    /// Squared distances from the nearest group's skin, at most tau; squared metres.
    nearest: [f32; BLOCK_POINTS],
    /// From the nearest skin of any other group.
    other: [f32; BLOCK_POINTS],
    /// The nearest group.
    owner: [u8; BLOCK_POINTS],
    /// For each group the greatest distance of a point from all others' skin, metres: beyond it the group adds nothing.
    reach_m: [f32; MAX_GROUPS],
}

/// The expected body about all points of a frame.
#[derive(Debug, Clone)]
pub struct ExpectedBody<const BONES: usize> {
    limbs: Limbs<BONES>,
    skins: Vec<ExpectedSkin, MAX_BLOCKS>,
    stride: usize,
}

impl<const BONES: usize> ExpectedBody<BONES> {
    /// Nothing is expected yet of a body with these limbs.
    #[must_use]
    pub const fn new(limbs: Limbs<BONES>) -> Self {
        Self { limbs, skins: Vec::new(), stride: 1 }
    }

    /// The limbs.
    #[must_use]
    pub const fn limbs(&self) -> &Limbs<BONES> {
        &self.limbs
    }

    /// Takes `surface` as what is expected about `blocks`.
    pub fn expect(&mut self, likelihood: &PointLikelihood, surface: &BodySurface<BONES>, blocks: &[PointBlock]) {
        self.stride = blocks.len().div_ceil(MAX_BLOCKS).max(1);
        self.skins.clear();
        for block in blocks.iter().step_by(self.stride) {
            // The stride was taken so that all fit.
            let _ = self.skins.push(ExpectedSkin::about(block, surface, likelihood.outlier_m, &self.limbs));
        }
    }

    /// The log-weights of the pose with `surface`, of the blocks that were expected: its log-likelihood, up to its constant, and for each
    /// limb by how much it raises that of the other groups' expected skin.
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
            for group in 0..self.limbs.count() {
                let Some(own) = self.squared_m(group, &near, surface, block, tau) else { continue };
                for i in 0..BLOCK_POINTS {
                    all[i] = min(all[i], own[i]);
                }
                if group != TRUNK_GROUP {
                    add(&mut sums, group, skin.gain(group, &own, block.count));
                }
            }
            let sum: f32 = all.iter().take(usize::from(block.count)).sum();
            add(&mut sums, TRUNK_GROUP, -sum);
        }
        let scale = self.stride as f32 / (2.0 * likelihood.std_m * likelihood.std_m);
        sums.map(|sum| sum * scale)
    }

    /// Squared distances of a block's points from one group's skin, at most tau; `None` if none of it is near.
    #[inline]
    fn squared_m(
        &self,
        group: usize,
        near: &NearCapsules,
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        tau: f32,
    ) -> Option<[f32; BLOCK_POINTS]> {
        let mut own = None;
        for &index in near.indices() {
            let Some(seen) = surface.capsules.get(usize::from(index)) else { continue };
            if self.limbs.group(seen.bone) == group {
                lower_to(own.get_or_insert([tau; BLOCK_POINTS]), seen, surface, block);
            }
        }
        own
    }
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
        let mut skin =
            Self { nearest: everywhere, other: everywhere, owner: [NOBODY; BLOCK_POINTS], reach_m: [0.0; MAX_GROUPS] };
        for group in 0..limbs.count() {
            let mut own = everywhere;
            for seen in surface.capsules.iter().filter(|seen| limbs.group(seen.bone) == group) {
                lower_to(&mut own, seen, surface, block);
            }
            for i in 0..BLOCK_POINTS {
                let is_nearest = own[i] < skin.nearest[i];
                skin.other[i] = if is_nearest { skin.nearest[i] } else { min(skin.other[i], own[i]) };
                skin.nearest[i] = min(skin.nearest[i], own[i]);
                skin.owner[i] = if is_nearest { group as u8 } else { skin.owner[i] };
            }
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
            others[i] = if usize::from(self.owner[i]) == group { self.other[i] } else { others[i] };
        }
        others
    }

    /// What the trunk, which is weighed with all limbs, needs no reach for.
    #[inline]
    fn reach_of(&self, group: usize) -> f32 {
        if group == TRUNK_GROUP { 0.0 } else { self.reach_m.get(group).copied().unwrap_or(0.0) }
    }

    /// By how much squared distances `own` of one group lie below those of all others, summed over the block's points.
    #[inline]
    fn gain(&self, group: usize, own: &[f32; BLOCK_POINTS], count: u8) -> f32 {
        let others = self.others(group);
        let mut sum = 0.0;
        for i in 0..BLOCK_POINTS {
            let nearer = max(others[i] - own[i], 0.0);
            sum += if i < usize::from(count) { nearer } else { 0.0 };
        }
        sum
    }
}

#[cfg(test)]
#[path = "limb_likelihood_tests.rs"]
mod tests;
