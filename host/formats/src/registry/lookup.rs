//! Formats of some kinds, by ending or by content.

use super::format::{Format, Kind};
use super::table::FORMATS;
use crate::file::open;
use std::io::Read;
use std::path::Path;

/// A motion in space: joints or markers.
pub const MOTION: &[Kind] = &[Kind::JointMotion, Kind::MarkerMotion];
/// How much of a file shows its first line. Chosen: three times the longest first number.
const BEGINNING_BYTES: u64 = 64;
/// What a person's segment lengths can be measured from.
pub const MEASURABLE: &[Kind] = &[Kind::JointMotion, Kind::Skeleton, Kind::MarkerMotion];

/// All formats of `kinds`, in the order of texts.
pub fn formats(kinds: &[Kind]) -> impl Iterator<Item = &'static Format> {
    FORMATS.iter().filter(move |format| kinds.contains(&format.kind()))
}

/// The endings of all formats of `kinds`, lower case, without a dot.
pub fn endings(kinds: &[Kind]) -> impl Iterator<Item = &'static str> {
    formats(kinds).flat_map(|format| format.extensions.iter().copied())
}

/// The format of `kinds` that the ending of `path` stands for, in any case.
#[must_use]
pub fn find(path: &Path, kinds: &[Kind]) -> Option<&'static Format> {
    let extension = path.extension()?.to_str()?;
    formats(kinds).find(|format| format.extensions.iter().any(|known| extension.eq_ignore_ascii_case(known)))
}

/// The format of `kinds` as which a file's content begins; `None` for formats without a signature.
#[must_use]
pub fn sniff(content: &[u8], kinds: &[Kind]) -> Option<&'static Format> {
    formats(kinds).find(|format| format.begins(content))
}

/// The format of `kinds` that the ending of `path` stands for, if its first line may be of that,
/// too: notes have the ending of a motion. A file that cannot be read may be of it.
#[must_use]
pub fn find_by_content(path: &Path, kinds: &[Kind]) -> Option<&'static Format> {
    let may_be = |is_first_line: fn(&str) -> bool| {
        let mut beginning = Vec::new();
        let read = open(path).and_then(|file| file.take(BEGINNING_BYTES).read_to_end(&mut beginning));
        let text = String::from_utf8_lossy(&beginning);
        let mut lines = text.trim_start_matches('\u{feff}').lines();
        read.is_err() || lines.find(|line| !line.trim().is_empty()).is_some_and(is_first_line)
    };
    find(path, kinds).filter(|format| format.first_line_rule().is_none_or(may_be))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn endings_are_lower_case_and_name_one_format_of_a_kind() {
        for format in &FORMATS {
            let kind = [format.kind()];
            assert!(!format.extensions.is_empty(), "{}", format.name);
            for extension in format.extensions {
                assert_eq!(*extension, extension.to_ascii_lowercase());
                let path = format!("a.{}", extension.to_ascii_uppercase());
                assert_eq!(find(Path::new(&path), &kind).unwrap().name, format.name);
            }
            let all: Vec<&str> = endings(&kind).collect();
            assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len(), "{all:?}");
        }
        assert!(find(Path::new("bvh"), MOTION).is_none());
        assert!(find(Path::new("a.ply"), MOTION).is_none());
    }

    #[test]
    fn a_text_without_numbers_is_no_motion() {
        let folder = tempfile::tempdir().unwrap();
        let is_found = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            find_by_content(&path, MOTION).is_some()
        };
        assert!(is_found("walk.txt", "\n0.5, -1.25,3\n") && is_found("walk.TXT", "\u{feff}1,"));
        for notes in ["", "Anna, second trial\n", "12 trials\n", "2024-05-01, Anna\n"] {
            assert!(!is_found("notes.txt", notes), "{notes}");
        }
        assert!(is_found("empty.bvh", ""), "its error says more");
    }

    #[test]
    fn content_shows_its_format() {
        let cases: [(&[u8], &[Kind], Option<&str>); 6] = [
            (b"HIERARCHY\nROOT Hips", MOTION, Some("BVH")),
            (b"\x02\x50", MOTION, Some("C3D")),
            (b"PathFileType\t4", MEASURABLE, Some("TRC")),
            (b"ply\nformat", &[Kind::Cloud], Some("PLY")),
            (b"P5 1 1 255 a", &[Kind::Image], Some("PGM")),
            (b"", MOTION, None),
        ];
        for (content, kinds, wanted) in cases {
            assert_eq!(sniff(content, kinds).map(|format| format.name), wanted);
        }
    }
}
