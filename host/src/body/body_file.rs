//! `body.json`: who is tracked.

use super::BodySize;
use crate::error::{Context, Result, ensure};
use crate::file::read_text;
use serde::{Deserialize, Serialize};
use sinew_core::math::Vec3;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_BONES, BODY_JOINT_NAMES};
use std::collections::BTreeMap;
use std::path::Path;

/// Measures of a person as a file holds them; lengths in metres, offsets as (outward, up, front).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyFile {
    /// Middle of the hips to the base of the neck.
    pub trunk_m: f32,
    /// Base of the neck to the middle of the head.
    pub head_m: f32,
    /// Base of the neck to a shoulder.
    pub shoulder_m: [f32; 3],
    /// Shoulder to elbow.
    pub upper_arm_m: f32,
    /// Elbow to wrist.
    pub forearm_m: f32,
    /// Middle of the hips to a hip joint.
    pub hip_m: [f32; 3],
    /// Hip to knee.
    pub thigh_m: f32,
    /// Knee to ankle.
    pub shank_m: f32,
    /// Ankle to the ball of the foot.
    pub foot_m: [f32; 3],
    /// Girth relative to a body 1.75 m tall.
    pub girth: f32,
    /// Radii of the capsules by the joint that they end at; by `girth` where there is none.
    #[serde(default)]
    pub radii_m: BTreeMap<String, f32>,
}

impl From<&BodyMeasures> for BodyFile {
    fn from(measures: &BodyMeasures) -> Self {
        Self::from(&BodySize::from(*measures))
    }
}

impl From<&BodySize> for BodyFile {
    fn from(BodySize { measures, radii_m }: &BodySize) -> Self {
        let named = (0..BODY_BONES).map(|bone| (BODY_JOINT_NAMES[bone].to_owned(), radii_m[bone]));
        Self {
            trunk_m: measures.trunk_m,
            head_m: measures.head_m,
            shoulder_m: measures.shoulder_m.into(),
            upper_arm_m: measures.upper_arm_m,
            forearm_m: measures.forearm_m,
            hip_m: measures.hip_m.into(),
            thigh_m: measures.thigh_m,
            shank_m: measures.shank_m,
            foot_m: measures.foot_m.into(),
            girth: measures.girth,
            radii_m: named.filter(|(_, radius_m)| *radius_m > 0.0).collect(),
        }
    }
}

impl BodyFile {
    /// The measures.
    ///
    /// # Errors
    /// A length that is not above zero, by name.
    pub fn measures(&self) -> Result<BodyMeasures> {
        let measures = BodyMeasures {
            trunk_m: self.trunk_m,
            head_m: self.head_m,
            shoulder_m: Vec3::from(self.shoulder_m),
            upper_arm_m: self.upper_arm_m,
            forearm_m: self.forearm_m,
            hip_m: Vec3::from(self.hip_m),
            thigh_m: self.thigh_m,
            shank_m: self.shank_m,
            foot_m: Vec3::from(self.foot_m),
            girth: self.girth,
        };
        Ok(measures.checked()?)
    }

    /// The measures, and the radii.
    ///
    /// # Errors
    /// A length or radius that is not above zero, or a joint that no body has, by name.
    pub fn size(&self) -> Result<BodySize> {
        let mut size = BodySize::from(self.measures()?);
        for (joint, &radius_m) in &self.radii_m {
            let has_flesh = |bone: &usize| size.radii_m[*bone] > 0.0 && BODY_JOINT_NAMES[*bone] == joint;
            let bone = (0..BODY_BONES).find(has_flesh);
            let bone = bone.with_context(|| format!("`radii_m` has `{joint}`, where no capsule ends; leave it out"))?;
            ensure!(
                radius_m > 0.0 && radius_m.is_finite(),
                "the radius at `{joint}` has to be finite and above 0 metres, not {radius_m}"
            );
            size.radii_m[bone] = radius_m;
        }
        Ok(size)
    }

    /// Reads the measures of a file.
    ///
    /// # Errors
    /// Names the file and what is wrong in it.
    pub fn read(path: &Path) -> Result<BodySize> {
        let text = read_text(path)
            .with_context(|| format!("`{}` cannot be read; check the path and who may read it", path.display()))?;
        let inner = || -> Result<BodySize> { serde_json::from_str::<Self>(&text)?.size() };
        inner().with_context(|| format!("`{}` is no body.json", path.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_come_back_from_their_file() {
        let measures = BodyMeasures::of_height(1.7).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("body.json");
        std::fs::write(&path, serde_json::to_string(&BodyFile::from(&measures)).unwrap()).unwrap();
        assert_eq!(BodyFile::read(&path).unwrap(), measures.into());
        let text = std::fs::read_to_string(&path).unwrap().replace("\"trunk_m\":", "\"trunk_m\":-");
        std::fs::write(&path, text).unwrap();
        let message = format!("{:#}", BodyFile::read(&path).unwrap_err());
        assert!(message.contains("body.json") && message.contains("trunk_m"), "{message}");
    }
}
