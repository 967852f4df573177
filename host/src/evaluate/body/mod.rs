//! The PIK paper's experiments on simulated stereo views of real motion (section 7).

pub mod trial;
