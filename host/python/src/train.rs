//! Training of motion models.

use crate::angles::Angles;
use crate::errors::exception;
use crate::model::Model;
use crate::process::detached;
use pyo3::prelude::*;
use sinew::cyclic::cuts::{Cut, CutList};
use sinew::cyclic::cutting::{CuttingOptions, cycles};
use sinew::cyclic::training::{TrainingOptions, cycles_of, read_cycles, train_on};
use sinew::cyclic::{AngleTable, CyclicError, CyclicModel, rate};
use sinew::error::Result;
use std::path::{Path, PathBuf};

/// What stands for recordings in memory in messages.
const RECORDINGS: &str = "recordings";

/// Trains a model on the cycles of a cut list.
#[pyfunction]
pub fn train_file(py: Python<'_>, cuts: PathBuf, length: usize, rate_hz: Option<f64>, mirror: bool) -> PyResult<Model> {
    let options = TrainingOptions { length, rate_hz, mirror };
    let trained = detached(py, || {
        let list = CutList::read(&cuts)?;
        Ok(train_on(&read_cycles(&list, mirror)?, &list, options)?)
    })?;
    Ok(Model::of(trained.map_err(|error| exception(&error))?))
}

/// A recording: its angles, the cycles in it if they are known, and whose it is.
type Recording<'py> = (PyRef<'py, Angles>, Option<Vec<[u64; 2]>>, Option<String>);

/// Trains a model on recordings in memory.
#[pyfunction]
pub fn train_angles(
    py: Python<'_>,
    recordings: Vec<Recording<'_>>,
    length: usize,
    rate_hz: Option<f64>,
    mirror: bool,
) -> PyResult<Model> {
    let options = TrainingOptions { length, rate_hz, mirror };
    let (mut tables, mut all) = (Vec::new(), Vec::new());
    for (angles, frames, person) in recordings {
        tables.push(angles.recorded.table.clone());
        all.push((frames, person));
    }
    let trained = detached(py, || {
        let mut cuts = Vec::new();
        for (index, ((frames, person), table)) in all.into_iter().zip(&tables).enumerate() {
            cuts.extend(cuts_of(index, table, frames, person, rate_hz)?);
        }
        trained(&tables, cuts, options)
    })?;
    Ok(Model::of(trained.map_err(|error| exception(&error))?))
}

fn name(index: usize) -> String {
    format!("{RECORDINGS}[{index}]")
}

/// The cycles of a recording, found where none are given.
fn cuts_of(
    index: usize,
    table: &AngleTable,
    frames: Option<Vec<[u64; 2]>>,
    person: Option<String>,
    rate_hz: Option<f64>,
) -> Result<Vec<Cut>> {
    let (file, line) = (name(index), index as u64 + 1);
    let found = match frames {
        Some(frames) => frames
            .into_iter()
            .map(|[start_frame, end_frame]| Cut { file: file.clone(), start_frame, end_frame, person: None, line })
            .collect(),
        None => {
            let rate_hz = rate::of_recording(Path::new(&file), table.rate_hz(), rate_hz)?;
            cycles(table, &file, CuttingOptions { rate_hz, ..CuttingOptions::default() })?
        }
    };
    Ok(found.into_iter().map(|cut| Cut { person: person.clone(), line, ..cut }).collect())
}

fn trained(tables: &[AngleTable], cuts: Vec<Cut>, options: TrainingOptions) -> Result<CyclicModel> {
    let list = CutList::of_cuts(cuts, Path::new(RECORDINGS))?;
    let table = |path: &Path| -> Result<AngleTable, CyclicError> {
        let index = (0..tables.len()).find(|index| Path::new(&name(*index)) == path);
        let table = index.and_then(|index| tables.get(index)).cloned();
        let rule = || format!("have no {}", path.display());
        table.ok_or_else(|| CyclicError::Parameter { parameter: RECORDINGS, rule: rule() })
    };
    Ok(train_on(&cycles_of(&list, options.mirror, &table)?, &list, options)?)
}
