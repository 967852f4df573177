//! A recording of whole cycles, played at another tempo.

use super::long_runs::{LongRun, Recording, tracked};
use super::rate::DEFAULT_RATE_HZ;
use anyhow::Result;
use sinew::cyclic::tracking::FilterName;
use sinew::cyclic::turns::least_angle;
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};

/// A tempo: its name, and the frame of the recording, of which there are so many, that is seen at a
/// frame of the new one.
pub type Tempo = (&'static str, fn(f64, f64) -> f64);

/// Steady tempos, tempos that drift, and abrupt changes.
pub const TEMPOS: [Tempo; 9] = [
    ("as recorded", |frame, _| frame),
    ("0.7 times the speed", |frame, _| 0.7 * frame),
    ("0.8 times", |frame, _| 0.8 * frame),
    ("1.25 times", |frame, _| 1.25 * frame),
    ("1.4 times", |frame, _| 1.4 * frame),
    ("slower and slower, to 0.7 times", |frame, frames| frame - 0.16 * frame * frame / frames),
    ("faster and faster, to 1.4 times", |frame, frames| frame + 0.24 * frame * frame / frames),
    ("0.75 times from the middle on", |frame, frames| frame - 0.25 * (frame - 0.5 * frames).max(0.0)),
    ("1.3 times from the middle on", |frame, frames| frame + 0.3 * (frame - 0.5 * frames).max(0.0)),
];

/// A recording from its first cycle on, its borders counted from there.
#[derive(Debug, Clone)]
pub struct Walk {
    /// Name in tables.
    pub name: String,
    /// Angles, one row a frame.
    pub rows: Vec<AngleRow>,
    /// Starts of all cycles and the end of the last, frames.
    pub borders: Vec<u64>,
}

impl Walk {
    /// The recording that is seen at `tempo`.
    ///
    /// # Errors
    /// Less than two rows.
    pub fn played(&self, (_, source): Tempo) -> Result<Recording> {
        let count = self.rows.len();
        let seen = |frame: u64| source(frame as f64, count as f64);
        let frames: Vec<u64> = (0..).take_while(|&frame| seen(frame) < (count - 1) as f64).collect();
        let rows = frames.iter().map(|&frame| {
            let before = seen(frame) as usize;
            between(&self.rows[before], &self.rows[before + 1], seen(frame) - before as f64, frame)
        });
        let frame_of = |border: &u64| frames.partition_point(|&frame| seen(frame) < *border as f64 - 0.5) as u64;
        let borders: Vec<u64> = self.borders.iter().map(frame_of).collect();
        let last = borders.last().copied().unwrap_or(0);
        let truth = AngleTable::new(rows.take_while(|row| row.frame < last).collect(), Vec::new())?;
        Ok(Recording::new(self.name.clone(), truth, borders))
    }
}

/// Runs of one tempo: its name with a run for each walk and seed.
pub type TempoRuns = (&'static str, Vec<LongRun>);

/// Runs of `coupled` on `walks` at each tempo by `model`, with noise of `sigma_deg` degrees drawn
/// from each of the seeds.
///
/// # Errors
/// As [`tracked`].
pub fn tempo_runs(walks: &[Walk], model: &CyclicModel, (sigma_deg, seeds): (f64, &[u64])) -> Result<Vec<TempoRuns>> {
    let of_tempo = |tempo: Tempo| {
        let played: Vec<Recording> = walks.iter().map(|walk| walk.played(tempo)).collect::<Result<_>>()?;
        let mut runs = Vec::new();
        for &seed in seeds {
            runs.extend(tracked(&played, model, DEFAULT_RATE_HZ, &[FilterName::Coupled], (sigma_deg, seed))?);
        }
        Ok((tempo.0, runs))
    };
    TEMPOS.into_iter().map(of_tempo).collect()
}

/// Angles between two rows, the shorter way round.
fn between(before: &AngleRow, after: &AngleRow, part: f64, frame: u64) -> AngleRow {
    let mut row = AngleRow { frame, extra: Vec::new(), ..before.clone() };
    for (angle, after) in row.angles_rad.iter_mut().zip(&after.angles_rad) {
        *angle = angle.zip(*after).map(|(before, after)| before + part * least_angle(after - before));
    }
    row
}
