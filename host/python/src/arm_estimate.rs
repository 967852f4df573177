//! What an arm tracker answers, as arrays by name.

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::frames::FrameView;
use sinew::track::ArmView;
use sinew::wording::{side_name, status_name};
use sinew_core::camera::Camera;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::{Particle, Status};

/// One arm in one frame; places of a lost arm are NaN.
pub fn estimate<'py>(
    py: Python<'py>,
    (frame, time_s): (usize, f64),
    arm: &ArmView,
    view: Option<&FrameView>,
    camera: &Camera,
) -> PyResult<Bound<'py, PyDict>> {
    let estimate = &arm.estimate;
    let is_known = estimate.status != Status::Lost;
    let known = |value: f32| if is_known { f64::from(value) } else { f64::NAN };
    let named = PyDict::new(py);
    named.set_item("frame", frame)?;
    named.set_item("time_s", time_s)?;
    named.set_item("side", side_name(estimate.side))?;
    named.set_item("status", status_name(estimate.status))?;
    let joints = estimate.joints;
    let places = [("shoulder", joints.shoulder_m), ("elbow", joints.elbow_m), ("hand", joints.hand_m)];
    for (name, place_m) in places {
        let pixel = camera.project(&place_m).map_or([f32::NAN; 2], |pixel| [pixel.u_px, pixel.v_px]);
        named.set_item(format!("{name}_m"), numbers(py, place_m.iter().copied().map(known)))?;
        named.set_item(format!("{name}_px"), numbers(py, pixel.into_iter().map(known)))?;
    }
    named.set_item("angles_rad", numbers(py, estimate.angles_rad.iter().copied().map(known)))?;
    named.set_item("hand_std_m", known(estimate.hand_std_m))?;
    named.set_item("hand_likelihood", f64::from(estimate.hand_likelihood))?;
    named.set_item("effective_sample_size", f64::from(estimate.effective_sample_size))?;
    named.set_item("log_evidence", f64::from(estimate.log_evidence))?;
    named.set_item("degenerate", estimate.degenerate)?;
    named.set_item("blob_count", view.map(|view| view.candidates.len()))?;
    named.set_item("dropped_blobs", view.map_or(0, |view| view.dropped_blobs))?;
    Ok(named)
}

/// The particles of one arm.
pub fn particles<'py>(py: Python<'py>, side: Side, all: &[(Particle, f32)]) -> PyResult<Bound<'py, PyDict>> {
    let named = PyDict::new(py);
    let places = |place: fn(&Particle) -> Vec3| rows(py, all.iter().map(|(particle, _)| place(particle).into()));
    named.set_item("side", side_name(side))?;
    named.set_item("weight", numbers(py, all.iter().map(|(_, weight)| f64::from(*weight))))?;
    named.set_item("angles_rad", rows(py, all.iter().map(|(particle, _)| particle.angles_rad)))?;
    named.set_item("elbow_m", places(|particle| particle.elbow_m))?;
    named.set_item("hand_m", places(|particle| particle.hand_m))?;
    let drivers: Vec<i64> = all.iter().map(|(particle, _)| particle.driver.map_or(-1, i64::from)).collect();
    named.set_item("driver_blob", drivers.into_pyarray(py))?;
    Ok(named)
}

fn numbers<'py>(py: Python<'py>, values: impl Iterator<Item = f64>) -> Bound<'py, PyArray1<f64>> {
    values.collect::<Vec<f64>>().into_pyarray(py)
}

fn rows<'py, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [f32; N]>,
) -> Bound<'py, PyArray2<f64>> {
    let count = rows.len();
    let values: Vec<f64> = rows.flatten().map(f64::from).collect();
    // As many numbers as `count` rows of N have.
    Array2::from_shape_vec((count, N), values).unwrap_or_default().into_pyarray(py)
}
