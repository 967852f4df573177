//! Runs firmware images in an emulator, decodes what they log and compares what they answer.

pub mod budget;
pub mod build;
pub mod emulator;
pub mod expected;
pub mod host_port;
pub mod inputs;
pub mod log;
pub mod run;
