//! Runners before the simulated camera, by several seeds of the tracker and clouds of the camera.
//!
//! A runner's clip begins 8 to 11 m away, where distances scatter by more than a limb's thickness.
//! One seed or one cloud proves nothing there: joint errors of one clip differ by a factor of
//! three.

use super::motions::ReadMotion;
use super::trial::{SeenMotion, TrialResult, trial};
use anyhow::Result;
use rayon::prelude::*;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::stereo::StereoOptions;

/// Rows in the data split of the runners that are shown. They count as tuning: nothing was chosen
/// on these clips, but their sources have clips on which numbers were.
pub const TRACKER: &str = "runners";

/// Seeds of the camera and of the tracker, from 1 on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seeds {
    /// Clouds of the camera.
    pub clouds: u64,
    /// Trackers on each cloud.
    pub trackers: u64,
}

/// The trials of one motion and model, cloud by cloud, in parallel; and PIK (35) of the truth,
/// metres a frame. The camera has `patches` patches without points.
///
/// # Errors
/// A motion that makes no scene; a parameter of the tracker that broke a rule.
pub fn runs(
    motion: &ReadMotion,
    (model, particles): (BodyModelKind, usize),
    tuning: &BodyTuning,
    (seeds, patches): (Seeds, u32),
) -> Result<(Vec<TrialResult>, f64)> {
    let of_cloud = |cloud| motion.seen_as(StereoOptions { seed: cloud, patches, ..StereoOptions::default() });
    let seen: Vec<SeenMotion> = (1..=seeds.clouds).into_par_iter().map(of_cloud).collect::<Result<_>>()?;
    let pairs: Vec<(&SeenMotion, u64)> =
        seen.iter().flat_map(|seen| (1..=seeds.trackers).map(move |seed| (seen, seed))).collect();
    let one = |&(seen, seed): &(&SeenMotion, u64)| Ok(trial(seen, model, tuning, particles, seed)?.0);
    let trials = pairs.par_iter().map(one).collect::<Result<_>>()?;
    Ok((trials, seen.first().map_or(0.0, SeenMotion::smoothness_m)))
}
