//! A body tracked frame by frame.

use crate::arrays::points_array;
use crate::errors::{exception, in_python, wrong};
use crate::process::detached;
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::body::first_points::{FirstPoints, UNIT_REMEDY};
use sinew::body::pose_file::{inside_limits, pose_from_json, read_pose};
use sinew::body::run::measures_source::{measures_from_json, measures_of_height, read_measures};
use sinew::body::run::tuning_file;
use sinew::body::tracking::facing::begin_from_frames;
use sinew::body::tracking::filter::WholeBodyEstimate;
use sinew::body::tracking::frame_time::decision_frames;
use sinew::body::tracking::size_from_frames::{size_frames, size_from_frames, sizing_options};
use sinew::body::tracking::stream::stick_at;
use sinew::body::tracking::{
    BodyModelKind, BodyStream, BodyStreamOptions, BodyTuning, FrameTime, SeenPoints, StreamedFrame,
};
use sinew::body::{BodyFile, BodyPart};
use sinew::cloud::PointCloud;
use sinew::error::Result;
use sinew::stereo::stick_wave::StickEnds;
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use std::path::{Path, PathBuf};
use std::process::id;

/// A file, or what would stand in it as JSON, which Python gives as bytes.
#[derive(Debug, FromPyObject)]
pub enum Given {
    Json(Vec<u8>),
    File(PathBuf),
}

impl Given {
    /// What `file` reads or `json` parses.
    fn read<T>(&self, file: impl FnOnce(&Path) -> Result<T>, json: impl FnOnce(&str) -> Result<T>) -> Result<T> {
        match self {
            Self::Json(bytes) => json(&String::from_utf8_lossy(bytes)),
            Self::File(path) => file(path),
        }
    }
}

/// A tracker that answers each frame from those before it.
#[pyclass(module = "sinew._sinew")]
#[derive(Debug)]
pub struct Body {
    stream: BodyStream,
    #[pyo3(get)]
    notes: Vec<String>,
    /// Points of the first clouds, while their units and axes are checked.
    first: Option<FirstPoints>,
    /// Whether a first pose is given.
    is_placed: bool,
    /// The process that has the stream's threads.
    process: u32,
}

#[pymethods]
impl Body {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the options of `sinew track body`")]
    fn new(
        height_m: Option<f32>,
        measures: Option<Given>,
        part: &str,
        model: &str,
        particles: Option<usize>,
        seed: u64,
        rate_hz: f32,
        first_pose: Option<Given>,
        floor_y_m: Option<f32>,
        threads: Option<usize>,
        config: Option<Given>,
    ) -> PyResult<Self> {
        let part: BodyPart = part.parse().map_err(|rule: String| wrong("part", &rule))?;
        let model: BodyModelKind = model.parse().map_err(|rule: String| wrong("model", &rule))?;
        let particles = particles.unwrap_or_else(|| model.default_particles());
        let mut notes = Vec::new();
        let mut make = || {
            let tuning = config.as_ref().map_or_else(
                || Ok(BodyTuning::default()),
                |given| given.read(tuning_file::load, |text| tuning_file::parse_json(text, "config")),
            )?;
            let defaults = BodyStreamOptions::default();
            let options =
                BodyStreamOptions { part, model, particles, seed, rate_hz, floor_y_m, threads, tuning, ..defaults };
            options.check()?;
            let measures = match &measures {
                None => measures_of_height(height_m, &mut notes)?,
                Some(Given::File(path)) => read_measures(path, false, &mut notes)?,
                Some(given) => given.read(BodyFile::read, |text| measures_from_json(text, "measures"))?,
            };
            let first = first_pose.as_ref().map(|given| {
                let pose = given.read(read_pose, |text| pose_from_json(text, "first_pose"))?;
                inside_limits(pose, &measures.measures, "first_pose", &mut notes)
            });
            BodyStream::new(options, measures, first.transpose()?)
        };
        let stream = make().map_err(|error| exception(&error))?;
        let is_placed = first_pose.is_some();
        let notes = notes.iter().map(|note| in_python(note)).collect();
        Ok(Self { stream, notes, first: Some(FirstPoints::default()), is_placed, process: id() })
    }

