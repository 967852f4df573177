//! The rows of an angle table as an evenly sampled series: one sample a frame, also for frames that
//! the table leaves out.

use super::angle_table::{AngleRow, AngleTable};

/// Frames that the table leaves out, at most, for each of its rows and beyond the first thousands.
/// Chosen: a person who is out of view for minutes; more is a mistake in the numbers.
const MAX_LEFT_OUT: u64 = 100;
const MAX_LEFT_OUT_ANYWAY: u64 = 100_000;

/// Frames from the first to the last row, each with its row.
#[derive(Debug)]
pub struct EvenRows<'a> {
    /// Number of the first frame.
    pub first_frame: u64,
    rows: Vec<Option<&'a AngleRow>>,
}

impl<'a> EvenRows<'a> {
    /// `None` where the table leaves out so many frames that their numbers must be wrong.
    #[must_use]
    pub fn new(table: &'a AngleTable) -> Option<Self> {
        let (first_frame, count) = (table.first_frame(), table.end_frame() - table.first_frame());
        if count > MAX_LEFT_OUT * table.rows().len() as u64 + MAX_LEFT_OUT_ANYWAY {
            return None;
        }
        let mut rows = vec![None; count as usize];
        for row in table.rows() {
            rows[(row.frame - first_frame) as usize] = Some(row);
        }
        Some(Self { first_frame, rows })
    }

    /// Number of frames.
    #[must_use]
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// What `value` gives of each row; `None` where there is no row.
    #[must_use]
    pub fn series(&self, value: impl Fn(&AngleRow) -> Option<f64>) -> Vec<Option<f64>> {
        self.rows.iter().map(|row| value((*row)?)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::angle_table::ANGLES;

    #[test]
    fn left_out_frames_are_missing() {
        let row = |frame: u64| AngleRow { frame, angles_rad: [Some(frame as f64); ANGLES], extra: Vec::new() };
        let table = AngleTable::new([5, 6, 9].map(row).to_vec(), Vec::new()).unwrap();
        let even = EvenRows::new(&table).unwrap();
        assert_eq!((even.first_frame, even.count()), (5, 5));
        assert_eq!(even.series(|row| row.angles_rad[3]), [Some(5.0), Some(6.0), None, None, Some(9.0)]);
        let table = AngleTable::new([0, 1_000_000_000].map(row).to_vec(), Vec::new()).unwrap();
        assert!(EvenRows::new(&table).is_none());
    }
}
