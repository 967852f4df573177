//! Arrays of numpy to rows and back; NaN is missing.

use numpy::ndarray::{Array2, ArrayView1, ArrayView2};
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use sinew::cyclic::angle_table::ANGLES;

/// Angles of one frame.
pub type Pose = [Option<f64>; ANGLES];

/// The number, or `None` for NaN.
pub fn seen(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

/// Angles of a frame; the caller has checked that there are 13.
pub fn pose(row: ArrayView1<'_, f64>) -> Pose {
    std::array::from_fn(|angle| seen(row[angle]))
}

/// Angles of all frames; the caller has checked that a frame has 13.
pub fn poses(angles: ArrayView2<'_, f64>) -> Vec<Pose> {
    angles.rows().into_iter().map(pose).collect()
}

/// An array of rows of as many numbers.
pub fn array<'py, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [f64; N]>,
) -> Bound<'py, PyArray2<f64>> {
    let count = rows.len();
    let values: Vec<f64> = rows.flatten().collect();
    // As many numbers as `count` rows of N have.
    Array2::from_shape_vec((count, N), values).unwrap_or_default().into_pyarray(py)
}

/// An array of rows whose missing numbers are NaN.
pub fn array_of_options<'py, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [Option<f64>; N]>,
) -> Bound<'py, PyArray2<f64>> {
    array(py, rows.map(|row| row.map(|value| value.unwrap_or(f64::NAN))))
}
