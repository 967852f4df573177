//! What decides how a body is tracked frame by frame, and the rules of it.

use super::end_effectors::MAX_BODY_PARTICLES;
use super::model_kind::BodyModelKind;
use super::tuning::BodyTuning;
use crate::body::BodyPart;
use crate::body::recording::DEFAULT_RATE_HZ;
use crate::cloud::MAX_POINTS;
use crate::error::{Result, ensure, ensure_option};
use serde::{Deserialize, Serialize};
use sinew_core::tracker::body::modes::MAX_MODES;

/// Slowest and fastest rate of frames, Hz.
pub const RATES_HZ: [f32; 2] = [0.1, 1000.0];
/// Maximum number of threads.
pub const MAX_THREADS: usize = 256;

/// Everything but the person and the first pose; results do not depend on `threads`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyStreamOptions {
    /// How much of the body is tracked.
    pub part: BodyPart,
    /// The motion model.
    pub model: BodyModelKind,
    /// Number of particles.
    pub particles: usize,
    /// Maximum number of points of a frame that are weighed; of more they are drawn at random.
    pub max_points: usize,
    /// Seed of all that is random.
    pub seed: u64,
    /// Frames in a second.
    pub rate_hz: f32,
    /// The floor of the pelvic lift, camera axes, metres.
    pub floor_y_m: Option<f32>,
    /// Number of threads; as many as the machine runs at a time where there is none.
    pub threads: Option<usize>,
    /// Numbers of the motion models.
    pub tuning: BodyTuning,
}

impl Default for BodyStreamOptions {
    fn default() -> Self {
        let model = BodyModelKind::default();
        Self {
            part: BodyPart::default(),
            model,
            particles: model.default_particles(),
            max_points: MAX_POINTS,
            seed: 1,
            rate_hz: DEFAULT_RATE_HZ,
            floor_y_m: None,
            threads: None,
            tuning: BodyTuning::default(),
        }
    }
}

impl BodyStreamOptions {
    /// Checks the ranges.
    ///
    /// # Errors
    /// Names the option and its range.
    pub fn check(&self) -> Result<()> {
        check_particles(self.particles)?;
        check_points(self.max_points)?;
        check_threads(self.threads)?;
        check_rate("--rate", self.rate_hz)?;
        check_part(self.part, self.model)?;
        check_modes(self.model, self.particles)?;
        let is_finite = self.floor_y_m.is_none_or(f32::is_finite);
        ensure_option!(is_finite, "`floor_y_m` has to be finite");
        Ok(())
    }
}

/// Checks a number of particles.
///
/// # Errors
/// Names the option and its range.
pub fn check_particles(particles: usize) -> Result<()> {
    ensure_option!(
        (1..=MAX_BODY_PARTICLES).contains(&particles),
        "--particles has to be from 1 to {MAX_BODY_PARTICLES}, not {particles}"
    );
    Ok(())
}

/// Checks a number of points.
///
/// # Errors
/// Names the option and its range.
pub fn check_points(points: usize) -> Result<()> {
    ensure_option!((1..=MAX_POINTS).contains(&points), "--points has to be from 1 to {MAX_POINTS}, not {points}");
    Ok(())
}

/// Checks a number of modes, where `model` has them.
///
/// # Errors
/// Names the option and its range.
pub fn check_modes(model: BodyModelKind, particles: usize) -> Result<()> {
    ensure_option!(
        model != BodyModelKind::Modes || particles <= MAX_MODES,
        "--particles has to be from 1 to {MAX_MODES} with --model modes, not {particles}"
    );
    Ok(())
}

/// Checks a number of threads.
///
/// # Errors
/// Names the option and its range.
pub fn check_threads(threads: Option<usize>) -> Result<()> {
    if let Some(threads) = threads {
        ensure_option!(
            (1..=MAX_THREADS).contains(&threads),
            "--threads has to be from 1 to {MAX_THREADS}, not {threads}; leave it out for all"
        );
    }
    Ok(())
}

/// Checks a rate that `name` says.
///
/// # Errors
/// If it is outside [`RATES_HZ`].
pub fn check_rate(name: &str, rate_hz: f32) -> Result<()> {
    let [low, high] = RATES_HZ;
    ensure_option!((low..=high).contains(&rate_hz), "{name} has to be from {low} to {high} Hz, not {rate_hz}");
    Ok(())
}

/// Refuses a model of limbs that are not tracked.
///
/// # Errors
/// Names both options.
pub fn check_part(part: BodyPart, model: BodyModelKind) -> Result<()> {
    ensure!(
        part == BodyPart::Whole || model != BodyModelKind::PelvicLift,
        "--model {} holds the feet, and --body {} has none; choose another model, or --body {}",
        model.name(),
        part.name(),
        BodyPart::Whole.name()
    );
    Ok(())
}
