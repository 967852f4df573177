//! Joint positions of the estimate: root and segment lengths filtered beside the angles (cyclic paper, section 3).

use super::Report;
use super::body::Body;
use crate::cyclic::AngleTable;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::export::trc::{JointPositions, joint_positions};
use crate::cyclic::image_joints::Point;
use crate::cyclic::tracking::Tracked;
use crate::motion::joint_names::JOINTS;
use anyhow::Result;
use sinew_core::cyclic::image_filter::ScalarFilter;
use sinew_core::skeleton::stick_figure::HUMAN;
use std::f64::consts::SQRT_2;
use std::fmt::Write as _;

/// Acceleration of the hips of a walker, who rises and sinks by 2.5 cm twice a second.
const ROOT_ACCELERATION_M_PER_S2: f64 = 4.0;
/// By which part of itself a segment's length in the picture changes in a second, as limbs leave the plane.
const LENGTH_WALK_PER_S: f64 = 0.1;
/// Beyond this standard deviation, in lengths of the trunk, the place of the root is not known any more.
const ROOT_LOST_TRUNKS: f64 = 0.5;
/// The segment whose length scales the noise of a keypoint.
const TRUNK: usize = 0;

/// Root and lengths over time, in the unit of the table.
struct PlaceFilter {
    root: Option<[ScalarFilter; 2]>,
    lengths: Vec<ScalarFilter>,
    keypoint_std: f64,
    root_acceleration: f64,
    lost_std: f64,
}

impl PlaceFilter {
    fn new(body: &Body, sigma_rad: f64, rate_hz: f64) -> Result<Self> {
        // An angle that is off by sigma is that of a segment whose ends are off by sigma L / sqrt(2) each.
        let keypoint_std = sigma_rad * body.lengths[TRUNK] / SQRT_2;
        let length = |length: f64| {
            let walk = LENGTH_WALK_PER_S * length / rate_hz.sqrt();
            ScalarFilter::new(length as f32, (SQRT_2 * keypoint_std) as f32, walk as f32, 0.0)
        };
        Ok(Self {
            root: None,
            lengths: body.lengths.iter().map(|value| length(*value)).collect::<Result<_, _>>()?,
            keypoint_std,
            root_acceleration: ROOT_ACCELERATION_M_PER_S2 / body.metres_per_unit / (rate_hz * rate_hz),
            lost_std: ROOT_LOST_TRUNKS * body.lengths[TRUNK],
        })
    }

    fn step(&mut self, step_frames: f64, root: Option<Point>, lengths: [Option<f64>; ANGLES]) -> Result<()> {
        let std = self.keypoint_std as f32;
        if let Some(filters) = &mut self.root {
            for (axis, filter) in filters.iter_mut().enumerate() {
                filter.step(step_frames as f32, root.map(|seen| seen[axis] as f32), std);
            }
        } else if let Some([x, y]) = root {
            let first = |value: f64| ScalarFilter::new(value as f32, std, 0.0, self.root_acceleration as f32);
            self.root = Some([first(x)?, first(y)?]);
        }
        for (filter, seen) in self.lengths.iter_mut().zip(lengths) {
            filter.step(step_frames as f32, seen.map(|seen| seen as f32), SQRT_2 as f32 * std);
        }
        Ok(())
    }

    /// The root, unless it was not seen for so long that nobody knows.
    fn root(&self) -> Option<Point> {
        let filters = self.root?;
        let known = filters.iter().all(|filter| f64::from(filter.variance()).sqrt() <= self.lost_std);
        known.then(|| filters.map(|filter| f64::from(filter.value())))
    }
}

/// Root, lengths and angles of a row: x forward, y down, in the table's unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Number of the frame.
    pub frame: u64,
    /// Where the root is; (0, 0) where the table tells no place, `None` where it is not known any more.
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

/// Joints of each row with its frame number: x forward, y down, in the table's unit; in metres about a root at (0, 0) where the
/// table tells no place. Joints that hang on an angle that was never measured are missing.
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
    let mut place = PlaceFilter::new(body, sigma_rad, tracked.rate_hz)?;
    let mut before = table.first_frame();
    let mut all = Vec::with_capacity(tracked.frames.len());
    for (row, frame) in table.rows().iter().zip(&tracked.frames) {
        let lengths = std::array::from_fn(|angle| body.length(&row.extra, angle));
        place.step((frame.frame - before) as f64, body.root(&row.extra), lengths)?;
        before = frame.frame;
        let root = if body.has_root() { place.root() } else { Some([0.0, 0.0]) };
        let lengths = std::array::from_fn(|angle| f64::from(place.lengths[angle].value()));
        let measured = |angle: usize| measured_shares[angle] > 0.0;
        let angles_rad = std::array::from_fn(|angle| measured(angle).then_some(frame.angles_rad[angle]));
        all.push(Figure { frame: frame.frame, root, lengths, angles_rad });
    }
    Ok(all)
}

/// Joints as they lie in the image of a person whose `side` is -1 where they face left: x is turned back, and left is the person's own
/// left again.
#[must_use]
pub fn in_image(joints: &JointPositions, side: f64) -> JointPositions {
    std::array::from_fn(|index| {
        let place = if side < 0.0 { joints[usize::from(HUMAN.joints()[index].mirror)] } else { joints[index] };
        place.map(|[x, y]| [side * x, y])
    })
}

/// `frame`, then x and y of each joint in the pixels of the image. Of a person who faces left, too, left is their own left here:
/// the mirroring of the table is undone.
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
        let side = body.side(&row.extra);
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
