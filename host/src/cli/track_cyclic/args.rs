//! The options of `sinew track cyclic`, and what follows from them alone.

use crate::cli::checkpoint_args::CheckpointArgs;
use crate::cli::viewer_args::ViewerArgs;
use crate::cyclic::CyclicModel;
use crate::cyclic::angle_table::AngleRows;
use crate::cyclic::model_file::MODEL_VALUE;
use crate::cyclic::rate;
use crate::cyclic::tracking::{FilterName, ScalingName, StartName, TrackingOptions, Updates};
use crate::file::STANDARD_INPUT;
use crate::output::check_writable_file;
use crate::resume::{Begun, file_crc32};
use anyhow::{Result, ensure};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew track cyclic`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate cyclic --model walking --out walk.csv
  sinew track cyclic walk.csv --model walking --out est.csv --report run")]
pub struct TrackCyclicArgs {
    /// Angle table, made by `sinew angles` from a motion in space or from keypoints; - is standard
    /// input.
    pub table: PathBuf,
    /// Motion: a shipped one, or a file of `sinew train cyclic`. Given several times, the motion of
    /// each frame is named, or none of these, and tracked by its own model.
    #[arg(long, value_name = MODEL_VALUE, required = true)]
    pub model: Vec<String>,
    /// Filter.
    #[arg(long, value_enum, default_value_t = FilterName::Coupled)]
    pub filter: FilterName,
    /// Standard deviation of a measured angle, degrees [default: found in the recording; 6 with
    /// --online].
    #[arg(long, value_name = "DEGREES")]
    pub sigma_deg: Option<f64>,
    /// Number of particles.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub particles: usize,
    /// What is known of the first state.
    #[arg(long, value_enum, default_value_t = StartName::Standard)]
    pub init: StartName,
    /// Position in the cycle at the first frame, [0, 1) [default: where the model's pose fits
    /// best].
    #[arg(long, value_name = "X")]
    pub initial_cycle_position: Option<f64>,
    /// Cycles per frame at the first frame [default: the model's mean].
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub initial_cycle_velocity: Option<f64>,
    /// Growth of the trained accelerations' noise with the cycle's velocity (paper, paper-cut).
    #[arg(long, value_enum, default_value_t = ScalingName::FourthPower)]
    pub covariance_scaling: ScalingName,
    /// Standard deviation of the temporal acceleration, cycles per frame^2 (paper, paper-cut,
    /// particle) [default: 0.0001; 0.0008 for `particle`].
    #[arg(long, value_name = "X")]
    pub temporal_std: Option<f64>,
    /// Use only every K-th measurement after the first.
    #[arg(long, value_name = "K", conflicts_with = "update_at")]
    pub update_every: Option<u64>,
    /// Use only the measurements of these frames.
    #[arg(long, value_name = "F1,F2,...", value_delimiter = ',')]
    pub update_at: Option<Vec<u64>>,
    /// Estimate each frame from those before it alone, as firmware does; so are more than 100,000
    /// rows, and what comes on standard input. Else a table is a finished recording: what was
    /// measured, filtered, and in gaps the person's own cycle.
    #[arg(long, conflicts_with = "smooth")]
    pub online: bool,
    /// Give each frame what the filter says given the whole recording, later frames included (not
    /// with `particle`), in place of a finished recording's estimate.
    #[arg(long)]
    pub smooth: bool,
    /// Frames per second of the recording [default: those of the table].
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Seed of everything that is drawn.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Table of estimates to write.
    #[arg(long, value_name = "EST.csv")]
    pub out: PathBuf,
    /// Folder for what a coach reads: summary, repetitions, curves over the cycle, symmetry, plots,
    /// TRC and MOT files.
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Draw figure and flexion angles on the frames of this video, or the images of this folder:
    /// frame k of the table on image k in natural order, counted from 0. The pictures are written
    /// into `EST_overlay` beside the estimates. Needs a table from keypoints.
    #[arg(long, value_name = "VIDEO|FOLDER")]
    pub overlay: Option<PathBuf>,
    /// Write the stick figure alone as an animation, what was measured thin and grey behind the
    /// estimate.
    #[arg(long, value_name = "FILE.gif")]
    pub animation: Option<PathBuf>,
    /// Height of the person, metres: the scale of step lengths and speeds, which a table in pixels
    /// has only so, and of the report's joints.trc [there: 1.75].
    #[arg(long, value_name = "METRES")]
    pub height: Option<f64>,
    /// End with an error where something speaks against the result; it is written all the same.
    #[arg(long)]
    pub strict: bool,
    /// Go on with the run to --out that did not reach its end; what decides the estimates has to be
    /// the same.
    #[arg(long)]
    pub resume: bool,
    /// When the state is saved.
    #[command(flatten)]
    pub checkpoint: CheckpointArgs,
    /// The run for a viewer.
    #[command(flatten)]
    pub viewer: ViewerArgs,
}

/// Rows beyond which a table is not kept whole: an hour at 25 frames a second takes 60 MB.
const MAX_WHOLE_ROWS: usize = 100_000;

/// Least bytes of a row: the frame's digit, a comma before each angle, the end of the line.
const MIN_ROW_BYTES: usize = 15;

/// The subcommand, in what it leaves.
pub(super) const COMMAND: &str = "track cyclic";

impl TrackCyclicArgs {
    /// Whether the table cannot be read a second time: it is standard input, or a pipe.
    pub(super) fn is_read_once(&self) -> bool {
        self.table.as_os_str() == STANDARD_INPUT || std::fs::metadata(&self.table).is_ok_and(|facts| !facts.is_file())
    }

    /// Whether something is asked for that needs all rows at once.
    fn needs_all_rows(&self) -> bool {
        let Self { model, smooth, report, overlay, animation, .. } = self;
        *smooth || model.len() > 1 || report.is_some() || overlay.is_some() || animation.is_some()
    }

    /// Whether each row is answered from those before it.
    ///
    /// # Errors
    /// The table cannot be read.
    pub(super) fn is_online(&self) -> crate::Result<bool> {
        if self.needs_all_rows() {
            return Ok(false);
        }
        if self.online || self.is_read_once() {
            return Ok(true);
        }
        let bytes = std::fs::metadata(&self.table).map_or(u64::MAX, |facts| facts.len());
        let may_be_long = bytes > (MAX_WHOLE_ROWS * MIN_ROW_BYTES) as u64;
        Ok(may_be_long && AngleRows::open(&self.table)?.has_more_than(MAX_WHOLE_ROWS)?)
    }

    /// Whether the estimates are those of a finished recording.
    pub(super) fn is_finished(&self) -> bool {
        !self.smooth && !self.online && self.model.len() == 1
    }

    /// Frames per second of a recording whose table says `of_table`.
    ///
    /// # Errors
    /// Both are unknown, or they contradict each other.
    pub(super) fn rate_hz(&self, of_table: Option<f64>) -> Result<f64> {
        Ok(rate::of_recording(&self.table, of_table, self.rate)?)
    }

    /// What can be checked before anything is read.
    pub(super) fn check(&self) -> Result<()> {
        let height = self.height_m();
        ensure!((0.3..=3.0).contains(&height), "`height` has to lie from 0.3 to 3 metres, not {height}");
        ensure!(
            !self.viewer.is_wanted() || self.report.is_some(),
            "`--rerun` shows a run directory; give one with `--report DIR`"
        );
        self.viewer.check()?;
        check_writable_file(&self.out)?;
        if let Some(path) = &self.animation {
            let is_gif = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gif"));
            ensure!(is_gif, "`animation` has to end in .gif, not `{}`", path.display());
            check_writable_file(path)?;
        }
        Ok(())
    }

    /// Height of the person, metres: that of an adult where none is given.
    pub(super) fn height_m(&self) -> f64 {
        self.height.unwrap_or(1.75)
    }

    /// The models of `--model`.
    pub(super) fn models(&self) -> Result<Vec<CyclicModel>> {
        Ok(self.model.iter().map(|name| CyclicModel::from_option(name)).collect::<crate::Result<_>>()?)
    }

    /// How the estimates come about; what is made of them may differ from run to run.
    pub(super) fn begun(&self, models: &[CyclicModel]) -> Result<Begun> {
        let options = json!({
            "model": self.model,
            "filter": self.filter,
            "sigma_deg": self.sigma_deg,
            "particles": self.particles,
            "init": self.init,
            "initial_cycle_position": self.initial_cycle_position,
            "initial_cycle_velocity": self.initial_cycle_velocity,
            "covariance_scaling": self.covariance_scaling,
            "temporal_std": self.temporal_std,
            "update_every": self.update_every,
            "update_at": self.update_at,
            "smooth": self.smooth,
            "online": self.online,
            "rate": self.rate,
            "seed": self.seed,
        });
        let mut begun = Begun::new(COMMAND, &options, &[])?;
        if !self.is_read_once() {
            begun = begun.on(&self.table)?.reading(format!("`{}`", self.table.display()), file_crc32(&self.table)?);
        }
        let named = self.model.iter().zip(models);
        Ok(named
            .fold(begun, |begun, (name, model)| begun.reading(format!("the model `{name}`"), model.numbers().crc32())))
    }

    /// The tracker's options, as far as they do not hang on the table.
    pub(super) fn options(&self) -> TrackingOptions {
        let updates = match (&self.update_every, &self.update_at) {
            (Some(every), _) => Updates::Every(*every),
            (None, Some(frames)) => Updates::At(frames.clone()),
            (None, None) => Updates::All,
        };
        TrackingOptions {
            filter: self.filter,
            sigma_rad: self.sigma_deg.map_or(TrackingOptions::default().sigma_rad, f64::to_radians),
            start: self.init,
            initial_cycle_position: self.initial_cycle_position,
            initial_cycle_velocity: self.initial_cycle_velocity,
            covariance_scaling: self.covariance_scaling,
            temporal_std: self.temporal_std,
            updates,
            rate_hz: self.rate,
            particles: self.particles,
            seed: self.seed,
            smooth: self.smooth,
        }
    }
}
