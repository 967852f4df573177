//! Tracking of whole recordings.

use crate::angles::Angles;
use crate::arrays::{Pose, array, array_of_options, poses};
use crate::errors::{exception, in_python};
use crate::model::Model;
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::cyclic::about::About;
use sinew::cyclic::anatomy::{ANATOMICAL_ANGLES, COUNT};
use sinew::cyclic::angle_table::{ANGLES, AngleRow};
use sinew::cyclic::own_cycle::{finish, noise};
use sinew::cyclic::report::Report;
use sinew::cyclic::tracking::{Tracked, TrackedFrame, TrackingOptions, track};
use sinew::cyclic::{AngleTable, CyclicModel, plausibility, rate};
use sinew::error::Result;
use std::path::{Path, PathBuf};

/// How a recording is tracked.
#[derive(Debug, Clone, Copy)]
struct How {
    model: &'static CyclicModel,
    rate_hz: f64,
    sigma_deg: Option<f64>,
    online: bool,
}

/// What a recording comes to.
#[derive(Debug)]
struct Found {
    tracked: Tracked,
    report: Report,
    options: TrackingOptions,
    doubts: Vec<String>,
}

impl How {
    /// Does what the command `sinew track cyclic --report` does.
    fn track(&self, table: &AngleTable, doubts: &[String]) -> Result<Found> {
        let default = TrackingOptions::default();
        let sigma_rad = self.sigma_deg.map_or(default.sigma_rad, f64::to_radians);
        let options = TrackingOptions { rate_hz: Some(self.rate_hz), sigma_rad, ..default };
        options.check()?;
        let is_noise_found = self.sigma_deg.is_none() && !self.online;
        let options = if is_noise_found { noise::with_noise_of(table, options) } else { options };
        let filtered = track(table, self.model, &options)?;
        let tracked = if self.online { filtered } else { finish(table, self.model, filtered, &options)? };
        let report = Report::new(table, &tracked, &options, None);
        let of_run = plausibility::doubts(&report.summary, &report.series, self.model, report.gait.as_ref());
        let doubts = doubts.iter().cloned().chain(of_run).map(|doubt| in_python(&doubt)).collect();
        Ok(Found { tracked, report, options, doubts })
    }
}

/// Tracks an array of frames and angles; `frames` are the numbers of the rows.
#[pyfunction]
pub fn track_array<'py>(
    py: Python<'py>,
    angles: PyReadonlyArray2<'py, f64>,
    frames: PyReadonlyArray1<'py, i64>,
    model: &Model,
    rate_hz: f64,
    sigma_deg: Option<f64>,
    online: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let poses = poses(angles.as_array());
    let frames: Vec<u64> = frames.as_array().iter().map(|frame| frame.unsigned_abs()).collect();
    let how = How { model: model.model, rate_hz, sigma_deg, online };
    let found = py.detach(|| how.track(&table(&frames, &poses)?.at_rate(Some(rate_hz)), &[]));
    answer(py, &found.map_err(|error| exception(&error))?)
}

fn table(frames: &[u64], poses: &[Pose]) -> Result<AngleTable> {
    let row = |(&frame, &angles_rad): (&u64, &Pose)| AngleRow { frame, angles_rad, extra: Vec::new() };
    Ok(AngleTable::new(frames.iter().zip(poses).map(row).collect(), Vec::new())?)
}

/// Tracks what `sinew.angles` found.
#[pyfunction]
pub fn track_angles<'py>(
    py: Python<'py>,
    angles: &Angles,
    model: &Model,
    rate_hz: Option<f64>,
    sigma_deg: Option<f64>,
    online: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let recorded = &angles.recorded;
    let found = py.detach(|| {
        let rate_hz = rate::of_recording(Path::new("angles"), recorded.rate_hz, rate_hz)?;
        How { model: model.model, rate_hz, sigma_deg, online }.track(&recorded.table, &recorded.doubts)
    });
    answer(py, &found.map_err(|error| exception(&error))?)
}

