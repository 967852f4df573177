//! Everything that decides the result of a run.

use super::arms::SideChoice;
use crate::config::Config;
use crate::skin::Rectangle;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Slowest and fastest rate of frames, Hz.
pub const RATES_HZ: [f64; 2] = [0.001, 10_000.0];

/// What reads the pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum FrontEnd {
    /// Whole pictures.
    #[default]
    Pictures,
    /// Lines of at most 320 x 240 pixels, as firmware reads them: its colours, its capacities.
    Lines,
}

/// Everything that decides the result of a run.
#[derive(Debug, Clone, Serialize)]
pub struct TrackOptions {
    /// Folder of the frames, or a video.
    pub folder: PathBuf,
    /// Which arms.
    pub side: SideChoice,
    /// Frames per second of the camera; of a video, how many are taken.
    pub rate_hz: f64,
    /// Seed of all that is random.
    pub seed: u64,
    /// The skin model, as for `--skin`.
    pub skin: String,
    /// Rectangle of skin in the first frame.
    pub calibrate: Option<Rectangle>,
    /// What reads the pictures; lines never with `hands`.
    pub front_end: FrontEnd,
    /// Table of hands that are taken in place of blobs.
    pub hands: Option<PathBuf>,
    /// Table of faces that are taken in place of those that are found; with `face` only.
    pub head: Option<PathBuf>,
    /// Whether a face is looked for, which gives skin, shoulders and hands over time; never with
    /// `calibrate`.
    pub face: bool,
    /// Whether overlays and a contact sheet are drawn.
    pub overlay: bool,
    /// Whether every particle is written.
    pub particles_csv: bool,
    /// Whether an unreadable image is refused.
    pub strict: bool,
    /// Camera, person, tracker, thresholds.
    pub config: Config,
}
