//! Recordings whose points all lie in one plane, as those of one camera do.

use crate::motion::joint_names::{HIP_CENTER, HIPS, NECK, SpatialJoints};
use sinew_core::math::Vec3;

/// Largest thickness of a planar recording, in lengths of the trunk. Chosen: a person's hips alone
/// are 0.3 apart; any value from 1e-5 (rounding of files) to 0.1 serves.
const MAX_THICKNESS_TRUNKS: f32 = 0.01;

/// The level direction within the plane of a planar recording, without a sign; `None` for a
/// recording in space. The plane holds `up` and is square to a coordinate axis.
#[must_use]
pub fn level_axis(frames: &[SpatialJoints], up: Vec3) -> Option<Vec3> {
    let trunk_m = frames.iter().filter_map(|joints| Some((joints[NECK]? - joints[HIP_CENTER]?).norm()));
    let trunk_m = trunk_m.fold(0.0, f32::max);
    let joints = || frames.iter().flatten().flatten();
    let first = *joints().next()?;
    let (low, high) = joints().fold((first, first), |(low, high), joint| (low.inf(joint), high.sup(joint)));
    let thickness = high - low;
    let is_normal = |axis: &Vec3| axis.dot(&up) == 0.0 && thickness.dot(axis) <= MAX_THICKNESS_TRUNKS * trunk_m;
    let normal = [Vec3::x(), Vec3::y(), Vec3::z()].into_iter().find(is_normal)?;
    Some(up.cross(&normal))
}

/// The direction along `axis` to which the knees point from the lines between hips and ankles,
/// metres; zero where no leg is seen.
#[must_use]
pub fn knee_direction(frames: &[SpatialJoints], axis: Vec3) -> Vec3 {
    let legs = frames.iter().flat_map(|joints| {
        HIPS.map(|hip| Some(joints[hip + 1]? - (joints[hip]? + joints[hip + 2]?) / 2.0)).into_iter().flatten()
    });
    let (sum, count) = legs.fold((0.0_f32, 0_u32), |(sum, count), knee| (sum + knee.dot(&axis), count + 1));
    axis * (sum / count.max(1) as f32)
}
