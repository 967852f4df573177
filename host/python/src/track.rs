//! Tracking of whole recordings.

use crate::angles::Angles;
use crate::arrays::{array, array_of_options};
use crate::errors::{exception, in_python};
use crate::model::Model;
use crate::process::detached;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::cyclic::about::About;
use sinew::cyclic::anatomy::{ANATOMICAL_ANGLES, COUNT};
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::own_cycle::{finish, noise};
use sinew::cyclic::report::Report;
use sinew::cyclic::tracking::{OnlineRun, Tracked, TrackedFrame, TrackingOptions, track};
use sinew::cyclic::{AngleTable, CyclicModel, plausibility, rate};
use sinew::error::Result;
use std::path::{Path, PathBuf};

/// How a recording is tracked, as Python hands it over.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub struct How {
    rate_hz: Option<f64>,
    sigma_deg: Option<f64>,
    smooth: bool,
    filter: String,
    particles: usize,
    seed: u64,
    covariance: bool,
}

/// What a recording comes to.
#[derive(Debug)]
struct Found {
    tracked: Tracked,
    report: Report,
    options: TrackingOptions,
    doubts: Vec<String>,
    /// Of the angles of each row; NaN where it is unknown.
    covariance_rad2: Option<Vec<Covariance>>,
}

/// Covariance of the angles of a row, rad^2.
type Covariance = [f64; ANGLES * ANGLES];

/// A recording with what was said about it.
struct Recording<'a> {
    table: &'a AngleTable,
    rate_hz: f64,
    doubts: &'a [String],
}

impl How {
    /// Does what the command `sinew track cyclic --report` does.
    fn track(&self, recording: &Recording<'_>, model: &'static CyclicModel) -> Result<Found> {
        let default = TrackingOptions::default();
        let options = TrackingOptions {
            filter: self.filter.parse()?,
            rate_hz: Some(recording.rate_hz),
            sigma_rad: self.sigma_deg.map_or(default.sigma_rad, f64::to_radians),
            particles: self.particles,
            seed: self.seed,
            ..default
        };
        options.check()?;
        let table = recording.table;
        let given_rad = self.sigma_deg.map(f64::to_radians);
        let is_noise_found = given_rad.is_none() && self.smooth;
        let options = if is_noise_found { noise::with_noise_of(table, options) } else { options };
        let filtered = track(table, model, &options)?;
        let tracked = if self.smooth { finish(table, model, filtered, &options, given_rad)? } else { filtered };
        let report = Report::new(table, &tracked, &options, None);
        let of_run = plausibility::doubts(&report.summary, &report.series, model, report.gait.as_ref().ok());
        let doubts = recording.doubts.iter().cloned().chain(of_run).map(|doubt| in_python(&doubt)).collect();
        let covariance_rad2 = if self.covariance { Some(covariances(table, model, &options)?) } else { None };
        Ok(Found { tracked, report, options, doubts, covariance_rad2 })
    }
}

/// Covariance of the filter's angles in each row. The filter runs once more, row by row.
fn covariances(table: &AngleTable, model: &'static CyclicModel, options: &TrackingOptions) -> Result<Vec<Covariance>> {
    let mut run = OnlineRun::new(model, options.clone())?;
    let mut before = None;
    let mut all = Vec::with_capacity(table.rows().len());
    for row in table.rows() {
        let angles_rad = row.angles_rad.map(|angle| angle.map(|angle| angle as f32));
        run.step(&angles_rad, before.map_or(1, |before| row.frame - before))?;
        before = Some(row.frame);
        all.push(covariance(&run));
    }
    Ok(all)
}

/// Covariance of the angles after the last row, rad^2; NaN where it is unknown.
pub fn covariance(run: &OnlineRun<'_>) -> Covariance {
    let known = run.angle_covariance_rad2();
    std::array::from_fn(|i| known.map_or(f64::NAN, |known| f64::from(known[i / ANGLES][i % ANGLES])))
}

/// Tracks angles in memory.
#[pyfunction]
pub fn track_angles<'py>(py: Python<'py>, angles: &Angles, model: &Model, how: How) -> PyResult<Bound<'py, PyDict>> {
    let recorded = &angles.recorded;
    let found = detached(py, || {
        let rate_hz = rate::of_recording(Path::new("angles"), recorded.rate_hz, how.rate_hz)?;
        let recording = Recording { table: &recorded.table, rate_hz, doubts: &recorded.doubts };
        how.track(&recording, model.model)
    })?;
    answer(py, &found.map_err(|error| exception(&error))?)
}

/// Tracks an angle table. Beside the answer, the notes of what made the table.
#[pyfunction]
pub fn track_file<'py>(
    py: Python<'py>,
    path: PathBuf,
    model: &Model,
    how: How,
) -> PyResult<(Bound<'py, PyDict>, Vec<String>)> {
    let found = detached(py, || {
        let table = AngleTable::read(&path)?;
        let rate_hz = rate::of_recording(&path, table.rate_hz(), how.rate_hz)?;
        let (notes, doubts) =
            About::read_beside(&path)?.map_or_else(Default::default, |about| (about.notes, about.doubts));
        let recording = Recording { table: &table, rate_hz, doubts: &doubts };
        Ok((how.track(&recording, model.model)?, notes.iter().map(|note| in_python(note)).collect()))
    })?;
    let (found, notes) = found.map_err(|error| exception(&error))?;
    Ok((answer(py, &found)?, notes))
}

/// Arrays and texts by name.
fn answer<'py>(py: Python<'py>, found: &Found) -> PyResult<Bound<'py, PyDict>> {
    let Found { tracked, report, options, doubts, covariance_rad2 } = found;
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
    let covariance_rad2 = covariance_rad2.as_ref().map(|rows| array(py, rows.iter().copied()));
    answer.set_item("covariance_rad2", covariance_rad2)?;
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
    let said = serde_json::to_string(&(&report.summary, &report.symmetries, report.gait.as_ref().ok()));
    answer.set_item("json", said.map_err(|error| exception(&error.into()))?)?;
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
