//! Errors of one run against the truth.

use super::observed::ObservedScene;
use anyhow::Result;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::json;
use sinew::resume::Cells;
use sinew::track::ArmSet;
use sinew_core::tracker::arm::{ArmOptions, Status};
use statrs::statistics::{Data, OrderStatistics};

/// First frame that counts: the paper looks at its trackers after 100 frames.
pub const FIRST_SCORED_FRAME: usize = 100;

/// Error of one frame.
#[derive(Debug, Clone, Copy, Default)]
pub struct FrameError {
    /// Distance of the estimated hand from the true one, metres.
    pub error_m: f64,
    /// The same in the image, pixels.
    pub error_px: f64,
    /// The standard deviation that the estimate says of its hand, metres an axis.
    pub hand_std_m: f64,
    /// How the estimate came about.
    pub status: Status,
}

/// Mean errors of one run.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct RunError {
    /// Mean 3D error of the scored frames, metres.
    pub mean_m: f64,
    /// Mean 2D error of the scored frames, pixels.
    pub mean_px: f64,
}

/// Median over runs with quartiles.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Spread {
    /// Lower quartile.
    pub lower: f64,
    /// Median.
    pub median: f64,
    /// Upper quartile.
    pub upper: f64,
}

impl Spread {
    /// Quartiles of `values`; NaN where there are none.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let mut data = Data::new(values.to_vec());
        Self { lower: data.lower_quartile(), median: data.median(), upper: data.upper_quartile() }
    }
}

/// Tracks a scene and returns the error of every frame. A lost arm's answer counts like any other.
///
/// # Errors
/// Names the parameter that cannot be used.
pub fn track(scene: &ObservedScene, tracker: &ArmOptions, seed: u64) -> Result<Vec<FrameError>> {
    let mut config = scene.config.clone();
    config.tracker = *tracker;
    let mut arms = ArmSet::new(&config, scene.size_px, scene.side, seed)?;
    let camera = *arms.models()[0].camera();
    let diagonal = f64::from(scene.size_px.0).hypot(f64::from(scene.size_px.1));
    let errors = scene.views.iter().zip(&scene.truth).enumerate().map(|(frame, (view, truth))| {
        let estimate = arms.step(frame as u64 * scene.frame_us, Some(view))[0].estimate;
        let hand = estimate.joints.hand_m;
        let error_px = camera.project(&hand).map_or(diagonal, |pixel| f64::from(pixel.distance_px(truth.hand_px)));
        FrameError {
            error_m: f64::from((hand - truth.hand_m).norm()),
            error_px: error_px.min(diagonal),
            hand_std_m: f64::from(estimate.hand_std_m),
            status: estimate.status,
        }
    });
    Ok(errors.collect())
}

/// Mean errors over the scored frames.
#[must_use]
pub fn summarise(errors: &[FrameError]) -> RunError {
    let scored = &errors[FIRST_SCORED_FRAME.min(errors.len().saturating_sub(1))..];
    let count = scored.len().max(1) as f64;
    RunError {
        mean_m: scored.iter().map(|e| e.error_m).sum::<f64>() / count,
        mean_px: scored.iter().map(|e| e.error_px).sum::<f64>() / count,
    }
}

/// Tracks every scene with its own seed and returns the runs' mean errors, in the scenes' order;
/// each run is a cell.
///
/// # Errors
/// As [`track`] and [`Cells::cell`].
pub fn run_all(scenes: &[ObservedScene], tracker: &ArmOptions, cells: &Cells<'_>) -> Result<Vec<RunError>> {
    let run = |scene: &ObservedScene| {
        let key = json!(["run", scene.key(), tracker]);
        cells.cell(&key, || track(scene, tracker, scene.seed).map(|errors| summarise(&errors)))
    };
    scenes.par_iter().map(run).collect()
}
