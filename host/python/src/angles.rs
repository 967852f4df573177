//! Angles of recordings: keypoints in memory, and files.

use crate::arrays::{Pose, array_of_options, poses};
use crate::errors::{SinewError, exception, in_python, of_array, wrong};
use crate::process::detached;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use sinew::cyclic::about::About;
use sinew::cyclic::recording::{RecordedAngles, RecordingOptions, angles, of_detections};
use sinew::cyclic::{AngleRow, AngleTable, CyclicError};
use sinew::keypoints::arrays::{self, ARRAY, from_points};
use sinew::keypoints::{Facing, PersonChoice};
use std::path::{Path, PathBuf};

/// Names of the layouts of keypoints.
#[pyfunction]
pub fn layouts() -> Vec<&'static str> {
    arrays::layouts()
}

/// Angles, frames, angles out of the plane, names and cells of other columns, and the rest as JSON.
type Parts<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
    Option<Bound<'py, PyArray2<f64>>>,
    (Vec<String>, Vec<Vec<String>>),
    String,
);

/// Angles of a recording.
#[pyclass(frozen, module = "sinew._sinew")]
#[derive(Debug)]
pub struct Angles {
    pub recorded: RecordedAngles,
    source: PathBuf,
}

#[pymethods]
impl Angles {
    #[getter]
    fn angles_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        array_of_options(py, self.recorded.table.rows().iter().map(|row| row.angles_rad))
    }

    #[getter]
    fn frame<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        // Frame numbers of a table end below 2^53.
        let frames: Vec<i64> = self.recorded.table.rows().iter().map(|row| row.frame as i64).collect();
        frames.into_pyarray(py)
    }

    #[getter]
    fn rate_hz(&self) -> Option<f64> {
        self.recorded.rate_hz
    }

    #[getter]
    fn facing(&self) -> Option<&'static str> {
        self.recorded.facing.map(Facing::name)
    }

    #[getter]
    fn layout(&self) -> Option<String> {
        self.recorded.layout.clone()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.recorded.notes.iter().map(|note| in_python(note)).collect()
    }

    #[getter]
    fn doubts(&self) -> Vec<String> {
        self.recorded.doubts.iter().map(|doubt| in_python(doubt)).collect()
    }

    /// Angles in memory; `frames` are the numbers of the rows.
    #[staticmethod]
    fn of_array(
        angles: PyReadonlyArray2<'_, f64>,
        frames: PyReadonlyArray1<'_, i64>,
        rate_hz: Option<f64>,
    ) -> PyResult<Self> {
        let frames = frames.as_array();
        let row = |(&frame, angles_rad): (&i64, Pose)| AngleRow {
            frame: frame.unsigned_abs(),
            angles_rad,
            extra: Vec::new(),
        };
        let rows = frames.iter().zip(poses(angles.as_array())).map(row).collect();
        let table = AngleTable::new(rows, Vec::new()).map_err(|error| exception(&error.into()))?;
        Ok(Self { recorded: RecordedAngles::of_table(table.at_rate(rate_hz)), source: PathBuf::from(ARRAY) })
    }

    /// All of it, which `of_parts` takes: for pickle.
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Parts<'py>> {
        let table = &self.recorded.table;
        let side = table.side_rad().map(|rows| array_of_options(py, rows.iter().copied()));
        let cells: Vec<Vec<String>> = table.rows().iter().map(|row| row.extra.clone()).collect();
        let about = serde_json::to_string(&self.recorded.about(&self.source))
            .map_err(|error| SinewError::new_err(error.to_string()))?;
        Ok((self.angles_rad(py), self.frame(py), side, (table.extra_columns().to_vec(), cells), about))
    }

    #[staticmethod]
    fn of_parts(
        angles: PyReadonlyArray2<'_, f64>,
        frames: PyReadonlyArray1<'_, i64>,
        side: Option<PyReadonlyArray2<'_, f64>>,
        other: (Vec<String>, Vec<Vec<String>>),
        about: &str,
    ) -> PyResult<Self> {
        let broken = |error: CyclicError| exception(&error.into());
        let about: About = serde_json::from_str(about).map_err(|error| SinewError::new_err(error.to_string()))?;
        let (columns, cells) = other;
        let frames = frames.as_array();
        let rows = frames
            .iter()
            .zip(poses(angles.as_array()))
            .zip(cells)
            .map(|((&frame, angles_rad), extra)| AngleRow { frame: frame.unsigned_abs(), angles_rad, extra });
        let mut table = AngleTable::new(rows.collect(), columns).map_err(broken)?.at_rate(about.rate_hz);
        if let Some(side) = side {
            table = table.with_side(poses(side.as_array())).map_err(broken)?;
        }
        let source = PathBuf::from(&about.source);
        let recorded = RecordedAngles {
            rate_hz: about.rate_hz,
            notes: about.notes,
            doubts: about.doubts,
            facing: about.facing,
            image_size_px: about.image_size_px,
            layout: about.layout,
            ..RecordedAngles::of_table(table)
        };
        Ok(Self { recorded, source })
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let write = || {
            self.recorded.table.write(&path)?;
            self.recorded.about(&self.source).write_beside(&path)
        };
        detached(py, write)?.map_err(|error| exception(&error))
    }
}

