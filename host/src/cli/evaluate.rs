//! `sinew evaluate ...`

use super::console::Console;
use super::evaluate_arm::{self, EvaluateArmArgs};
use super::evaluate_body::{self, EvaluateBodyArgs};
use super::evaluate_cyclic::{self, EvaluateCyclicArgs};
use super::evaluate_hands::{self, EvaluateHandsArgs};
use super::evaluate_skin::{self, EvaluateSkinArgs};
use clap::Subcommand;

/// What can be evaluated.
#[derive(Debug, Subcommand)]
pub enum Evaluate {
    /// Compare the trackers on rendered scenes with known truth.
    Arm(EvaluateArmArgs),
    /// Make the PIK paper's comparison of motion models on real motion before a simulated stereo camera.
    Body(EvaluateBodyArgs),
    /// Make the cyclic paper's tables and figures on cut cycles with known angles.
    Cyclic(EvaluateCyclicArgs),
    /// Track both hands on real frames and compare with reference boxes.
    Hands(EvaluateHandsArgs),
    /// Score a skin model on images with masks.
    Skin(EvaluateSkinArgs),
}

/// Runs the chosen evaluation.
///
/// # Errors
/// As the chosen evaluation.
pub fn run(evaluate: &Evaluate, console: &Console) -> anyhow::Result<()> {
    match evaluate {
        Evaluate::Arm(args) => evaluate_arm::run(args, console),
        Evaluate::Body(args) => evaluate_body::run(args, console),
        Evaluate::Cyclic(args) => evaluate_cyclic::run(args, console),
        Evaluate::Hands(args) => evaluate_hands::run(args, console),
        Evaluate::Skin(args) => evaluate_skin::run(args, console),
    }
}
