//! How well a pose explains a cloud of points: PIK (24) to (29).

use super::body_surface::{BodySurface, SeenCapsule};
use super::point_cloud::{BLOCK_POINTS, PointBlock};
use crate::math::{Vec3, max, min, sqrt_branch_free};
use crate::numeric::rolled::HAS_VECTORS;
use heapless::Vec;

/// Points whose standard deviation along their lines of sight exceeds that across them by less than
/// this share of it count as points without one, for which loops run on vectors.
///
/// Chosen: the variance differs by less than a quarter; tuning runners have 2.94 cm with it, and
/// 2.92 where every share counts.
const LEAST_STRETCH_RATIO: f32 = 0.5;

/// The robust metric and its scale.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::body_surface::BodySurface;
/// use sinew_core::observation::{point_cloud::PointCloud, point_likelihood::PointLikelihood};
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // An arm that hangs two metres before the camera, 4 cm thick at the forearm.
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// let hanging = posture(&arm, &Vec3::new(0.0, 0.0, 2.0), &[0.0; 4]);
/// let surface = BodySurface::new(&hanging, &[0.05, 0.04], Vec3::zeros());
/// // One point a standard deviation before the skin costs a half, one far off no more than an
/// // outlier.
/// let likelihood = PointLikelihood { std_m: 0.1, outlier_m: 0.2 };
/// let mut cloud = PointCloud::<1>::new();
/// let _ =
///     cloud.set(&mut [Vec3::new(0.0, 0.5, 1.86), Vec3::new(0.9, 0.0, 3.0)], &Vec3::zeros());
/// assert!((likelihood.log_likelihood(&surface, cloud.blocks()) + 0.5 + 2.0).abs() < 1e-3);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLikelihood {
    /// sigma of PIK (25), metres.
    pub std_m: f32,
    /// Root of tau of PIK (29): beyond this distance a point is an outlier, metres.
    pub outlier_m: f32,
}

impl PointLikelihood {
    /// log p(X | theta), up to its constant: minus the sum of min(d^2, tau) / 2 sigma^2.
    #[must_use]
    pub fn log_likelihood<const BONES: usize>(&self, surface: &BodySurface<BONES>, blocks: &[PointBlock]) -> f32 {
        self.log_likelihood_of(surface, blocks.iter())
    }

    /// As [`Self::log_likelihood`], of some of the blocks.
    #[must_use]
    pub fn log_likelihood_of<'b, const BONES: usize>(
        &self,
        surface: &BodySurface<BONES>,
        blocks: impl Iterator<Item = &'b PointBlock>,
    ) -> f32 {
        let tau = self.outlier_m * self.outlier_m;
        let mut sum = 0.0;
        let mut near = NearCapsules::new();
        for block in blocks {
            let stretch = self.stretch(block);
            near.find(surface, block, self.outlier_m, stretch);
            let mut least = [tau; BLOCK_POINTS];
            for capsule in &near.found {
                let seen = surface.capsules.get(usize::from(capsule.index));
                if let Some(seen) = seen.filter(|_| capsule.lowers_any(&least)) {
                    lower_to_stretched(&mut least, seen, surface, block, stretch);
                }
            }
            for (i, squared) in least.into_iter().enumerate() {
                sum += if i < usize::from(block.count) { squared } else { 0.0 };
            }
        }
        -sum / (2.0 * self.std_m * self.std_m)
    }
}

impl PointLikelihood {
    /// How many times the variance of a block's points along their lines of sight exceeds that
    /// across them, less one; zero where they are nearly the same.
    #[inline]
    pub(super) fn stretch(&self, block: &PointBlock) -> f32 {
        let ratio = block.along_std_m / self.std_m;
        if ratio < LEAST_STRETCH_RATIO { 0.0 } else { ratio * ratio }
    }

    /// sigma^2 of a residual along the unit vector `normal` of a point that is seen along
    /// `sight`, over that across the line of sight.
    #[inline]
    pub(super) fn variance_ratio(stretch: f32, normal: &Vec3, sight: &Vec3) -> f32 {
        let along = normal.dot(sight);
        1.0 + stretch * along * along / max(sight.dot(sight), f32::MIN_POSITIVE)
    }
}

