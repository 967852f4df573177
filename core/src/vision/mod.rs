//! What a camera's lines can give without a frame buffer.

pub mod component_scanner;
pub mod components;
pub mod mask;
pub mod morphology;
pub mod runs;
pub mod skin;
