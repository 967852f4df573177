//! Which of several motions the rows of a recording show.

use crate::cyclic::tracking::NamedMotion;
use crate::cyclic::tracking::table::{MotionCells, NO_MOTION};

/// The motion of each row, one of several models or none.
#[derive(Debug)]
pub(super) struct Motions<'a> {
    names: &'a [String],
    /// In how many rows each model's motion is named.
    rows_of: Vec<usize>,
    /// Name and probability of each row's motion.
    pub(super) cells: MotionCells,
}

impl<'a> Motions<'a> {
    /// The motions of the rows; `names` are those of the models.
    pub(super) fn new(names: &'a [String], motions: &[NamedMotion]) -> Self {
        let mut rows_of = vec![0; names.len()];
        motions.iter().filter_map(|named| named.motion).for_each(|index| rows_of[index] += 1);
        let name = |index: Option<usize>| index.map_or_else(|| NO_MOTION.to_owned(), |index| names[index].clone());
        let cells = motions.iter().map(|named| (name(named.motion), named.probability)).collect();
        Self { names, rows_of, cells }
    }

    /// In how many rows each motion is named, in the order of the options, none of them last.
    pub(super) fn counts(&self) -> Vec<(&str, usize)> {
        let none = self.cells.len() - self.rows_of.iter().sum::<usize>();
        let named = self.names.iter().map(String::as_str).zip(self.rows_of.iter().copied());
        named.chain([(NO_MOTION, none)]).collect()
    }

    /// The counts as a line for a terminal.
    pub(super) fn line(&self) -> String {
        let counts: Vec<String> = self.counts().iter().map(|(name, count)| format!("{name} in {count}")).collect();
        format!("motion: {} frames\n", counts.join(", "))
    }

    /// The model whose motion most rows show; `None` where no row shows any.
    pub(super) fn leading(&self) -> Option<usize> {
        let most = self.rows_of.iter().copied().max().filter(|most| *most > 0)?;
        self.rows_of.iter().position(|rows| *rows == most)
    }

    /// Whether two or more motions are named.
    pub(super) fn are_several(&self) -> bool {
        self.rows_of.iter().filter(|rows| **rows > 0).count() > 1
    }

    /// The names of the models, for a sentence.
    pub(super) fn choice(&self) -> String {
        self.names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_leading_motion_is_that_of_most_rows() {
        let names = ["walking".to_owned(), "running".to_owned()];
        let of = |indices: &[Option<usize>]| {
            let rows: Vec<NamedMotion> =
                indices.iter().map(|motion| NamedMotion { motion: *motion, probability: 0.5, shown: 0 }).collect();
            let motions = Motions::new(&names, &rows);
            (motions.leading(), motions.are_several(), motions.line())
        };
        let line = |counts: &str| format!("motion: {counts} frames\n");
        assert_eq!(of(&[None, None]), (None, false, line("walking in 0, running in 0, none in 2")));
        assert_eq!(of(&[None, None, Some(1)]), (Some(1), false, line("walking in 0, running in 1, none in 2")));
        assert_eq!(of(&[Some(0), Some(1), Some(1)]), (Some(1), true, line("walking in 1, running in 2, none in 0")));
    }
}
