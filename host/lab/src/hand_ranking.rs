//! Does the hand likelihood rank hands above other blobs on real frames? The area under the ROC
//! curve.

use super::hands::ReferenceBox;
use anyhow::Result;
use image::RgbImage;
use serde::Serialize;
use sinew::frames::FrameReader;
use sinew::skin::SkinModel;
use sinew_core::vision::blobs::LikelyBlob;
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::{
    DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE, DEFAULT_WEIGHTS, HandLikelihood, LikelihoodForm,
};

/// A blob outside of all boxes counts from this area on, pixels.
pub const OTHER_MIN_AREA_PX: u32 = 300;

/// Areas under the ROC curve of both forms of the likelihood; `None` where a class is empty.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct HandRanking {
    /// Boxes with a blob: the largest one is the hand.
    pub hands: usize,
    /// Blobs over [`OTHER_MIN_AREA_PX`] in no box.
    pub others: usize,
    /// Area under the curve of the default form.
    pub filled_area: Option<f64>,
    /// Area under the curve of the form as printed in the arm paper.
    pub paper_area: Option<f64>,
}

/// Scores of blobs on real frames: those of the default form, of the printed one, and the area
/// term.
#[derive(Debug, Clone, Default)]
pub struct BlobScores {
    /// Of each box with a blob, those of its largest blob.
    pub hands: Vec<[f32; 3]>,
    /// Of blobs over [`OTHER_MIN_AREA_PX`] in no box.
    pub others: Vec<[f32; 3]>,
}

impl BlobScores {
    /// Adds those of another sequence.
    pub fn merge(&mut self, other: Self) {
        self.hands.extend(other.hands);
        self.others.extend(other.others);
    }

    fn area(&self, score: usize) -> Option<f64> {
        let of = |scores: &[[f32; 3]]| -> Vec<f32> { scores.iter().map(|blob| blob[score]).collect() };
        area_under_curve(&of(&self.hands), &of(&self.others))
    }

    /// How well both forms rank the hands.
    #[must_use]
    pub fn ranking(&self) -> HandRanking {
        HandRanking {
            hands: self.hands.len(),
            others: self.others.len(),
            filled_area: self.area(0),
            paper_area: self.area(1),
        }
    }

    /// Area under the curve of the default form's area term alone.
    #[must_use]
    pub fn area_alone(&self) -> Option<f64> {
        self.area(2)
    }
}

/// Finds the blobs of all `frames`, sorts them by `boxes` into hands and others, and scores them.
///
/// # Errors
/// As [`FrameReader::read`].
pub fn blob_scores(frames: &[Option<RgbImage>], boxes: &[ReferenceBox], skin: &SkinModel) -> Result<BlobScores> {
    let form = |form, weights| HandLikelihood::new(form, weights, DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE);
    let filled = HandLikelihood::default();
    let paper = form(LikelihoodForm::Paper, DEFAULT_WEIGHTS)?;
    let area_alone = form(LikelihoodForm::Filled, [1.0, 0.0, 0.0])?;
    let mut reader = FrameReader::new(filled, EdgeDetector::default())?;
    let mut found = BlobScores::default();
    for (index, frame) in frames.iter().enumerate() {
        let Some(frame) = frame else { continue };
        let image_area_px = (frame.width() * frame.height()) as f32;
        let blobs = reader.read(frame, &*skin.for_image(frame)?)?.blobs;
        let scores =
            |blob: &LikelyBlob| [filled, paper, area_alone].map(|form| form.evaluate(&blob.blob, image_area_px));
        let here: Vec<&ReferenceBox> = boxes.iter().filter(|b| b.frame == index).collect();
        for wanted in &here {
            let inside = blobs.iter().filter(|blob| wanted.contains(blob.blob.centroid));
            found.hands.extend(inside.max_by_key(|blob| blob.blob.area_px).map(scores));
        }
        let is_other = |blob: &&LikelyBlob| {
            blob.blob.area_px > OTHER_MIN_AREA_PX && !here.iter().any(|b| b.contains(blob.blob.centroid))
        };
        found.others.extend(blobs.iter().filter(is_other).map(scores));
    }
    Ok(found)
}

/// How well both forms rank the blobs of all `frames`.
///
/// # Errors
/// As [`blob_scores`].
pub fn rank(frames: &[Option<RgbImage>], boxes: &[ReferenceBox], skin: &SkinModel) -> Result<HandRanking> {
    Ok(blob_scores(frames, boxes, skin)?.ranking())
}

/// Part of all pairs in which the hand has the greater score, ties by half; `None` where there is
/// no pair.
#[must_use]
pub fn area_under_curve(hands: &[f32], others: &[f32]) -> Option<f64> {
    let pairs = hands.iter().flat_map(|h| others.iter().map(move |o| h.total_cmp(o)));
    let wins: f64 = pairs.map(|order| 0.5 * f64::from(order as i8 + 1)).sum();
    let count = hands.len() * others.len();
    (count > 0).then(|| wins / count as f64)
}

#[cfg(test)]
mod tests {
    use super::area_under_curve;

    #[test]
    fn the_area_counts_pairs_and_halves_ties() {
        assert_eq!(area_under_curve(&[0.9, 0.8], &[0.1, 0.2]), Some(1.0));
        assert_eq!(area_under_curve(&[0.1], &[0.9]), Some(0.0));
        assert_eq!(area_under_curve(&[0.5, 0.5], &[0.5, 0.1]), Some(0.75));
        assert_eq!(area_under_curve(&[], &[0.5]), None);
    }
}