/// What both kinds of recordings take.
fn options(
    fps: Option<f64>,
    image_size_px: Option<[f64; 2]>,
    min_confidence: f64,
    facing: Option<&str>,
    person: &str,
) -> PyResult<RecordingOptions> {
    if let Some(fps) = fps.filter(|fps| !(*fps > 0.0 && fps.is_finite())) {
        return Err(wrong("fps", &format!("has to be greater than zero, not {fps}")));
    }
    if !(min_confidence >= 0.0 && min_confidence.is_finite()) {
        return Err(wrong("min_confidence", &format!("has to be zero or more, not {min_confidence}")));
    }
    if let Some(size) = image_size_px.filter(|size| !size.iter().all(|side| (1.0..1.0e6).contains(side))) {
        return Err(wrong("image_size_px", &format!("has to be width and height in pixels, not {size:?}")));
    }
    Ok(RecordingOptions {
        input_rate_hz: fps,
        image_size_px,
        min_confidence,
        facing: facing.map(str::parse::<Facing>).transpose().map_err(|rule| wrong("facing", &rule))?,
        person: person.parse::<PersonChoice>().map_err(|rule| wrong("person", &rule.replace("it has", "has")))?,
        ..RecordingOptions::default()
    })
}

/// Angles of keypoints, an array of frames, points and x, y and confidence.
#[pyfunction]
pub fn angles_of_array(
    py: Python<'_>,
    keypoints: PyReadonlyArray3<'_, f64>,
    layout: &str,
    fps: f64,
    image_size_px: Option<[f64; 2]>,
    min_confidence: f64,
    facing: Option<&str>,
) -> PyResult<Angles> {
    let options = options(Some(fps), image_size_px, min_confidence, facing, "largest")?;
    let points: Vec<Vec<[f64; 3]>> = keypoints
        .as_array()
        .outer_iter()
        .map(|frame| frame.outer_iter().map(|point| [point[0], point[1], point[2]]).collect())
        .collect();
    let source = Path::new(ARRAY);
    let recorded = detached(py, || of_detections(&from_points(&points, layout, image_size_px)?, source, &options))?;
    let recorded = recorded.map_err(|error| exception(&error))?;
    let (notes, doubts) = (of_array(&recorded.notes), of_array(&recorded.doubts));
    Ok(Angles { recorded: RecordedAngles { notes, doubts, ..recorded }, source: source.to_path_buf() })
}

/// Angles of a file or folder, as the command `sinew angles` reads it.
#[pyfunction]
pub fn angles_of_file(
    py: Python<'_>,
    path: PathBuf,
    fps: Option<f64>,
    image_size_px: Option<[f64; 2]>,
    min_confidence: f64,
    facing: Option<&str>,
    person: &str,
) -> PyResult<Angles> {
    let options = options(fps, image_size_px, min_confidence, facing, person)?;
    let recorded = detached(py, || angles(&path, &options))?.map_err(|error| exception(&error))?;
    Ok(Angles { recorded, source: path })
}
