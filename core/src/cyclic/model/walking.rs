//! The walking model: 53 cycles of eight people, each also with its sides exchanged. The same
//! numbers as the host's shipped model of that name.

use crate::cyclic::model::table::HumanModelTable;

/// The model in the form of [`crate::cyclic::model::bytes`].
static BYTES: &[u8] = include_bytes!("walking.sinewmodel");

/// The walking model.
///
/// ```
/// use sinew_core::cyclic::model::walking::WALKING;
///
/// // It lies in flash; the model only borrows it. A cycle, two steps, takes a little over a second.
/// let model = WALKING.model()?;
/// let cycle_s = 1.0 / (model.mean_cycle_velocity() * model.rate_hz());
/// assert!((0.9..1.3).contains(&cycle_s));
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
pub static WALKING: HumanModelTable = match HumanModelTable::from_bytes(BYTES) {
    Ok(table) => table,
    Err(_) => {
        panic!(
            "walking.sinewmodel has to be made again: SINEW_REGENERATE=1 cargo test -p sinew --test library walking_model"
        )
    }
};
