//! The walking model: ten cycles of three people, the same numbers as the host's shipped model of that name.

use crate::cyclic::model_table::HumanModelTable;

/// The model in the form of [`crate::cyclic::model_bytes`].
static BYTES: &[u8] = include_bytes!("walking.sinewmodel");

/// The walking model.
pub static WALKING: HumanModelTable = match HumanModelTable::from_bytes(BYTES) {
    Ok(table) => table,
    Err(_) => {
        panic!("walking.sinewmodel has to be made again: SINEW_REGENERATE=1 cargo test -p sinew --test walking_model")
    }
};
