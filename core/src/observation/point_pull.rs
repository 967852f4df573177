//! Which way a cloud of points pulls a pose: the derivatives of the point likelihood (DESIGN.md, section 3: guided proposals).

use super::body_surface::BodySurface;
use super::point_cloud::{BLOCK_POINTS, PointBlock};
use super::point_likelihood::{NearCapsules, PointLikelihood, lower_to};
use crate::kinematics::body_information::BodyInformation;
use crate::math::{Vec3, unit};

/// Nearer than this a point lies on the skin, metres: the skin's own normal is taken.
const TOUCHING_M: f32 = 1.0e-4;

/// Adds to `information` what `blocks` say about the bones of `surface`: each point wants the nearest place of the visible skin
/// to come to it, along the line between both; outliers want nothing. `share` multiplies every point, for a cloud of which
/// only a part is looked at.
pub fn add_pull<'b, const BONES: usize>(
    likelihood: &PointLikelihood,
    surface: &BodySurface<BONES>,
    blocks: impl Iterator<Item = &'b PointBlock>,
    share: f32,
    information: &mut BodyInformation<BONES>,
) {
    let weight = share / (likelihood.std_m * likelihood.std_m);
    let tau = likelihood.outlier_m * likelihood.outlier_m;
    let mut near = NearCapsules::new();
    for block in blocks {
        near.find(surface, block, likelihood.outlier_m);
        let mut least = [tau; BLOCK_POINTS];
        let mut owner = [u8::MAX; BLOCK_POINTS];
        for &index in near.indices() {
            let Some(seen) = surface.capsules.get(usize::from(index)) else { continue };
            let before = least;
            lower_to(&mut least, seen, surface, block);
            for i in 0..BLOCK_POINTS {
                if least[i] < before[i] {
                    owner[i] = index;
                }
            }
        }
        for i in 0..usize::from(block.count) {
            let Some(seen) = surface.capsules.get(usize::from(owner[i])) else { continue };
            let point_m = block.point_m(i);
            let skin_m = seen.capsule.nearest_visible(&surface.camera_m, &point_m);
            let (axis_m, _) = seen.axis_point(&point_m);
            // At the skin itself the line between both has no direction, but the skin has.
            let way = point_m - skin_m;
            let apart = unit(way).filter(|_| least[i] > TOUCHING_M * TOUCHING_M);
            let normal = apart.or_else(|| unit(skin_m - axis_m)).unwrap_or_else(Vec3::z);
            information.add(seen.bone, &skin_m, &normal, way.dot(&normal), weight);
        }
    }
}
