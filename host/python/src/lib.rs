//! The extension module `sinew._sinew`: numpy in, numpy out.
//!
//! The package `sinew` in `python/sinew` is what users import. It checks shapes and documents the
//! functions; here each of them is one call of the library.

#![expect(clippy::needless_pass_by_value, reason = "functions for Python own what their arguments are turned into")]

mod angles;
mod arm;
mod arm_estimate;
mod arm_options;
mod arrays;
mod batch;
mod body;
mod errors;
mod model;
mod motion;
mod names_of_body;
mod online;
mod pictures;
mod process;
mod simulate;
mod simulate_arm;
mod stereo;
mod track;
mod train;

use pyo3::prelude::*;

/// Native part of the package `sinew`.
#[pymodule]
mod _sinew {
    #[pymodule_export]
    use crate::angles::{Angles, angles_of_array, angles_of_file, layouts};
    #[pymodule_export]
    use crate::arm::ArmTracker;
    #[pymodule_export]
    use crate::batch::{BatchPart, WholeBatch, batch_rows, raise_error, run_command};
    #[pymodule_export]
    use crate::body::Body;
    #[pymodule_export]
    use crate::errors::SinewError;
    #[pymodule_export]
    use crate::model::{Model, models};
    #[pymodule_export]
    use crate::motion::{read_cloud, read_motion, turn_of_up};
    #[pymodule_export]
    use crate::online::Tracker;
    #[pymodule_export]
    use crate::pictures::{find_blobs, read_image, segment_skin};
    #[pymodule_export]
    use crate::simulate::simulate_keypoints;
    #[pymodule_export]
    use crate::simulate_arm::simulate_arm;
    #[pymodule_export]
    use crate::stereo::simulate_stereo;
    #[pymodule_export]
    use crate::track::{track_angles, track_file};
    #[pymodule_export]
    use crate::train::{train_angles, train_file};
    use pyo3::prelude::*;
    use sinew::body::BodyPart;
    use sinew::limits::MAX_FILE_BYTES;
    use sinew_core::skeleton::full_body;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::process::remember_process();
        module.add("BLOB_COLUMNS", crate::pictures::blob_columns().to_vec())?;
        module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
        module.add("FLEXIONS", sinew::cyclic::anatomy::ANATOMICAL_ANGLES.to_vec())?;
        module.add("BODY_JOINTS", full_body::BODY_JOINT_NAMES.to_vec())?;
        module.add("BODY_COORDINATES", full_body::BODY_ANGLE_NAMES.to_vec())?;
        let parents = full_body::BODY_PARENTS.map(|parent| parent.map_or(-1, i64::from));
        module.add("BODY_PARENTS", parents.to_vec())?;
        module.add("UPPER_BODY_COORDINATES", BodyPart::Upper.coordinates().to_vec())?;
        module.add("MAX_CLOUD_POINTS", MAX_FILE_BYTES / 12)?;
        let columns = sinew::cyclic::angle_table::angle_columns().take(sinew::cyclic::angle_table::ANGLES);
        module.add("ANGLES", columns.map(|column| column.trim_end_matches("_rad")).collect::<Vec<_>>())
    }
}