/// As [`lower_to`], of points whose variance along their lines of sight is 1 + `stretch` times
/// that across them. A residual d that has a part a along the line of sight has the variance
/// sigma^2 (1 + stretch a^2 / d^2), that of its own direction. The distance is in units of the
/// sigma across.
#[inline(always)]
fn lower_to_stretched<const BONES: usize>(
    least: &mut [f32; BLOCK_POINTS],
    seen: &SeenCapsule,
    surface: &BodySurface<BONES>,
    block: &PointBlock,
    stretch: f32,
) {
    if !(stretch > 0.0) {
        lower_to(least, seen, surface, block);
        return;
    }
    let v = &seen.across;
    let line_has_side = v.x != 0.0 || v.y != 0.0 || v.z != 0.0;
    let radius_m = seen.capsule.radius_m;
    for i in 0..BLOCK_POINTS {
        let at = NearAxis::of(seen, surface, block, i);
        let per_sight = if at.t > 0.5 { seen.per_squared_sight[1] } else { seen.per_squared_sight[0] };
        let along = at.towards * at.towards * per_sight;
        let side = at.off[0] * v.x + at.off[1] * v.y + at.off[2] * v.z;
        let beside = max(at.squared - along, 0.0);
        let inner = (at.t > 0.0) & (at.t < 1.0) & line_has_side;
        let is_seen = at.towards >= 0.0;
        let rho = if is_seen {
            at.squared
        } else if inner {
            side * side
        } else {
            beside
        };
        let distance = at.squared_to_skin(radius_m, rho);
        // Of a seen point the residual has the direction of x - p; of a hidden one all of the way
        // along the line of sight is part of it.
        let part = if is_seen { along * distance / max(at.squared, f32::MIN_POSITIVE) } else { min(along, distance) };
        let stretched = distance * distance / max(distance + stretch * part, f32::MIN_POSITIVE);
        least[i] = min(least[i], stretched);
    }
}

/// Lowers each entry of `least` to the squared distance of the block's points from one capsule's
/// visible skin, squared metres.
///
/// A point that is seen from p: (|x-p| - r)^2. A hidden one: |x-p|^2 - 2 r rho + r^2. There rho is
/// the part of x - p along v, or across the line of sight on the round ends. Both are one formula
/// in rho. Most points are seen: the hidden case is computed only for blocks that have a point to
/// which it matters. Loops are branch-free, so that they run on vectors.
#[inline(always)]
pub(super) fn lower_to<const BONES: usize>(
    least: &mut [f32; BLOCK_POINTS],
    seen: &SeenCapsule,
    surface: &BodySurface<BONES>,
    block: &PointBlock,
) {
    if !HAS_VECTORS {
        lower_one_by_one(least, seen, surface, block);
        return;
    }
    // A word and no flag, so that the loop stays one over vectors.
    let mut hidden_nearer = 0;
    for i in 0..BLOCK_POINTS {
        let at = NearAxis::of(seen, surface, block, i);
        let distance = at.squared_to_skin(seen.capsule.radius_m, at.squared);
        let is_seen = at.towards >= 0.0;
        // No part of a capsule's skin is nearer than all of it.
        hidden_nearer |= u32::from(!is_seen & (distance < least[i]));
        least[i] = if is_seen { min(least[i], distance) } else { least[i] };
    }
    if hidden_nearer != 0 {
        lower_hidden_to(least, seen, surface, block);
    }
}

/// Points farther from the axis than this times what can matter are left out.
/// Chosen: a thousand times the rounding of the squared distance.
const BEYOND_ROUNDING: f32 = 1.001;

