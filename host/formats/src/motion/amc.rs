//! Acclaim motions (AMC): per frame a line of angles for each bone of an ASF skeleton.
//!
//! A bone turns by C R C^-1, with C from its `axis` and R = Rz Ry Rx of its degrees of freedom. Its
//! end is the parent's end + global rotation * direction * length.

use super::asf::{self, Skeleton, about, rotation_axis};
use super::error::{MotionError, number, read_text};
use super::read_options::ReadOptions;
use super::recording::Motion;
use super::shortfall::check_positions;
use sinew_core::math::{Mat3, Vec3};
use std::collections::BTreeMap;
use std::path::Path;

/// Reads a motion of `skeleton`, recorded at `frames_per_second`.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path, skeleton: &Skeleton, frames_per_second: f32) -> Result<Motion, MotionError> {
    parse(&read_text(path)?, path, skeleton, frames_per_second)
}

/// Reads a motion of the skeleton that `options` names, or of the only one in the motion's folder.
///
/// # Errors
/// Names the file, the line and the rule that it broke; or the folder without a skeleton.
pub fn read_with_skeleton(path: &Path, options: &ReadOptions<'_>) -> Result<Motion, MotionError> {
    let skeleton = match options.skeleton {
        Some(skeleton) => asf::read(skeleton)?,
        None => asf::read(&asf::beside(path)?)?,
    };
    read(path, &skeleton, options.rate())
}

/// Parses the text of a motion; `path` is for messages only. The joints are `root` and the ends of
/// all bones.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path, skeleton: &Skeleton, frames_per_second: f32) -> Result<Motion, MotionError> {
    let mut joints = vec!["root".to_string()];
    joints.extend(skeleton.bones.iter().map(|bone| bone.name.clone()));
    // The joint of a bone is its end, behind the root.
    let mut parents = vec![None];
    parents.extend(skeleton.bones.iter().map(|bone| Some(bone.parent.map_or(0, |parent| parent + 1))));
    let index: BTreeMap<&str, usize> = skeleton.bones.iter().enumerate().map(|(i, b)| (b.name.as_str(), i)).collect();
    let radians_per_unit = core::f32::consts::PI / 180.0;
    let mut reader = Reader { path, skeleton, index, radians_per_unit, frame: None, bytes: text.len() };
    let mut motion = Motion { frames_per_second, joints, parents, positions_m: Vec::new(), shortfall: None };
    let mut line = 0;
    for content in text.lines() {
        line += 1;
        let words: Vec<&str> = content.split_whitespace().collect();
        match words.as_slice() {
            [] => {}
            [first, ..] if first.starts_with('#') => {}
            [first, ..] if first.starts_with(':') => reader.header(first),
            [single] if single.parse::<u64>().is_ok() => reader.next_frame(line, single, &mut motion)?,
            [name, values @ ..] => reader.values(line, name, values)?,
        }
    }
    reader.finish_frame(line, &mut motion)?;
    if motion.is_empty() {
        return Err(MotionError::broken(path, line, "a motion needs at least one frame"));
    }
    Ok(motion)
}

/// Angles of the frame that is being read, radians; `None` until its line came.
#[derive(Debug)]
struct Frame {
    number: u64,
    root: Option<(Vec3, Mat3)>,
    rotations: Vec<Option<Mat3>>,
}

#[derive(Debug)]
struct Reader<'a> {
    path: &'a Path,
    skeleton: &'a Skeleton,
    index: BTreeMap<&'a str, usize>,
    radians_per_unit: f32,
    frame: Option<Frame>,
    /// Bytes of the file.
    bytes: usize,
}

