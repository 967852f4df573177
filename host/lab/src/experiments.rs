//! The comparisons of `evaluate arm`. They are variants against particle counts, and each option's
//! own effect. Others are the trackers as the arm paper prints them, and recovery after the hand
//! was away.

use super::clips::Clip;
use super::observed::{FrontEnd, ObservedScene, observe_all};
use super::score::{FrameError, Spread, run_all, track};
use anyhow::Result;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use sinew::config::Config;
use sinew::resume::Cells;
use sinew::scene::SceneOptions;
use sinew_core::observation::hough::HoughSettings;
use sinew_core::tracker::arm::options::{AreaCue, DEFAULT_AREA_CUE, EstimateRule, LimbCombination};
use sinew_core::tracker::arm::{ArmOptions, Variant};
use sinew_core::vision::hand_likelihood::LikelihoodForm;

/// Stack of a worker thread: the trackers with thousands of particles are built there.
pub const STACK_BYTES: usize = 32 << 20;

/// Errors of one tracker over all scenes.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// What was tracked with.
    pub name: String,
    /// Number of particles.
    pub particles: usize,
    /// Mean 3D error of a run, median over runs with quartiles, metres.
    pub error_m: Spread,
    /// Mean 2D error of a run, median over runs with quartiles, pixels.
    pub error_px: Spread,
    /// Every run's mean errors, in the scenes' order: metres, pixels.
    pub runs: Vec<(f64, f64)>,
}

/// Tracks all scenes with one configuration.
///
/// # Errors
/// As [`run_all`].
pub fn row(name: &str, scenes: &[ObservedScene], tracker: &ArmOptions, cells: &Cells<'_>) -> Result<Row> {
    let runs: Vec<(f64, f64)> = run_all(scenes, tracker, cells)?.iter().map(|run| (run.mean_m, run.mean_px)).collect();
    let spread = |value: fn(&(f64, f64)) -> f64| Spread::of(&runs.iter().map(value).collect::<Vec<_>>());
    Ok(Row {
        name: name.to_owned(),
        particles: tracker.particles,
        error_m: spread(|run| run.0),
        error_px: spread(|run| run.1),
        runs,
    })
}

/// Every variant with every particle count, variants first.
///
/// # Errors
/// As [`row`].
pub fn variants(
    scenes: &[ObservedScene],
    names: &[Variant],
    particles: &[usize],
    cells: &Cells<'_>,
) -> Result<Vec<Row>> {
    let jobs = names.iter().flat_map(|&variant| particles.iter().map(move |&particles| (variant, particles)));
    jobs.map(|(variant, particles)| {
        let tracker = ArmOptions { variant, particles, ..ArmOptions::default() };
        row(variant.traits().name, scenes, &tracker, cells)
    })
    .collect()
}

/// How blobs are ranked as the arm paper prints it: (6) to (9) of the plain blob.
#[must_use]
pub fn printed_base() -> Config {
    let mut base = Config::default();
    base.likelihood.form = LikelihoodForm::Paper;
    base
}

/// The paper keeps no orientation of a limb at rest. The option has to be positive, seconds.
const NO_ORIENTATION_MEMORY_S: f32 = 1.0e-3;

/// A tracker as the arm paper prints it: mean of both limbs, no gate, no area cue, no memory of
/// blobs or orientations, every pair of pixels votes in full, mean of all particles. Its blobs are
/// ranked by [`printed_base`].
#[must_use]
pub fn as_printed(variant: Variant, particles: usize) -> ArmOptions {
    ArmOptions {
        variant,
        particles,
        combination: LimbCombination::Mean,
        gate: None,
        area_cue: None,
        depth_from_area: false,
        blob_memory: None,
        estimate: EstimateRule::Mean,
        orientation_memory_s: NO_ORIENTATION_MEMORY_S,
        // Two pixels make a line; the distance has to be positive.
        hough: HoughSettings { min_separation_px: 0.5, min_pixels: 2, doubt_pixels: 0.0, ..HoughSettings::default() },
        ..ArmOptions::default()
    }
}

/// Three of these trackers on all scenes, which were read alone, by [`printed_base`].
///
/// # Errors
/// As [`row`].
pub fn printed(scenes: &[ObservedScene], cells: &Cells<'_>) -> Result<Vec<Row>> {
    let trackers = [(Variant::Corrected, 50), (Variant::Standard, 50), (Variant::Standard, 1000)];
    let named = |variant: Variant| format!("{} as printed", variant.traits().name);
    let measured = |(variant, n)| row(&named(variant), scenes, &as_printed(variant, n), cells);
    trackers.into_iter().map(measured).collect()
}

