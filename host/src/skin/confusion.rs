//! Counts of right and wrong decisions, and the scores made of them.

use super::bit_image::BitImage;
use serde::{Deserialize, Serialize};

/// Decisions compared with the truth; the counts may be pixels or any other unit.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Confusion {
    /// Skin that was found.
    pub true_positive: f64,
    /// Other things taken for skin.
    pub false_positive: f64,
    /// Skin that was missed.
    pub false_negative: f64,
}

/// Precision, recall and F1, each 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Part of what was found that is skin.
    pub precision: f64,
    /// Part of the skin that was found.
    pub recall: f64,
    /// Harmonic mean of both.
    pub f1: f64,
}

impl Confusion {
    /// Counts the pixels of `found` against those of `truth`, which has the same size.
    #[must_use]
    pub fn of(found: &BitImage, truth: &BitImage) -> Self {
        let count = |join: fn(u32, u32) -> u32| -> f64 {
            found.words().iter().zip(truth.words()).map(|(&f, &t)| f64::from(join(f, t).count_ones())).sum()
        };
        Self {
            true_positive: count(|f, t| f & t),
            false_positive: count(|f, t| f & !t),
            false_negative: count(|f, t| !f & t),
        }
    }

    /// Adds `count` decisions of one kind.
    pub fn add(&mut self, found: bool, is_skin: bool, count: f64) {
        match (found, is_skin) {
            (true, true) => self.true_positive += count,
            (true, false) => self.false_positive += count,
            (false, true) => self.false_negative += count,
            (false, false) => {}
        }
    }

    /// Adds all counts of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.true_positive += other.true_positive;
        self.false_positive += other.false_positive;
        self.false_negative += other.false_negative;
    }

    /// The scores. Where there is no skin and none was found all are 1.
    #[must_use]
    pub fn scores(&self) -> Scores {
        let ratio = |part: f64, rest: f64| if part + rest > 0.0 { part / (part + rest) } else { 1.0 };
        Scores {
            precision: ratio(self.true_positive, self.false_positive),
            recall: ratio(self.true_positive, self.false_negative),
            f1: ratio(2.0 * self.true_positive, self.false_positive + self.false_negative),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, Luma};

    #[test]
    fn scores_follow_from_counts() {
        let found = GrayImage::from_fn(10, 1, |u, _| Luma([if u < 4 { 255 } else { 0 }]));
        let truth = GrayImage::from_fn(10, 1, |u, _| Luma([if (1..7).contains(&u) { 255 } else { 0 }]));
        let bits = |image| BitImage::from_gray(image, 127).unwrap();
        let confusion = Confusion::of(&bits(&found), &bits(&truth));
        assert_eq!(confusion, Confusion { true_positive: 3.0, false_positive: 1.0, false_negative: 3.0 });
        let scores = confusion.scores();
        assert_eq!((scores.precision, scores.recall, scores.f1), (0.75, 0.5, 0.6));
    }

    #[test]
    fn nothing_to_find_and_nothing_found_is_perfect() {
        assert_eq!(Confusion::default().scores().f1, 1.0);
        let alarm = Confusion { false_positive: 2.0, ..Confusion::default() };
        assert_eq!(alarm.scores().f1, 0.0);
    }
}
