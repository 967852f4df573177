//! What motion models predict before they see a point: figures 2, 19 and 20 of the PIK paper.

pub mod chain_spread;
pub mod lift;
mod pictures;

pub use chain_spread::ChainSpread;
pub use lift::LiftPrediction;

use super::trial::SeenMotion;
use anyhow::Result;
use image::RgbImage;
use serde::Serialize;
use sinew::body::tracking::BodyTuning;

/// Seed of all draws: the figures are the same in every run.
const SEED: u64 = 1;

/// What the figures show, as numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PredictionReport {
    /// Figure 2: how far joints spread under noise of angles and under goals.
    pub chain_spread: ChainSpread,
    /// Figures 19 and 20: what is drawn in a pelvic lift, and the blocks of the importance
    /// distribution's precision.
    pub pelvic_lift: LiftPrediction,
}

/// Draws poses of the person of `motion` from the first pose (figure 2) and of the built-in pelvic
/// lift (figures 19 and 20). The second part of the answer is the figures with
/// their file names.
///
/// # Errors
/// Measures or numbers of a model that break a rule.
pub fn predict(motion: &SeenMotion, tuning: &BodyTuning) -> Result<(PredictionReport, Vec<(String, RgbImage)>)> {
    let (chain_spread, chains) = chain_spread::draw(&motion.measures, motion.first_rad, SEED)?;
    let (pelvic_lift, samples) = lift::draw(tuning, SEED)?;
    let figures = vec![
        ("figure_2_spread.png".to_owned(), pictures::figure_2(&chain_spread, &chains)),
        ("figure_19_samples.png".to_owned(), pictures::figure_19(&pelvic_lift, &samples)),
        ("figure_20_precision.png".to_owned(), pictures::figure_20(&samples)?),
    ];
    Ok((PredictionReport { chain_spread, pelvic_lift }, figures))
}
