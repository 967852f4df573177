//! Acclaim skeletons (ASF): bones with direction, length, local axis and degrees of freedom.

use super::error::{MotionError, number, read_text};
use crate::limits::MAX_JOINTS;
use sinew_core::math::{Mat3, SIN_COS_MAX_ARGUMENT_RAD, Vec3, axis_rotation};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

const METRES_PER_INCH: f32 = 0.0254;
/// Smallest `length` of `:units`. Chosen: with inches in a metre it is 0.025; smaller ones would
/// put joints beyond all numbers.
const MIN_LENGTH_UNIT: f32 = 1.0e-6;
/// Metres per length unit of the CMU collection, whose files have `length 0.45`.
pub const CMU_METRES_PER_UNIT: f32 = METRES_PER_INCH / 0.45;

/// One degree of freedom of a bone: a rotation about the axis with this index (0 = x, 1 = y, 2 =
/// z).
pub type RotationAxis = usize;

/// A bone; its end is a joint of the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Bone {
    /// Name, unique in the skeleton.
    pub name: String,
    /// Index of the parent bone in [`Skeleton::bones`]; `None` hangs on the root.
    pub parent: Option<usize>,
    /// Direction times length in the rest pose, file units, world axes.
    pub offset: Vec3,
    /// Rotation C of the bone's own axes in the rest pose.
    pub axes: Mat3,
    /// Axes of the values that an AMC file gives, in their order.
    pub degrees_of_freedom: Vec<RotationAxis>,
}

/// A skeleton; parents stand before their children.
#[derive(Debug, Clone, PartialEq)]
pub struct Skeleton {
    /// Metres per file unit: 0.0254 over the `length` of `:units` (CMU: 0.0254 / 0.45).
    pub metres_per_unit: f32,
    /// Radians per angle unit of this file.
    pub radians_per_unit: f32,
    /// What the six values of the root mean, e.g. `TX TY TZ RX RY RZ`, in lower case.
    pub root_order: Vec<String>,
    /// Rotation of the root's own axes.
    pub root_axes: Mat3,
    /// All bones.
    pub bones: Vec<Bone>,
}

/// The one skeleton in the folder of an AMC file.
///
/// # Errors
/// If there is none, or more than one.
pub fn beside(motion: &Path) -> Result<PathBuf, MotionError> {
    let folder = motion.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let unreadable = |reason| MotionError::Unreadable { path: folder.to_path_buf(), reason };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("asf")) {
            found.push(path);
        }
    }
    match found.len() {
        1 => Ok(found.remove(0)),
        n => Err(MotionError::NoSkeleton { path: motion.to_path_buf(), found: format!("{n} .asf files are") }),
    }
}

/// Reads a skeleton.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path) -> Result<Skeleton, MotionError> {
    parse(&read_text(path)?, path)
}

/// A bone as its `begin ... end` block gives it.
#[derive(Debug, Default)]
struct Block {
    name: Option<String>,
    direction: Option<Vec3>,
    length: Option<f32>,
    axes: Option<Mat3>,
    degrees_of_freedom: Vec<RotationAxis>,
}

#[derive(Debug)]
struct Parser<'a> {
    path: &'a Path,
    skeleton: Skeleton,
    block: Option<Block>,
    unordered: Vec<Bone>,
    links: Vec<(usize, String, Vec<String>)>,
    /// Names in `links`.
    linked: usize,
}

/// Parses the text of a skeleton; `path` is for messages only.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path) -> Result<Skeleton, MotionError> {
    let skeleton = Skeleton {
        metres_per_unit: METRES_PER_INCH,
        radians_per_unit: core::f32::consts::PI / 180.0,
        root_order: ["tx", "ty", "tz", "rx", "ry", "rz"].map(String::from).to_vec(),
        root_axes: Mat3::identity(),
        bones: Vec::new(),
    };
    let mut parser = Parser { path, skeleton, block: None, unordered: Vec::new(), links: Vec::new(), linked: 0 };
    let mut section = String::new();
    let mut last_line = 1;
    for (index, raw) in text.lines().enumerate() {
        let (line, content) = (index + 1, raw.trim());
        last_line = line;
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        if let Some(keyword) = content.strip_prefix(':') {
            section = keyword.split_whitespace().next().unwrap_or("").to_ascii_lowercase();
            continue;
        }
        let words: Vec<&str> = content.split_whitespace().collect();
        match section.as_str() {
            "units" => parser.units(line, &words)?,
            "root" => parser.root(line, &words)?,
            "bonedata" => parser.bone(line, &words)?,
            "hierarchy" => parser.link(line, &words)?,
            _ => {}
        }
    }
    parser.finish(last_line)
}

