//! A walk that begins in the middle of a recording, after somebody stood or did something else: how
//! soon its phase is found.

use super::Protocol;
use super::protocol::measurements;
use anyhow::Result;
use sinew::cyclic::tracking::{TrackingOptions, track};
use sinew::cyclic::{AngleRow, AngleTable, CyclicModel};
use std::ops::Range;

/// Error of the position beyond which a frame is off, cycles. Chosen: less than a foot's whole
/// stance.
const OFF_CYCLES: f64 = 0.15;
/// Frames of the second second at 60 a second.
const SECOND_SECOND: Range<usize> = 60..120;

/// Frames of walks whose position is off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct OffFrames {
    /// Of the second second, off and all.
    soon: [usize; 2],
    /// From then on, off and all.
    later: [usize; 2],
}

impl OffFrames {
    /// Adds the frames of `walk`, angles at 60 a second, each time after one of `befores`: the
    /// positions with noise of `sigma_deg` against those of the walk alone without noise.
    ///
    /// # Errors
    /// A table that the model cannot track.
    pub fn add(
        &mut self,
        model: &CyclicModel,
        walk: &[AngleRow],
        befores: &[Vec<AngleRow>],
        (sigma_deg, seeds): (f64, &[u64]),
    ) -> Result<()> {
        let wanted = positions(model, walk, None)?;
        for before in befores {
            let whole: Vec<AngleRow> = before.iter().chain(walk).cloned().collect();
            for &seed in seeds {
                let found = positions(model, &whole, Some((sigma_deg, seed)))?;
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
    #[must_use]
    pub fn shares(&self) -> [f64; 2] {
        [self.soon, self.later].map(|[off, all]| off as f64 / all as f64)
    }
}

/// Cycle position in each row of `rows`, numbered anew, with noise.
fn positions(model: &CyclicModel, rows: &[AngleRow], noise: Option<(f64, u64)>) -> Result<Vec<f64>> {
    let numbered = rows.iter().zip(0..).map(|(row, frame)| AngleRow { frame, extra: Vec::new(), ..row.clone() });
    let truth = AngleTable::new(numbered.collect(), Vec::new())?;
    let (sigma_deg, seed) = noise.unwrap_or((1.0, 1));
    let table = match noise {
        Some(_) => measurements(&truth, Protocol::Noisy, sigma_deg.to_radians(), seed),
        None => truth,
    };
    let options = TrackingOptions { sigma_rad: sigma_deg.to_radians(), ..TrackingOptions::default() };
    let run = track(&table, model, &options)?;
    Ok(run.frames.iter().map(|frame| f64::from(frame.estimate.cycle_position)).collect())
}
