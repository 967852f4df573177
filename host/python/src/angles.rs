//! Angles of recordings: keypoints in memory, and files.

use crate::arrays::array_of_options;
use crate::errors::{exception, wrong};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use sinew::cyclic::recording::{RecordedAngles, RecordingOptions, angles, of_detections};
use sinew::keypoints::arrays::{self, ARRAY, from_points};
use sinew::keypoints::{Facing, PersonChoice};
use std::path::{Path, PathBuf};

/// Names of the layouts of keypoints.
#[pyfunction]
pub fn layouts() -> Vec<&'static str> {
    arrays::layouts()
}

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
        self.recorded.notes.clone()
    }

    #[getter]
    fn doubts(&self) -> Vec<String> {
        self.recorded.doubts.clone()
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let write = || {
            self.recorded.table.write(&path)?;
            self.recorded.about(&self.source).write_beside(&path)
        };
        py.detach(write).map_err(|error| exception(&error))
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
    let recorded = py.detach(|| of_detections(&from_points(&points, layout, image_size_px)?, source, &options));
    Ok(Angles { recorded: recorded.map_err(|error| exception(&error))?, source: source.to_path_buf() })
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
    let recorded = py.detach(|| angles(&path, &options)).map_err(|error| exception(&error))?;
    Ok(Angles { recorded, source: path })
}
