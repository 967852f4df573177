//! Metres for the unit in which feet are measured.

use crate::cyclic::even_rows::EvenRows;
use crate::cyclic::place_columns::PlaceColumns;
use crate::motion::anthropometry::{SHANK, THIGH};
use crate::signal::median::median;

/// Thigh and shank of the left and the right leg among the angles.
pub(super) const LEGS: [[usize; 2]; 2] = [[8, 9], [11, 12]];

/// What is known of a person's size.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scale {
    /// Body height, metres. A table in metres does not need it.
    pub height_m: Option<f64>,
}

/// Lengths of one leg in the table's unit, or in body heights where the table has none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LegLengths {
    /// Thigh and shank: medians over the recording, or Winter's shares of the body's height.
    pub segments: [f64; 2],
    /// Whether they were measured.
    pub is_measured: bool,
}

impl LegLengths {
    /// The left and the right leg. If only one was measured, it stands for both.
    pub fn find(even: &EvenRows<'_>, columns: Option<&PlaceColumns>) -> [Self; 2] {
        let length = |segment: usize| {
            let columns = columns?;
            let series = even.series(|row| columns.length(row, segment));
            median(&mut series.into_iter().flatten().collect::<Vec<f64>>())
        };
        let [left, right] = LEGS.map(|[thigh, shank]| Some([length(thigh)?, length(shank)?]));
        let measured = [left.or(right), right.or(left)];
        measured.map(|segments| Self {
            segments: segments.unwrap_or_else(|| [THIGH, SHANK].map(f64::from)),
            is_measured: segments.is_some(),
        })
    }

    pub fn sum(&self) -> f64 {
        self.segments.iter().sum()
    }
}

impl Scale {
    /// Metres of one unit in which `legs` are given; `None` where nothing says.
    pub(super) fn metres_per_unit(self, legs: &[LegLengths; 2], unit: Option<&str>) -> Option<f64> {
        let is_measured = legs.iter().all(|leg| leg.is_measured);
        if is_measured && unit == Some("m") {
            return Some(1.0);
        }
        // Legs that are not measured are shares of the height, so that the result is the height.
        let leg = legs.iter().map(LegLengths::sum).fold(0.0, f64::max);
        self.height_m.map(|height_m| height_m * f64::from(THIGH + SHANK) / leg)
    }
}
