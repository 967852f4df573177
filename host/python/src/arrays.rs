//! Arrays of numpy to rows and back; NaN is missing.

use numpy::ndarray::{Array2, Array3, ArrayView1, ArrayView2};
use numpy::{IntoPyArray, PyArray2, PyArray3};
use pyo3::prelude::*;
use sinew::cyclic::angle_table::ANGLES;
use sinew_core::math::Vec3;

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
    // Room for all at once: `flatten` does not say how many come.
    let mut values = Vec::with_capacity(count * N);
    rows.for_each(|row| values.extend_from_slice(&row));
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

/// An array of points.
pub fn points_array<'py>(py: Python<'py>, points_m: &[Vec3]) -> Bound<'py, PyArray2<f32>> {
    let values: Vec<f32> = points_m.iter().flat_map(|point| point.iter().copied()).collect();
    // Three numbers a point.
    Array2::from_shape_vec((points_m.len(), 3), values).unwrap_or_default().into_pyarray(py)
}

/// An array of frames of `count` points; those that are missing are NaN.
pub fn frames_array<'py, F: AsRef<[Option<Vec3>]>>(
    py: Python<'py>,
    frames: &[F],
    count: usize,
) -> Bound<'py, PyArray3<f32>> {
    let missing = Vec3::repeat(f32::NAN);
    let places = frames.iter().flat_map(|frame| frame.as_ref().iter().map(|place| place.unwrap_or(missing)));
    let values: Vec<f32> = places.flat_map(<[f32; 3]>::from).collect();
    // As many points as the caller counts in each frame.
    Array3::from_shape_vec((frames.len(), count, 3), values).unwrap_or_default().into_pyarray(py)
}
