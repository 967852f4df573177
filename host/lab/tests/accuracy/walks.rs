//! Walks of people that no model was trained on.

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
