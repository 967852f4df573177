//! Recordings of bodies that several tests are scored on; nothing was chosen on any of them.

/// The six motions of the report set, as the book's table of bodies has them.
pub const REPORT_SET: [&str; 6] = [
    "cmu-expmap/train_directing_traffic_1.txt@0-5",
    "bandai/dataset-2_wave-both-hands_normal_001.bvh@0-5",
    "cmu-walk/02/02_01.amc",
    "cmu-walk/35/35_01.amc",
    "cmu-exercise/13_29.amc@0-3.9",
    "cmu-exercise/13_29.amc@31.7-36",
];
/// Runners.
pub const RUNNERS: [&str; 3] =
    ["bandai/dataset-2_run_active_002.bvh", "bandai/dataset-2_run_exhausted_001.bvh", "cmu-expmap/train_running_3.txt"];
