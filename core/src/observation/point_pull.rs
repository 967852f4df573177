//! Derivatives of the point likelihood by a pose, for guided proposals.

use super::body_surface::{BodySurface, SeenCapsule};
use super::point_cloud::{BLOCK_POINTS, PointBlock};
use super::point_likelihood::{NearAxis, NearestSkin, PointLikelihood};
use crate::kinematics::body_information::BodyInformation;
use crate::math::{Vec3, max, sqrt_branch_free};
use crate::numeric::rolled::HAS_VECTORS;

/// Nearer than this a point lies on the skin, metres: the skin's own normal is taken.
///
/// Chosen: far above rounding at a few metres, far below a sensor's noise.
const TOUCHING_M: f32 = 1.0e-4;

/// A point that skin is near to, and how it pulls.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::body_surface::BodySurface;
/// use sinew_core::observation::point_cloud::PointCloud;
/// use sinew_core::observation::point_likelihood::PointLikelihood;
/// use sinew_core::observation::point_pull::for_each_pull;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// let hanging = posture(&arm, &Vec3::new(0.0, 0.0, 2.0), &[0.0; 4]);
/// let surface = BodySurface::new(&hanging, &[0.05, 0.04], Vec3::zeros());
/// let likelihood = PointLikelihood { std_m: 0.1, outlier_m: 0.2 };
/// let mut cloud = PointCloud::<1>::new();
/// let _ = cloud.set(&mut [Vec3::new(0.0, 0.5, 1.91)], &Vec3::zeros());
/// for_each_pull(&likelihood, &surface, cloud.blocks().iter(), 1.0, |pull| {
///     // Half way down the forearm, five centimetres before its skin.
///     assert_eq!(pull.bone, FOREARM);
///     assert!((pull.residual_m - 0.05).abs() < 0.002);
///     assert!((pull.axis_share - 0.57).abs() < 0.02);
/// });
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointPull {
    /// The bone of that skin.
    pub bone: usize,
    /// Nearest place of the visible skin, metres.
    pub skin_m: Vec3,
    /// Place of the bone's axis under it, metres.
    pub axis_m: Vec3,
    /// Where that lies: 0 at the bone's start, 1 at its end.
    pub axis_share: f32,
    /// Unit vector of the line between skin and point; zero for a point on the axis.
    pub normal: Vec3,
    /// How far the skin should move along it, metres.
    pub residual_m: f32,
    /// Inverse variance of the residual, 1 / m^2.
    pub weight: f32,
}

/// Calls `each` for the points of `blocks`, but for outliers. Returns the log-likelihood of all, as
/// [`PointLikelihood::log_likelihood_of`] does: `share` is no factor of it.
///
/// A point's residual is to the nearest place of the visible skin, along the line between both.
/// `share` multiplies every point, for a cloud of which only a part is used.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::body_surface::BodySurface;
/// use sinew_core::observation::point_cloud::PointCloud;
/// use sinew_core::observation::point_likelihood::PointLikelihood;
/// use sinew_core::observation::point_pull::for_each_pull;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// let hanging = posture(&arm, &Vec3::new(0.0, 0.0, 2.0), &[0.0; 4]);
/// let surface = BodySurface::new(&hanging, &[0.05, 0.04], Vec3::zeros());
/// let likelihood = PointLikelihood { std_m: 0.1, outlier_m: 0.2 };
/// let mut cloud = PointCloud::<1>::new();
/// let _ = cloud
///     .set(&mut [Vec3::new(0.0, 0.5, 1.91), Vec3::new(0.9, 0.0, 3.0)], &Vec3::zeros());
/// let mut pulls = 0;
/// let log_likelihood =
///     for_each_pull(&likelihood, &surface, cloud.blocks().iter(), 1.0, |_| pulls += 1);
/// assert_eq!(pulls, 1, "the other point is an outlier");
/// assert_eq!(log_likelihood, likelihood.log_likelihood(&surface, cloud.blocks()));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub fn for_each_pull<'b, const BONES: usize>(
    likelihood: &PointLikelihood,
    surface: &BodySurface<BONES>,
    blocks: impl Iterator<Item = &'b PointBlock>,
    share: f32,
    mut each: impl FnMut(&PointPull),
) -> f32 {
    let mut squares_m2 = 0.0;
    let weight = share / (likelihood.std_m * likelihood.std_m);
    for block in blocks {
        let stretch = likelihood.stretch(block);
        let nearest = NearestSkin::find_stretched(surface, block, likelihood.outlier_m, stretch);
        let count = usize::from(block.count).min(BLOCK_POINTS);
        for i in 0..count {
            squares_m2 += nearest.squared_m[i];
        }
        let mut left = nearest.owners();
        while left != 0 {
            let index = left.trailing_zeros();
            left &= left - 1;
            let Some(seen) = surface.capsules.get(index as usize) else { continue };
            let own = nearest.capsule.map(|capsule| u32::from(capsule) == index);
            let lines = SkinLines::of(seen, surface, block, &own);
            for i in 0..count {
                if own[i] {
                    each(&lines.pull((seen, surface), block, i, weight, stretch));
                }
            }
        }
    }
    -squares_m2 / (2.0 * likelihood.std_m * likelihood.std_m)
}