impl Parser<'_> {
    fn broken(&self, line: usize, rule: impl Into<String>) -> MotionError {
        MotionError::broken(self.path, line, rule)
    }

    fn units(&mut self, line: usize, words: &[&str]) -> Result<(), MotionError> {
        match words {
            ["length", value, ..] => {
                let length = number(self.path, line, value)?;
                if length < MIN_LENGTH_UNIT {
                    return Err(self.broken(line, "the length unit has to be greater than zero (1e-6 at least)"));
                }
                self.skeleton.metres_per_unit = METRES_PER_INCH / length;
            }
            ["angle", value, ..] if value.to_ascii_lowercase().starts_with("rad") => {
                self.skeleton.radians_per_unit = 1.0;
            }
            _ => {}
        }
        Ok(())
    }

    fn root(&mut self, line: usize, words: &[&str]) -> Result<(), MotionError> {
        match words {
            ["order", order @ ..] => {
                self.skeleton.root_order = order.iter().map(|w| w.to_ascii_lowercase()).collect();
                for word in &self.skeleton.root_order {
                    if !["tx", "ty", "tz", "rx", "ry", "rz"].contains(&word.as_str()) {
                        return Err(self.broken(line, format!("`{word}` is no channel of a root (TX..TZ, RX..RZ)")));
                    }
                }
            }
            ["orientation", x, y, z, ..] => self.skeleton.root_axes = self.rotation(line, &[x, y, z], "XYZ")?,
            _ => {}
        }
        Ok(())
    }

    fn rotation(&self, line: usize, angles: &[&str; 3], order: &str) -> Result<Mat3, MotionError> {
        let mut rotation = Mat3::identity();
        for (word, axis) in angles.iter().zip(order.chars()) {
            let Some(axis) = axis_index(axis) else {
                return Err(self.broken(line, format!("the axis order has to be made of X, Y and Z, not `{order}`")));
            };
            let angle_rad = number(self.path, line, word)? * self.skeleton.radians_per_unit;
            rotation = about(axis, angle_rad) * rotation;
        }
        Ok(rotation)
    }

    fn bone(&mut self, line: usize, words: &[&str]) -> Result<(), MotionError> {
        if words[0] == "begin" {
            if self.block.is_some() {
                return Err(self.broken(line, "`begin` inside a bone that has no `end` yet"));
            }
            self.block = Some(Block::default());
            return Ok(());
        }
        let Some(mut block) = self.block.take() else {
            return Err(self.broken(line, format!("`{}` outside of a bone; `begin` was expected", words[0])));
        };
        match words {
            ["end", ..] => return self.close(line, block),
            ["name", name, ..] => block.name = Some((*name).to_string()),
            ["direction", x, y, z, ..] => {
                let read = |word| number(self.path, line, word);
                block.direction = Some(Vec3::new(read(x)?, read(y)?, read(z)?));
            }
            ["length", value, ..] => block.length = Some(number(self.path, line, value)?),
            ["axis", x, y, z, order, ..] => block.axes = Some(self.rotation(line, &[x, y, z], order)?),
            ["dof", kinds @ ..] => {
                for kind in kinds {
                    block.degrees_of_freedom.push(rotation_axis(kind).ok_or_else(|| {
                        self.broken(line, format!("degree of freedom `{kind}`; only rx, ry and rz are read"))
                    })?);
                }
            }
            ["direction" | "axis" | "name" | "length", ..] => {
                return Err(self.broken(line, format!("`{}` has too few values", words[0])));
            }
            _ => {} // id, limits, bodymass: not needed
        }
        self.block = Some(block);
        Ok(())
    }

    fn close(&mut self, line: usize, block: Block) -> Result<(), MotionError> {
        let missing = |what| self.broken(line, format!("a bone without `{what}`"));
        let name = block.name.ok_or_else(|| missing("name"))?;
        let direction = block.direction.ok_or_else(|| missing("direction"))?;
        let length = block.length.ok_or_else(|| missing("length"))?;
        if self.unordered.len() >= MAX_JOINTS {
            return Err(self.broken(line, format!("the skeleton has more than {MAX_JOINTS} bones")));
        }
        if self.unordered.iter().any(|bone| bone.name == name) {
            return Err(self.broken(line, format!("a second bone called `{name}`")));
        }
        self.unordered.push(Bone {
            name,
            parent: None,
            offset: direction * length,
            axes: block.axes.unwrap_or_else(Mat3::identity),
            degrees_of_freedom: block.degrees_of_freedom,
        });
        Ok(())
    }

    fn link(&mut self, line: usize, words: &[&str]) -> Result<(), MotionError> {
        if words[0] != "begin" && words[0] != "end" {
            self.linked += words.len();
            // A bone's own name stands before its children's.
            if self.linked > 2 * MAX_JOINTS {
                return Err(self.broken(line, format!("the hierarchy links more than {MAX_JOINTS} bones")));
            }
            let children = words[1..].iter().map(|w| (*w).to_string()).collect();
            self.links.push((line, words[0].to_string(), children));
        }
        Ok(())
    }

    /// Orders the bones along the hierarchy.
    fn finish(mut self, last_line: usize) -> Result<Skeleton, MotionError> {
        if self.block.is_some() {
            return Err(self.broken(last_line, "the last bone has no `end`"));
        }
        for (line, parent, children) in std::mem::take(&mut self.links) {
            let placed = |bones: &[Bone], name: &str| bones.iter().position(|bone| bone.name == name);
            let parent_index = placed(&self.skeleton.bones, &parent);
            if parent != "root" && parent_index.is_none() {
                return Err(
                    self.broken(line, format!("parent `{parent}` is not connected to the root by a line above"))
                );
            }
            for child in children {
                if placed(&self.skeleton.bones, &child).is_some() {
                    return Err(self.broken(line, format!("bone `{child}` has a second parent")));
                }
                let Some(index) = placed(&self.unordered, &child) else {
                    return Err(self.broken(line, format!("bone `{child}` is not in :bonedata")));
                };
                let bone = self.unordered.swap_remove(index);
                self.skeleton.bones.push(Bone { parent: parent_index, ..bone });
            }
        }
        if let Some(lost) = self.unordered.first() {
            return Err(self.broken(last_line, format!("bone `{}` is not in :hierarchy", lost.name)));
        }
        if self.skeleton.bones.is_empty() {
            return Err(self.broken(last_line, "a skeleton needs at least one bone"));
        }
        Ok(self.skeleton)
    }
}

fn axis_index(letter: char) -> Option<usize> {
    "xyz".find(letter.to_ascii_lowercase())
}

/// Axis of `rx`, `ry` or `rz`.
pub(crate) fn rotation_axis(kind: &str) -> Option<RotationAxis> {
    match kind.to_ascii_lowercase().as_str() {
        "rx" => Some(0),
        "ry" => Some(1),
        "rz" => Some(2),
        _ => None,
    }
}

/// Rotation about a coordinate axis.
pub(crate) fn about(axis: usize, angle_rad: f32) -> Mat3 {
    let unit = [Vec3::x(), Vec3::y(), Vec3::z()][axis];
    rotation(&unit, angle_rad)
}

/// Rotation about the unit vector `axis` by any number of turns. Sine and cosine of the core are
/// exact up to [`SIN_COS_MAX_ARGUMENT_RAD`]; beyond it whole turns are taken off.
pub(crate) fn rotation(axis: &Vec3, angle_rad: f32) -> Mat3 {
    let is_exact = angle_rad.abs() <= SIN_COS_MAX_ARGUMENT_RAD;
    axis_rotation(axis, if is_exact { angle_rad } else { (f64::from(angle_rad) % TAU) as f32 })
}
