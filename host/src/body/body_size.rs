//! Lengths and radii of a person.

use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_BONES, body_radii_m};

/// Lengths and radii of a person.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodySize {
    /// The lengths; their girth is the mean of the radii's.
    pub measures: BodyMeasures,
    /// Radii of the capsules, metres.
    pub radii_m: [f32; BODY_BONES],
}

impl From<BodyMeasures> for BodySize {
    fn from(measures: BodyMeasures) -> Self {
        Self { measures, radii_m: body_radii_m(&measures) }
    }
}

impl BodySize {
    /// From the soles to the middle of the head of the person who stands, metres.
    #[must_use]
    pub fn standing_m(&self) -> f32 {
        let BodyMeasures { trunk_m, head_m, thigh_m, shank_m, foot_m, .. } = &self.measures;
        trunk_m + head_m + thigh_m + shank_m - foot_m.y
    }
}

/// Measures with each of the nine lengths times its own factor, in the order of the fields: trunk,
/// head, shoulder, upper arm, forearm, hip, thigh, shank, foot.
pub(crate) fn lengths_times(measures: &BodyMeasures, of: impl Fn(usize) -> f32) -> BodyMeasures {
    BodyMeasures {
        trunk_m: measures.trunk_m * of(0),
        head_m: measures.head_m * of(1),
        shoulder_m: measures.shoulder_m * of(2),
        upper_arm_m: measures.upper_arm_m * of(3),
        forearm_m: measures.forearm_m * of(4),
        hip_m: measures.hip_m * of(5),
        thigh_m: measures.thigh_m * of(6),
        shank_m: measures.shank_m * of(7),
        foot_m: measures.foot_m * of(8),
        girth: measures.girth,
    }
}
