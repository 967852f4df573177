//! Recorded input for firmware: what the trackers of a run were given, bit for bit (see
//! [`sinew_record`]).

mod arm;
mod arm_run;
mod camera;
mod cyclic;
mod form;
mod run_dir;
mod stream_writer;

#[cfg(feature = "rerun")]
pub(crate) use arm_run::SeenFrames;
pub use camera::interleaved;
pub use cyclic::cyclic_stream;
pub use form::Form;
pub use run_dir::{Recorded, record};
pub use stream_writer::StreamWriter;
