//! `sinew track ...`

use super::console::Console;
use super::track_arm::{self, TrackArmArgs};
use super::track_body::{self, TrackBodyArgs};
use super::track_cyclic::{self, TrackCyclicArgs};
use clap::Subcommand;

/// What can be tracked.
#[derive(Debug, Subcommand)]
pub enum Track {
    /// Track the arms of the person in a folder of video frames.
    Arm(TrackArmArgs),
    /// Track a whole body in a folder of point clouds.
    Body(TrackBodyArgs),
    /// Track a cyclic motion, walking or another, in an angle table.
    Cyclic(TrackCyclicArgs),
}

/// Runs the chosen tracker.
///
/// # Errors
/// As the chosen tracker.
pub fn run(track: &Track, console: &Console) -> anyhow::Result<()> {
    match track {
        Track::Arm(args) => track_arm::run(args, console),
        Track::Body(args) => track_body::run(args, console),
        Track::Cyclic(args) => track_cyclic::run(args, console),
    }
}
