//! The walking model: 53 cycles of eight people, each also with its sides exchanged. The same
//! numbers as the host's shipped model of that name.

use crate::cyclic::model::coupled_table::HumanCoupledTable;
use crate::cyclic::model::table::HumanModelTable;

/// The model in the form of [`crate::cyclic::model::bytes`].
static BYTES: &[u8] = include_bytes!("walking.sinewmodel");

/// What to do where the bytes are of another version.
const REMEDY: &str =
    "walking.sinewmodel has to be made again: SINEW_REGENERATE=1 cargo test -p sinew --test library walking_model";

/// The walking model for all filters, 52 KB.
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
    Err(_) => panic!("{}", REMEDY),
};

/// The walking model for the phase-coupled filter, 5.5 KB.
///
/// ```
/// use sinew_core::cyclic::model::walking::{WALKING, WALKING_COUPLED};
///
/// // The same numbers, of which the other filters' part is left out.
/// assert_eq!(WALKING_COUPLED.model()?, *WALKING.model()?);
/// assert!(size_of_val(&WALKING_COUPLED) * 9 < size_of_val(&WALKING));
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
pub static WALKING_COUPLED: HumanCoupledTable = match HumanCoupledTable::from_bytes(BYTES) {
    Ok(table) => table,
    Err(_) => panic!("{}", REMEDY),
};
