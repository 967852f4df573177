//! Names that a user gives to the points of a file: lines as `left_hip,NAME`, with further names
//! for the middle of several points.

use super::error::{MotionError, read_text};
use super::joint_names::given::{PREFIX, joint_names};
use super::markers::{MarkerMotion, middle};
use crate::quote::listed;
use std::path::Path;

/// Adds a point to `motion` for each joint that the file at `path` names.
///
/// # Errors
/// The file cannot be read, names no joint that is known, or a point that `motion` does not have.
pub(super) fn add_named_points(motion: &mut MarkerMotion, path: &Path) -> Result<(), MotionError> {
    let text = read_text(path)?;
    for (index, line) in text.lines().enumerate() {
        let line = line.split_once('#').map_or(line, |(before, _)| before).trim();
        let words: Vec<&str> = line.split([',', ';', '\t', '=']).map(unquoted).collect();
        let is_heading = index == 0 && words[0].eq_ignore_ascii_case("joint");
        if line.is_empty() || is_heading {
            continue;
        }
        let broken = |rule: String| MotionError::broken(path, index + 1, rule);
        let joint = words[0].to_ascii_lowercase();
        if !joint_names().any(|known| known == joint) {
            let known = joint_names().map(str::to_owned).collect::<Vec<_>>();
            return Err(broken(format!("`{}` is no joint; name one of {}", words[0], listed(&known))));
        }
        let point = |name: &&str| {
            let found = motion.names.iter().position(|other| other.trim() == *name);
            found.ok_or_else(|| broken(format!("`{name}` is no point of the motion; it has {}", listed(&motion.names))))
        };
        let named: Vec<&str> = words[1..].iter().copied().filter(|name| !name.is_empty()).collect();
        let points: Vec<usize> = named.iter().map(point).collect::<Result<_, _>>()?;
        if points.is_empty() {
            return Err(broken(format!("`{joint}` needs the name of a point after a comma")));
        }
        motion.names.push(format!("{PREFIX}{joint}"));
        if !motion.parents.is_empty() {
            motion.parents.push(None);
        }
        for positions_m in &mut motion.positions_m {
            positions_m.push(middle(points.iter().map(|&point| positions_m[point])));
        }
    }
    Ok(())
}

/// Without spaces, quotes and the brackets of a list.
fn unquoted(word: &str) -> &str {
    word.trim_matches(|letter: char| letter.is_whitespace() || matches!(letter, '"' | '\'' | '[' | ']'))
}

#[cfg(test)]
mod tests {
    use super::super::joint_names::{HIPS, JointSources, NECK, SHOULDERS};
    use super::*;
    use sinew_core::math::Vec3;

    fn motion() -> MarkerMotion {
        let names = "a b c LShoulder RShoulder LElbow RElbow LWrist RWrist RHip LKnee RKnee LAnkle RAnkle";
        let names: Vec<String> = names.split(' ').map(str::to_owned).collect();
        let positions_m = vec![(0..names.len()).map(|index| Some(Vec3::new(index as f32, 0.0, 0.0))).collect()];
        MarkerMotion { frames_per_second: 50.0, names, positions_m, ..MarkerMotion::default() }
    }

    fn added(text: &str) -> Result<MarkerMotion, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("names.csv");
        std::fs::write(&path, text).unwrap();
        let mut motion = motion();
        add_named_points(&mut motion, &path).map_err(|error| error.to_string())?;
        Ok(motion)
    }

    #[test]
    fn named_points_go_before_all_others() {
        for text in [
            "joint,name\nleft_hip,b\nright_knee,a,c\nleft_toe,c\n",
            "# mine\r\nleft_hip = \"b\"\r\nright_knee = [\"a\", \"c\"]\r\n\r\nleft_toe = 'c'",
        ] {
            let motion = added(text).unwrap();
            let sources = JointSources::find(&motion.names, false, Path::new("m.trc")).unwrap();
            let joints = sources.of_motion(&motion)[0];
            let x = |joint: usize| joints[joint].unwrap().x;
            assert_eq!((x(HIPS[0]), x(HIPS[1] + 1), x(HIPS[0] + 1)), (1.0, 1.0, 10.0));
            let [[heel, toe], right] = sources.feet_of_motion(&motion)[0];
            assert_eq!((heel, toe.unwrap().x, right), (None, 2.0, [None, None]));
        }
    }

    #[test]
    fn a_named_shoulder_leaves_the_collar_to_the_neck() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("names.csv");
        std::fs::write(&path, "left_shoulder,a\nright_shoulder,b").unwrap();
        let mut motion = motion();
        motion.names[2] = "LHip".to_owned();
        add_named_points(&mut motion, &path).unwrap();
        let sources = JointSources::find(&motion.names, false, Path::new("m.trc")).unwrap();
        let joints = sources.of_motion(&motion)[0].map(|joint| joint.unwrap().x);
        assert_eq!((joints[NECK], joints[SHOULDERS[0]], joints[SHOULDERS[1]]), (3.5, 0.0, 1.0));
    }

    #[test]
    fn wrong_names_are_refused_with_line_and_remedy() {
        for (text, wanted) in [
            ("left_hip,b\nleft_nose,a", "names.csv:2: `left_nose` is no joint; name one of hips, neck"),
            ("left_hip,d", "names.csv:1: `d` is no point of the motion; it has a, b, c"),
            ("left_hip", "names.csv:1: `left_hip` needs the name of a point"),
        ] {
            let message = added(text).unwrap_err();
            assert!(message.contains(wanted), "{message} lacks {wanted}");
        }
    }
}
