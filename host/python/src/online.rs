//! Tracking frame by frame.

use crate::arrays::pose;
use crate::errors::{exception, wrong};
use crate::model::Model;
use crate::track::covariance;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::cyclic::tracking::summary::cadence;
use sinew::cyclic::tracking::{OnlineRun, TrackedFrame, TrackingOptions};

/// A tracker that answers each frame from those before it.
#[pyclass(module = "sinew._sinew")]
#[derive(Debug)]
pub struct Tracker {
    run: OnlineRun<'static>,
}

#[pymethods]
impl Tracker {
    #[new]
    fn new(model: &Model, rate_hz: f64, sigma_deg: Option<f64>) -> PyResult<Self> {
        let default = TrackingOptions::default();
        let sigma_rad = sigma_deg.map_or(default.sigma_rad, f64::to_radians);
        let options = TrackingOptions { rate_hz: Some(rate_hz), sigma_rad, ..default };
        Ok(Self { run: OnlineRun::new(model.model, options).map_err(|error| exception(&error))? })
    }

    /// The estimate as a dictionary, `None` before the first angle.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        angles_rad: PyReadonlyArray1<'py, f64>,
        dt_frames: u64,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let angles_rad = pose(angles_rad.as_array()).map(|angle| angle.map(|angle| angle as f32));
        if angles_rad.iter().flatten().any(|angle| !angle.is_finite()) {
            return Err(wrong("z", "has to be finite; NaN is a missing angle"));
        }
        let answer = self.run.step(&angles_rad, dt_frames).map_err(|error| exception(&error))?;
        answer.map(|answer| self.estimate(py, &answer)).transpose()
    }

    #[getter]
    fn frame(&self) -> Option<u64> {
        self.run.frame()
    }

    #[getter]
    fn rate_hz(&self) -> f64 {
        self.run.rates().0
    }

    /// Covariance of the angles after the last frame, rad^2; NaN where it is unknown.
    fn covariance_rad2<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        covariance(&self.run).to_vec().into_pyarray(py)
    }

    /// Frame and state, which `restore` takes.
    fn saved(&mut self) -> PyResult<(Option<u64>, Option<String>)> {
        Ok((self.run.frame(), self.run.saved().map_err(|error| exception(&error))?))
    }

    fn restore(&mut self, frame: Option<u64>, state: Option<&str>) -> PyResult<()> {
        self.run.restore(frame, state).map_err(|error| exception(&error))
    }
}

impl Tracker {
    fn estimate<'py>(&self, py: Python<'py>, answer: &TrackedFrame) -> PyResult<Bound<'py, PyDict>> {
        let estimate = &answer.estimate;
        let (rate_hz, step_frames) = self.run.rates();
        let velocity = [estimate.cycle_velocity_per_frame, estimate.cycle_velocity_variance];
        let (cadence_per_min, cadence_std_per_min) = cadence(velocity, 60.0 * rate_hz * step_frames);
        let std_rad = estimate.angle_variance_rad2.map(|variance| f64::from(variance.max(0.0).sqrt()));
        let named = PyDict::new(py);
        named.set_item("frame", answer.frame)?;
        named.set_item("angles_rad", answer.angles_rad.to_vec().into_pyarray(py))?;
        named.set_item("std_rad", std_rad.to_vec().into_pyarray(py))?;
        named.set_item("cycle_position", f64::from(estimate.cycle_position))?;
        named.set_item("cycle_position_std", f64::from(estimate.cycle_position_variance.max(0.0).sqrt()))?;
        named.set_item("cycles", answer.cycles)?;
        named.set_item("cadence_per_min", cadence_per_min)?;
        named.set_item("cadence_std_per_min", cadence_std_per_min)?;
        named.set_item("log_likelihood", f64::from(estimate.log_likelihood))?;
        named.set_item("outlier", estimate.outlier)?;
        named.set_item("misfit", estimate.misfit)?;
        Ok(named)
    }
}
