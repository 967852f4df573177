//! Reads any motion, by the ending of its file's name.

use super::error::MotionError;
use super::given_names::add_named_points;
use super::markers::MarkerMotion;
use super::read_options::ReadOptions;
use super::recording::Motion;
use crate::registry::{JointReader, Kind, MOTION, Reader, choice, extensions, find, formats, sniff};
use std::io::Read;
use std::path::Path;

/// Bytes of a file that show its format.
const SIGNATURE_BYTES: u64 = 16;

/// Reads the joints of a motion.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path, options: &ReadOptions<'_>) -> Result<Motion, MotionError> {
    let rate = options.rate();
    if !(rate > 0.0 && rate.is_finite()) {
        let rule = format!("must be greater than zero, not {rate}");
        return Err(MotionError::Parameter { parameter: "frames_per_second", rule });
    }
    // A file that is missing is reported as missing, whatever its name.
    let unreadable = |reason| MotionError::Unreadable { path: path.to_path_buf(), reason };
    std::fs::metadata(path).map_err(unreadable)?;
    match find(path, &[Kind::JointMotion]).map(|format| format.reader) {
        Some(Reader::Joints(reader)) => (reader.read)(path, options),
        _ => Err(MotionError::UnknownKind { path: path.to_path_buf(), known: known(path) }),
    }
}

/// Reads a motion in space: markers, or the joints of the whole body.
///
/// `options.frames_per_second` also replaces the rate of a file that gives one, and
/// [`MarkerMotion::replaced_rate_hz`] keeps that.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read_space(path: &Path, options: &ReadOptions<'_>) -> Result<MarkerMotion, MotionError> {
    let mut motion = match find(path, MOTION).map(|format| format.reader) {
        Some(Reader::Markers(reader)) => (reader.read)(path, options)?,
        Some(Reader::Joints(JointReader { read_whole_body: Some(read), .. })) => {
            MarkerMotion::from(&read(path, options)?)
        }
        _ => MarkerMotion::from(&read(path, options)?),
    };
    if let Some(rate) = options.frames_per_second {
        motion.replaced_rate_hz = gives_rate(path).then_some(motion.frames_per_second);
        motion.frames_per_second = rate;
    }
    if let Some(names) = options.names {
        add_named_points(&mut motion, names)?;
    }
    Ok(motion)
}

/// Whether the motion at `path` needs a skeleton from another file.
#[must_use]
pub fn needs_skeleton(path: &Path) -> bool {
    let reader = find(path, &[Kind::JointMotion]).map(|format| format.reader);
    matches!(reader, Some(Reader::Joints(reader)) if reader.needs_skeleton)
}

/// Whether the points of the motion at `path` are markers on the skin.
#[must_use]
pub fn has_skin_markers(path: &Path) -> bool {
    let reader = find(path, &[Kind::MarkerMotion]).map(|format| format.reader);
    matches!(reader, Some(Reader::Markers(reader)) if reader.is_on_skin)
}

/// Whether the motion at `path` gives its rate.
fn gives_rate(path: &Path) -> bool {
    match find(path, MOTION).map(|format| format.reader) {
        Some(Reader::Joints(reader)) => reader.has_rate,
        Some(Reader::Markers(_)) => true,
        _ => false,
    }
}

/// The endings of motions that do not give their rate: `.amc, .txt`.
#[must_use]
pub fn endings_without_rate() -> String {
    let without = formats(&[Kind::JointMotion])
        .filter(|format| matches!(format.reader, Reader::Joints(reader) if !reader.has_rate));
    without.flat_map(|format| format.extensions).map(|end| format!(".{end}")).collect::<Vec<_>>().join(", ")
}

/// What to give instead of the file at `path`.
fn known(path: &Path) -> String {
    let mut words = Vec::new();
    for format in formats(&[Kind::JointMotion]) {
        let note = if needs_skeleton(Path::new(&format!("m.{}", format.extensions[0]))) {
            format!(" (with its {})", extensions(&[Kind::Skeleton]))
        } else if format.note.is_empty() {
            String::new()
        } else {
            format!(" of {}", format.note)
        };
        words.extend(format.extensions.iter().map(|extension| format!("a .{extension}{note}")));
    }
    let joints = words.join(", ");
    let text = format!("{joints}, or for a whole body a {}", choice(&[Kind::MarkerMotion]));
    let mut beginning = Vec::new();
    let content = std::fs::File::open(path).map(|file| file.take(SIGNATURE_BYTES).read_to_end(&mut beginning));
    match sniff(&beginning, MOTION).filter(|_| content.is_ok()) {
        Some(format) => format!("{text} (its content begins as {}: name it *.{})", format.name, format.extensions[0]),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn without_a_skeleton_in_the_folder_the_option_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let motion = folder.path().join("m.amc");
        fs::write(&motion, "1\n").unwrap();
        let message = read(&motion, &ReadOptions::default()).unwrap_err().to_string();
        assert!(message.contains("0 .asf files") && message.contains("--skeleton FILE.asf"), "{message}");
    }

    #[test]
    fn an_unknown_ending_is_answered_with_the_known_ones() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.dat");
        fs::write(&path, "no motion").unwrap();
        let message = |path: &Path| read_space(path, &ReadOptions::default()).unwrap_err().to_string();
        let wanted = "is of no known kind; give a .bvh, a .amc (with its .asf), a .txt of exponential maps, \
            or for a whole body a .trc or .c3d";
        assert!(message(&path).ends_with(wanted), "{}", message(&path));
        fs::write(&path, "HIERARCHY").unwrap();
        assert!(message(&path).ends_with("begins as BVH: name it *.bvh)"), "{}", message(&path));
        assert!(message(&folder.path().join("missing.dat")).contains("check the path"));
    }

    #[test]
    fn formats_differ_in_what_they_lack() {
        let of = |test: fn(&Path) -> bool| {
            let all = crate::registry::endings(MOTION);
            all.filter(|end| test(Path::new(&format!("m.{end}")))).collect::<Vec<_>>()
        };
        assert_eq!((of(needs_skeleton), of(has_skin_markers)), (vec!["amc"], vec!["c3d"]));
        assert_eq!(endings_without_rate(), ".amc, .txt");
    }
}