/// The lines between a capsule's visible skin and a block's points, coordinate by coordinate. Loops
/// are branch-free, so that they run on vectors.
struct SkinLines {
    /// Unit vectors; zero for a point on the axis.
    normal: [[f32; BLOCK_POINTS]; 3],
    /// How far the points are along them, metres.
    residual_m: [f32; BLOCK_POINTS],
}

impl SkinLines {
    /// Those of the points of `own`; those of all others are undefined.
    #[inline(always)]
    fn of<const BONES: usize>(
        seen: &SeenCapsule,
        surface: &BodySurface<BONES>,
        block: &PointBlock,
        own: &[bool; BLOCK_POINTS],
    ) -> Self {
        let mut lines = Self { normal: [[0.0; BLOCK_POINTS]; 3], residual_m: [0.0; BLOCK_POINTS] };
        // A word and no flag, so that the loop stays one over vectors.
        let mut hidden = 0;
        for i in 0..BLOCK_POINTS {
            if !HAS_VECTORS && !own[i] {
                continue;
            }
            let at = NearAxis::of(seen, surface, block, i);
            let length_m = sqrt_branch_free(at.squared);
            let per_length = 1.0 / max(length_m, f32::MIN_POSITIVE);
            for axis in 0..3 {
                lines.normal[axis][i] = at.off[axis] * per_length;
            }
            lines.residual_m[i] = length_m - seen.capsule.radius_m;
            hidden |= u32::from((at.towards < 0.0) & own[i]);
        }
        // Most points are seen.
        if hidden != 0 {
            lines.set_hidden(seen, surface, block);
        }
        lines
    }

