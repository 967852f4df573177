//! `sinew evaluate ...`

use super::evaluate_hands::{self, EvaluateHandsArgs};
use super::evaluate_skin::{self, EvaluateSkinArgs};
use clap::Subcommand;

/// What can be evaluated.
#[derive(Debug, Subcommand)]
pub enum Evaluate {
    /// Track both hands on real frames and compare with reference boxes.
    Hands(EvaluateHandsArgs),
    /// Score a skin model on images with masks.
    Skin(EvaluateSkinArgs),
}

/// Runs the chosen evaluation.
///
/// # Errors
/// As the chosen evaluation.
pub fn run(evaluate: &Evaluate) -> anyhow::Result<()> {
    match evaluate {
        Evaluate::Hands(args) => evaluate_hands::run(args),
        Evaluate::Skin(args) => evaluate_skin::run(args),
    }
}