/// As [`lower_to`], point by point: the same bits. A point whose axis is too far for its skin to be
/// nearer than what is known is done after its distance from the axis.
fn lower_one_by_one<const BONES: usize>(
    least: &mut [f32; BLOCK_POINTS],
    seen: &SeenCapsule,
    surface: &BodySurface<BONES>,
    block: &PointBlock,
) {
    let v = &seen.across;
    let line_has_side = v.x != 0.0 || v.y != 0.0 || v.z != 0.0;
    let radius_m = seen.capsule.radius_m;
    for i in 0..BLOCK_POINTS {
        let at = NearAxis::of(seen, surface, block, i);
        let far_m = BEYOND_ROUNDING * (radius_m + sqrt_branch_free(least[i]));
        if at.squared > far_m * far_m {
            continue;
        }
        let rho = if at.towards >= 0.0 {
            at.squared
        } else if at.t > 0.0 && at.t < 1.0 && line_has_side {
            let side = at.off[0] * v.x + at.off[1] * v.y + at.off[2] * v.z;
            side * side
        } else {
            let per_sight = if at.t > 0.5 { seen.per_squared_sight[1] } else { seen.per_squared_sight[0] };
            max(at.squared - at.towards * at.towards * per_sight, 0.0)
        };
        least[i] = min(least[i], at.squared_to_skin(radius_m, rho));
    }
}

/// As [`lower_to`], of the points that are behind the capsule alone.
#[inline(always)]
fn lower_hidden_to<const BONES: usize>(
    least: &mut [f32; BLOCK_POINTS],
    seen: &SeenCapsule,
    surface: &BodySurface<BONES>,
    block: &PointBlock,
) {
    let v = &seen.across;
    let line_has_side = v.x != 0.0 || v.y != 0.0 || v.z != 0.0;
    for i in 0..BLOCK_POINTS {
        let at = NearAxis::of(seen, surface, block, i);
        let side = at.off[0] * v.x + at.off[1] * v.y + at.off[2] * v.z;
        let per_sight = if at.t > 0.5 { seen.per_squared_sight[1] } else { seen.per_squared_sight[0] };
        let beside = max(at.squared - at.towards * at.towards * per_sight, 0.0);
        let inner = (at.t > 0.0) & (at.t < 1.0) & line_has_side;
        let distance = at.squared_to_skin(seen.capsule.radius_m, if inner { side * side } else { beside });
        least[i] = if at.towards < 0.0 { min(least[i], distance) } else { least[i] };
    }
}

/// A point beside the axis of a capsule.
pub(super) struct NearAxis {
    /// Where the nearest point of the axis lies: 0 at the start, 1 at the end.
    pub(super) t: f32,
    /// From there to the point, metres.
    pub(super) off: [f32; 3],
    /// Its square, square metres.
    pub(super) squared: f32,
    /// Its product with the way to the camera: negative on the hidden side.
    pub(super) towards: f32,
}

impl NearAxis {
    #[inline(always)]
    pub(super) fn of<const BONES: usize>(
        seen: &SeenCapsule,
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        i: usize,
    ) -> Self {
        let (a, u, c) = (&seen.capsule.start_m, &seen.along_m, &surface.camera_m);
        let (x, y, z) = (block.x[i], block.y[i], block.z[i]);
        let share = ((x - a.x) * u.x + (y - a.y) * u.y + (z - a.z) * u.z) * seen.per_squared_length;
        let t = min(max(share, 0.0), 1.0);
        let (px, py, pz) = (a.x + t * u.x, a.y + t * u.y, a.z + t * u.z);
        let off = [x - px, y - py, z - pz];
        let squared = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
        let towards = off[0] * (c.x - px) + off[1] * (c.y - py) + off[2] * (c.z - pz);
        Self { t, off, squared, towards }
    }

    /// |x-p|^2 - 2 r rho + r^2, where rho squared is given.
    #[inline(always)]
    fn squared_to_skin(&self, radius_m: f32, squared_rho: f32) -> f32 {
        max(self.squared - 2.0 * radius_m * sqrt_branch_free(squared_rho) + radius_m * radius_m, 0.0)
    }
}

/// A block's points with the capsules whose visible skin is nearest to each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NearestSkin {
    /// Squared distances from it, squared metres; the square of the outlier distance where no skin
    /// is nearer.
    pub squared_m: [f32; BLOCK_POINTS],
    /// Places of the capsules in the surface's list; beyond its end where no skin is near.
    pub capsule: [u8; BLOCK_POINTS],
}

