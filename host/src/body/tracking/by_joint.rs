//! One number for each joint of a body: noise of its angles, or their concentration.

use serde::{Deserialize, Serialize};
use sinew_core::skeleton::full_body::BODY_ANGLES;

/// A value by the joint that an angle belongs to; left and right are alike.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ByJoint {
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

impl ByJoint {
    /// The same for every joint.
    #[must_use]
    pub const fn uniform(value: f32) -> Self {
        Self { trunk: value, head: value, shoulder: value, elbow: value, hip: value, knee: value, ankle: value }
    }

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

    /// `of` each value.
    #[must_use]
    pub fn map(&self, of: impl FnMut(f32) -> f32) -> Self {
        let Self { trunk, head, shoulder, elbow, hip, knee, ankle } = *self;
        let [trunk, head, shoulder, elbow, hip, knee, ankle] = [trunk, head, shoulder, elbow, hip, knee, ankle].map(of);
        Self { trunk, head, shoulder, elbow, hip, knee, ankle }
    }
}
