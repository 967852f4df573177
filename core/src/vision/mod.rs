//! What a camera's lines can give without a frame buffer.

pub mod skin;
