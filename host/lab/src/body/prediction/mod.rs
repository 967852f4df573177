//! What motion models predict before they see a point: figures 2, 19 and 20 of the PIK paper.

pub mod chain_spread;
pub mod drawn;
pub mod lift;
mod pictures;

pub use chain_spread::ChainSpread;
pub use drawn::{Drawn, PredictionReport, draw};
pub use lift::LiftPrediction;

use super::trial::SeenMotion;
use anyhow::Result;
use image::RgbImage;
use sinew::body::tracking::BodyTuning;

/// As [`draw`], as pictures with their file names.
///
/// # Errors
/// As [`draw`].
pub fn predict(motion: &SeenMotion, tuning: &BodyTuning) -> Result<(PredictionReport, Vec<(String, RgbImage)>)> {
    let drawn = draw(motion, tuning)?;
    let figures = vec![
        ("figure_2_spread.png".to_owned(), pictures::figure_2(&drawn)),
        ("figure_19_samples.png".to_owned(), pictures::figure_19(&drawn)),
        ("figure_20_precision.png".to_owned(), pictures::figure_20(&drawn)?),
    ];
    Ok((drawn.report, figures))
}
