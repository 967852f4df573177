//! The person's measures from a file: `body.json`, or a motion or skeleton that is measured.

use crate::body::recording::BodyRecording;
use crate::body::{BodyFile, BodySize, BodySources, measure};
use crate::error::{Context, Result, bail, ensure};
use crate::motion::{self, DEFAULT_FRAMES_PER_SECOND, MarkerMotion, ReadOptions, amc, asf};
use crate::registry::{Kind, MEASURABLE, extensions, find};
use sinew_core::kinematics::forward::posture;
use sinew_core::math::Vec3;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLES, full_body};
use std::path::Path;

/// Height of a person of whom nothing is known, metres.
pub const UNKNOWN_HEIGHT_M: f32 = 1.75;
/// Farthest joint from the pelvis of a standing person, metres.
const MAX_REACH_M: f32 = 2.0;

/// Reads measures from a .json as `simulate stereo` writes it, or measures the person of a motion.
/// Of a .asf without motion the rest pose is measured. With `partial` a motion may have fewer
/// frames than its header promises, of which a note is made.
///
/// # Errors
/// Names the file, and what is missing in it or breaks a rule.
pub fn read_measures(path: &Path, partial: bool, notes: &mut Vec<String>) -> Result<BodySize> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    let measures = match extension.as_str() {
        "json" => BodyFile::read(path)?,
        _ if find(path, MEASURABLE).is_some() => measured(path, partial, notes)
            .with_context(|| format!("the person of `{}` cannot be measured", path.display()))?
            .into(),
        _ => bail!(
            "`{}` is no skeleton that can be read; give a body.json, or a motion to measure ({})",
            path.display(),
            extensions(MEASURABLE)
        ),
    };
    checked(measures, &path.display().to_string())
}

/// The measures of a JSON text as `body.json` has it; messages call it `name`.
///
/// # Errors
/// Names the text, and what is missing in it or breaks a rule.
pub fn measures_from_json(text: &str, name: &str) -> Result<BodySize> {
    let parsed = || -> Result<BodySize> { serde_json::from_str::<BodyFile>(text)?.size() };
    checked(parsed().with_context(|| format!("`{name}` is no body.json"))?, name)
}

/// The measures of a person of whom the height is known, metres; `None` is one of
/// [`UNKNOWN_HEIGHT_M`], of which a note is made.
///
/// # Errors
/// No person is as tall.
pub fn measures_of_height(height_m: Option<f32>, notes: &mut Vec<String>) -> Result<BodySize> {
    if height_m.is_none() {
        notes.push(format!("nothing says who is tracked; a person {UNKNOWN_HEIGHT_M} m tall (--height, --skeleton)"));
    }
    let height_m = height_m.unwrap_or(UNKNOWN_HEIGHT_M);
    ensure!((0.5..=2.5).contains(&height_m), "--height has to be from 0.5 to 2.5 metres, not {height_m}");
    Ok(BodyMeasures::of_height(height_m)?.into())
}

/// Refuses what is no person's measures; `name` is where they come from.
fn checked(size: BodySize, name: &str) -> Result<BodySize> {
    let skeleton = full_body(&size.measures).with_context(|| format!("`{name}` is no person's skeleton"))?;
    let ends_m = posture(&skeleton, &Vec3::zeros(), &[0.0; BODY_ANGLES]).ends;
    let farthest_m = ends_m.iter().map(Vec3::norm).fold(0.0, f32::max);
    ensure!(
        farthest_m <= MAX_REACH_M,
        "the person of `{name}` has a joint {farthest_m} m from the pelvis, and {MAX_REACH_M} m is the most; give lengths in metres"
    );
    Ok(size)
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
        assert_eq!(read_measures(&path, false, &mut Vec::new()).unwrap(), measures.into());
        write(&BodyFile { shank_m: 40.0, ..file });
        let message = format!("{:#}", read_measures(&path, false, &mut Vec::new()).unwrap_err());
        assert!(message.contains("give lengths in metres"), "{message}");
    }
}
