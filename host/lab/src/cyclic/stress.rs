//! Walkers of the training, each tracked by a model of the other people: where `coupled` loses its
//! place, without recordings that are kept for reporting.
//!
//! Each person's cycles follow each other in a chain, at nine tempos. In further sets the joints
//! lie elsewhere, as in a recording of another source, and farther than in any.

use super::LongRun;
use super::protocol::LONG_ANGLES;
use super::rate::DEFAULT_RATE_HZ;
use super::tempo::{Walk, tempo_runs};
use anyhow::{Context, Result};
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::training::{TrainingOptions, cycles_of, train_on};
use sinew::cyclic::turns::least_angle;
use sinew::cyclic::{AngleRow, AngleTable, Cut, CutList, CyclicModel};
use sinew_core::random::Stream;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

/// Cycles of a chain.
const CHAIN_CYCLES: usize = 8;
/// Standard deviation of an angle's offset where joints lie elsewhere, of the long parts and of the
/// links of hips and shoulders, degrees. Chosen: about what another source's joints have.
const OFFSET_STD_DEG: [f64; 2] = [12.0, 30.0];
/// Smallest and largest factor of such an angle's swing. Chosen likewise.
const SWING: [f64; 2] = [0.6, 1.3];
/// Factors of the offsets and powers of the swings' factors: own joints, elsewhere, and farther.
/// Chosen: so that filters which are alike at the first differ at the others.
pub const ELSEWHERE: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 1.0), (1.5, 1.3), (2.0, 1.6)];
/// The cut list of the shipped walking model.
const CUTS: &str = include_str!("../../../models/cuts/walking.csv");

/// One person, and a model of all others.
#[derive(Debug)]
pub struct Stranger {
    /// Trained on the seven other people.
    pub model: CyclicModel,
    /// The person's chain with joints at each of [`ELSEWHERE`].
    pub chains: [Walk; ELSEWHERE.len()],
}

/// Each of the eight people of the shipped walking model, from the recordings below `cmu_walk`.
///
/// # Errors
/// A recording that cannot be read, or cycles that give no model.
pub fn strangers(cmu_walk: &Path) -> Result<Vec<Stranger>> {
    let list = CutList::parse(CUTS, &cmu_walk.join("walking.csv"))?;
    let tables = tables(&list, cmu_walk)?;
    let mut people: Vec<&str> = list.cuts().iter().filter_map(|cut| cut.person.as_deref()).collect();
    people.dedup();
    people.iter().zip(1..).map(|(person, seed)| stranger(&list, &tables, (person, seed))).collect()
}

/// Angle tables of the recordings, by the path that the list gives them.
fn tables(list: &CutList, cmu_walk: &Path) -> Result<BTreeMap<PathBuf, AngleTable>> {
    let options = RecordingOptions { rate_hz: Some(DEFAULT_RATE_HZ), ..RecordingOptions::default() };
    let mut tables = BTreeMap::new();
    for cut in list.cuts() {
        if let Entry::Vacant(table) = tables.entry(list.table_path(cut)) {
            let recording = cmu_walk.join(&cut.file[..2]).join(cut.file.replace(".csv", ".amc"));
            table.insert(angles(&recording, &options)?.table);
        }
    }
    Ok(tables)
}

fn stranger(list: &CutList, tables: &BTreeMap<PathBuf, AngleTable>, (person, seed): (&str, u64)) -> Result<Stranger> {
    let (own, others): (Vec<Cut>, Vec<Cut>) =
        list.cuts().iter().cloned().partition(|cut| cut.person.as_deref() == Some(person));
    let others = CutList::of_cuts(others, list.path())?;
    let cycles = cycles_of(&others, true, &|path| Ok(tables[path].clone()))?;
    let options = TrainingOptions { rate_hz: Some(DEFAULT_RATE_HZ), mirror: true, ..TrainingOptions::default() };
    let model = train_on(&cycles, &others, options)?;
    let chain = chain(&own, |cut| &tables[&list.table_path(cut)]).context("an angle is missing in a cycle")?;
    let walk = |by: (f64, f64)| {
        let poses = elsewhere(&chain.0, by, seed);
        let rows = poses.into_iter().zip(0..).map(|(pose, frame)| AngleRow {
            frame,
            angles_rad: pose.map(Some),
            extra: Vec::new(),
        });
        Walk { name: person.to_owned(), rows: rows.collect(), borders: chain.1.clone() }
    };
    Ok(Stranger { model, chains: ELSEWHERE.map(walk) })
}

