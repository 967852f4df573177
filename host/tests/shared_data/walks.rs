//! Walks of people that no model was trained on, cut by `sinew cut`.

use sinew::cyclic::CutList;
use sinew::cyclic::cuts::{self, Cut};
use sinew::cyclic::cutting::{CuttingOptions, cycles};
use sinew::cyclic::recording::{RecordingOptions, angles};
use std::path::Path;

/// Walks of two sources that no model was trained on.
pub const WALKS: [&str; 8] = [
    "bandai/dataset-1_walk_feminine_001.bvh",
    "bandai/dataset-1_walk_happy_001.bvh",
    "bandai/dataset-1_walk_tired_001.bvh",
    "bandai/dataset-2_walk_elderly_001.bvh",
    "bandai/dataset-2_walk_elderly_002.bvh",
    "bandai/dataset-2_walk_normal_001.bvh",
    "bandai/dataset-2_walk_normal_002.bvh",
    "pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh",
];

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
