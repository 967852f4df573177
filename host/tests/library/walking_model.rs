//! The walking model of the core, a file for flash, is the one that the command ships.

use sinew::cyclic::model::CyclicModel;
use std::path::Path;

#[test]
fn the_model_for_flash_is_the_shipped_one() {
    let shipped = CyclicModel::from_option("walking").unwrap();
    let bytes = shipped.to_bytes().unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/src/cyclic/model/walking.sinewmodel");
    if std::env::var_os("SINEW_REGENERATE").is_some() {
        std::fs::write(&path, &bytes).unwrap();
    }
    assert!(
        std::fs::read(&path).unwrap() == bytes,
        "the model was trained anew; SINEW_REGENERATE=1 cargo test -p sinew --test library walking_model"
    );
}
