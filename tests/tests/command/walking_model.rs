//! The walking model as a constant of the core is the one that the command ships.

use sinew::cyclic::model::CyclicModel;
use sinew_core::cyclic::model::walking::WALKING;

#[test]
fn the_constant_is_the_shipped_model() {
    assert_eq!(WALKING.model().unwrap(), CyclicModel::from_option("walking").unwrap().view());
}
