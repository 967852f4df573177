//! What the figures of predictions draw.

use super::chain_spread::{self, ChainSpread};
use super::lift::{self, LiftPrediction, Precision};
use crate::body::trial::SeenMotion;
use anyhow::Result;
use serde::Serialize;
use sinew::body::tracking::BodyTuning;
use sinew::body::tracking::filter::WholeBodyParticle;
use sinew::draw::body_views::{DrawnBone, drawn_bones};

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

/// What the figures draw.
#[derive(Debug)]
pub struct Drawn {
    /// Their numbers.
    pub report: PredictionReport,
    /// Figure 2: a hundred poses by noise of every angle, and by goals.
    pub chains: [Vec<Vec<DrawnBone>>; 2],
    /// Figure 19: ten poses.
    pub lift: Vec<Vec<DrawnBone>>,
    /// Figure 20: the precision that the first of them was drawn with, its diagonal scaled to one.
    pub precision: Precision,
}

/// Draws poses of the person of `motion` from the first pose (figure 2) and of the built-in pelvic
/// lift (figures 19 and 20).
///
/// # Errors
/// Measures or numbers of a model that break a rule.
pub fn draw(motion: &SeenMotion, tuning: &BodyTuning) -> Result<Drawn> {
    let (chain_spread, chains) = chain_spread::draw(&motion.measures, motion.first_rad, SEED)?;
    let (pelvic_lift, samples) = lift::draw(tuning, SEED)?;
    let bones = |poses: &[WholeBodyParticle]| -> Vec<Vec<DrawnBone>> {
        let posture = |pose: &WholeBodyParticle| chains.scene.posture(&pose.angles_rad);
        poses.iter().map(|pose| drawn_bones(&posture(pose), &chains.scene.radii_m)).collect()
    };
    Ok(Drawn {
        chains: [bones(&chains.angular), bones(&chains.end_effector)],
        lift: samples.postures.iter().map(|posture| drawn_bones(posture, &samples.radii_m)).collect(),
        precision: samples.precisions.first().map(lift::scaled).unwrap_or_default(),
        report: PredictionReport { chain_spread, pelvic_lift },
    })
}
