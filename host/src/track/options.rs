//! Everything that decides the result of a run.

use super::arms::SideChoice;
use crate::config::Config;
use crate::error::{Result, ensure};
use crate::person::{FaceLooks, FaceTable};
use crate::skin::Rectangle;
use crate::skin::model::DEFAULT_SKIN;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::str::FromStr;

/// Slowest and fastest rate of frames, Hz.
pub const RATES_HZ: [f64; 2] = [0.001, 10_000.0];
/// Rate of frames that do not say, Hz. Chosen: webcams indoors.
pub const DEFAULT_RATE_HZ: f64 = 15.0;
/// Seed where none is given.
pub const DEFAULT_SEED: u64 = 1;

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

impl FrontEnd {
    /// All, in the order of the documentation.
    pub const ALL: [Self; 2] = [Self::Pictures, Self::Lines];

    /// Name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pictures => "pictures",
            Self::Lines => "lines",
        }
    }
}

impl FromStr for FrontEnd {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|front_end| front_end.name() == name);
        found.ok_or_else(|| format!("has to be `pictures` or `lines`, not `{name}`"))
    }
}

/// Where the person's face comes from, which gives skin, shoulders and hands over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum FaceSource {
    /// None is known: skin is that of the model, shoulders are those of the configuration.
    Unknown,
    /// It is looked for; one that comes with a frame counts in its place.
    #[default]
    Found,
    /// It is in a table, or comes with a frame; none is looked for.
    Given(FaceTable),
}

impl FaceSource {
    /// Faces in pictures of so many a second whose pixels are blocks.
    pub(super) fn looks(&self, rate_hz: f64, block: u32) -> Result<Option<FaceLooks>> {
        match self {
            Self::Unknown => Ok(None),
            Self::Found => FaceLooks::new(rate_hz, block, None).map(Some),
            Self::Given(table) => FaceLooks::new(rate_hz, block, Some(table.clone())).map(Some),
        }
    }
}

/// Everything that decides the arms of a stream of images, beside these. [`Default`] is what the
/// command does without options.
#[derive(Debug, Clone)]
pub struct StreamOptions {
    /// Which arms.
    pub side: SideChoice,
    /// Frames per second.
    pub rate_hz: f64,
    /// Seed of all that is random.
    pub seed: u64,
    /// Rectangle of skin in the first image.
    pub calibrate: Option<Rectangle>,
    /// What reads the pictures.
    pub front_end: FrontEnd,
    /// Where the person's face comes from.
    pub face: FaceSource,
    /// Camera, person, tracker, thresholds.
    pub config: Config,
}

impl Default for StreamOptions {
    fn default() -> Self {
        Self {
            side: SideChoice::default(),
            rate_hz: DEFAULT_RATE_HZ,
            seed: DEFAULT_SEED,
            calibrate: None,
            front_end: FrontEnd::default(),
            face: FaceSource::default(),
            config: Config::default(),
        }
    }
}

/// Refuses a rate that no camera has.
pub(super) fn check_rate(rate_hz: f64) -> Result<()> {
    let [low, high] = RATES_HZ;
    ensure!((low..=high).contains(&rate_hz), "`rate` must lie from {low} to {high} Hz, not {rate_hz}");
    Ok(())
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

impl Default for TrackOptions {
    fn default() -> Self {
        let StreamOptions { side, rate_hz, seed, calibrate, front_end, face, config } = StreamOptions::default();
        Self {
            folder: PathBuf::new(),
            side,
            rate_hz,
            seed,
            skin: DEFAULT_SKIN.to_owned(),
            calibrate,
            front_end,
            hands: None,
            head: None,
            face: face != FaceSource::Unknown,
            overlay: false,
            particles_csv: false,
            strict: false,
            config,
        }
    }
}

impl TrackOptions {
    /// What decides the arms; reads the table of faces.
    ///
    /// # Errors
    /// The table of faces cannot be read, or breaks a rule.
    pub fn stream(&self) -> Result<StreamOptions> {
        let given = self.head.as_deref().map(FaceTable::read).transpose()?;
        let face = match (self.face, given) {
            (false, _) => FaceSource::Unknown,
            (true, None) => FaceSource::Found,
            (true, Some(table)) => FaceSource::Given(table),
        };
        let Self { side, rate_hz, seed, calibrate, front_end, ref config, .. } = *self;
        Ok(StreamOptions { side, rate_hz, seed, calibrate, front_end, face, config: config.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_files_and_of_the_command() {
        for front_end in FrontEnd::ALL {
            assert_eq!(front_end.name().parse(), Ok(front_end));
            assert_eq!(serde_json::to_value(front_end).unwrap(), front_end.name());
        }
        for side in SideChoice::ALL {
            assert_eq!(side.name().parse(), Ok(side));
            assert_eq!(serde_json::to_value(side).unwrap(), side.name());
        }
        #[cfg(feature = "command")]
        {
            use clap::ValueEnum;
            let same = |name: &str, value: Option<clap::builder::PossibleValue>| {
                assert_eq!(value.as_ref().map(clap::builder::PossibleValue::get_name), Some(name));
            };
            assert_eq!(
                (FrontEnd::value_variants(), SideChoice::value_variants()),
                (&FrontEnd::ALL[..], &SideChoice::ALL[..])
            );
            FrontEnd::ALL.into_iter().for_each(|front_end| same(front_end.name(), front_end.to_possible_value()));
            SideChoice::ALL.into_iter().for_each(|side| same(side.name(), side.to_possible_value()));
        }
        assert!("Lines".parse::<FrontEnd>().unwrap_err().contains("`pictures` or `lines`, not `Lines`"));
        assert!("middle".parse::<SideChoice>().unwrap_err().contains("`left`, `right` or `both`, not `middle`"));
    }
}
