//! Which of several motions the rows of a recording show.

use crate::cyclic::CyclicModel;
use crate::cyclic::tracking::NamedMotion;
use crate::cyclic::tracking::table::{MotionCells, NO_MOTION};

/// The motion of each row, one of several models or none.
#[derive(Debug)]
pub(super) struct Motions<'a> {
    names: &'a [String],
    /// In how many rows each model's motion is named.
    rows_of: Vec<usize>,
    /// Rows of a mean cycle of each model.
    cycle_rows: Vec<f64>,
    /// Name and probability of each row's motion.
    pub(super) cells: MotionCells,
}

impl<'a> Motions<'a> {
    /// The motions of the rows at `rate_hz`; `names` are those of the `models`.
    pub(super) fn new(names: &'a [String], models: &[CyclicModel], motions: &[NamedMotion], rate_hz: f64) -> Self {
        let of_cycle = |model: &CyclicModel| {
            let numbers = model.numbers();
            rate_hz * f64::from(numbers.mean_duration_frames) / f64::from(numbers.rate_hz)
        };
        let cycle_rows = models.iter().map(of_cycle).collect();
        let mut rows_of = vec![0; names.len()];
        motions.iter().filter_map(|named| named.motion).for_each(|index| rows_of[index] += 1);
        let name = |index: Option<usize>| index.map_or_else(|| NO_MOTION.to_owned(), |index| names[index].clone());
        let cells = motions.iter().map(|named| (name(named.motion), named.probability)).collect();
        Self { names, rows_of, cycle_rows, cells }
    }

    /// In how many rows each motion is named, in the order of the options, none of them last.
    pub(super) fn counts(&self) -> Vec<(&str, usize)> {
        let none = self.cells.len() - self.named_rows();
        let named = self.names.iter().map(String::as_str).zip(self.rows_of.iter().copied());
        named.chain([(NO_MOTION, none)]).collect()
    }

    /// The counts as a line for a terminal.
    pub(super) fn line(&self) -> String {
        let counts: Vec<String> = self.counts().iter().map(|(name, count)| format!("{name} in {count}")).collect();
        format!("motion: {} frames\n", counts.join(", "))
    }

    /// The model whose motion most rows show; `None` where fewer rows show any than its mean cycle
    /// has.
    pub(super) fn leading(&self) -> Option<usize> {
        let most = self.rows_of.iter().copied().max()?;
        let leading = self.rows_of.iter().position(|rows| *rows == most)?;
        (most > 0 && most as f64 >= self.cycle_rows[leading]).then_some(leading)
    }

    /// In how many rows any motion is named.
    pub(super) fn named_rows(&self) -> usize {
        self.rows_of.iter().sum()
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
    use crate::cyclic::model_file;

    #[test]
    fn the_leading_motion_is_that_of_most_rows() {
        let names = ["walking", "running"].map(str::to_owned);
        let models = ["walking", "running"].map(|name| model_file::shipped(name).unwrap().clone());
        let of = |indices: &[Option<usize>], rate_hz: f64| {
            let rows: Vec<NamedMotion> =
                indices.iter().map(|motion| NamedMotion { motion: *motion, probability: 0.5, shown: 0 }).collect();
            let motions = Motions::new(&names, &models, &rows, rate_hz);
            (motions.leading(), motions.are_several(), motions.line())
        };
        let line = |counts: &str| format!("motion: {counts} frames\n");
        // Cycles of more than half a second: less than a row, then more than one.
        let (slow, fast) = (1.0, 4.0);
        assert_eq!(of(&[None, None], slow), (None, false, line("walking in 0, running in 0, none in 2")));
        assert_eq!(of(&[None, None, Some(1)], slow), (Some(1), false, line("walking in 0, running in 1, none in 2")));
        assert_eq!(of(&[None, None, Some(1)], fast).0, None, "less than a cycle");
        assert_eq!(
            of(&[Some(0), Some(1), Some(1)], slow),
            (Some(1), true, line("walking in 1, running in 2, none in 0"))
        );
    }
}
