//! What decides the result of a run.

use crate::body::BodyPart;
use crate::body::tracking::stream_options::{check_modes, check_particles, check_rate, check_threads};
use crate::body::tracking::{BodyModelKind, BodyStreamOptions, BodyTuning};
use crate::error::{Result, ensure_option};
use serde::Serialize;
use std::path::PathBuf;

/// Everything that decides the result of a run; results do not depend on `threads`.
#[derive(Debug, Clone, Serialize)]
pub struct BodyTrackOptions {
    /// Folder of clouds, or a folder that holds them in `points/`.
    pub folder: PathBuf,
    /// How much of the body is tracked; what the folder's `run.json` says, or all, where there is
    /// none.
    pub part: Option<BodyPart>,
    /// The motion model.
    pub model: BodyModelKind,
    /// Number of particles.
    pub particles: usize,
    /// File with the person's measures or with a motion to measure; `body.json` of the folder where
    /// there is none.
    pub skeleton: Option<PathBuf>,
    /// Whether a motion to measure may have fewer frames than its header promises.
    pub partial: bool,
    /// Height of the person instead of measures, metres.
    pub height_m: Option<f32>,
    /// The pose of the first frame; `first_pose.json` of the folder where there is none.
    pub init: Option<PathBuf>,
    /// The stick's ends; `stick.csv` of the folder where there is none.
    pub stick: Option<PathBuf>,
    /// Seed of all that is random.
    pub seed: u64,
    /// Number of threads; as many as the machine runs at a time where there is none.
    pub threads: Option<usize>,
    /// Frames in a second; that of the folder's `run.json`, or 15, where there is none.
    pub rate_hz: Option<f32>,
    /// Whether a cloud that cannot be read ends the run.
    pub strict: bool,
    /// Whether every particle is written.
    pub particles_csv: bool,
    /// Whether pictures are drawn.
    pub pictures: bool,
    /// Numbers of the motion models.
    pub tuning: BodyTuning,
}

impl Default for BodyTrackOptions {
    /// Those of the command. The folder is still to be named.
    fn default() -> Self {
        let BodyStreamOptions { model, particles, seed, threads, tuning, .. } = BodyStreamOptions::default();
        Self {
            folder: PathBuf::new(),
            part: None,
            model,
            particles,
            skeleton: None,
            partial: false,
            height_m: None,
            init: None,
            stick: None,
            seed,
            threads,
            rate_hz: None,
            strict: false,
            particles_csv: false,
            pictures: false,
            tuning,
        }
    }
}

impl BodyTrackOptions {
    /// Checks what can be checked without files.
    ///
    /// # Errors
    /// Names the option and its range.
    pub fn check(&self) -> Result<()> {
        check_particles(self.particles)?;
        check_modes(self.model, self.particles)?;
        check_threads(self.threads)?;
        if let Some(rate_hz) = self.rate_hz {
            check_rate("--rate", rate_hz)?;
        }
        ensure_option!(
            self.stick.is_none() || self.model == BodyModelKind::Stick,
            "--stick is for --model stick, and the model is {}; choose one of both",
            self.model.name()
        );
        Ok(())
    }
}
