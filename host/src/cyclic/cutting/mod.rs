//! Finds the cycles of an angle table by itself.
//!
//! The period is where the motion of all angles resembles itself best ([`period`]). A cycle starts
//! where the left thigh is farthest forward, in the swing of one period. The next one starts where
//! the whole pose round that moment repeats ([`recurrence`]), which is steadier than the next peak.
//! Where the tempo changes, that may be after several cycles ([`multiples`]).

pub mod alignment;
pub mod channels;
pub mod multiples;
pub mod period;
pub mod recurrence;

use super::angle_table::AngleTable;
use super::cuts::Cut;
use super::error::CyclicError;
use channels::Channels;

/// Maximum number of frames that are searched.
const MAX_FRAMES: u64 = 2_000_000;

/// What counts as a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuttingOptions {
    /// Frames per second of the table.
    pub rate_hz: f64,
    /// Shortest cycle, seconds.
    pub shortest_s: f64,
    /// Longest cycle, seconds.
    pub longest_s: f64,
}

impl Default for CuttingOptions {
    fn default() -> Self {
        Self { rate_hz: 60.0, shortest_s: 0.4, longest_s: 6.0 }
    }
}

/// The cycles of `table`, one after the other; `file` is the name that they get in a cut list.
///
/// # Errors
/// Says why there is no cycle: too short, nothing moves, nothing comes back; or which option is out
/// of range.
pub fn cycles(table: &AngleTable, file: &str, options: CuttingOptions) -> Result<Vec<Cut>, CyclicError> {
    let CuttingOptions { rate_hz, shortest_s, longest_s } = options;
    if !(rate_hz > 0.0 && rate_hz.is_finite()) {
        return Err(CyclicError::parameter("rate", format!("has to be greater than zero, not {rate_hz}")));
    }
    if !(shortest_s > 0.0 && shortest_s < longest_s && longest_s.is_finite()) {
        let rule = format!("has to be above zero and below the longest, not {shortest_s} and {longest_s}");
        return Err(CyclicError::parameter("shortest cycle", rule));
    }
    let refuse = |reason: String| Err(CyclicError::NoCycle { file: file.to_owned(), reason });
    let frames = table.end_frame() - table.first_frame();
    if frames > MAX_FRAMES {
        return refuse(format!(
            "it spans {frames} frames, from its first to its last; {MAX_FRAMES} are searched at most"
        ));
    }
    let Some(channels) = Channels::of(table) else {
        return refuse("no angle moves by more than a few degrees in it".into());
    };
    let bounds = [(shortest_s * rate_hz).round().max(4.0) as usize, (longest_s * rate_hz).round() as usize];
    let period = match period::find(&channels, bounds) {
        Ok(period) => period,
        Err(reason) => return refuse(reason),
    };
    let over_period = channels.over_period(period);
    let boundaries = recurrence::boundaries(table, &over_period, period);
    let boundaries = multiples::split(&over_period, &boundaries, bounds[0]);
    let cuts: Vec<Cut> = boundaries
        .iter()
        .map(|&[start, end]| Cut {
            file: file.to_owned(),
            start_frame: table.first_frame() + start as u64,
            end_frame: table.first_frame() + end as u64,
            person: None,
            line: 0,
        })
        .collect();
    if cuts.is_empty() {
        return refuse(format!("no motion comes back after its period of {period} frames"));
    }
    Ok(cuts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::angle_table::ANGLES;
    use sinew_core::random::Stream;
    use std::f64::consts::TAU;

    /// Arms and legs swing against each other with harmonics; `noise` is a deterministic jitter.
    fn walk(period: f64, frames: usize, noise: f64) -> AngleTable {
        let row = |frame: usize| {
            std::array::from_fn::<_, ANGLES, _>(|angle| {
                let side = if angle >= 10 || (4..7).contains(&angle) { 0.5 } else { 0.0 };
                let phase = TAU * (frame as f64 / period + side + 0.05 * angle as f64);
                let jitter = ((frame * 7919 + angle * 104_729) % 1000) as f64 / 500.0 - 1.0;
                Some(1.5 + 0.4 * phase.sin() + 0.1 * (2.0 * phase).sin() + noise * jitter)
            })
        };
        AngleTable::from_angles(5, &(0..frames).map(row).collect::<Vec<_>>()).unwrap()
    }

    fn refusal(table: &AngleTable) -> String {
        cycles(table, "t.csv", CuttingOptions::default()).unwrap_err().to_string()
    }

    #[test]
    fn every_whole_cycle_is_cut_at_its_length() {
        for period in [40.0, 67.3, 130.0] {
            let cuts = cycles(&walk(period, 600, 0.05), "t.csv", CuttingOptions::default()).unwrap();
            assert!(cuts.len() >= (600.0 / period) as usize - 1, "{period}: {} cuts", cuts.len());
            assert!(cuts.windows(2).all(|pair| pair[0].end_frame == pair[1].start_frame));
            let mean = (cuts[cuts.len() - 1].end_frame - cuts[0].start_frame) as f64 / cuts.len() as f64;
            assert!((mean / period - 1.0).abs() < 0.01, "{period}: {mean}");
            assert!(cuts[0].start_frame >= 5 && cuts[cuts.len() - 1].end_frame <= 605);
        }
    }

    /// Hips and shoulders of a person from the side are a few pixels long, and their angles noise.
    #[test]
    fn short_segments_do_not_outvote_long_ones() {
        let is_short = |angle: usize| [1, 4, 7, 10].contains(&angle);
        let names = crate::cyclic::angle_table::COLUMNS[1..].iter().map(|name| name.trim_end_matches("_rad"));
        let lengths: Vec<String> = names.map(|name| format!("{name}_length_px")).collect();
        let root = ["hip_center_u_px", "hip_center_v_px"].map(str::to_owned);
        let columns = || root.iter().chain(&lengths).cloned().collect::<Vec<String>>();
        let mut rows = walk(60.0, 400, 0.02).rows().to_vec();
        for row in &mut rows {
            for (angle, value) in row.angles_rad.iter_mut().enumerate() {
                let random = Stream::new(row.frame, 0, angle as u32).uniform();
                *value =
                    if is_short(angle) { Some(TAU * f64::from(random)) } else { Some(0.4 * (value.unwrap() - 1.5)) };
            }
        }
        let unknown = refusal(&AngleTable::new(rows.clone(), Vec::new()).unwrap());
        assert!(unknown.contains("nothing comes back"), "{unknown}");
        for row in &mut rows {
            let length = |angle: usize| if is_short(angle) { "3" } else { "80" }.to_owned();
            row.extra = (0..2).map(|_| "0".to_owned()).chain((0..ANGLES).map(length)).collect();
        }
        let cuts = cycles(&AngleTable::new(rows, columns()).unwrap(), "t.csv", CuttingOptions::default()).unwrap();
        assert!(cuts.len() >= 5 && cuts.iter().all(|cut| cut.duration_frames().abs_diff(60) <= 2), "{cuts:?}");
    }

    #[test]
    fn missing_angles_do_not_hinder() {
        let mut rows = walk(60.0, 400, 0.02).rows().to_vec();
        for (index, row) in rows.iter_mut().enumerate() {
            for (angle, value) in row.angles_rad.iter_mut().enumerate() {
                if (index / 9 + angle) % 3 == 0 || angle == 8 {
                    *value = None;
                }
            }
        }
        rows.retain(|row| !(100..104).contains(&row.frame));
        let cuts = cycles(&AngleTable::new(rows, Vec::new()).unwrap(), "t.csv", CuttingOptions::default()).unwrap();
        assert!(cuts.len() >= 5 && cuts.iter().all(|cut| cut.duration_frames().abs_diff(60) <= 2), "{cuts:?}");
    }

    #[test]
    fn what_has_no_cycle_is_refused_with_the_reason() {
        assert!(refusal(&walk(60.0, 50, 0.0)).contains("t.csv"));
        assert!(refusal(&walk(60.0, 50, 0.0)).contains("it may be too short"));
        assert!(refusal(&walk(60.0, 20, 0.0)).contains("frames are too short"));
        let still = AngleTable::from_angles(0, &vec![[Some(1.0); ANGLES]; 300]).unwrap();
        assert!(refusal(&still).contains("no angle moves"));
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / 16_777_216.0
        };
        let rows: Vec<_> = (0..300).map(|_| std::array::from_fn::<_, ANGLES, _>(|_| Some(random()))).collect();
        let restless = AngleTable::from_angles(0, &rows).unwrap();
        assert!(refusal(&restless).contains("nothing comes back"), "{}", refusal(&restless));
        let mut rows = still.rows().to_vec();
        rows[299].frame = 10_000_000;
        assert!(refusal(&AngleTable::new(rows, Vec::new()).unwrap()).contains("it spans 10000001 frames"));
        let options = CuttingOptions { shortest_s: 2.0, longest_s: 1.0, ..CuttingOptions::default() };
        assert!(cycles(&still, "t.csv", options).is_err());
        assert!(cycles(&still, "t.csv", CuttingOptions { rate_hz: 0.0, ..CuttingOptions::default() }).is_err());
    }
}
