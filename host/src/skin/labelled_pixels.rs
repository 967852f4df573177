//! Labelled pixels in the form of the UCI "Skin Segmentation" set: rows `B G R label`,
//! where 1 is skin and 2 is not.

use crate::error::{Context, Result, bail};
use crate::file::read_lines;
use std::path::Path;

/// A colour and whether it is skin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LabelledPixel {
    /// Red, green, blue.
    pub rgb: [u8; 3],
    /// Whether it was labelled as skin.
    pub is_skin: bool,
}

/// The rows of a file of labelled pixels, each kept once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelledPixels {
    /// Different (colour, label) rows, sorted; both labels occur.
    pub unique: Vec<LabelledPixel>,
    /// Rows of the file, duplicates included.
    pub row_count: usize,
}

/// Reads rows `B G R label` separated by white space; empty lines are passed over, duplicates are
/// dropped.
///
/// # Errors
/// Names the file, the line and what is wrong there; or says which label is missing.
pub fn read(path: &Path) -> Result<LabelledPixels> {
    let text = read_lines(path).with_context(|| {
        format!("`{}` cannot be read; check the path, and give a file of rows `B G R label`", path.display())
    })?;
    let mut rows = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        let row = parse_row(line)
            .with_context(|| format!("`{}`, line {}: `{}`", path.display(), index + 1, excerpt(line)))?;
        rows.push(row);
    }
    let row_count = rows.len();
    rows.sort_unstable();
    rows.dedup();
    for (label, is_skin) in [("1 (skin)", true), ("2 (not skin)", false)] {
        if !rows.iter().any(|row| row.is_skin == is_skin) {
            bail!("`{}` has no row with label {label}; training needs rows of both labels", path.display());
        }
    }
    Ok(LabelledPixels { unique: rows, row_count })
}

fn parse_row(line: &str) -> Result<LabelledPixel> {
    let fields: Vec<&str> = line.split_whitespace().collect();
    let [blue, green, red, label] = fields[..] else {
        bail!("has {} values, but a row is `B G R label`", fields.len());
    };
    let channel = |name: &str, text: &str| {
        text.parse::<u8>().ok().with_context(|| format!("{name} is `{text}`, but has to be a whole number 0 to 255"))
    };
    let is_skin = match label {
        "1" => true,
        "2" => false,
        other => bail!("the label is `{other}`, but has to be 1 (skin) or 2 (not skin)"),
    };
    Ok(LabelledPixel { rgb: [channel("R", red)?, channel("G", green)?, channel("B", blue)?], is_skin })
}

fn excerpt(line: &str) -> String {
    line.chars().take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn read_text(text: &str) -> Result<LabelledPixels> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pixels.txt");
        fs::write(&path, text).unwrap();
        read(&path)
    }

    #[test]
    fn rows_are_turned_to_rgb_and_kept_once() {
        let pixels = read_text("74\t85 123  1\n\n74 85 123 1\r\n1 2 3 2\n74 85 123 2\n").unwrap();
        assert_eq!(pixels.row_count, 4);
        let expected = [([3, 2, 1], false), ([123, 85, 74], false), ([123, 85, 74], true)];
        assert_eq!(pixels.unique, expected.map(|(rgb, is_skin)| LabelledPixel { rgb, is_skin }));
    }

    #[test]
    fn a_bad_row_is_named_with_its_line() {
        for (text, words) in [
            ("1 2 3 1\n1 2 256 2\n", "R is `256`"),
            ("1 2 3 1\n1 2 3\n", "3 values"),
            ("1 2 3 1\n1 2 3 0\n", "label is `0`"),
        ] {
            let message = format!("{:#}", read_text(text).unwrap_err());
            assert!(message.contains("pixels.txt`, line 2") && message.contains(words), "{message}");
        }
        let message = format!("{:#}", read_text("1 2 3 2\n").unwrap_err());
        assert!(message.contains("label 1 (skin)"), "{message}");
    }
}
