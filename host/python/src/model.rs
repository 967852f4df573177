//! Motion models.

use crate::errors::{exception, in_python};
use crate::process::detached;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::PyFileNotFoundError;
use pyo3::prelude::*;
use sinew::cyclic::CyclicModel;
use sinew::cyclic::model_file::{parse, shipped, shipped_names, to_json};
use sinew::output::write_atomically;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Names of the models that are part of the package.
#[pyfunction]
pub fn models() -> Vec<&'static str> {
    shipped_names().to_vec()
}

/// A model that lives as long as the process, so that a tracker can borrow it.
#[pyclass(frozen, module = "sinew._sinew")]
#[derive(Debug)]
pub struct Model {
    name: String,
    pub model: &'static CyclicModel,
}

impl Model {
    /// A model that was trained here.
    pub fn of(model: CyclicModel) -> Self {
        Self { name: "trained".to_owned(), model: kept(model) }
    }
}

/// The model as one that is never freed; equal ones are kept once.
fn kept(model: CyclicModel) -> &'static CyclicModel {
    static READ: Mutex<Vec<&'static CyclicModel>> = Mutex::new(Vec::new());
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = read.iter().copied().find(|known| **known == model) {
        return known;
    }
    let leaked: &'static CyclicModel = Box::leak(Box::new(model));
    read.push(leaked);
    leaked
}

#[pymethods]
impl Model {
    #[new]
    fn new(name: String) -> PyResult<Self> {
        if let Some(model) = shipped(&name) {
            return Ok(Self { name, model });
        }
        let model = CyclicModel::from_option(&name).map_err(|error| {
            // A name of a file, and not a misspelt one of a model.
            let is_file = Path::new(&name).extension().is_some() || name.contains(std::path::MAIN_SEPARATOR);
            if is_file && !Path::new(&name).exists() {
                return PyFileNotFoundError::new_err(in_python(&error.chain()));
            }
            exception(&error)
        })?;
        Ok(Self { name, model: kept(model) })
    }

    /// The model from the text of its file, for pickle.
    #[staticmethod]
    fn from_json(name: String, text: &str) -> PyResult<Self> {
        Ok(Self { name, model: kept(parse(text).map_err(|error| exception(&error))?) })
    }

    fn to_json(&self) -> PyResult<String> {
        to_json(self.model).map_err(|error| exception(&error))
    }

    /// Writes the file that `sinew train cyclic` writes.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let write = || {
            let json = to_json(self.model)?;
            write_atomically(&path, |writer| Ok(writer.write_all(json.as_bytes())?))
        };
        detached(py, write)?.map_err(|error| exception(&error))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn rate_hz(&self) -> f64 {
        f64::from(self.model.numbers().rate_hz)
    }

    #[getter]
    fn cadence_per_min(&self) -> f64 {
        60.0 * self.rate_hz() / f64::from(self.model.numbers().mean_duration_frames)
    }

    #[getter]
    fn trained_cycles(&self) -> u64 {
        self.model.trained_on().cycles
    }

    #[getter]
    fn mean_cycle_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let numbers = self.model.numbers();
        let values: Vec<f64> = numbers.mean_pose_rad.iter().copied().map(f64::from).collect();
        let shape = (values.len() / numbers.angle_count, numbers.angle_count);
        // The model's numbers were checked to be rows of so many angles.
        Array2::from_shape_vec(shape, values).unwrap_or_default().into_pyarray(py)
    }
}
