//! Heels and toes of a motion in space.

use crate::motion::joint_names::named_points;
use crate::motion::markers::MarkerMotion;
use sinew_core::math::Vec3;

/// Heel and toe of the left and the right foot, metres; `None` where one was not seen.
pub type SpatialFeet = [[Option<Vec3>; 2]; 2];

/// Names of heel and toe markers: OpenSim's, Vicon's, and those of BVH and ASF.
const PATTERNS: [&[&str]; 2] = [
    &["{l}hee", "{l}heel", "{L}heel", "{l}calc"],
    &["{l}toe", "{l}bigtoe", "{L}toe", "{L}bigtoe", "{L}toebase", "{l}toes", "toe{l}", "toes{l}"],
];

/// Heels and toes of each frame.
#[must_use]
pub fn feet_in_space(motion: &MarkerMotion) -> Vec<SpatialFeet> {
    let sources = [true, false].map(|left| PATTERNS.map(|patterns| named_points(&motion.names, patterns, left)));
    let frame = |positions_m: &Vec<Option<Vec3>>| {
        sources.each_ref().map(|foot| {
            foot.each_ref().map(|points| {
                let point = points.as_ref()?.first()?;
                *positions_m.get(*point)?
            })
        })
    };
    motion.positions_m.iter().map(frame).collect()
}
