//! A folder of text files as ultralytics YOLO writes them: one file a frame, one line a person. A
//! line has class, box (centre and size) and points, all as shares of the picture.

use super::error::{KeypointError, read_lines};
use super::file_numbers;
use super::orders::{self, PointFrame, Points};
use std::path::{Path, PathBuf};

/// Numbers of a line before its points: class, centre and size of the box.
const BEFORE_POINTS: usize = 5;
/// Numbers of a line after its points, at most: the box's confidence and the track's number.
const MAX_AFTER_POINTS: usize = 2;

/// Reads all text files of a folder.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read_folder(files: &[PathBuf]) -> Result<(Vec<PointFrame>, bool), KeypointError> {
    let names: Vec<String> = files.iter().map(|path| path.to_string_lossy().into_owned()).collect();
    let numbered = file_numbers::frames(&names);
    let read = |&(frame, index): &(u64, usize)| {
        let path = &files[index];
        Ok(PointFrame { frame, people: people(&read_lines(path)?, path)? })
    };
    Ok((numbered.frames.iter().map(read).collect::<Result<_, _>>()?, numbered.is_counted))
}

fn people(text: &str, path: &Path) -> Result<Vec<Points>, KeypointError> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines
        .map(|(index, line)| {
            person(line).map_err(|rule| KeypointError::broken(path, format!("line {}", index + 1), rule))
        })
        .collect()
}

fn person(line: &str) -> Result<Points, String> {
    let number = |cell: &str| {
        let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("`{cell}` has to be a finite number"))
    };
    let values = line.split_whitespace().map(number).collect::<Result<Vec<f64>, String>>()?;
    let values = values.get(BEFORE_POINTS..).unwrap_or_default();
    for width in [3, 2] {
        for after in 0..=MAX_AFTER_POINTS {
            let Some(points) = values.len().checked_sub(after).map(|end| &values[..end]) else { continue };
            if points.len().is_multiple_of(width) && orders::parts(points.len() / width).is_some() {
                let triples =
                    points.chunks(width).flat_map(|point| [point[0], point[1], point.get(2).copied().unwrap_or(1.0)]);
                return orders::points(&triples.collect::<Vec<f64>>());
            }
        }
    }
    Err(format!(
        "{} numbers after class and box; a line of YOLO pose is `class cx cy w h`, then x, y, confidence of 17 points",
        values.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_with_and_without_confidence_box_score_and_track_are_read() {
        let line = |width: usize, after: &str| {
            let points: String = (0..17)
                .map(|i| [" 0.5", " 0.25", " 0.8"][..width].concat().replace("0.5", &format!("0.{}", 10 + i)))
                .collect();
            person(&format!("0 0.5 0.5 0.2 0.8{points}{after}"))
        };
        for after in ["", " 0.9", " 0.9 3"] {
            let found = line(3, after).unwrap();
            assert_eq!((found.len(), found[1]), (17, [0.11, 0.25, 0.8]), "{after}");
        }
        assert_eq!(line(2, "").unwrap()[1], [0.11, 0.25, 1.0]);
        assert!(person("0 0.5 0.5 0.2 0.8").unwrap_err().starts_with("0 numbers after class and box"));
        assert!(person("0 0.5 x").unwrap_err().contains("`x` has to be a finite number"));
        assert_eq!(people("\n", Path::new("a.txt")).unwrap().len(), 0);
    }
}