/// Poses of [`CHAIN_CYCLES`] cycles in a row and their borders. Each cycle is closed by a drift, so
/// that it begins and ends with the mean of all first poses.
fn chain<'a>(cuts: &[Cut], table: impl Fn(&Cut) -> &'a AngleTable) -> Option<(Vec<[f64; ANGLES]>, Vec<u64>)> {
    let pose = |cut: &Cut, frame: u64| {
        let row = table(cut).row(frame.min(table(cut).end_frame() - 1))?;
        let mut pose = [0.0; ANGLES];
        pose.iter_mut().zip(row.angles_rad).try_for_each(|(to, angle)| angle.map(|angle| *to = angle))?;
        Some(pose)
    };
    let first = pose(&cuts[0], cuts[0].start_frame)?;
    let mut start = first;
    for cut in cuts {
        let other = pose(cut, cut.start_frame)?;
        (0..ANGLES).for_each(|i| start[i] += least_angle(other[i] - first[i]) / cuts.len() as f64);
    }
    let (mut poses, mut borders) = (Vec::new(), vec![0]);
    for cut in cuts.iter().cycle().take(CHAIN_CYCLES) {
        let ends = [pose(cut, cut.start_frame)?, pose(cut, cut.end_frame)?];
        for frame in cut.start_frame..cut.end_frame {
            let part = (frame - cut.start_frame) as f64 / cut.duration_frames() as f64;
            let mut closed = pose(cut, frame)?;
            for i in 0..ANGLES {
                let [off, end_off] = ends.map(|end| least_angle(end[i] - start[i]));
                closed[i] -= off + part * (end_off - off);
            }
            poses.push(closed);
        }
        borders.push(poses.len() as u64);
    }
    poses.push(start);
    Some((poses, borders))
}

/// `poses` with an offset of each angle and another swing about its mean.
fn elsewhere(poses: &[[f64; ANGLES]], (farther, power): (f64, f64), seed: u64) -> Vec<[f64; ANGLES]> {
    let mut moved = poses.to_vec();
    for i in 0..ANGLES {
        let mut stream = Stream::new(seed, 0, i as u32);
        let swing = (SWING[0] + f64::from(stream.uniform()) * (SWING[1] - SWING[0])).powf(power);
        let std_deg = OFFSET_STD_DEG[usize::from(!LONG_ANGLES.contains(&i))];
        let offset_rad = farther * std_deg.to_radians() * f64::from(stream.normal());
        let about = poses[0][i];
        let mean = about + poses.iter().map(|pose| least_angle(pose[i] - about)).sum::<f64>() / poses.len() as f64;
        moved.iter_mut().for_each(|pose| pose[i] = mean + offset_rad + swing * least_angle(pose[i] - mean));
    }
    moved
}

/// Runs of `coupled` on all chains at all tempos, by [`ELSEWHERE`].
///
/// # Errors
/// A filter cannot start.
pub fn stress_runs(strangers: &[Stranger], sigma_deg: f64, seeds: &[u64]) -> Result<[Vec<LongRun>; ELSEWHERE.len()]> {
    let mut runs = ELSEWHERE.map(|_| Vec::new());
    for stranger in strangers {
        for (walk, runs) in stranger.chains.iter().zip(&mut runs) {
            let tempos = tempo_runs(std::slice::from_ref(walk), &stranger.model, (sigma_deg, seeds))?;
            runs.extend(tempos.into_iter().flat_map(|(_, runs)| runs));
        }
    }
    Ok(runs)
}
