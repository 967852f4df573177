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
