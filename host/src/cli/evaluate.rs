//! `sinew evaluate ...`

use super::evaluate_skin::{self, EvaluateSkinArgs};
use clap::Subcommand;

/// What can be evaluated.
#[derive(Debug, Subcommand)]
pub enum Evaluate {
    /// Score a skin model on images with masks.
    Skin(EvaluateSkinArgs),
}

/// Runs the chosen evaluation.
///
/// # Errors
/// As the chosen evaluation.
pub fn run(evaluate: &Evaluate) -> anyhow::Result<()> {
    match evaluate {
        Evaluate::Skin(args) => evaluate_skin::run(args),
    }
}