    /// The estimate as a dictionary; `None` in the place of what is not known yet.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        points: Option<PyReadonlyArray2<'py, f32>>,
        time_s: Option<f64>,
        stick: Option<[[f32; 3]; 2]>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let numbers = points.as_ref().map_or(Ok(&[][..]), PyReadonlyArray2::as_slice)?;
        let (points, _) = numbers.as_chunks::<3>();
        let when = time_s.map_or(FrameTime::Next, FrameTime::Seconds);
        let ends: Option<StickEnds> = stick.map(|ends| ends.map(Vec3::from));
        let stick = ends.and_then(stick_at).unwrap_or(StickSight::Unseen);
        self.check_first(points)?;
        let stream = &mut self.stream;
        if self.process != id() {
            stream.renew_threads().map_err(|error| exception(&error))?;
            self.process = id();
        }
        let answer = detached(py, || stream.update(points.iter().copied().map(Vec3::from), when, stick))?;
        let answer = answer.map_err(|error| exception(&error))?;
        if self.stream.begun_anew() == Some(answer.frame) {
            self.notes
                .push(format!("frame {}: most points were away from the body; it was looked for anew", answer.frame));
        }
        self.answer(py, &answer)
    }

    /// How many clouds with points `estimated_measures` looks at.
    #[getter]
    fn size_frames(&self) -> usize {
        size_frames(self.stream.options().rate_hz)
    }

    /// Measures of the person whom these numbered clouds show, as `body.json` has them.
    fn estimated_measures(
        &self,
        py: Python<'_>,
        clouds: Vec<(u64, PyReadonlyArray2<'_, f32>)>,
    ) -> PyResult<Option<String>> {
        if self.stream.frame().is_some() {
            return Err(wrong("estimate_measures", "is for a tracker that answered no frame: make a new one"));
        }
        let clouds = checked_points_of(clouds)?;
        let found = detached(py, || {
            let (options, start, first_rad) = (self.stream.options(), *self.stream.size(), self.stream.first_rad());
            let sizing = BodyStream::new(sizing_options(options), start, first_rad)?;
            size_from_frames(options, &start, first_rad, &seen_frames(&sizing, clouds))
        })?;
        found.map_err(|error| exception(&error))?.map(|size| json_of_measures(&BodyFile::from(&size))).transpose()
    }

    /// How many clouds with points `found_first_pose` looks at.
    #[getter]
    fn decision_frames(&self) -> usize {
        decision_frames(self.stream.options().rate_hz)
    }

    /// Pose of the person whom these numbered clouds show first, by how much a point is likelier
    /// than with the opposite, and whether that is little.
    fn found_first_pose(
        &self,
        py: Python<'_>,
        clouds: Vec<(u64, PyReadonlyArray2<'_, f32>)>,
    ) -> PyResult<(Vec<f32>, f32, bool)> {
        let clouds = checked_points_of(clouds)?;
        let found = detached(py, || {
            let mut stream = BodyStream::new(self.stream.options().clone(), *self.stream.size(), None)?;
            let frames = seen_frames(&stream, clouds);
            begin_from_frames(&mut stream, &frames)
        })?;
        let first = found.map_err(|error| exception(&error))?;
        Ok((first.angles_rad.to_vec(), first.facing_margin, first.is_facing_doubtful()))
    }

    #[getter]
    fn frame(&self) -> Option<u64> {
        self.stream.frame()
    }

    #[getter]
    fn part(&self) -> &'static str {
        self.stream.options().part.name()
    }

    #[getter]
    fn model(&self) -> &'static str {
        self.stream.options().model.name()
    }

    #[getter]
    fn particles(&self) -> usize {
        self.stream.options().particles
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.stream.options().seed
    }

    #[getter]
    fn rate_hz(&self) -> f64 {
        f64::from(self.stream.options().rate_hz)
    }

    #[getter]
    fn measures_json(&self) -> PyResult<String> {
        json_of_measures(&BodyFile::from(self.stream.size()))
    }

    #[getter]
    fn state_crc32(&mut self) -> PyResult<u32> {
        self.stream.state_crc32().map_err(|error| exception(&error))
    }

    /// The tracker as text, which `restored` takes.
    fn saved(&mut self) -> PyResult<String> {
        self.stream.saved().map_err(|error| exception(&error))
    }

    #[staticmethod]
    fn restored(py: Python<'_>, saved: &str, notes: Vec<String>) -> PyResult<Self> {
        let stream = detached(py, || BodyStream::restored(saved))?.map_err(|error| exception(&error))?;
        let first = stream.frame().is_none().then(FirstPoints::default);
        let is_placed = stream.first_rad().is_some();
        Ok(Self { stream, notes, first, is_placed, process: id() })
    }
}

