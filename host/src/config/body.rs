//! Section `[body]`.

use crate::motion::anthropometry as fraction;
use serde::{Deserialize, Serialize};
use sinew_core::error::{ParameterError, finite, positive, within};
use sinew_core::math::{Mat3, Vec3, axis_rotation};
use sinew_core::skeleton::arm::facing_camera;
use sinew_core::skeleton::{ArmGeometry, Side};

/// Area of a half-open hand's image at one metre, over squared height: 0.0194 m^2 at 1.75 m.
const HAND_AREA: f32 = 0.00632;

/// Size and place of the person.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BodyConfig {
    /// Height of the person, metres; lengths that are not given follow from it.
    pub height_m: f32,
    /// Shoulder to elbow, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper_arm_m: Option<f32>,
    /// Elbow to the middle of the hand, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forearm_m: Option<f32>,
    /// The person's left shoulder in camera axes, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_shoulder_m: Option<[f32; 3]>,
    /// The person's right shoulder in camera axes, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub right_shoulder_m: Option<[f32; 3]>,
    /// Image area of the hand times squared depth over squared focal length, square metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand_area_m2: Option<f32>,
    /// Turn of the torso about its own vertical axis, degrees; positive turns the person to their
    /// left.
    pub torso_yaw_deg: f32,
    /// Forward lean of the torso, degrees; a camera that looks down by so much sees the same.
    pub torso_pitch_deg: f32,
}

impl Default for BodyConfig {
    fn default() -> Self {
        Self {
            height_m: 1.75,
            upper_arm_m: None,
            forearm_m: None,
            left_shoulder_m: None,
            right_shoulder_m: None,
            hand_area_m2: None,
            torso_yaw_deg: 0.0,
            torso_pitch_deg: 0.0,
        }
    }
}

impl BodyConfig {
    /// Shoulders of a seated adult before a laptop: 0.9 m away, at the height of the camera.
    pub const DEFAULT_SHOULDERS_M: [[f32; 3]; 2] = [[0.2, 0.0, 0.9], [-0.2, 0.0, 0.9]];

    pub(super) fn set_all(&mut self) {
        (self.upper_arm_m, self.forearm_m, self.hand_area_m2) = (Some(1.0), Some(1.0), Some(1.0));
        (self.left_shoulder_m, self.right_shoulder_m) = (Some([1.0; 3]), Some([1.0; 3]));
    }

    pub(super) fn check(&self) -> Result<(), ParameterError> {
        within("height_m", self.height_m, 0.3, 3.0)?;
        for (name, value) in
            [("upper_arm_m", self.upper_arm_m), ("forearm_m", self.forearm_m), ("hand_area_m2", self.hand_area_m2)]
        {
            value.map_or(Ok(0.0), |value| positive(name, value))?;
        }
        for (name, place) in [("left_shoulder_m", self.left_shoulder_m), ("right_shoulder_m", self.right_shoulder_m)] {
            for value in place.into_iter().flatten() {
                finite(name, value)?;
            }
        }
        within("torso_yaw_deg", self.torso_yaw_deg, -180.0, 180.0)?;
        within("torso_pitch_deg", self.torso_pitch_deg, -90.0, 90.0)?;
        Ok(())
    }

    /// Whether the file says where both shoulders are; without it they are guessed.
    #[must_use]
    pub fn knows_shoulders(&self) -> bool {
        self.left_shoulder_m.is_some() && self.right_shoulder_m.is_some()
    }

    /// Left and right shoulder in camera axes, metres. One that is given places the other by the
    /// default's distance.
    #[must_use]
    pub fn shoulders_m(&self) -> [Vec3; 2] {
        let [left, right] = Self::DEFAULT_SHOULDERS_M.map(Vec3::from);
        match (self.left_shoulder_m.map(Vec3::from), self.right_shoulder_m.map(Vec3::from)) {
            (Some(left), Some(right)) => [left, right],
            (Some(given), None) => [given, given + right - left],
            (None, Some(given)) => [given + left - right, given],
            (None, None) => [left, right],
        }
    }

    /// Image area of the hand at one metre over squared focal length, square metres.
    #[must_use]
    pub fn hand_area_m2(&self) -> f32 {
        self.hand_area_m2.unwrap_or(HAND_AREA * self.height_m * self.height_m)
    }

    /// The arm of one side.
    ///
    /// # Errors
    /// Lengths have to be positive.
    pub fn arm(&self, side: Side) -> Result<ArmGeometry, ParameterError> {
        let upper_arm_m = self.upper_arm_m.unwrap_or(fraction::UPPER_ARM * self.height_m);
        let forearm_m = self.forearm_m.unwrap_or(fraction::ELBOW_TO_HAND_CENTRE * self.height_m);
        Ok(ArmGeometry { torso: self.torso(), ..ArmGeometry::new(side, upper_arm_m, forearm_m)? })
    }

    /// Body axes to camera axes.
    fn torso(&self) -> Mat3 {
        // Yaw about up (camera -y), then pitch about the camera's x axis, which tips the upper body
        // towards the camera.
        let yaw = axis_rotation(&-Vec3::y(), self.torso_yaw_deg.to_radians());
        let pitch = axis_rotation(&Vec3::x(), self.torso_pitch_deg.to_radians());
        pitch * yaw * facing_camera()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_given_shoulder_places_the_other() {
        let config = BodyConfig { left_shoulder_m: Some([0.3, 0.0, 1.0]), ..BodyConfig::default() };
        assert!((config.shoulders_m()[1] - Vec3::new(-0.1, 0.0, 1.0)).norm() < 1.0e-6);
        assert!(!config.knows_shoulders());
    }

    #[test]
    fn leaning_forward_brings_the_head_nearer_to_the_camera() {
        let lean = BodyConfig { torso_pitch_deg: 20.0, ..BodyConfig::default() }.arm(Side::Left).unwrap();
        let up: Vec3 = lean.torso.column(1).into();
        assert!(up.z < -0.3 && up.y < -0.9, "{up}");
        let turned = BodyConfig { torso_yaw_deg: 30.0, ..BodyConfig::default() }.arm(Side::Left).unwrap();
        let front: Vec3 = turned.torso.column(2).into();
        assert!(front.x > 0.4, "{front}");
    }
}
