//! What was seen of a recording, frame by frame.

use crate::cyclic::AngleTable;
use crate::cyclic::even_rows::EvenRows;
use crate::cyclic::tracking::Updates;
use crate::cyclic::turns::unwrap_along_time;

/// Angles of all frames from the first row to the last, those that the table leaves out too.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen<const N: usize> {
    /// Number of the first frame.
    pub first_frame: u64,
    /// Angles of each frame, radians, without jumps over whole turns.
    pub angles_rad: Vec<[Option<f64>; N]>,
}

impl<const N: usize> Seen<N> {
    /// The measurements of a table that `updates` lets the filter see; `None` where frame numbers
    /// leave out so many frames that they must be wrong.
    #[must_use]
    pub fn of_table(table: &AngleTable, updates: &Updates) -> Option<Self> {
        let first_frame = table.first_frame();
        let mut angles_rad = vec![[None; N]; EvenRows::new(table)?.count()];
        for (index, row) in table.rows().iter().enumerate() {
            if updates.sees(first_frame, row.frame) {
                let frame = &mut angles_rad[(row.frame - first_frame) as usize];
                *frame = std::array::from_fn(|angle| table.row_angle_rad(index, angle));
            }
        }
        let mut seen = Self { first_frame, angles_rad };
        for angle in 0..N {
            unwrap_along_time(seen.angles_rad.iter_mut().map(|frame| &mut frame[angle]));
        }
        Some(seen)
    }

    /// One angle over time, radians.
    #[must_use]
    pub fn series(&self, angle: usize) -> Vec<Option<f64>> {
        self.angles_rad.iter().map(|frame| frame[angle]).collect()
    }

    /// Whether any angle of a frame was seen.
    #[must_use]
    pub fn is_seen(&self, frame: usize) -> bool {
        self.angles_rad[frame].iter().any(Option::is_some)
    }

    /// The stretches in which the person was seen: first and last frame of each, counted from the
    /// first row. Nothing was seen between two of them for longer than `longest` frames.
    #[must_use]
    pub fn stretches(&self, longest: f64) -> Vec<[usize; 2]> {
        let mut stretches: Vec<[usize; 2]> = Vec::new();
        for frame in (0..self.angles_rad.len()).filter(|frame| self.is_seen(*frame)) {
            match stretches.last_mut() {
                Some([_, last]) if (frame - *last) as f64 <= longest + 1.0 => *last = frame,
                _ => stretches.push([frame, frame]),
            }
        }
        stretches
    }
}
