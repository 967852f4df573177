//! `sinew train ...`

use super::console::Console;
use super::train_cyclic::{self, TrainCyclicArgs};
use super::train_skin::{self, TrainSkinArgs};
use clap::Subcommand;

/// What can be trained.
#[derive(Debug, Subcommand)]
pub enum Train {
    /// Train a skin model from labelled pixels or from images with masks.
    Skin(TrainSkinArgs),
    /// Train a model of a cyclic motion from cut cycles of angle tables.
    Cyclic(TrainCyclicArgs),
}

/// Runs the chosen training.
///
/// # Errors
/// As the chosen training.
pub fn run(train: &Train, console: &Console) -> anyhow::Result<()> {
    match train {
        Train::Skin(args) => train_skin::run(args, console),
        Train::Cyclic(args) => train_cyclic::run(args, console),
    }
}
