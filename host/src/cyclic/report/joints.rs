//! Joint positions of the estimate: root and segment lengths filtered beside the angles by the
//! core.

use super::body::Body;
use super::contents::Report;
use crate::cyclic::AngleTable;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::export::trc::{JointPositions, joint_positions};
use crate::cyclic::image_joints::Point;
use crate::cyclic::tracking::Tracked;
use crate::error::Result;
use crate::motion::joint_names::JOINTS;
use sinew_core::cyclic::{FigurePlace, PlaceOptions};
use sinew_core::skeleton::stick_figure::HUMAN;
use std::fmt::Write as _;

/// The segment whose length scales the noise of a keypoint.
const TRUNK: usize = 0;
/// Places of thigh and shank of the left leg.
const LEG: [usize; 2] = [8, 9];

/// Root, lengths and angles of a row: x forward, y down, in the table's unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Number of the frame.
    pub frame: u64,
    /// Where the root is; (0, 0) where the table has no place, `None` where it is not known any
    /// more.
    pub root: Option<Point>,
    /// Length of each segment.
    pub lengths: [f64; ANGLES],
    /// Angles of the estimate; one that was never measured is missing.
    pub angles_rad: [Option<f64>; ANGLES],
}

impl Figure {
    /// The joints about `root`.
    #[must_use]
    pub fn joints_about(&self, root: Option<Point>) -> JointPositions {
        joint_positions(root, &self.lengths, &self.angles_rad)
    }
}

/// Joints of each row with its frame number: x forward, y down, in the table's unit. Where the
/// table has no place they are in metres about a root at (0, 0). Joints that hang on an angle that
/// was never measured are missing.
///
/// # Errors
/// None in practice: lengths and noise are positive.
pub fn positions(
    table: &AngleTable,
    tracked: &Tracked,
    report: &Report,
    body: &Body,
    sigma_rad: f64,
) -> Result<Vec<(u64, JointPositions)>> {
    let figures = figures(table, tracked, &report.measured_shares, body, sigma_rad)?;
    Ok(figures.iter().map(|figure| (figure.frame, figure.joints_about(figure.root))).collect())
}

/// The figure of each row, root and lengths filtered.
///
/// # Errors
/// None in practice: lengths and noise are positive.
pub fn figures(
    table: &AngleTable,
    tracked: &Tracked,
    measured_shares: &[f64; ANGLES],
    body: &Body,
    sigma_rad: f64,
) -> Result<Vec<Figure>> {
    let trunk = body.lengths[TRUNK] as f32;
    let options =
        PlaceOptions::of_person(trunk, body.metres_per_unit as f32, sigma_rad as f32, tracked.rate_hz as f32)?;
    let mut place = FigurePlace::<ANGLES>::with_lengths(options, &body.lengths.map(|length| length as f32))?;
    // Hips as high as the legs are long: a marker at 0 0 0 passes for a missing one.
    let standing = [0.0, -LEG.iter().map(|segment| body.lengths[*segment]).sum::<f64>()];
    let mut before = table.first_frame();
    let mut all = Vec::with_capacity(tracked.frames.len());
    for (row, frame) in table.rows().iter().zip(&tracked.frames) {
        let lengths = std::array::from_fn(|angle| body.length(row, angle).map(|length| length as f32));
        let root = body.root(row).map(|root| root.map(|value| value as f32));
        place.step((frame.frame - before) as f32, root, &lengths);
        before = frame.frame;
        let root = if body.has_root() { place.root_px().map(|root| root.map(f64::from)) } else { Some(standing) };
        let filtered = place.lengths_px();
        let lengths = std::array::from_fn(|angle| filtered[angle].map_or(body.lengths[angle], f64::from));
        let measured = |angle: usize| measured_shares[angle] > 0.0;
        let angles_rad = std::array::from_fn(|angle| measured(angle).then_some(frame.angles_rad[angle]));
        all.push(Figure { frame: frame.frame, root, lengths, angles_rad });
    }
    Ok(all)
}

/// Joints as they lie in the image of a person whose `side` is -1 where they face left: then x is
/// turned back.
#[must_use]
pub fn in_image(joints: &JointPositions, side: f64) -> JointPositions {
    joints.map(|joint| joint.map(|[x, y]| [side * x, y]))
}

/// `frame`, then x and y of each joint in the pixels of the image.
#[must_use]
pub fn to_csv_px(positions: &[(u64, JointPositions)], table: &AngleTable, body: &Body) -> String {
    let names: Vec<&str> = std::iter::once("hip_center").chain(HUMAN.angle_names()).collect();
    let mut text = "frame".to_owned();
    for name in names.iter().take(JOINTS) {
        // Writing to a string cannot fail.
        let _ = write!(text, ",{name}_x_px,{name}_y_px");
    }
    text.push('\n');
    for ((frame, joints), row) in positions.iter().zip(table.rows()) {
        let side = body.side(row);
        let _ = write!(text, "{frame}");
        for place in in_image(joints, side) {
            let _ = match place {
                Some([x, y]) => write!(text, ",{x:.2},{y:.2}"),
                None => write!(text, ",,"),
            };
        }
        text.push('\n');
    }
    text
}
