//! `particles.csv`: every particle of every frame.

use super::table::{coordinate_columns, end_effectors};
use crate::body::BodyPart;
use crate::body::tracking::BodyFilter;
use sinew_core::skeleton::full_body::BODY_JOINT_NAMES;

/// Columns: frame, particle, weight, coordinates of the pose, places of the end-effectors.
#[must_use]
pub fn header(part: BodyPart) -> Vec<String> {
    let mut columns = ["frame", "particle", "weight"].map(str::to_owned).to_vec();
    columns.extend(coordinate_columns(part));
    let ends = end_effectors(part).map(|bone| BODY_JOINT_NAMES[bone]);
    columns.extend(ends.flat_map(|joint| ["x", "y", "z"].map(|axis| format!("{joint}_{axis}_m"))));
    columns
}

/// Rows of the particles after a step.
pub fn rows(part: BodyPart, frame: u64, filter: &BodyFilter) -> impl Iterator<Item = Vec<String>> {
    let (particles, weights) = filter.particles();
    particles.iter().zip(weights).enumerate().map(move |(index, (particle, weight))| {
        let mut cells = vec![frame.to_string(), index.to_string(), weight.to_string()];
        cells.extend(part.coordinates().iter().map(|&index| particle.angles_rad[index].to_string()));
        let ends: Vec<_> = end_effectors(part).map(|bone| particle.ends_m[bone]).collect();
        cells.extend(ends.iter().flat_map(|place| place.iter()).map(f32::to_string));
        cells
    })
}