impl Reader<'_> {
    fn broken(&self, line: usize, rule: impl Into<String>) -> MotionError {
        MotionError::broken(self.path, line, rule)
    }

    fn header(&mut self, word: &str) {
        if word.eq_ignore_ascii_case(":radians") {
            self.radians_per_unit = 1.0;
        }
    }

    fn next_frame(&mut self, line: usize, word: &str, motion: &mut Motion) -> Result<(), MotionError> {
        let number: u64 = word.parse().unwrap_or(0);
        if let Some(before) = self.frame.as_ref().map(|frame| frame.number)
            && Some(number) != before.checked_add(1)
        {
            return Err(self.broken(line, format!("frame {number} follows frame {before}; one is missing")));
        }
        self.finish_frame(line, motion)?;
        let bones = &self.skeleton.bones;
        let rotations = bones.iter().map(|b| b.degrees_of_freedom.is_empty().then(Mat3::identity)).collect();
        self.frame = Some(Frame { number, root: None, rotations });
        Ok(())
    }

    fn values(&mut self, line: usize, name: &str, words: &[&str]) -> Result<(), MotionError> {
        let values = words.iter().map(|word| number(self.path, line, word)).collect::<Result<Vec<f32>, _>>()?;
        let expected = match self.index.get(name) {
            Some(&bone) => self.skeleton.bones[bone].degrees_of_freedom.len(),
            None if name == "root" => self.skeleton.root_order.len(),
            None => return Err(self.broken(line, format!("bone `{name}` is not in the skeleton"))),
        };
        if values.len() != expected {
            return Err(self.broken(line, format!("`{name}` needs {expected} numbers, found {}", values.len())));
        }
        let root = (name == "root").then(|| self.root(&values));
        let Some(frame) = self.frame.as_mut() else {
            return Err(self.broken(line, "values before the first frame number"));
        };
        if let Some(&bone) = self.index.get(name) {
            let bone_axes = &self.skeleton.bones[bone];
            let mut rotation = Mat3::identity();
            for (&axis, value) in bone_axes.degrees_of_freedom.iter().zip(&values) {
                rotation = about(axis, value * self.radians_per_unit) * rotation;
            }
            frame.rotations[bone] = Some(bone_axes.axes * rotation * bone_axes.axes.transpose());
        } else {
            frame.root = root;
        }
        Ok(())
    }

    /// Position in file units and global rotation of the root.
    fn root(&self, values: &[f32]) -> (Vec3, Mat3) {
        let (mut position, mut rotation) = (Vec3::zeros(), Mat3::identity());
        for (kind, &value) in self.skeleton.root_order.iter().zip(values) {
            match (rotation_axis(kind), kind.as_str()) {
                (Some(axis), _) => rotation = about(axis, value * self.radians_per_unit) * rotation,
                (None, "tx") => position.x = value,
                (None, "ty") => position.y = value,
                (None, _) => position.z = value,
            }
        }
        let axes = self.skeleton.root_axes;
        (position, axes * rotation * axes.transpose())
    }

    fn finish_frame(&mut self, line: usize, motion: &mut Motion) -> Result<(), MotionError> {
        let Some(frame) = self.frame.take() else { return Ok(()) };
        check_positions(motion.joints.len(), motion.len() + 1, self.bytes, self.path, line)?;
        let lacks = |name: &str| self.broken(line, format!("frame {} ends without values of `{name}`", frame.number));
        let root = frame.root.ok_or_else(|| lacks("root"))?;
        let mut globals: Vec<(Vec3, Mat3)> = Vec::with_capacity(self.skeleton.bones.len());
        let scale = self.skeleton.metres_per_unit;
        motion.positions_m.push(root.0 * scale);
        for (bone, local) in self.skeleton.bones.iter().zip(&frame.rotations) {
            let local = local.ok_or_else(|| lacks(&bone.name))?;
            let parent = bone.parent.map_or(root, |index| globals[index]);
            let rotation = parent.1 * local;
            let end = parent.0 + rotation * bone.offset;
            globals.push((end, rotation));
            motion.positions_m.push(end * scale);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASF: &str = ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n position 0 0 0\n orientation 0 0 0\n\
        :bonedata\n begin\n id 1\n name upper\n direction 0 -1 0\n length 4.5\n axis 0 0 90 XYZ\n dof rx ry rz\n limits (-1 1)\n (-1 1)\n (-1 1)\n end\n\
        begin\n id 2\n name lower\n direction 0 -1 0\n length 9\n axis 0 0 0 XYZ\n dof rx\n end\n\
        begin\n id 3\n name tip\n direction 1 0 0\n length 0.45\n axis 0 0 0 XYZ\n end\n\
        :hierarchy\n begin\n root upper\n upper lower\n lower tip\n end\n";

    fn skeleton() -> Skeleton {
        asf::parse(ASF, Path::new("s.asf")).unwrap()
    }

    fn positions(text: &str) -> Result<Motion, MotionError> {
        parse(text, Path::new("m.amc"), &skeleton(), 120.0)
    }

    fn close(a: Vec3, b: [f32; 3]) -> bool {
        (a - Vec3::new(b[0], b[1], b[2])).norm() < 1.0e-5
    }

    #[test]
    fn a_straight_chain_hangs_down_in_metres() {
        let motion = positions(":DEGREES\n1\nroot 0.45 0 0 0 0 0\nupper 0 0 0\nlower 0\n").unwrap();
        let frame = motion.frame(0);
        assert!(close(frame[0], [0.0254, 0.0, 0.0]));
        assert!(close(frame[1], [0.0254, -0.254, 0.0]));
        assert!(close(frame[2], [0.0254, -0.762, 0.0]));
        assert!(close(frame[3], [0.0508, -0.762, 0.0]));
    }

    /// C = Rz(90): a turn by 90 degrees about the bone's own x is one about world y. It keeps (0,
    /// -1, 0) and turns the tip from x to -z. The lower bone's 90 degrees about x turn (0, -1, 0)
    /// to (0, 0, -1) before that.
    #[test]
    fn a_bone_turns_about_its_own_axes() {
        let motion = positions("1\nroot 0 0 0 0 0 0\nupper 90 0 0\nlower 90\n").unwrap();
        let frame = motion.frame(0);
        assert!(close(frame[1], [0.0, -0.254, 0.0]));
        assert!(close(frame[2], [-0.508, -0.254, 0.0]), "{:?}", frame[2]);
        assert!(close(frame[3], [-0.508, -0.254, -0.0254]), "{:?}", frame[3]);
    }

    #[test]
    fn the_root_turns_everything_in_the_order_z_y_x() {
        let motion = positions("1\nroot 0 0 0 90 0 90\nupper 0 0 0\nlower 0\n").unwrap();
        // x first: (0, -1, 0) -> (0, 0, -1); then z leaves it. The tip: x stays x, then turns to y.
        assert!(close(motion.frame(0)[2], [0.0, 0.0, -0.762]));
        assert!(close(motion.frame(0)[3], [0.0, 0.0254, -0.762]));
    }

    #[test]
    fn broken_files_name_file_line_and_rule() {
        let cases = [
            ("1\nroot 0 0 0 0 0 0\nupper 0 0\nlower 0\n", "m.amc:3: `upper` needs 3 numbers, found 2"),
            ("1\nroot 0 0 0 0 0 0\nupper 0 NaN 0\nlower 0\n", "m.amc:3: `NaN` is not finite"),
            ("1\nroot 0 0 0 0 0 0\nupper 0 x 0\nlower 0\n", "m.amc:3: a number was expected, found `x`"),
            ("1\nroot 0 0 0 0 0 0\nupper 0 0 0\n", "m.amc:3: frame 1 ends without values of `lower`"),
            ("1\nroot 0 0 0 0 0 0\nupper 0 0 0\nlower 0\n3\n", "m.amc:5: frame 3 follows frame 1"),
            ("1\nroot 0 0 0 0 0 0\nother 0\n", "m.amc:3: bone `other` is not in the skeleton"),
            ("upper 0 0 0\n", "m.amc:1: values before the first frame number"),
            ("", "m.amc:0: a motion needs at least one frame"),
        ];
        for (text, message) in cases {
            let found = positions(text).unwrap_err().to_string();
            assert!(found.starts_with(message), "{found} does not start with {message}");
        }
    }

    #[test]
    fn broken_skeletons_name_file_line_and_rule() {
        let changes = [
            ("upper lower", "lost lower", "s.asf:39: parent `lost` is not connected"),
            ("root upper", "root upper tip upper", "s.asf:38: bone `upper` has a second parent"),
            ("lower tip", "", "s.asf:41: bone `tip` is not in :hierarchy"),
            ("dof rx\n", "dof tx\n", "s.asf:27: degree of freedom `tx`"),
            ("direction 1 0 0", "direction 1 0", "s.asf:32: `direction` has too few values"),
            ("length 9\n", "", "s.asf:27: a bone without `length`"),
            (" axis 0 0 90 XYZ", " axis 0 0 90 XQZ", "s.asf:15: the axis order has to be made of X, Y and Z"),
            (" length 0.45\n angle", " length 0\n angle", "s.asf:2: the length unit has to be greater than zero"),
        ];
        for (from, to, message) in changes {
            let found = asf::parse(&ASF.replacen(from, to, 1), Path::new("s.asf")).unwrap_err().to_string();
            assert!(found.starts_with(message), "{found} does not start with {message}");
        }
    }
}
