//! Recordings cut by `sinew cut`.

use sinew::cyclic::CutList;
use sinew::cyclic::cuts::{self, Cut};
use sinew::cyclic::cutting::{CuttingOptions, cycles};
use sinew::cyclic::recording::{RecordingOptions, angles};
use std::path::Path;

/// A cut list of the recordings in `data` whose cycles `sinew cut` finds, at least three in each.
pub fn list(data: &Path, folder: &Path, files: &[&str]) -> CutList {
    let options = RecordingOptions { rate_hz: Some(60.0), ..RecordingOptions::default() };
    let mut all: Vec<Cut> = Vec::new();
    for file in files {
        let table = angles(&data.join(file), &options).unwrap().table;
        let name = file.replace('/', "_").replace(".bvh", ".csv");
        table.write(&folder.join(&name)).unwrap();
        all.extend(cycles(&table, &name, CuttingOptions::default()).unwrap());
    }
    cuts::write(&folder.join("cuts.csv"), &all).unwrap();
    CutList::read(&folder.join("cuts.csv")).unwrap()
}
