//! `track.csv`: a row for each cloud.

use crate::body::BodyPart;
use crate::body::tracking::end_effectors::END_EFFECTORS;
use crate::body::tracking::filter::WholeBodyEstimate;
use sinew_core::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_BONES, BODY_JOINT_NAMES};
use sinew_core::skeleton::tree::SHIFTS;

/// Columns: frame, the root, every joint in metres (camera axes), every angle in radians, the
/// filter's own state. Then of every end-effector its spread, whether points show it and the weight
/// that puts it elsewhere, and the number of weighed points.
#[must_use]
pub fn header(part: BodyPart) -> Vec<String> {
    let mut columns = vec!["frame".to_owned()];
    columns.extend(coordinate_columns(part).take(SHIFTS));
    columns.extend(
        BODY_JOINT_NAMES[..part.bones()]
            .iter()
            .flat_map(|joint| ["x", "y", "z"].map(|axis| format!("{joint}_{axis}_m"))),
    );
    columns.extend(coordinate_columns(part).skip(SHIFTS));
    columns.extend(["effective_sample_size".to_owned(), "log_evidence".to_owned()]);
    for bone in end_effectors(part) {
        let joint = BODY_JOINT_NAMES[bone];
        columns.extend(["spread_m", "observed", "ambiguous"].map(|name| format!("{joint}_{name}")));
    }
    columns.push("points".to_owned());
    columns
}

/// The end-effectors that `part` has.
pub fn end_effectors(part: BodyPart) -> impl Iterator<Item = usize> {
    END_EFFECTORS.into_iter().filter(move |&bone| bone < part.bones())
}

/// Columns of the skeleton's coordinates: the root's three shifts first, then all angles.
pub fn coordinate_columns(part: BodyPart) -> impl Iterator<Item = String> {
    part.coordinates()
        .iter()
        .map(|&index| (index, BODY_ANGLE_NAMES[index]))
        .map(|(index, name)| if index < SHIFTS { format!("{name}_m") } else { format!("{name}_rad") })
}

/// Cells of a row; numbers have the shortest digits that give the same number back.
#[must_use]
pub fn cells(
    part: BodyPart,
    frame: u64,
    estimate: &WholeBodyEstimate,
    ambiguous: &[f32; BODY_BONES],
    points: usize,
) -> Vec<String> {
    let mut cells = vec![frame.to_string()];
    let angles = part.coordinates().iter().map(|&index| estimate.angles_rad[index].to_string());
    cells.extend(angles.clone().take(SHIFTS));
    cells.extend(estimate.ends_m[..part.bones()].iter().flat_map(|place| place.iter()).map(f32::to_string));
    cells.extend(angles.skip(SHIFTS));
    cells.extend([estimate.effective_sample_size.to_string(), estimate.log_evidence.to_string()]);
    for bone in end_effectors(part) {
        cells.extend([estimate.spread_m[bone].to_string(), u8::from(estimate.observed[bone]).to_string()]);
        cells.push(ambiguous[bone].to_string());
    }
    cells.push(points.to_string());
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::math::Vec3;

    #[test]
    fn every_cell_has_a_column_of_its_own() {
        let estimate = WholeBodyEstimate {
            angles_rad: std::array::from_fn(|index| index as f32 * 0.1),
            ends_m: [Vec3::new(0.25, -1.0, 3.0); 17],
            spread_m: [0.02; 17],
            observed: [true; 17],
            effective_sample_size: 40.0,
            log_evidence: -3.5,
            tempering: 1.0,
            is_degenerate: false,
        };
        let upper = cells(BodyPart::Upper, 7, &estimate, &[0.25; 17], 1990);
        assert_eq!(header(BodyPart::Upper).len(), upper.len());
        let (header, cells) = (header(BodyPart::Whole), cells(BodyPart::Whole, 7, &estimate, &[0.25; 17], 1990));
        assert_eq!(header.len(), cells.len());
        assert_eq!(header.iter().collect::<std::collections::BTreeSet<_>>().len(), header.len());
        let cell = |name: &str| cells[header.iter().position(|column| column == name).unwrap()].as_str();
        assert_eq!((cell("frame"), cell("root_y_m"), cell("root_turn_rad")), ("7", "0.1", "0.3"));
        assert_eq!((cell("l_wrist_y_m"), cell("r_ankle_flexion_rad")), ("-1", "2.9"));
        assert_eq!((cell("head_observed"), cell("l_wrist_spread_m"), cell("points")), ("1", "0.02", "1990"));
        assert_eq!(cell("r_ankle_ambiguous"), "0.25");
        assert_eq!(header[..5], ["frame", "root_x_m", "root_y_m", "root_z_m", "pelvis_x_m"]);
    }
}