impl NearestSkin {
    /// The nearest skin of `surface` within `outlier_m` of each point of `block`.
    #[must_use]
    pub fn find<const BONES: usize>(surface: &BodySurface<BONES>, block: &PointBlock, outlier_m: f32) -> Self {
        Self::find_stretched(surface, block, outlier_m, 0.0)
    }

    /// As [`Self::find`], in units of the sigma across the line of sight
    /// ([`PointLikelihood::stretch`]).
    pub(super) fn find_stretched<const BONES: usize>(
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        outlier_m: f32,
        stretch: f32,
    ) -> Self {
        let mut near = NearCapsules::new();
        near.find(surface, block, outlier_m, stretch);
        let mut nearest = Self { squared_m: [outlier_m * outlier_m; BLOCK_POINTS], capsule: [u8::MAX; BLOCK_POINTS] };
        for capsule in &near.found {
            let Some(seen) = surface.capsules.get(usize::from(capsule.index)) else { continue };
            let before = nearest.squared_m;
            if !capsule.lowers_any(&before) {
                continue;
            }
            lower_to_stretched(&mut nearest.squared_m, seen, surface, block, stretch);
            for i in 0..BLOCK_POINTS {
                if nearest.squared_m[i] < before[i] {
                    nearest.capsule[i] = capsule.index;
                }
            }
        }
        nearest
    }

    /// The capsules that are the nearest to some point, a bit each.
    #[inline]
    pub(super) fn owners(&self) -> u32 {
        self.capsule.iter().fold(0, |owners, &capsule| owners | 1_u32.checked_shl(u32::from(capsule)).unwrap_or(0))
    }
}

/// Capsules that can be the nearest to some point of a block; 32 at most, as a skeleton's bones.
/// The one that the block is nearest to comes first.
#[derive(Debug)]
pub(super) struct NearCapsules {
    found: Vec<NearCapsule, 32>,
}

/// A capsule near a block of points.
#[derive(Debug, Clone, Copy)]
struct NearCapsule {
    /// Its place in the surface's list.
    index: u8,
    /// No squared distance of a point, as [`NearestSkin`] counts it, is less, square metres.
    min_squared_m2: f32,
}

impl NearCapsule {
    /// Whether a point can be nearer to this capsule than the root of its entry in `squared_m`.
    #[inline(always)]
    fn lowers_any(&self, squared_m: &[f32; BLOCK_POINTS]) -> bool {
        // A word and no flag, so that the loop is one over vectors.
        squared_m.iter().fold(0, |any, &squared| any | u32::from(squared > self.min_squared_m2)) != 0
    }
}

impl NearCapsules {
    /// Room for all capsules.
    pub(super) const fn new() -> Self {
        Self { found: Vec::new() }
    }

    /// Places of those found last in the surface's list.
    pub(super) fn indices(&self) -> impl Iterator<Item = usize> {
        self.found.iter().map(|capsule| usize::from(capsule.index))
    }

    /// Finds the capsules that can lie nearest to a point of `block` and nearer than `outlier_m`.
    /// A distance counts `1 + stretch` times less at most.
    fn find<const BONES: usize>(
        &mut self,
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        outlier_m: f32,
        stretch: f32,
    ) {
        self.find_stretched(surface, block, (outlier_m, stretch), |_| 0.0);
    }

    /// As [`Self::find`] without stretch, and those that can come nearer to a point than `reach_m`
    /// of their bone, metres.
    pub(super) fn find_or_within<const BONES: usize>(
        &mut self,
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        outlier_m: f32,
        reach_m: impl Fn(usize) -> f32,
    ) {
        self.find_stretched(surface, block, (outlier_m, 0.0), reach_m);
    }

