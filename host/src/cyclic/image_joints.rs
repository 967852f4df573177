//! The joints of the stick figure in an image plane over time, and their angles.

use super::angle_table::{ANGLES, AngleRow, AngleTable};
use super::error::CyclicError;
use super::facing::{FACING, Facing};
use super::feet::{self, Feet};
use super::turns::unwrap_along_time;
use crate::motion::joint_names::JOINTS;
use sinew_core::skeleton::stick_figure::HUMAN;

/// A point of the plane: x right, y down.
pub type Point = [f64; 2];

/// One frame.
#[derive(Debug, Clone, PartialEq)]
pub struct JointFrame {
    /// Number of the frame in the recording.
    pub frame: u64,
    /// The joints in the order of [`HUMAN`]; `None` where one was not seen.
    pub joints: [Option<Point>; JOINTS],
    /// Heels and toes.
    pub feet: Feet,
}

/// Joints over time.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageJoints {
    /// The frames, rising in number.
    pub frames: Vec<JointFrame>,
    /// Unit of the coordinates as it stands in column names: `px` or `m`.
    pub unit: &'static str,
}

/// What an angle table holds beside the angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExtraColumns {
    /// Nothing.
    None,
    /// Where the root is, how long each segment is, and which way the person faces: what an
    /// overlay needs. The root is where it was in the image.
    RootAndLengths {
        /// Which way the person faces in the image.
        facing: Facing,
    },
}

/// Index of the parent of joint `joint`; the root is its own.
fn parent(joint: usize) -> usize {
    HUMAN.joints()[joint].parent.map_or(0, usize::from)
}

impl ImageJoints {
    /// The same with the sign of x changed: who faced left faces right, and left and right are
    /// still the person's own.
    #[must_use]
    pub fn x_negated(&self) -> Self {
        let frame = |frame: &JointFrame| JointFrame {
            frame: frame.frame,
            joints: frame.joints.map(|joint| joint.map(|[x, y]| [-x, y])),
            feet: feet::x_negated(&frame.feet),
        };
        Self { frames: self.frames.iter().map(frame).collect(), unit: self.unit }
    }

    /// Angle of each segment out of the plane of these joints, to the person's left, radians in
    /// [-pi/2, pi/2]. It is the arc tangent of its part along the left over its length in the
    /// plane. `front` are the same frames seen from before.
    #[must_use]
    pub fn side_angles_rad(&self, front: &Self) -> Vec<[Option<f64>; ANGLES]> {
        let segment = |frame: &JointFrame, angle: usize| -> Option<Point> {
            let (start, end) = (frame.joints[parent(angle + 1)]?, frame.joints[angle + 1]?);
            Some([end[0] - start[0], end[1] - start[1]])
        };
        let both = self.frames.iter().zip(&front.frames);
        both.map(|(side, front)| {
            std::array::from_fn(|angle| {
                let ([dx, dy], [left, _]) = (segment(side, angle)?, segment(front, angle)?);
                (dx != 0.0 || dy != 0.0).then(|| left.atan2(dx.hypot(dy)))
            })
        })
        .collect()
    }

    /// Each frame with the names of left and right exchanged, places as they are.
    #[must_use]
    pub fn sides_swapped(&self) -> Self {
        let frame = |frame: &JointFrame| JointFrame {
            frame: frame.frame,
            joints: std::array::from_fn(|joint| frame.joints[usize::from(HUMAN.joints()[joint].mirror)]),
            feet: feet::sides_swapped(&frame.feet),
        };
        Self { frames: self.frames.iter().map(frame).collect(), unit: self.unit }
    }

    /// The angle of each segment, unwrapped along time.
    ///
    /// # Errors
    /// If there is no frame.
    pub fn angle_table(&self, extra: ExtraColumns) -> Result<AngleTable, CyclicError> {
        let mut rows: Vec<AngleRow> = self.frames.iter().map(|frame| row(frame, extra)).collect();
        for angle in 0..ANGLES {
            unwrap_along_time(rows.iter_mut().map(|row| &mut row.angles_rad[angle]));
        }
        let mut columns = extra_columns(extra, self.unit);
        if let ExtraColumns::RootAndLengths { facing } = extra
            && self.frames.iter().any(|frame| feet::is_seen(&frame.feet))
        {
            let side = facing.side();
            columns.extend(feet::columns(self.unit));
            rows.iter_mut().zip(&self.frames).for_each(|(row, frame)| row.extra.extend(feet::cells(&frame.feet, side)));
        }
        AngleTable::new(rows, columns)
    }
}

/// Names of the extra columns.
fn extra_columns(extra: ExtraColumns, unit: &str) -> Vec<String> {
    if extra == ExtraColumns::None {
        return Vec::new();
    }
    let root = ["u", "v"].map(|axis| format!("hip_center_{axis}_{unit}"));
    let lengths = HUMAN.angle_names().map(|name| format!("{name}_length_{unit}"));
    root.into_iter().chain(lengths).chain([FACING.to_owned()]).collect()
}

