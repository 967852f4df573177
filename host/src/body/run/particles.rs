//! `particles.csv`: every particle of every frame.

use super::table::coordinate_columns;
use crate::body::tracking::BodyFilter;
use crate::body::tracking::filter::END_EFFECTORS;
use sinew_core::skeleton::full_body::BODY_JOINT_NAMES;

/// Columns: frame, particle, weight, coordinates of the pose, places of the end-effectors.
#[must_use]
pub fn header() -> Vec<String> {
    let mut columns = ["frame", "particle", "weight"].map(str::to_owned).to_vec();
    columns.extend(coordinate_columns());
    let ends = END_EFFECTORS.map(|bone| BODY_JOINT_NAMES[bone]);
    columns.extend(ends.iter().flat_map(|joint| ["x", "y", "z"].map(|axis| format!("{joint}_{axis}_m"))));
    columns
}

/// Rows of the particles after a step.
pub fn rows(frame: u64, filter: &BodyFilter) -> impl Iterator<Item = Vec<String>> {
    let (particles, weights) = filter.particles();
    particles.iter().zip(weights).enumerate().map(move |(index, (particle, weight))| {
        let mut cells = vec![frame.to_string(), index.to_string(), weight.to_string()];
        cells.extend(particle.angles_rad.iter().map(f32::to_string));
        let ends = END_EFFECTORS.map(|bone| particle.ends_m[bone]);
        cells.extend(ends.iter().flat_map(|place| place.iter()).map(f32::to_string));
        cells
    })
}
