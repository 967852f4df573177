//! Lengths and girth of a body's segments.
//!
//! ```
//! use sinew_core::skeleton::BodyMeasures;
//!
//! let tall = BodyMeasures::of_height(1.90)?;
//! let small = BodyMeasures::of_height(1.60)?;
//! assert!(tall.thigh_m > small.thigh_m);
//! // A measure of your own is checked.
//! assert!(BodyMeasures { forearm_m: -0.2, ..tall }.checked().is_err());
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::error::{ParameterError, positive};
use crate::math::Vec3;

/// Lengths of a body that is the same on both sides, metres.
///
/// Offsets are in body axes, (outward, up, front), of the left as of the right side.
///
/// ```
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{FOREARMS, full_body};
///
/// // All by stature, and one length that was measured.
/// let person = BodyMeasures { forearm_m: 0.28, ..BodyMeasures::of_height(1.75)? };
/// let skeleton = full_body(&person)?;
/// assert!((skeleton.bones()[FOREARMS[0]].offset_m.norm() - 0.28).abs() < 1e-6);
/// // From the middle of the hips to the neck it is three tenths of the stature.
/// assert!((person.trunk_m - 0.525).abs() < 1e-6);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyMeasures {
    /// Middle of the hips to the base of the neck.
    pub trunk_m: f32,
    /// Base of the neck to the middle of the head.
    pub head_m: f32,
    /// Base of the neck to a shoulder.
    pub shoulder_m: Vec3,
    /// Shoulder to elbow.
    pub upper_arm_m: f32,
    /// Elbow to wrist.
    pub forearm_m: f32,
    /// Middle of the hips to a hip joint.
    pub hip_m: Vec3,
    /// Hip to knee.
    pub thigh_m: f32,
    /// Knee to ankle.
    pub shank_m: f32,
    /// Ankle to the tip of the foot.
    pub foot_m: Vec3,
    /// Girth of all segments relative to [`crate::skeleton::full_body::BODY_RADII_M`] of a body
    /// 1.75 m tall.
    pub girth: f32,
}

/// Height of the body of [`crate::skeleton::full_body::BODY_RADII_M`], metres.
///
/// Chosen: about the mean stature of adults; radii scale with the stature.
pub const REFERENCE_HEIGHT_M: f32 = 1.75;

impl BodyMeasures {
    /// An adult `height_m` tall, by the segment lengths of Drillis and Contini (1966) as fractions
    /// of stature.
    ///
    /// The hip joints lie closer together than their table's hips, which are measured over the
    /// trochanters: 0.05 of stature from the middle each.
    ///
    /// # Errors
    /// The height has to be positive.
    pub fn of_height(height_m: f32) -> Result<Self, ParameterError> {
        let h = positive("height_m", height_m)?;
        Ok(Self {
            trunk_m: 0.300 * h,
            head_m: 0.110 * h,
            shoulder_m: Vec3::new(0.115, -0.012, 0.0) * h,
            upper_arm_m: 0.186 * h,
            forearm_m: 0.146 * h,
            hip_m: Vec3::new(0.05, 0.0, 0.0) * h,
            thigh_m: 0.245 * h,
            shank_m: 0.246 * h,
            foot_m: Vec3::new(0.0, -0.030, 0.100) * h,
            girth: h / REFERENCE_HEIGHT_M,
        })
    }

    /// The measures, if they can be a body's.
    ///
    /// # Errors
    /// Lengths have to be positive and finite; offsets finite.
    pub fn checked(self) -> Result<Self, ParameterError> {
        positive("trunk_m", self.trunk_m)?;
        positive("head_m", self.head_m)?;
        positive("upper_arm_m", self.upper_arm_m)?;
        positive("forearm_m", self.forearm_m)?;
        positive("thigh_m", self.thigh_m)?;
        positive("shank_m", self.shank_m)?;
        positive("girth", self.girth)?;
        positive("length of shoulder_m", self.shoulder_m.norm())?;
        positive("length of hip_m", self.hip_m.norm())?;
        positive("length of foot_m", self.foot_m.norm())?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_standing_adult_is_as_tall_as_said() {
        let measures = BodyMeasures::of_height(1.8).unwrap();
        let legs = measures.thigh_m + measures.shank_m - measures.foot_m.y;
        let top = measures.trunk_m + measures.head_m + 0.095 * measures.girth;
        assert!((legs + top - 1.8).abs() < 0.05, "{}", legs + top);
    }

    #[test]
    fn what_is_no_length_is_named() {
        assert_eq!(BodyMeasures::of_height(0.0).unwrap_err().parameter, "height_m");
        let mut measures = BodyMeasures::of_height(1.7).unwrap();
        measures.forearm_m = f32::NAN;
        assert_eq!(measures.checked().unwrap_err().parameter, "forearm_m");
        measures.forearm_m = 0.2;
        measures.hip_m = Vec3::zeros();
        assert_eq!(measures.checked().unwrap_err().parameter, "length of hip_m");
    }
}
