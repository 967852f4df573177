//! Arm circles forwards of one person in two recordings, the shipped model's own.

use sinew::cyclic::recording::{RecordingOptions, angles};
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::cyclic::{AngleTable, CutList, CyclicModel};
use std::path::Path;

/// First and end frames of the circles, found by `sinew cut` in the frames of that direction, at 60
/// frames a second.
pub type Circles = &'static [(u64, u64)];

/// Each recording with its circles.
pub const FORWARDS: [(&str, Circles); 2] =
    [("13_29", &[(639, 694), (694, 752), (752, 821)]), ("13_31", &[(1031, 1074), (1074, 1124)])];

/// The angles of a recording in `data`.
pub fn table(data: &Path, trial: &str) -> AngleTable {
    let skeleton = Some(data.join("cmu-walk/35/35.asf"));
    let options = RecordingOptions { skeleton, rate_hz: Some(60.0), ..RecordingOptions::default() };
    angles(&data.join(format!("cmu-exercise/{trial}.amc")), &options).unwrap().table
}

/// Both trials as angle tables in `folder`.
pub fn write_tables(data: &Path, folder: &Path) {
    for (trial, _) in FORWARDS {
        table(data, trial).write(&folder.join(format!("{trial}.csv"))).unwrap();
    }
}

/// A model of the circles of `recordings` alone, whose tables are in `folder`.
pub fn trained(folder: &Path, recordings: &[(&str, Circles)]) -> CyclicModel {
    let lines = recordings
        .iter()
        .flat_map(|(trial, circles)| circles.iter().map(move |(first, end)| format!("{trial}.csv,{first},{end}\n")));
    let cuts: String = lines.collect();
    let list = CutList::parse(&format!("file,start_frame,end_frame\n{cuts}"), &folder.join("cuts.csv")).unwrap();
    train(&list, TrainingOptions { rate_hz: Some(60.0), ..TrainingOptions::default() }).unwrap()
}