    /// Sets those of the points that are behind the capsule.
    #[inline(never)]
    fn set_hidden<const BONES: usize>(&mut self, seen: &SeenCapsule, surface: &BodySurface<BONES>, block: &PointBlock) {
        let v = [seen.across.x, seen.across.y, seen.across.z];
        let camera_m = [surface.camera_m.x, surface.camera_m.y, surface.camera_m.z];
        let line_has_side = v != [0.0; 3];
        let unit = |vector: [f32; 3]| {
            let squared = vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2];
            let per_length = 1.0 / max(sqrt_branch_free(squared), f32::MIN_POSITIVE);
            vector.map(|entry| entry * per_length)
        };
        for i in 0..BLOCK_POINTS {
            let at = NearAxis::of(seen, surface, block, i);
            let point_m = [block.x[i], block.y[i], block.z[i]];
            let side = at.off[0] * v[0] + at.off[1] * v[1] + at.off[2] * v[2];
            let towards_side = if side < 0.0 { -1.0 } else { 1.0 };
            let per_sight = if at.t > 0.5 { seen.per_squared_sight[1] } else { seen.per_squared_sight[0] };
            let inner = (at.t > 0.0) & (at.t < 1.0) & line_has_side;
            let mut edge = [0.0; 3];
            for axis in 0..3 {
                let sight = camera_m[axis] - point_m[axis] + at.off[axis];
                let beside = at.off[axis] - sight * (at.towards * per_sight);
                edge[axis] = if inner { v[axis] * towards_side } else { beside };
            }
            let edge = unit(edge);
            let mut way = [0.0; 3];
            let mut squared = 0.0;
            for axis in 0..3 {
                way[axis] = at.off[axis] - edge[axis] * seen.capsule.radius_m;
                squared += way[axis] * way[axis];
            }
            let is_touching = squared <= TOUCHING_M * TOUCHING_M;
            let apart = unit(way);
            let is_hidden = at.towards < 0.0;
            let mut residual_m = 0.0;
            for axis in 0..3 {
                // On the skin the line between both has no direction: the skin's normal is taken.
                let normal = if is_touching { edge[axis] } else { apart[axis] };
                residual_m += way[axis] * normal;
                self.normal[axis][i] = if is_hidden { normal } else { self.normal[axis][i] };
            }
            self.residual_m[i] = if is_hidden { residual_m } else { self.residual_m[i] };
        }
    }

    /// How point `i` pulls, whose weight is `weight` but for the stretch of its block.
    #[inline(always)]
    fn pull<const BONES: usize>(
        &self,
        (seen, surface): (&SeenCapsule, &BodySurface<BONES>),
        block: &PointBlock,
        i: usize,
        weight: f32,
        stretch: f32,
    ) -> PointPull {
        let point_m = block.point_m(i);
        let normal = Vec3::new(self.normal[0][i], self.normal[1][i], self.normal[2][i]);
        let residual_m = self.residual_m[i];
        let (axis_m, axis_share) = seen.axis_point(&point_m);
        let ratio = if stretch > 0.0 {
            PointLikelihood::variance_ratio(stretch, &normal, &(point_m - surface.camera_m))
        } else {
            1.0
        };
        let skin_m = point_m - normal * residual_m;
        PointPull { bone: seen.bone, skin_m, axis_m, axis_share, normal, residual_m, weight: weight / ratio }
    }
}

