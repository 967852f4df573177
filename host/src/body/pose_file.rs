//! A pose by the names of its coordinates, as `first_pose.json` holds it.

use crate::error::{Context, Result, bail};
use crate::json_file::read_json;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_ANGLES, full_body};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// JSON of a pose: metres and radians by name, in the skeleton's order.
#[must_use]
pub fn pose_json(angles: &[f32; BODY_ANGLES]) -> String {
    let mut text = String::from("{\n");
    for (index, (name, value)) in BODY_ANGLE_NAMES.iter().zip(angles).enumerate() {
        let end = if index + 1 < BODY_ANGLES { "," } else { "" };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  \"{name}\": {value:?}{end}");
    }
    text.push_str("}\n");
    text
}

/// Reads a pose; coordinates that are not named are zero.
///
/// # Errors
/// Names the file, and a coordinate that is not known or not a finite number.
pub fn read_pose(path: &Path) -> Result<[f32; BODY_ANGLES]> {
    let inner = || -> Result<[f32; BODY_ANGLES]> { pose(read_json(path)?) };
    inner().with_context(|| format!("the pose `{}` cannot be used", path.display()))
}

/// The pose of a JSON text as a file has it; messages call it `name`.
///
/// # Errors
/// As [`read_pose`].
pub fn pose_from_json(text: &str, name: &str) -> Result<[f32; BODY_ANGLES]> {
    let inner = || -> Result<[f32; BODY_ANGLES]> { pose(serde_json::from_str(text)?) };
    inner().with_context(|| format!("`{name}` cannot be used"))
}

fn pose(named: BTreeMap<String, f32>) -> Result<[f32; BODY_ANGLES]> {
    let mut angles = [0.0; BODY_ANGLES];
    for (name, value) in named {
        let Some(index) = BODY_ANGLE_NAMES.iter().position(|other| *other == name) else {
            bail!("`{name}` is no coordinate; these are {}", BODY_ANGLE_NAMES.join(", "));
        };
        if !value.is_finite() {
            bail!("`{name}` has to be a finite number");
        }
        angles[index] = value;
    }
    Ok(angles)
}

/// `given` inside the limits of a body with `measures`; each coordinate that was not is noted.
/// `from` is where it comes from.
///
/// # Errors
/// Measures that no body has.
pub fn inside_limits(
    given: [f32; BODY_ANGLES],
    measures: &BodyMeasures,
    from: &str,
    notes: &mut Vec<String>,
) -> Result<[f32; BODY_ANGLES]> {
    let inside = full_body(measures)?.clamp(given);
    for (name, (given, inside)) in BODY_ANGLE_NAMES.iter().zip(given.iter().zip(&inside)) {
        if given != inside {
            notes.push(format!("`{from}`: {name} = {given} breaks its limit; {inside} is used"));
        }
    }
    Ok(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_comes_back_bit_by_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("first_pose.json");
        let angles = std::array::from_fn(|index| 0.1 * index as f32 - 1.3);
        std::fs::write(&path, pose_json(&angles)).unwrap();
        assert_eq!(read_pose(&path).unwrap(), angles);
        std::fs::write(&path, "{\"l_elbow\": 1.0}").unwrap();
        assert_eq!(pose_from_json(&pose_json(&angles), "first_pose").unwrap(), angles);
        let message = format!("{:#}", read_pose(&path).unwrap_err());
        assert!(message.contains("`l_elbow` is no coordinate") && message.contains("l_elbow_flexion"), "{message}");
    }
}