/// Tracks an angle table.
#[pyfunction]
pub fn track_file<'py>(
    py: Python<'py>,
    path: PathBuf,
    model: &Model,
    rate_hz: Option<f64>,
    sigma_deg: Option<f64>,
    online: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let found = py.detach(|| {
        let table = AngleTable::read(&path)?;
        let rate_hz = rate::of_recording(&path, table.rate_hz(), rate_hz)?;
        let doubts = About::read_beside(&path)?.map_or_else(Vec::new, |about| about.doubts);
        How { model: model.model, rate_hz, sigma_deg, online }.track(&table, &doubts)
    });
    answer(py, &found.map_err(|error| exception(&error))?)
}

/// Arrays and texts by name.
fn answer<'py>(py: Python<'py>, found: &Found) -> PyResult<Bound<'py, PyDict>> {
    let Found { tracked, report, options, doubts } = found;
    let frames = &tracked.frames;
    let known = |frame: &TrackedFrame, value: f64| if frame.is_known { value } else { f64::NAN };
    let numbers = |value: fn(&TrackedFrame) -> f64| -> Vec<f64> {
        frames.iter().map(|frame| known(frame, value(frame))).collect()
    };
    let std_rad = |frame: &TrackedFrame| {
        frame.estimate.angle_variance_rad2.map(|variance| known(frame, f64::from(variance.max(0.0).sqrt())))
    };
    let angles_rad = |frame: &TrackedFrame| -> [f64; ANGLES] { frame.angles_rad.map(|angle| known(frame, angle)) };
    let answer = PyDict::new(py);
    let frame: Vec<i64> = frames.iter().map(|frame| frame.frame as i64).collect();
    answer.set_item("frame", frame.into_pyarray(py))?;
    answer.set_item("rate_hz", tracked.rate_hz)?;
    answer.set_item("angles_rad", array(py, frames.iter().map(angles_rad)))?;
    answer.set_item("std_rad", array(py, frames.iter().map(std_rad)))?;
    let is_known: Vec<bool> = frames.iter().map(|frame| frame.is_known).collect();
    answer.set_item("is_known", is_known.into_pyarray(py))?;
    let outlier: Vec<bool> = frames.iter().map(|frame| frame.is_known && frame.estimate.outlier).collect();
    answer.set_item("outlier", outlier.into_pyarray(py))?;
    let misfit: Vec<bool> = frames.iter().map(|frame| frame.is_known && frame.estimate.misfit).collect();
    answer.set_item("misfit", misfit.into_pyarray(py))?;
    let position = numbers(|frame| f64::from(frame.estimate.cycle_position));
    answer.set_item("cycle_position", position.into_pyarray(py))?;
    answer.set_item("cycles", numbers(|frame| frame.cycles).into_pyarray(py))?;
    answer.set_item("flexion_deg", array_of_options(py, flexions(found).into_iter()))?;
    answer.set_item("sigma_deg", options.sigma_rad.to_degrees())?;
    answer.set_item("doubts", doubts)?;
    let texts = serde_json::json!({
        "summary": report.summary, "symmetries": report.symmetries, "gait": report.gait,
    });
    answer.set_item("json", texts.to_string())?;
    Ok(answer)
}

/// The anatomical angles of the tracked frames, degrees. The report's also stand in frames that the
/// recording leaves out.
fn flexions(found: &Found) -> Vec<[Option<f64>; COUNT]> {
    const { assert!(ANATOMICAL_ANGLES.len() == COUNT) };
    let series = &found.report.series;
    let mut all = series.frames.iter().zip(&series.angles_deg);
    let of_frame = |frame: &TrackedFrame| {
        let of_same = all.find(|(number, _)| **number == frame.frame);
        of_same.map_or([None; COUNT], |(_, angles_deg)| *angles_deg)
    };
    found.tracked.frames.iter().map(of_frame).collect()
}
