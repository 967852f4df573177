//! A walk that begins in the middle of a recording, after somebody stood or did something else: how
//! soon its phase is found.

use super::Protocol;
use super::other_sources::{Excerpt, WALKS, excerpt};
use super::protocol::measurements;
use super::stress::{ELSEWHERE, Stranger, strangers};
use anyhow::Result;
use sinew::cyclic::tracking::{TrackingOptions, track};
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};
use std::ops::Range;
use std::path::Path;

/// Error of the position beyond which a frame is off, cycles. Chosen: less than a foot's whole
/// stance.
const OFF_CYCLES: f64 = 0.15;
/// Frames of the second second at 60 a second.
const SECOND_SECOND: Range<usize> = 60..120;

/// Frames of a walk: five seconds from the half second on.
const WALK: Range<usize> = 30..330;
/// Frames for which somebody stands before walking.
const STANDING: [usize; 2] = [20, 90];
/// What comes before [`WALKS`]: squats, a waving hand, half a second of an arm exercise.
const EXERCISES: [Excerpt; 3] = [
    ("cmu-exercise/13_30.amc", Some("cmu-walk/35/35.asf"), 708..828),
    ("bandai/dataset-2_wave-right-hand_normal_001.bvh", None, 60..180),
    ("cmu-exercise/13_31.amc", Some("cmu-walk/35/35.asf"), 1000..1031),
];
/// What comes before the people of the training.
const SIGNALS: [Excerpt; 10] = [
    ("cmu-expmap/train_directing_traffic_1.txt", None, 0..120),
    ("cmu-expmap/train_directing_traffic_1.txt", None, 150..181),
    ("cmu-expmap/train_directing_traffic_1.txt", None, 400..520),
    ("cmu-expmap/train_basketball_signal_3.txt", None, 0..90),
    ("cmu-expmap/train_basketball_signal_3.txt", None, 100..131),
    ("cmu-expmap/train_basketball_signal_3.txt", None, 120..240),
    ("cmu-expmap/train_jumping_1.txt", None, 0..120),
    ("cmu-expmap/train_jumping_1.txt", None, 130..161),
    ("cmu-expmap/train_running_1.txt", None, 0..60),
    ("cmu-expmap/train_running_2.txt", None, 0..100),
];

/// A walk, what came before it, and who follows it.
#[derive(Debug, Clone)]
pub struct WalkAfter {
    model: CyclicModel,
    /// Angles at 60 a second.
    walk: Vec<AngleRow>,
    befores: Vec<Vec<AngleRow>>,
}

/// [`WALKS`] below `mocap` after standing and after exercises, for the shipped model.
///
/// # Errors
/// A recording cannot be read.
pub fn of_other_sources(mocap: &Path) -> Result<Vec<WalkAfter>> {
    let model = CyclicModel::from_option("walking")?;
    let exercises = before(mocap, EXERCISES)?;
    let after = |file| {
        let walk = excerpt(mocap, (file, None, WALK))?;
        Ok(WalkAfter { model: model.clone(), befores: with_standing(&walk, &exercises), walk })
    };
    WALKS.into_iter().map(after).collect()
}

/// The [people of the training](super::stress) after standing, hand signals and jumps, each for a
/// model of the others, by [`ELSEWHERE`]. By these the filter may be chosen.
///
/// # Errors
/// As [`of_other_sources`].
pub fn of_strangers(mocap: &Path) -> Result<[Vec<WalkAfter>; ELSEWHERE.len()]> {
    let signals = before(mocap, SIGNALS)?;
    let mut all = ELSEWHERE.map(|_| Vec::new());
    for Stranger { model, chains } in strangers(&mocap.join("cmu-walk"))? {
        for (chain, all) in chains.iter().zip(&mut all) {
            let walk = chain.rows[..WALK.len().min(chain.rows.len())].to_vec();
            all.push(WalkAfter { model: model.clone(), befores: with_standing(&walk, &signals), walk });
        }
    }
    Ok(all)
}

/// Share of the frames that are off in the second second of the walks, and from then on; with noise
/// of `sigma_deg` from each of the seeds, by the filter alone or looking back over the recording.
///
/// # Errors
/// The filter refuses a recording.
pub fn off_shares(walks: &[WalkAfter], (sigma_deg, seeds): (f64, &[u64]), smooth: bool) -> Result<[f64; 2]> {
    let mut off = OffFrames::default();
    for walk in walks {
        off.add(walk, (sigma_deg, seeds), smooth)?;
    }
    Ok(off.shares())
}

fn before<const COUNT: usize>(mocap: &Path, others: [Excerpt; COUNT]) -> Result<Vec<Vec<AngleRow>>> {
    others.into_iter().map(|other| excerpt(mocap, other)).collect()
}

/// Standing as `walk` begins, and each of `others`.
fn with_standing(walk: &[AngleRow], others: &[Vec<AngleRow>]) -> Vec<Vec<AngleRow>> {
    let standing = STANDING.iter().map(|&frames| vec![walk[0].clone(); frames]);
    standing.chain(others.iter().cloned()).collect()
}

/// Frames of walks whose position is off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct OffFrames {
    /// Of the second second, off and all.
    soon: [usize; 2],
    /// From then on, off and all.
    later: [usize; 2],
}

impl OffFrames {
    /// Adds the frames of a walk, each time after something else: the positions with noise of
    /// `sigma_deg` against those of the walk alone without noise.
    fn add(
        &mut self,
        WalkAfter { model, walk, befores }: &WalkAfter,
        (sigma_deg, seeds): (f64, &[u64]),
        smooth: bool,
    ) -> Result<()> {
        let wanted = positions(model, walk, None, false)?;
        for before in befores {
            let whole: Vec<AngleRow> = before.iter().chain(walk).cloned().collect();
            for &seed in seeds {
                let found = positions(model, &whole, Some((sigma_deg, seed)), smooth)?;
                for (frame, (found, wanted)) in found[before.len()..].iter().zip(&wanted).enumerate() {
                    let way = found - wanted;
                    let is_off = usize::from((way - way.round()).abs() > OFF_CYCLES);
                    if SECOND_SECOND.contains(&frame) {
                        self.soon = [self.soon[0] + is_off, self.soon[1] + 1];
                    } else if frame >= SECOND_SECOND.end {
                        self.later = [self.later[0] + is_off, self.later[1] + 1];
                    }
                }
            }
        }
        Ok(())
    }

    /// Share of the frames that are off in the second second, and from then on.
    fn shares(&self) -> [f64; 2] {
        [self.soon, self.later].map(|[off, all]| off as f64 / all as f64)
    }
}

/// Cycle position in each row of `rows`, numbered anew, with noise.
fn positions(model: &CyclicModel, rows: &[AngleRow], noise: Option<(f64, u64)>, smooth: bool) -> Result<Vec<f64>> {
    let numbered = rows.iter().zip(0..).map(|(row, frame)| AngleRow { frame, extra: Vec::new(), ..row.clone() });
    let truth = AngleTable::new(numbered.collect(), Vec::new())?;
    let (sigma_deg, seed) = noise.unwrap_or((1.0, 1));
    let table = match noise {
        Some(_) => measurements(&truth, Protocol::Noisy, sigma_deg.to_radians(), seed),
        None => truth,
    };
    let options = TrackingOptions { sigma_rad: sigma_deg.to_radians(), smooth, ..TrackingOptions::default() };
    let run = track(&table, model, &options)?;
    Ok(run.frames.iter().map(|frame| f64::from(frame.estimate.cycle_position)).collect())
}
