//! The measured figure, as numbers and in pixels.

use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::export::trc::{JointPositions, joint_positions};
use crate::cyclic::image_joints::Point;
use crate::cyclic::report::body::Body;
use crate::cyclic::{AngleRow, AngleTable};
use crate::draw::stick_figure::FigureJoints;
use sinew_core::camera::Pixel;

/// The figure as it was measured in a row, about `root`. A length that was not seen is that of the
/// body.
#[must_use]
pub fn measured(row: &AngleRow, body: &Body, root: Option<Point>) -> JointPositions {
    let lengths: [f64; ANGLES] = std::array::from_fn(|angle| body.length(row, angle).unwrap_or(body.lengths[angle]));
    joint_positions(root, &lengths, &row.angles_rad)
}

/// Points as pixels of a picture.
pub(super) fn pixels(joints: &JointPositions) -> FigureJoints {
    joints.map(|joint| joint.map(|[u, v]| Pixel::new(u as f32, v as f32)))
}

/// Whether the table has the places of the joints in a picture.
#[must_use]
pub fn has_pixels(table: &AngleTable) -> bool {
    Body::of_table(table, 1.75).is_in_pixels()
}
