//! What decides the result of a run.

use crate::body::BodyPart;
use crate::body::tracking::stream_options::{check_modes, check_particles, check_points, check_rate, check_threads};
use crate::body::tracking::{BodyModelKind, BodyStreamOptions, BodyTuning};
use crate::cloud::Region;
use crate::error::{Result, ensure_option};
use serde::Serialize;
use sinew_core::math::Vec3;
use std::path::PathBuf;

/// Points of a depth image that are weighed where nothing else is asked for.
///
/// Chosen: as many as the scenes have that the models were tuned on.
pub const DEPTH_POINTS: usize = 2000;

/// Everything that decides the result of a run; results do not depend on `threads`.
#[derive(Debug, Clone, Serialize)]
pub struct BodyTrackOptions {
    /// Folder of clouds, or a folder that holds them in `points/`.
    pub folder: PathBuf,
    /// The camera of depth images; `camera.json` of the folder where there is none.
    pub camera: Option<PathBuf>,
    /// Least and greatest x, y and z of the points that count, metres.
    pub inside_m: Option<[f32; 6]>,
    /// Points count where a x + b y + c z + d is positive, x, y and z in metres.
    pub above_plane: Option<[f32; 4]>,
    /// Maximum number of points of a frame that are weighed.
    pub max_points: Option<usize>,
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
    /// Where the person's size comes from; estimated where no file says it, if there is none.
    pub size: Option<SizeSource>,
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

/// Where the person's lengths and radii come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum SizeSource {
    /// As the file or the height says.
    Given,
    /// From the points of the first three seconds, beginning with what file or height says.
    Estimated,
}

impl Default for BodyTrackOptions {
    /// Those of the command. The folder is still to be named.
    fn default() -> Self {
        let BodyStreamOptions { model, particles, seed, threads, tuning, .. } = BodyStreamOptions::default();
        Self {
            folder: PathBuf::new(),
            camera: None,
            inside_m: None,
            above_plane: None,
            max_points: None,
            part: None,
            model,
            particles,
            skeleton: None,
            partial: false,
            height_m: None,
            size: None,
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
    /// Where points count.
    pub(super) fn region(&self) -> Region {
        let corners = |[x0, x1, y0, y1, z0, z1]: [f32; 6]| [Vec3::new(x0, y0, z0), Vec3::new(x1, y1, z1)];
        Region { inside_m: self.inside_m.map(corners), above: self.above_plane }
    }

    /// Checks what can be checked without files.
    ///
    /// # Errors
    /// Names the option and its range.
    pub fn check(&self) -> Result<()> {
        check_particles(self.particles)?;
        check_modes(self.model, self.particles)?;
        check_threads(self.threads)?;
        self.max_points.map_or(Ok(()), check_points)?;
        if let Some([x0, x1, y0, y1, z0, z1]) = self.inside_m {
            ensure_option!(
                x0 < x1 && y0 < y1 && z0 < z1,
                "--inside has to be least and greatest x, y and z, and one of {x0},{x1},{y0},{y1},{z0},{z1} is not below its greatest"
            );
        }
        if let Some([a, b, c, d]) = self.above_plane {
            let is_plane = [a, b, c, d].iter().all(|number| number.is_finite()) && [a, b, c] != [0.0; 3];
            ensure_option!(is_plane, "--above-plane has to be finite with a direction A,B,C, not {a},{b},{c},{d}");
        }
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
