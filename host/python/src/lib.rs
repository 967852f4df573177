//! The extension module `sinew._sinew`: numpy in, numpy out.
//!
//! The package `sinew` in `python/sinew` is what users import. It checks shapes and documents the
//! functions; here each of them is one call of the library.

#![expect(clippy::needless_pass_by_value, reason = "functions for Python own what their arguments are turned into")]

mod angles;
mod arrays;
mod batch;
mod errors;
mod model;
mod online;
mod simulate;
mod track;

use pyo3::prelude::*;

/// Native part of the package `sinew`.
#[pymodule]
mod _sinew {
    #[pymodule_export]
    use crate::angles::{Angles, angles_of_array, angles_of_file, layouts};
    #[pymodule_export]
    use crate::batch::{BatchPart, WholeBatch, batch_rows, raise_error, run_command};
    #[pymodule_export]
    use crate::errors::SinewError;
    #[pymodule_export]
    use crate::model::{Model, models};
    #[pymodule_export]
    use crate::online::Tracker;
    #[pymodule_export]
    use crate::simulate::simulate_keypoints;
    #[pymodule_export]
    use crate::track::{track_angles, track_array, track_file};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
        module.add("FLEXIONS", sinew::cyclic::anatomy::ANATOMICAL_ANGLES.to_vec())?;
        let columns = sinew::cyclic::angle_table::angle_columns().take(sinew::cyclic::angle_table::ANGLES);
        module.add("ANGLES", columns.map(|column| column.trim_end_matches("_rad")).collect::<Vec<_>>())
    }
}
