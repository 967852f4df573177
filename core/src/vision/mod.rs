//! What a camera's lines can give without a frame buffer.

pub mod blobs;
pub mod component_scanner;
pub mod components;
pub mod distance;
pub mod edges;
pub mod ellipse;
pub mod features;
pub mod frame;
pub mod front_end;
pub mod hand_likelihood;
pub mod line_morphology;
pub mod mask;
pub mod morphology;
pub mod runs;
pub mod shape;
pub mod skin;