fn row(frame: &JointFrame, extra: ExtraColumns) -> AngleRow {
    let segment = |angle: usize| {
        let (start, end) = (frame.joints[parent(angle + 1)]?, frame.joints[angle + 1]?);
        Some([end[0] - start[0], end[1] - start[1]])
    };
    let angles_rad = std::array::from_fn(|angle| {
        let [dx, dy] = segment(angle)?;
        (dx != 0.0 || dy != 0.0).then(|| dy.atan2(dx))
    });
    let mut cells = Vec::new();
    if let ExtraColumns::RootAndLengths { facing } = extra {
        let cell = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
        let side = facing.side();
        cells.push(cell(frame.joints[0].map(|root| side * root[0])));
        cells.push(cell(frame.joints[0].map(|root| root[1])));
        cells.extend((0..ANGLES).map(|angle| cell(segment(angle).map(|[dx, dy]| dx.hypot(dy)))));
        cells.push(facing.name().to_owned());
    }
    AngleRow { frame: frame.frame, angles_rad, extra: cells }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn standing() -> [Option<Point>; JOINTS] {
        let mut joints = [None; JOINTS];
        joints[0] = Some([100.0, 200.0]);
        joints[1] = Some([100.0, 150.0]);
        joints[8] = Some([97.0, 204.0]);
        joints[9] = Some([97.0, 204.0]);
        joints
    }

    #[test]
    fn angles_lengths_and_root_are_those_of_the_points() {
        let frames = vec![JointFrame { frame: 4, joints: standing(), feet: Feet::default() }];
        let points = ImageJoints { frames, unit: "px" };
        let table = points.angle_table(ExtraColumns::RootAndLengths { facing: Facing::Right }).unwrap();
        let row = table.row(4).unwrap();
        assert!((row.angles_rad[0].unwrap() + FRAC_PI_2).abs() < 1.0e-12, "the neck is above");
        assert!((row.angles_rad[7].unwrap() - 4.0_f64.atan2(-3.0)).abs() < 1.0e-12);
        assert_eq!(row.angles_rad[8], None, "a segment without length has no angle");
        assert_eq!(table.extra_columns()[..3], ["hip_center_u_px", "hip_center_v_px", "neck_length_px"]);
        assert_eq!(row.extra[..4], ["100.000", "200.000", "50.000", ""]);
        assert_eq!((row.extra[9].as_str(), row.extra[15].as_str()), ("5.000", "right"));
    }

    #[test]
    fn who_faces_left_has_angles_of_pi_minus_theta_and_the_own_sides() {
        let points = ImageJoints {
            frames: vec![JointFrame { frame: 0, joints: standing(), feet: Feet::default() }],
            unit: "px",
        };
        let extra = ExtraColumns::RootAndLengths { facing: Facing::Left };
        let table = points.x_negated().angle_table(extra).unwrap();
        let row = &table.rows()[0];
        assert!((row.angles_rad[7].unwrap() - (PI - 4.0_f64.atan2(-3.0))).abs() < 1.0e-12);
        assert_eq!(row.angles_rad[8], None);
        assert_eq!((row.extra[0].as_str(), row.extra[15].as_str()), ("100.000", "left"));
        assert_eq!(points.x_negated().x_negated(), points);
        assert_eq!(points.sides_swapped().frames[0].joints[11], Some([97.0, 204.0]));
        assert_eq!(points.sides_swapped().frames[0].joints[8], None);
    }

    /// A segment 3 ahead, 4 down and 5 to the left leans out of the plane by 45 degrees. Seen in a
    /// mirror, it leans to the other side.
    #[test]
    fn a_segment_leans_out_of_the_plane_to_the_left() {
        let seen = |neck: Point| {
            let mut joints = [None; JOINTS];
            joints[0] = Some([1.0, 1.0]);
            joints[1] = Some([1.0 + neck[0], 1.0 + neck[1]]);
            ImageJoints { frames: vec![JointFrame { frame: 0, joints, feet: Feet::default() }], unit: "m" }
        };
        let (side, front) = (seen([3.0, 4.0]), seen([5.0, 4.0]));
        let lean = |front: &ImageJoints| side.side_angles_rad(front)[0];
        assert!((lean(&front)[0].unwrap() - PI / 4.0).abs() < 1.0e-12);
        assert!((lean(&front.x_negated())[0].unwrap() + PI / 4.0).abs() < 1.0e-12);
        assert_eq!(lean(&front)[8], None, "what was not seen has no angle");
        assert_eq!(seen([0.0, 0.0]).side_angles_rad(&front)[0][0], None, "nor has what points straight at the camera");
    }

    #[test]
    fn angles_are_unwrapped_along_time() {
        let frame = |index: u64| {
            let angle = 0.4 * index as f64;
            let mut joints = [None; JOINTS];
            joints[0] = Some([0.0, 0.0]);
            joints[1] = Some([angle.cos(), angle.sin()]);
            JointFrame { frame: index, joints, feet: Feet::default() }
        };
        let table =
            ImageJoints { frames: (0..60).map(frame).collect(), unit: "m" }.angle_table(ExtraColumns::None).unwrap();
        assert!((table.rows()[59].angles_rad[0].unwrap() - 23.6).abs() < 1.0e-9);
        assert!(table.extra_columns().is_empty());
    }
}
