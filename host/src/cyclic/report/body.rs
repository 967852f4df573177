//! The person's size and place in a table.

use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::export::trc::standard_lengths_m;
use crate::cyclic::image_joints::Point;
use crate::cyclic::place_columns::PlaceColumns;
use crate::cyclic::{AngleRow, AngleTable};
use crate::motion::anthropometry::{SHANK, THIGH, TRUNK};

/// Lengths of the person's segments, their scale, and the columns of the place of the root.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Length of each segment in the table's unit: the median over the rows, else that of an adult.
    pub lengths: [f64; ANGLES],
    /// Metres in the table's unit.
    pub metres_per_unit: f64,
    columns: Option<PlaceColumns>,
}

/// Thigh and shank of each side.
const LEGS: [[usize; 2]; 2] = [[8, 9], [11, 12]];
const NECK: usize = 0;

impl Body {
    /// The body of a table; `height_m` is that of the person.
    #[must_use]
    pub fn of_table(table: &AngleTable, height_m: f64) -> Self {
        let standard = standard_lengths_m(height_m);
        let Some(columns) = PlaceColumns::find(table).filter(PlaceColumns::has_facing) else {
            return Self { lengths: standard, metres_per_unit: 1.0, columns: None };
        };
        let medians: [Option<f64>; ANGLES] =
            std::array::from_fn(|angle| median(table.rows().iter().filter_map(|row| columns.length(row, angle))));
        let metres_per_unit = if columns.unit == "m" { 1.0 } else { metres_per_px(&medians, height_m) };
        let lengths = std::array::from_fn(|i| medians[i].unwrap_or(standard[i] / metres_per_unit));
        Self { lengths, metres_per_unit, columns: Some(columns) }
    }

    /// Whether the table has the place of the root.
    #[must_use]
    pub const fn has_root(&self) -> bool {
        self.columns.is_some()
    }

    /// Whether places are in pixels of the image.
    #[must_use]
    pub fn is_in_pixels(&self) -> bool {
        self.columns.as_ref().is_some_and(|columns| columns.unit == "px")
    }

    /// 1 where the image's x points forward, -1 where the person faces left in a row.
    #[must_use]
    pub fn side(&self, row: &AngleRow) -> f64 {
        self.columns.as_ref().map_or(1.0, |columns| columns.side(row))
    }

    /// The measured root of a row: x forward, y down.
    #[must_use]
    pub fn root(&self, row: &AngleRow) -> Option<Point> {
        self.columns.as_ref()?.root(row)
    }

    /// The measured length of a segment in a row.
    #[must_use]
    pub fn length(&self, row: &AngleRow, angle: usize) -> Option<f64> {
        self.columns.as_ref()?.length(row, angle)
    }
}

/// Size of a pixel at the person's distance from the longer leg or else the trunk; one metre where
/// neither was seen.
fn metres_per_px(lengths_px: &[Option<f64>; ANGLES], height_m: f64) -> f64 {
    let leg = LEGS.iter().filter_map(|[thigh, shank]| Some(lengths_px[*thigh]? + lengths_px[*shank]?));
    let leg = leg.reduce(f64::max).map(|leg_px| f64::from(THIGH + SHANK) * height_m / leg_px);
    let trunk = lengths_px[NECK].map(|trunk_px| f64::from(TRUNK) * height_m / trunk_px);
    leg.or(trunk).filter(|size| size.is_finite() && *size > 0.0).unwrap_or(1.0)
}

fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
