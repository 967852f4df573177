//! Files of points and of motion.

use crate::arrays::{frames_array, points_array};
use crate::errors::{exception, wrong};
use crate::process::detached;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::body::camera_axes::{turn_to_camera, up_of};
use sinew::cloud::{CloudSource, DepthCamera};
use sinew::motion::{ReadOptions, has_skin_markers, read_space};
use sinew_core::math::Vec3;
use std::path::PathBuf;

/// The usable points of a cloud's file, or of a depth image by its camera's file.
#[pyfunction]
pub fn read_cloud(py: Python<'_>, path: PathBuf, camera: Option<PathBuf>) -> PyResult<Bound<'_, PyArray2<f32>>> {
    let read = || {
        let camera = camera.as_deref().map(DepthCamera::read).transpose()?;
        CloudSource { camera, ..CloudSource::default() }.read_noting(&path, |_| ())
    };
    let cloud = detached(py, read)?.map_err(|error| exception(&error.into()))?;
    Ok(points_array(py, &cloud.points_m))
}

/// A motion of any format, as arrays and texts by name.
#[pyfunction]
pub fn read_motion<'py>(
    py: Python<'py>,
    path: PathBuf,
    skeleton: Option<PathBuf>,
    rate_hz: Option<f32>,
    metres_per_unit: Option<f32>,
    names: Option<PathBuf>,
    partial: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let options = ReadOptions {
        skeleton: skeleton.as_deref(),
        frames_per_second: rate_hz,
        metres_per_unit,
        partial,
        names: names.as_deref(),
    };
    let read = || read_space(&path, &options).map(|motion| (up_of(&motion, &path).ok(), motion));
    let (up, motion) = detached(py, read)?.map_err(|error| exception(&error.into()))?;
    let said = motion.shortfall.map(|shortfall| shortfall.to_string());
    let notes: Vec<String> = motion.notes.iter().cloned().chain(said).collect();
    let parents: Option<Vec<i64>> = (!motion.parents.is_empty())
        .then(|| motion.parents.iter().map(|parent| parent.map_or(-1, |parent| parent as i64)).collect());
    let named = PyDict::new(py);
    named.set_item("rate_hz", f64::from(motion.frames_per_second))?;
    named.set_item("joints_m", frames_array(py, &motion.positions_m, motion.names.len()))?;
    named.set_item("names", motion.names)?;
    named.set_item("parents", parents)?;
    named.set_item("up", up.as_ref().map(axis_name))?;
    named.set_item("is_on_skin", has_skin_markers(&path))?;
    named.set_item("is_scale_assumed", motion.is_scale_assumed)?;
    named.set_item("notes", notes)?;
    Ok(named)
}

/// What turns joints of which `up` points up into camera axes, row by row.
#[pyfunction]
pub fn turn_of_up(up: &str) -> PyResult<[[f32; 3]; 3]> {
    let axis = |name: &str| (0..3).find(|axis| ["x", "y", "z"][*axis] == name);
    let (name, sign) = up.strip_prefix('-').map_or((up, 1.0), |name| (name, -1.0));
    let mut direction = Vec3::zeros();
    if let Some(axis) = axis(name) {
        direction[axis] = sign;
    }
    let turn = turn_to_camera(&direction)
        .ok_or_else(|| wrong("up", &format!("has to be one of x, y, z, -x, -y and -z, not {up:?}")))?;
    Ok(std::array::from_fn(|row| std::array::from_fn(|column| turn[(row, column)])))
}

/// A coordinate axis as `up` has it.
fn axis_name(axis: &Vec3) -> String {
    let name = ["x", "y", "z"][axis.iamax()];
    if axis.min() < 0.0 { format!("-{name}") } else { name.to_owned() }
}
