//! Noise of a body's angles, one number a joint.

use serde::{Deserialize, Serialize};
use sinew_core::skeleton::full_body::BODY_ANGLES;

/// Standard deviations of angles after one second, by the joint they belong to; radians by root
/// second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointStd {
    /// Trunk against the pelvis.
    pub trunk: f32,
    /// Head against the trunk.
    pub head: f32,
    /// Shoulders.
    pub shoulder: f32,
    /// Elbows.
    pub elbow: f32,
    /// Hips.
    pub hip: f32,
    /// Knees.
    pub knee: f32,
    /// Ankles.
    pub ankle: f32,
}

impl JointStd {
    /// One value an angle, in the order of the skeleton; the root's own are not read.
    #[must_use]
    pub fn per_angle(&self) -> [f32; BODY_ANGLES] {
        let (s, e, h, k, a) = (self.shoulder, self.elbow, self.hip, self.knee, self.ankle);
        let mut result = [1.0; BODY_ANGLES];
        result[6..9].fill(self.trunk);
        result[9..12].fill(self.head);
        for first in [12, 16] {
            result[first..first + 4].copy_from_slice(&[s, s, s, e]);
        }
        for first in [20, 25] {
            result[first..first + 5].copy_from_slice(&[h, h, h, k, a]);
        }
        result
    }

    /// All values times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        let Self { trunk, head, shoulder, elbow, hip, knee, ankle } = *self;
        let [trunk, head, shoulder, elbow, hip, knee, ankle] =
            [trunk, head, shoulder, elbow, hip, knee, ankle].map(|std| std * factor);
        Self { trunk, head, shoulder, elbow, hip, knee, ankle }
    }
}