/// Each option of `variant` changed on its own, with 50 particles; the unchanged tracker first.
///
/// # Errors
/// As [`row`].
pub fn options(scenes: &[ObservedScene], variant: Variant, cells: &Cells<'_>) -> Result<Vec<Row>> {
    let base = || ArmOptions { variant, ..ArmOptions::default() };
    let changed = [
        ("default", base()),
        ("no gate", ArmOptions { gate: None, ..base() }),
        ("no area cue", ArmOptions { area_cue: None, ..base() }),
        ("depth from area", ArmOptions { depth_from_area: true, ..base() }),
        ("no joint limits", ArmOptions { joint_limits: false, ..base() }),
        (
            "area not foreshortened",
            ArmOptions { area_cue: Some(AreaCue { foreshortening: 0.0, ..DEFAULT_AREA_CUE }), ..base() },
        ),
        ("no blob memory", ArmOptions { blob_memory: None, ..base() }),
        ("mean of all particles", ArmOptions { estimate: EstimateRule::Mean, ..base() }),
        ("mean of both limbs", ArmOptions { combination: LimbCombination::Mean, ..base() }),
    ];
    let named = |name: &str| format!("{}: {name}", variant.traits().name);
    changed.iter().map(|(name, tracker)| row(&named(name), scenes, tracker, cells)).collect()
}

/// Frames in which the hand is away in the recovery scenes.
pub const AWAY: std::ops::Range<usize> = 120..150;
/// Frames after the return within which it counts as found again.
pub const RECOVERY_FRAMES: usize = 5;
/// Frames on end with a small error that make a recovery.
pub const STEADY_FRAMES: usize = 3;
/// The small error, as a share of the image's width.
pub const RECOVERED_SHARE: f64 = 0.05;

/// Share of runs that recovered in time.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Recovery {
    /// Runs without a skin-coloured face.
    pub without_false_blob: f64,
    /// Runs with one in all frames.
    pub with_false_blob: f64,
    /// Runs of each kind.
    pub runs: usize,
}

/// Whether the error was small for [`STEADY_FRAMES`] on end, beginning within [`RECOVERY_FRAMES`]
/// after the return.
fn recovered(errors: &[FrameError], width_px: u32) -> bool {
    let small = |error: &FrameError| error.error_px < RECOVERED_SHARE * f64::from(width_px);
    let after = errors.get(AWAY.end..).unwrap_or(&[]);
    after.windows(STEADY_FRAMES).take(RECOVERY_FRAMES).any(|frames| frames.iter().all(small))
}

/// Sends the hand away and sees whether the default tracker finds it again.
///
/// # Errors
/// As [`observe_all`], [`track`] and [`Cells::cell`].
pub fn recovery(clips: &[Clip], seeds: &[u64], front_end: &FrontEnd<'_>, cells: &Cells<'_>) -> Result<Recovery> {
    let share = |false_blob_fraction: f32| -> Result<f64> {
        let options = SceneOptions {
            frames: AWAY.end + 15,
            away: Some(AWAY),
            hidden_fraction: 0.0,
            false_blob_fraction,
            ..SceneOptions::default()
        };
        let scenes = observe_all(clips, seeds, &options, front_end, cells)?;
        let found: Vec<bool> = scenes
            .par_iter()
            .map(|scene| {
                let key = json!(["recovery", scene.key(), f64::from(false_blob_fraction)]);
                cells.cell(&key, || {
                    track(scene, &front_end.config.tracker, scene.seed)
                        .map(|errors| recovered(&errors, scene.size_px.0))
                })
            })
            .collect::<Result<_>>()?;
        Ok(found.iter().filter(|found| **found).count() as f64 / found.len().max(1) as f64)
    };
    Ok(Recovery { without_false_blob: share(0.0)?, with_false_blob: share(1.0)?, runs: clips.len() * seeds.len() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovery_needs_three_small_errors_on_end_soon_enough() {
        let frame = |error_px| FrameError { error_px, ..FrameError::default() };
        let mut errors = vec![frame(100.0); AWAY.end + 15];
        assert!(!recovered(&errors, 640));
        for error in &mut errors[AWAY.end + 4..AWAY.end + 7] {
            *error = frame(5.0);
        }
        assert!(recovered(&errors, 640));
        errors[AWAY.end + 5] = frame(50.0);
        assert!(!recovered(&errors, 640));
        for error in &mut errors[AWAY.end + 6..] {
            *error = frame(5.0);
        }
        assert!(!recovered(&errors, 640), "too late");
    }
}
