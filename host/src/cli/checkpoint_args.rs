//! `--checkpoint`: how often a run saves its state.

use crate::resume::DEFAULT_CHECKPOINT;
use clap::Args;
use std::time::Duration;

/// Maximum interval, seconds: a day.
const MAX_INTERVAL_S: f64 = 86_400.0;

/// Options of the commands that can be resumed.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct CheckpointArgs {
    /// Save the state at least so often, for --resume; 0 saves after every frame.
    #[arg(long, value_name = "SECONDS", default_value_t = DEFAULT_CHECKPOINT.as_secs_f64(), value_parser = seconds,
        allow_negative_numbers = true)]
    checkpoint: f64,
}

impl CheckpointArgs {
    /// The interval.
    #[must_use]
    pub fn interval(&self) -> Duration {
        Duration::from_secs_f64(self.checkpoint)
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.0..=MAX_INTERVAL_S).contains(seconds));
    seconds.ok_or_else(|| format!("give seconds from 0 to {MAX_INTERVAL_S}, as 10"))
}
