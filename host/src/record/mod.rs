//! Recorded input for firmware: what the trackers of a run were given, bit for bit (see [`sinew_core::record`]).

mod cyclic;
mod run_dir;
mod stream_writer;

pub use cyclic::cyclic_stream;
pub use run_dir::{Recorded, record};
pub use stream_writer::StreamWriter;
