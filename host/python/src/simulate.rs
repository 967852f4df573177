//! Made-up recordings, to try things without a video.

use crate::errors::{exception, wrong};
use crate::model::Model;
use crate::process::detached;
use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray3};
use pyo3::prelude::*;
use sinew::cyclic::SyntheticPerson;
use sinew::cyclic::synthetic_keypoints::{FilmedPerson, Filming};
use sinew::keypoints::Facing;
use sinew::motion::joint_names::JOINTS;

/// Keypoints as frames, points and x, y and confidence; width and height of the picture, pixels;
/// cycles a minute.
pub type Filmed<'py> = (Bound<'py, PyArray3<f64>>, [u32; 2], f64);

/// Keypoints of a made-up person who passes a camera.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of `sinew simulate keypoints`")]
pub fn simulate_keypoints<'py>(
    py: Python<'py>,
    model: &Model,
    seconds: f64,
    rate_hz: f64,
    facing: &str,
    height_px: f64,
    sigma_px: f64,
    missing: f64,
    seed: u64,
) -> PyResult<Filmed<'py>> {
    let facing = facing.parse::<Facing>().map_err(|rule| wrong("facing", &rule))?;
    let like = Filming { frames: 0, rate_hz, height_px, facing, noise_px: sigma_px, missing_share: missing, seed };
    let filming = Filming::lasting(seconds, like).map_err(|error| exception(&error.into()))?;
    let person = SyntheticPerson::draw(model.model, rate_hz, seed).map_err(|error| exception(&error))?;
    let (filmed, found) = detached(py, || {
        let filmed = FilmedPerson::film(&person, &filming);
        let found = filmed.detected(&filming);
        (filmed, found)
    })?;
    let shape = (found.len(), JOINTS, 3);
    let values: Vec<f64> = found.into_iter().flatten().flat_map(|point| point.unwrap_or([f64::NAN; 3])).collect();
    let keypoints = Array3::from_shape_vec(shape, values).unwrap_or_default().into_pyarray(py);
    Ok((keypoints, filmed.size_px, 60.0 * rate_hz / person.cycle_frames()))
}