/// Adds the information of `blocks` about the bones of `surface`; `share` and what is returned as
/// in [`for_each_pull`].
pub(crate) fn add_pull<'b, const BONES: usize>(
    likelihood: &PointLikelihood,
    surface: &BodySurface<BONES>,
    blocks: impl Iterator<Item = &'b PointBlock>,
    share: f32,
    information: &mut BodyInformation<BONES>,
) -> f32 {
    for_each_pull(likelihood, surface, blocks, share, |pull| {
        information.add(pull.bone, &pull.skin_m, &pull.normal, pull.residual_m, pull.weight);
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::math::unit;
    use crate::observation::point_cloud::PointCloud;
    use crate::random::Stream;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BodySkeleton, body_radii_m, full_body};

    const LIKELIHOOD: PointLikelihood = PointLikelihood { std_m: 0.1, outlier_m: 0.3 };

    /// A body three metres away.
    struct Posed {
        skeleton: BodySkeleton,
        radii_m: [f32; BODY_BONES],
        angles_rad: [f32; BODY_ANGLES],
        surface: BodySurface<BODY_BONES>,
    }

    fn posed(stream: &mut Stream) -> Posed {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (skeleton, radii_m) = (full_body(&measures).unwrap(), body_radii_m(&measures));
        let mut angles_rad = [0.0; BODY_ANGLES];
        angles_rad.iter_mut().for_each(|angle| *angle = 0.3 * stream.normal());
        angles_rad[2] = 3.0;
        let angles_rad = skeleton.clamp(angles_rad);
        let surface = BodySurface::new(&posture(&skeleton, &Vec3::zeros(), &angles_rad), &radii_m, Vec3::zeros());
        Posed { skeleton, radii_m, angles_rad, surface }
    }

    #[test]
    fn the_pull_is_the_slope_of_the_likelihood() {
        the_pull_is_the_slope(0.0, 0.0);
    }

    #[test]
    fn lines_begin_at_the_nearest_visible_skin() {
        let mut stream = Stream::new(9, 0, 0);
        let Posed { surface, .. } = posed(&mut stream);
        let mut points: Vec<Vec3> = (0..400)
            .map(|i| {
                let seen = &surface.capsules[i % surface.capsules.len()];
                seen.capsule.start_m + seen.along_m * stream.uniform() + stream.normal3() * 0.08
            })
            .collect();
        let mut cloud = PointCloud::<32>::new();
        let _ = cloud.set(&mut points, &Vec3::zeros());
        let mut hidden = 0;
        for_each_pull(&LIKELIHOOD, &surface, cloud.blocks().iter(), 1.0, |pull| {
            let point = pull.skin_m + pull.normal * pull.residual_m;
            let seen = surface.capsules.iter().find(|seen| seen.bone == pull.bone).unwrap();
            let nearest = seen.capsule.nearest_visible(&Vec3::zeros(), &point);
            // The likelihood takes the line of sight from an end of the axis.
            assert!((pull.skin_m - nearest).norm() < 1.0e-3, "{} instead of {nearest}", pull.skin_m);
            assert!((pull.normal.norm() - 1.0).abs() < 1.0e-5);
            hidden += u32::from((point - pull.axis_m).dot(&pull.axis_m) > 0.0);
        });
        assert!(hidden > 50, "{hidden} points are behind their bones");
    }

    /// The pull leaves out how the angle between skin and line of sight changes. That adds up where
    /// points lie to both sides of the skin alike, and is little where they are all before it.
    #[test]
    fn so_it_is_of_points_that_scatter_along_their_lines_of_sight() {
        the_pull_is_the_slope(0.15, 0.06);
    }

    /// Points are off the skin by `off_m` on the mean and scatter by `along_std_m`, metres.
    fn the_pull_is_the_slope(along_std_m: f32, off_m: f32) {
        let mut stream = Stream::new(6, 0, 0);
        let Posed { skeleton, radii_m, angles_rad, surface } = posed(&mut stream);
        let there = posture(&skeleton, &Vec3::zeros(), &angles_rad);
        let mut points: Vec<Vec3> = (0..400)
            .map(|i| {
                let seen = &surface.capsules[i % surface.capsules.len()];
                let axis = seen.capsule.start_m + seen.along_m * (0.2 + 0.6 * stream.uniform());
                // On the side of the camera, off the skin by a few centimetres. Behind the axis
                // both edges of the visible skin would be as near, and rounding would choose one.
                let radius_m = seen.capsule.radius_m;
                axis - unit(axis).unwrap() * (radius_m + off_m + (0.03 * stream.normal()).max(-0.5 * radius_m))
            })
            .collect();
        let mut cloud = PointCloud::<64>::new();
        let _ = cloud.set(&mut points, &Vec3::zeros());
        cloud.scatter_by(along_std_m);
        let mut information = BodyInformation::empty();
        information.clear(&there);
        let pulled = add_pull(&LIKELIHOOD, &surface, cloud.blocks().iter(), 1.0, &mut information);
        assert_eq!(pulled, LIKELIHOOD.log_likelihood(&surface, cloud.blocks()));
        let (mut gradient, mut hessian) = ([0.0; BODY_ANGLES], [[0.0; BODY_ANGLES]; BODY_ANGLES]);
        information.add_to(&skeleton, &there, &mut gradient, &mut hessian);
        let log_likelihood = |angles_rad: &[f32; BODY_ANGLES]| {
            let there = posture(&skeleton, &Vec3::zeros(), angles_rad);
            LIKELIHOOD.log_likelihood(&BodySurface::new(&there, &radii_m, Vec3::zeros()), cloud.blocks())
        };
        // In units of each coordinate's own precision, where points inform it. Points that change
        // from one bone to another bend the slope a little.
        let (mut product, mut squares) = (0.0, [0.0; 2]);
        for i in (0..BODY_ANGLES).filter(|&i| hessian[i][i] > 1.0e-2) {
            let (mut below, mut above) = (angles_rad, angles_rad);
            below[i] -= 1.0e-3;
            above[i] += 1.0e-3;
            let slope = (log_likelihood(&above) - log_likelihood(&below)) / (2.0e-3 * hessian[i][i].sqrt());
            let found = gradient[i] / hessian[i][i].sqrt();
            product += slope * found;
            squares[0] += slope * slope;
            squares[1] += found * found;
        }
        let cosine = product / (squares[0] * squares[1]).sqrt();
        assert!(cosine > 0.95, "the pull and the slope have a cosine of {cosine}");
        let length = (squares[1] / squares[0]).sqrt();
        assert!((length - 1.0).abs() < 0.1, "the pull is {length} times the slope");
    }
}
