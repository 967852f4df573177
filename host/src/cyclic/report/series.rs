//! The estimate as anatomical angles over time.

use crate::cyclic::AngleTable;
use crate::cyclic::anatomy::AnatomicalSeries;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::tracking::{Summary, Tracked, Updates};

/// Frames that the table leaves out are bridged by a straight line up to this part of a cycle.
const LONGEST_BRIDGE_CYCLES: f64 = 0.1;

/// Share of the rows in which each angle was measured and seen by the filter.
#[must_use]
pub fn measured_shares(table: &AngleTable, updates: &Updates) -> [f64; ANGLES] {
    let rows = table.rows();
    std::array::from_fn(|angle| {
        let seen =
            rows.iter().filter(|row| updates.sees(table.first_frame(), row.frame) && row.angles_rad[angle].is_some());
        seen.count() as f64 / rows.len() as f64
    })
}

/// Anatomical angles of the estimate. An angle that was never measured is the model's, not the
/// person's, and is left out.
#[must_use]
pub fn estimated(tracked: &Tracked, summary: &Summary, measured_shares: &[f64; ANGLES]) -> AnatomicalSeries {
    let pose = |angles: &[f64; ANGLES], is_known: bool| {
        std::array::from_fn(|i| (is_known && measured_shares[i] > 0.0).then_some(angles[i]))
    };
    let cycle_frames = summary.cadence_per_min.map_or(0.0, |cadence| 60.0 * tracked.rate_hz / cadence);
    let longest = LONGEST_BRIDGE_CYCLES * cycle_frames;
    let (mut frames, mut poses) = (Vec::new(), Vec::new());
    for pair in tracked.frames.windows(2) {
        let [before, after] = [&pair[0], &pair[1]];
        frames.push(before.frame);
        poses.push(pose(&before.angles_rad, before.is_known));
        let step = after.frame - before.frame;
        // Not so without a cadence, or with a negative one: there are no cycles to bridge for.
        if step as f64 <= longest {
            for k in 1..step {
                let share = k as f64 / step as f64;
                let between = |i: usize| before.angles_rad[i] + share * (after.angles_rad[i] - before.angles_rad[i]);
                frames.push(before.frame + k);
                poses.push(pose(&std::array::from_fn(between), before.is_known && after.is_known));
            }
        }
    }
    let last = &tracked.frames[tracked.frames.len() - 1];
    frames.push(last.frame);
    poses.push(pose(&last.angles_rad, last.is_known));
    AnatomicalSeries::of_poses(frames, &poses, tracked.rate_hz)
}
