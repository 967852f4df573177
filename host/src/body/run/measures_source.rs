//! The person's measures from a file: `body.json`, or a motion or skeleton that is measured.

use crate::body::recording::BodyRecording;
use crate::body::{BodyFile, BodySources, measure};
use crate::error::{Context, Result, bail, ensure};
use crate::motion::{self, DEFAULT_FRAMES_PER_SECOND, MarkerMotion, ReadOptions, amc, asf};
use crate::registry::{Kind, MEASURABLE, extensions, find};
use sinew_core::kinematics::forward::posture;
use sinew_core::math::Vec3;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLES, full_body};
use std::path::Path;

/// Farthest joint from the pelvis of a standing person, metres.
const MAX_REACH_M: f32 = 2.0;

/// Reads measures from a .json as `simulate stereo` writes it, or measures the person of a motion.
/// Of a .asf without motion the rest pose is measured. With `partial` a motion may have fewer
/// frames than its header promises, of which a note is made.
///
/// # Errors
/// Names the file, and what is missing in it or breaks a rule.
pub fn read_measures(path: &Path, partial: bool, notes: &mut Vec<String>) -> Result<BodyMeasures> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    let measures = match extension.as_str() {
        "json" => BodyFile::read(path)?,
        _ if find(path, MEASURABLE).is_some() => measured(path, partial, notes)
            .with_context(|| format!("the person of `{}` cannot be measured", path.display()))?,
        _ => bail!(
            "`{}` is no skeleton that can be read; give a body.json, or a motion to measure ({})",
            path.display(),
            extensions(MEASURABLE)
        ),
    };
    let skeleton = full_body(&measures).with_context(|| format!("`{}` is no person's skeleton", path.display()))?;
    let ends_m = posture(&skeleton, &Vec3::zeros(), &[0.0; BODY_ANGLES]).ends;
    let farthest_m = ends_m.iter().map(Vec3::norm).fold(0.0, f32::max);
    ensure!(
        farthest_m <= MAX_REACH_M,
        "the person of `{}` has a joint {farthest_m} m from the pelvis, and {MAX_REACH_M} m is the most; give lengths in metres",
        path.display()
    );
    Ok(measures)
}

fn measured(path: &Path, partial: bool, notes: &mut Vec<String>) -> Result<BodyMeasures> {
    let motion = if find(path, &[Kind::Skeleton]).is_some() {
        let skeleton = asf::read(path)?;
        MarkerMotion::from(&amc::parse(&rest_pose(&skeleton), path, &skeleton, DEFAULT_FRAMES_PER_SECOND)?)
    } else {
        motion::read_space(path, &ReadOptions { partial, ..ReadOptions::default() })?
    };
    notes.extend(motion.shortfall.map(|shortfall| format!("`{}`: {shortfall}", path.display())));
    let joints_m = BodySources::find(&motion.names, path)?.of_motion(&motion);
    measure(&BodyRecording { rate_hz: motion.frames_per_second, joints_m })
}

/// A motion of one frame in which all angles of `skeleton` are zero.
fn rest_pose(skeleton: &asf::Skeleton) -> String {
    let mut text = format!("1\nroot{}\n", " 0".repeat(skeleton.root_order.len()));
    for bone in skeleton.bones.iter().filter(|bone| !bone.degrees_of_freedom.is_empty()) {
        text += &format!("{}{}\n", bone.name, " 0".repeat(bone.degrees_of_freedom.len()));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_skeleton_is_named() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text, wanted) in [
            ("body.json", "{\"trunk_m\": 0.5}", "no body.json"),
            ("body.asf", "nonsense", "cannot be measured"),
            ("body.obj", "", "no skeleton that can be read"),
            ("missing.json", "", "missing.json"),
        ] {
            let path = folder.path().join(name);
            if name != "missing.json" {
                std::fs::write(&path, text).unwrap();
            }
            let message = format!("{:#}", read_measures(&path, false, &mut Vec::new()).unwrap_err());
            assert!(message.contains(wanted) && message.contains(name), "{message}");
        }
    }

    #[test]
    fn measures_of_a_body_file_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("somebody.json");
        let measures = BodyMeasures::of_height(1.6).unwrap();
        let write = |file: &BodyFile| std::fs::write(&path, serde_json::to_string(file).unwrap()).unwrap();
        let file = BodyFile::from(&measures);
        write(&file);
        assert_eq!(read_measures(&path, false, &mut Vec::new()).unwrap(), measures);
        write(&BodyFile { shank_m: 40.0, ..file });
        let message = format!("{:#}", read_measures(&path, false, &mut Vec::new()).unwrap_err());
        assert!(message.contains("give lengths in metres"), "{message}");
    }
}
