//! Columns of a run's tables as numbers, row by row of a file of any length.

use crate::error::{Context, Result};
use crate::file::read_text_within;
use crate::limits::MAX_FILE_BYTES;
use std::collections::BTreeMap;
use std::path::Path;

/// The rows of a table, with the columns that were asked for.
#[derive(Debug, Clone, Default)]
pub struct Numbers {
    columns: BTreeMap<String, usize>,
    /// Numbers of each row; NaN where a cell is empty or holds a word.
    rows: Vec<Vec<f64>>,
    sides: Vec<String>,
}

impl Numbers {
    /// Reads the columns of the CSV file that are `wanted`, and `side` where it is there.
    ///
    /// # Errors
    /// A file that cannot be read, or that is no table.
    pub fn read(path: &Path, wanted: impl Fn(&str) -> bool) -> Result<Self> {
        let inner = || -> Result<Self> {
            // A table of particles grows with the run.
            let text = read_text_within(path, MAX_FILE_BYTES)?;
            let mut reader = csv::Reader::from_reader(text.as_bytes());
            let mut numbers = Self::default();
            let mut places = Vec::new();
            let mut side = None;
            for (place, name) in reader.headers()?.iter().enumerate() {
                if name == "side" {
                    side = Some(place);
                } else if wanted(name) {
                    numbers.columns.insert(name.to_owned(), places.len());
                    places.push(place);
                }
            }
            let mut record = csv::StringRecord::new();
            while reader.read_record(&mut record)? {
                let cell = |place: usize| record.get(place).unwrap_or_default().trim();
                numbers.rows.push(places.iter().map(|&place| cell(place).parse().unwrap_or(f64::NAN)).collect());
                numbers.sides.push(side.map_or_else(String::new, |place| cell(place).to_owned()));
            }
            Ok(numbers)
        };
        inner().with_context(|| format!("`{}` cannot be shown", path.display()))
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// A finite number.
    #[must_use]
    pub fn get(&self, row: usize, column: &str) -> Option<f64> {
        let value = *self.rows.get(row)?.get(*self.columns.get(column)?)?;
        value.is_finite().then_some(value)
    }

    /// The row's frame.
    #[must_use]
    pub fn frame(&self, row: usize) -> Option<i64> {
        self.get(row, "frame").map(|frame| frame as i64)
    }

    /// The row's side, `left` or `right`; empty in a table without sides.
    #[must_use]
    pub fn side(&self, row: usize) -> &str {
        self.sides.get(row).map_or("", String::as_str)
    }

    /// A place such as `hand_x_m`, `hand_y_m`, `hand_z_m`, if all of it is there.
    #[must_use]
    pub fn place<const N: usize>(&self, row: usize, joint: &str, axes: [&str; N]) -> Option<[f32; N]> {
        let mut place = [0.0; N];
        for (value, axis) in place.iter_mut().zip(axes) {
            *value = self.get(row, &format!("{joint}_{axis}"))? as f32;
        }
        Some(place)
    }

    /// The sides that occur, in the order of their first row.
    #[must_use]
    pub fn distinct_sides(&self) -> Vec<String> {
        let mut sides: Vec<String> = Vec::new();
        for side in &self.sides {
            if !sides.contains(side) {
                sides.push(side.clone());
            }
        }
        sides
    }

    /// Rows of each frame, frame by frame.
    #[must_use]
    pub fn by_frame(&self) -> BTreeMap<i64, Vec<usize>> {
        let mut frames: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
        for row in 0..self.len() {
            if let Some(frame) = self.frame(row) {
                frames.entry(frame).or_default().push(row);
            }
        }
        frames
    }
}