/// Numbered clouds, out of numpy's arrays; other units or axes are refused.
fn checked_points_of(clouds: Vec<(u64, PyReadonlyArray2<'_, f32>)>) -> PyResult<Vec<(u64, Vec<Vec3>)>> {
    let points = |array: &PyReadonlyArray2<'_, f32>| -> PyResult<Vec<Vec3>> {
        Ok(array.as_slice()?.as_chunks::<3>().0.iter().copied().map(Vec3::from).collect())
    };
    let clouds = clouds.iter().map(|(frame, array)| Ok((*frame, points(array)?))).collect::<PyResult<Vec<_>>>()?;
    let mut first = FirstPoints::default();
    for (_, points_m) in &clouds {
        if !first.is_complete() {
            first.add(PointCloud::from_points(points_m.iter().copied()));
        }
    }
    refuse_other_units(&first, "clouds")?;
    Ok(clouds)
}

/// Those in which the stream sees the points of a body.
fn seen_frames(stream: &BodyStream, clouds: Vec<(u64, Vec<Vec3>)>) -> Vec<(u64, SeenPoints)> {
    let seen = clouds.into_iter().map(|(at, points_m)| (at, stream.seen(PointCloud::from_points(points_m), at)));
    seen.filter(|(_, seen)| seen.show_a_body()).collect()
}

impl Body {
    /// Refuses first points in other units or axes, as the command does.
    fn check_first(&mut self, points: &[[f32; 3]]) -> PyResult<()> {
        let Some(first) = &mut self.first else { return Ok(()) };
        first.add(PointCloud::from_points(points.iter().copied().map(Vec3::from)));
        if !first.can_be_checked() {
            return Ok(());
        }
        if let Err(error) = refuse_other_units(first, "points") {
            *first = FirstPoints::default();
            return Err(error);
        }
        if first.is_complete() {
            let doubt = first.lies_along_sight("").filter(|_| !self.is_placed);
            self.notes.extend(doubt.map(|doubt| in_python(&doubt)));
            self.first = None;
        }
        Ok(())
    }

    fn answer<'py>(&self, py: Python<'py>, answer: &StreamedFrame) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        named.set_item("frame", answer.frame)?;
        named.set_item("time_s", answer.time_s)?;
        named.set_item("points", answer.points)?;
        named.set_item("skipped_points", answer.skipped)?;
        named.set_item("points_over_cap", answer.over_cap)?;
        if let Some(estimate) = &answer.estimate {
            self.add_estimate(py, &named, estimate)?;
        }
        Ok(named)
    }

    fn add_estimate<'py>(
        &self,
        py: Python<'py>,
        named: &Bound<'py, PyDict>,
        estimate: &WholeBodyEstimate,
    ) -> PyResult<()> {
        let bones = self.stream.options().part.bones();
        named.set_item("pose", estimate.angles_rad.to_vec().into_pyarray(py))?;
        named.set_item("joints_m", points_array(py, &estimate.ends_m[..bones]))?;
        named.set_item("spread_m", estimate.spread_m[..bones].to_vec().into_pyarray(py))?;
        named.set_item("observed", estimate.observed[..bones].to_vec().into_pyarray(py))?;
        let ambiguous = self.stream.filter().ambiguous(estimate);
        named.set_item("ambiguous", ambiguous[..bones].to_vec().into_pyarray(py))?;
        named.set_item("effective_sample_size", estimate.effective_sample_size)?;
        named.set_item("log_evidence", estimate.log_evidence)?;
        named.set_item("tempering", estimate.tempering)?;
        named.set_item("is_degenerate", estimate.is_degenerate)
    }
}

/// Refuses first points in other units or axes.
fn refuse_other_units(first: &FirstPoints, parameter: &str) -> PyResult<()> {
    first.check("", UNIT_REMEDY).map_err(|error| PyValueError::new_err(format!("`{parameter}`: {error}")))
}

/// Measures as `body.json` has them.
pub fn json_of_measures(file: &BodyFile) -> PyResult<String> {
    serde_json::to_string(file).map_err(|error| exception(&error.into()))
}
