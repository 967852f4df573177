//! Which bones a frame's points show.

use crate::math::{length, max, min, sqrt};
use crate::observation::body_surface::BodySurface;
use crate::observation::limb_likelihood::squared_by_group;
use crate::observation::point_cloud::{BLOCK_POINTS, PointBlock};
use crate::observation::point_likelihood::NearestSkin;
use crate::skeleton::Limbs;
use crate::skeleton::limbs::{MAX_GROUPS, TRUNK_GROUP};

/// A point nearer to a bone's skin than this belongs to it, metres.
/// Chosen: above the noise of points.
const NEAR_M: f32 = 0.06;
/// A point speaks for a limb if the skin of every other limb and of the trunk is farther by this at
/// least, metres. Chosen: more than a point's noise.
const CLEARER_M: f32 = 0.03;
/// It is also farther by this many times the points' mean distance from the skin: those of a body
/// far away are scattered in depth. A limb of one bone, a head, cannot reach in front of other skin
/// and needs no more than the least. Chosen: scatter beyond it is rare.
const CLEARER_SCATTERS: f32 = 2.5;
/// A point farther from all skin than this says nothing about the scatter, metres.
/// Chosen: beyond the noise of every sensor in use; such a point lies on another object.
const SCATTERED_M: f32 = 0.2;
/// A bone with less than this share of the points that its size lets expect is not observed.
/// Chosen: a limb half hidden is observed.
const MIN_SHARE: f32 = 0.25;

/// Whether the points show each bone. Enough of them have to lie on its skin and, where it is part
/// of a limb, clearly on no other limb's nor the trunk's. A limb that is hidden before the trunk,
/// say, would else be shown by the trunk's points.
///
/// What to expect follows from the size in which each bone would appear to the camera, as if none
/// hid another. So a limb behind the trunk is not observed. Without points nothing is; a bone
/// without flesh has no skin to show.
#[must_use]
pub fn observed<const BONES: usize>(
    surface: &BodySurface<BONES>,
    limbs: &Limbs<BONES>,
    blocks: &[PointBlock],
) -> [bool; BONES] {
    let (mut counts, mut found) = ([0.0_f32; BONES], 0.0);
    let scattered_m = max(CLEARER_M, CLEARER_SCATTERS * scatter_m(surface, blocks));
    let clearer_m: [f32; MAX_GROUPS] = core::array::from_fn(|group| {
        let bones = surface.capsules.iter().filter(|seen| limbs.group(seen.bone) == group).count();
        if bones == 1 { CLEARER_M } else { scattered_m }
    });
    for block in blocks {
        let nearest = NearestSkin::find(surface, block, NEAR_M);
        let squared_m = squared_by_group(surface, limbs, block, f32::INFINITY);
        for (i, &index) in nearest.capsule.iter().enumerate().take(usize::from(block.count)) {
            let Some(seen) = surface.capsules.get(usize::from(index)).filter(|_| i < BLOCK_POINTS) else { continue };
            found += 1.0;
            let group = limbs.group(seen.bone);
            let mut other = f32::INFINITY;
            for (_, squared_m) in squared_m.iter().enumerate().filter(|(another, _)| *another != group) {
                other = min(other, squared_m[i]);
            }
            let clearer_m = clearer_m.get(group).copied().unwrap_or(CLEARER_M);
            let is_clear = group == TRUNK_GROUP || sqrt(other) > sqrt(nearest.squared_m[i]) + clearer_m;
            if let (true, Some(count)) = (is_clear, counts.get_mut(seen.bone)) {
                *count += 1.0;
            }
        }
    }
    let mut sizes = [0.0; BONES];
    for seen in &surface.capsules {
        let middle = (seen.capsule.start_m + seen.capsule.end_m) * 0.5 - surface.camera_m;
        let squared = max(middle.dot(&middle), 1.0e-6);
        let foreshortened = length(&seen.along_m.cross(&middle)) / sqrt(squared);
        let r = seen.capsule.radius_m;
        if let Some(size) = sizes.get_mut(seen.bone) {
            *size = (2.0 * r * foreshortened + 3.0 * r * r) / squared;
        }
    }
    let size: f32 = sizes.iter().sum();
    let mut result = [false; BONES];
    for bone in 0..BONES {
        result[bone] = counts[bone] > 0.0 && counts[bone] >= MIN_SHARE * found * sizes[bone] / size;
    }
    result
}

/// Mean distance of the points from the nearest skin, metres, without those that belong to none.
fn scatter_m<const BONES: usize>(surface: &BodySurface<BONES>, blocks: &[PointBlock]) -> f32 {
    let (mut sum_m, mut count) = (0.0, 0.0);
    for block in blocks {
        let nearest = NearestSkin::find(surface, block, SCATTERED_M);
        for (&index, &squared_m) in nearest.capsule.iter().zip(&nearest.squared_m).take(usize::from(block.count)) {
            if surface.capsules.get(usize::from(index)).is_some() {
                sum_m += sqrt(squared_m);
                count += 1.0;
            }
        }
    }
    if count > 0.0 { sum_m / count } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::math::Vec3;
    use crate::observation::point_cloud::PointCloud;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{BODY_ANGLES, BODY_BONES, FOREARMS, TRUNK, body_radii_m, full_body};

    /// Which bones a standing body 2.5 m away shows while the left arm is believed to lie across
    /// the trunk. The points lie on the visible skin of the bones that are not in `hidden`.
    fn shown(hidden: &[usize]) -> [bool; BODY_BONES] {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (skeleton, radii_m) = (full_body(&measures).unwrap(), body_radii_m(&measures));
        let mut angles = [0.0; BODY_ANGLES];
        (angles[2], angles[12], angles[14], angles[15]) = (2.5, 0.2, -1.2, 1.6);
        let there = posture(&skeleton, &Vec3::zeros(), &skeleton.clamp(angles));
        let surface = BodySurface::new(&there, &radii_m, Vec3::zeros());
        let mut points = Vec::new();
        for seen in surface.capsules.iter().filter(|seen| !hidden.contains(&seen.bone)) {
            for i in 0..60 {
                let axis = seen.capsule.start_m + seen.along_m * (i as f32 / 60.0);
                points.push(axis - axis.normalize() * seen.capsule.radius_m);
            }
        }
        let mut cloud = PointCloud::<128>::new();
        assert_eq!(cloud.set(&mut points, &Vec3::zeros()).over_capacity, 0);
        observed(&surface, &Limbs::of(&skeleton), cloud.blocks())
    }

    #[test]
    fn a_hidden_forearm_is_not_shown_by_the_trunk_behind_it() {
        let all = shown(&[]);
        assert!(all[FOREARMS[0]] && all[FOREARMS[1]] && all[TRUNK]);
        let hidden = shown(&[FOREARMS[0]]);
        assert!(!hidden[FOREARMS[0]] && hidden[FOREARMS[1]] && hidden[TRUNK]);
    }

    #[test]
    fn without_points_nothing_is_shown() {
        assert_eq!(shown(&core::array::from_fn::<usize, BODY_BONES, _>(|bone| bone)), [false; BODY_BONES]);
    }
}