    #[inline(always)]
    fn find_stretched<const BONES: usize>(
        &mut self,
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        (outlier_m, stretch): (f32, f32),
        reach_m: impl Fn(usize) -> f32,
    ) {
        let bounds = surface.distance_bounds(&block.centre_m, block.radius_m);
        let mut bound = outlier_m * outlier_m;
        for &most in bounds.max_squared_m2.iter().take(surface.capsules.len()) {
            bound = min(bound, most);
        }
        let bound = sqrt_branch_free(bound * (1.0 + stretch));
        let per_stretch = 1.0 / (1.0 + stretch);
        self.found.clear();
        let (mut nearest, mut nearest_m) = (0, f32::INFINITY);
        for (index, (&min_m, seen)) in bounds.min_m.iter().zip(&surface.capsules).enumerate() {
            // Slightly wider, for rounding.
            if min_m > max(bound, reach_m(seen.bone)) * 1.0001 + 1.0e-6 {
                continue;
            }
            if min_m < nearest_m {
                (nearest, nearest_m) = (self.found.len(), min_m);
            }
            // Slightly less, for rounding.
            let min_m = max(min_m * 0.9999 - 1.0e-5, 0.0);
            let _ = self.found.push(NearCapsule { index: index as u8, min_squared_m2: min_m * min_m * per_stretch });
        }
        if nearest < self.found.len() {
            self.found.swap(0, nearest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::math::Vec3;
    use crate::observation::point_cloud::PointCloud;
    use crate::random::Stream;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BodySkeleton, body_radii_m, full_body};
    use proptest::prelude::*;
    use std::vec::Vec;

    const LIKELIHOOD: PointLikelihood = PointLikelihood { std_m: 0.15, outlier_m: 0.25 };

    fn body() -> (BodySkeleton, [f32; BODY_BONES]) {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        (full_body(&measures).unwrap(), body_radii_m(&measures))
    }

    fn pose(skeleton: &BodySkeleton, stream: &mut Stream) -> [f32; BODY_ANGLES] {
        let mut angles = [0.0; BODY_ANGLES];
        angles.iter_mut().for_each(|angle| *angle = 0.5 * stream.normal());
        angles[2] += 3.0;
        skeleton.clamp(angles)
    }

    /// Points about a posture: some on its skin, some anywhere.
    fn points(surface: &BodySurface<BODY_BONES>, count: usize, stream: &mut Stream) -> Vec<Vec3> {
        (0..count)
            .map(|i| {
                let capsule = surface.capsules[i % surface.capsules.len()].capsule;
                let axis = capsule.start_m + (capsule.end_m - capsule.start_m) * stream.uniform();
                axis + stream.normal3() * if i % 9 == 0 { 0.5 } else { 0.1 }
            })
            .collect()
    }

    #[test]
    fn point_by_point_gives_the_bits_of_the_vectors() {
        let (skeleton, radii) = body();
        let mut stream = Stream::new(8, 0, 0);
        for _ in 0..30 {
            let there = posture(&skeleton, &Vec3::zeros(), &pose(&skeleton, &mut stream));
            let surface = BodySurface::new(&there, &radii, Vec3::zeros());
            let mut cloud = PointCloud::<32>::new();
            let _ = cloud.set(&mut points(&surface, 500, &mut stream), &Vec3::zeros());
            for block in cloud.blocks() {
                for most in [0.0064, f32::INFINITY] {
                    let (mut together, mut alone) = ([most; BLOCK_POINTS], [most; BLOCK_POINTS]);
                    for seen in &surface.capsules {
                        lower_to(&mut together, seen, &surface, block);
                        lower_one_by_one(&mut alone, seen, &surface, block);
                        assert_eq!(together.map(f32::to_bits), alone.map(f32::to_bits));
                    }
                }
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn leaving_out_far_capsules_changes_nothing(seed in 0_u64..100_000) {
            let (skeleton, radii) = body();
            let mut stream = Stream::new(seed, 0, 0);
            let there = posture(&skeleton, &Vec3::zeros(), &pose(&skeleton, &mut stream));
            let surface = BodySurface::new(&there, &radii, Vec3::zeros());
            let mut cloud = points(&surface, 333, &mut stream);
            let exact: f64 = cloud.iter().map(|point| {
                let nearest = surface.capsules.iter().map(|seen| {
                    (point - seen.capsule.nearest_visible(&Vec3::zeros(), point)).norm_squared()
                });
                f64::from(nearest.fold(0.25 * 0.25, f32::min))
            }).sum::<f64>() / -(2.0 * 0.15 * 0.15);
            let mut blocks = PointCloud::<64>::new();
            prop_assert_eq!(blocks.set(&mut cloud, &Vec3::zeros()).over_capacity, 0);
            let found = f64::from(LIKELIHOOD.log_likelihood(&surface, blocks.blocks()));
            prop_assert!((found / exact - 1.0).abs() < 1.0e-3, "{} instead of {}", found, exact);
        }
    }

    /// A forearm across the line of sight, 2 m away. A point 12 cm before it has the scatter along
    /// the line of sight, one 6 cm beside it has none.
    #[test]
    fn scatter_along_the_line_of_sight_widens_what_lies_on_it_alone() {
        let skeleton = crate::skeleton::ArmGeometry::new(crate::skeleton::Side::Left, 0.3, 0.35).unwrap();
        let there = posture(&skeleton.skeleton().unwrap(), &Vec3::new(0.0, 0.0, 2.0), &[0.0; 4]);
        let surface = BodySurface::new(&there, &[0.05, 0.04], Vec3::zeros());
        let elbow = surface.capsules[1].capsule;
        let middle = (elbow.start_m + elbow.end_m) * 0.5;
        let sight = middle / middle.norm();
        let across = sight.cross(&(elbow.end_m - elbow.start_m)).normalize();
        let likelihood = PointLikelihood { std_m: 0.05, outlier_m: 0.2 };
        let cost = |point_m: Vec3, along_std_m: f32| {
            let mut cloud = PointCloud::<1>::new();
            let _ = cloud.set(&mut [point_m], &Vec3::zeros());
            cloud.scatter_by(along_std_m);
            -likelihood.log_likelihood(&surface, cloud.blocks())
        };
        let (before, beside) = (middle - sight * 0.16, middle + across * 0.1);
        let wanted = |off_m: f32, variance: f32| off_m * off_m / (2.0 * variance);
        // The forearm leans against the line of sight.
        let cosine = across.cross(&(elbow.end_m - elbow.start_m)).normalize().dot(&sight).abs();
        let off_m = 0.16 * cosine - 0.04;
        let near = |found: f32, wanted: f32| (found - wanted).abs() < 0.05 * wanted;
        assert!(near(cost(before, 0.0), wanted(off_m, 0.0025)), "{}", cost(before, 0.0));
        assert!(near(cost(before, 0.1), wanted(off_m, 0.0025 + 0.01 * cosine * cosine)), "{}", cost(before, 0.1));
        assert!(near(cost(beside, 0.0), wanted(0.06, 0.0025)), "{}", cost(beside, 0.0));
        assert!(near(cost(beside, 0.1), wanted(0.06, 0.0025)), "{}", cost(beside, 0.1));
        // Behind it: the edge of the visible skin is the nearest, and most of the way is along.
        let behind = middle + sight * 0.15;
        assert!(cost(behind, 0.1) < 0.4 * cost(behind, 0.0), "{} {}", cost(behind, 0.1), cost(behind, 0.0));
        // Hardly any scatter is as none.
        for place in [before, beside, behind, middle + Vec3::new(0.05, 0.1, 0.07)] {
            assert!((cost(place, 1.0e-4) - cost(place, 0.0)).abs() < 1.0e-3 * cost(place, 0.0));
        }
    }

    #[test]
    fn a_cloud_far_from_the_body_weighs_every_pose_alike() {
        let (skeleton, radii) = body();
        let mut stream = Stream::new(1, 0, 0);
        let mut cloud: Vec<Vec3> = (0..50).map(|_| Vec3::new(9.0, 9.0, 9.0) + stream.normal3() * 0.1).collect();
        let mut blocks = PointCloud::<8>::new();
        let _ = blocks.set(&mut cloud, &Vec3::zeros());
        for _ in 0..5 {
            let there = posture(&skeleton, &Vec3::zeros(), &pose(&skeleton, &mut stream));
            let surface = BodySurface::new(&there, &radii, Vec3::zeros());
            let found = LIKELIHOOD.log_likelihood(&surface, blocks.blocks());
            assert!((found + 50.0 * 0.25 * 0.25 / (2.0 * 0.15 * 0.15)).abs() < 1.0e-3, "{found}");
        }
    }
}
