//! The one error of the library: what failed, as kinds that a caller can act on.

mod context;
mod conversions;
mod error_kind;
mod macros;
#[cfg(test)]
mod tests;

pub(crate) use context::{Context, WriteContext};
pub use error_kind::ErrorKind;
pub(crate) use macros::{bail, bail_output, ensure, ensure_option};

use crate::cyclic::CyclicError;
use crate::keypoints::error::KeypointError;
use crate::resume::Interrupted;
use context::with_causes;
use sinew_core::cyclic::ModelError;
use sinew_core::error::ParameterError;
use sinew_core::saved_state::StateError;
use sinew_formats::cloud::CloudError;
use sinew_formats::images::{ImageFileError, InputError, VideoError};
use sinew_formats::motion::MotionError;
use sinew_formats::motion::export::ExportError;
use sinew_record::RecordError;
use std::fmt::Display;
use std::path::PathBuf;

/// What a function of the library returns.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a function of the library failed.
///
/// `{}` prints what failed, and [`Error::chain`] its causes too.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A rule is broken: the text names the file or value, the rule, and the remedy.
    #[error("{0}")]
    Invalid(String),
    /// An option has a value that it cannot have, or does not go with another.
    #[error("{0}")]
    Option(String),
    /// An output is nothing that results can be written to.
    #[error("{0}")]
    Output(String),
    /// A parameter of the core breaks its rule.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The numbers of a motion model break a rule.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A record for firmware cannot be made.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The saved state of a tracker cannot be used.
    #[error(transparent)]
    State(#[from] StateError),
    /// A motion cannot be read.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A motion cannot be exported.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// A cloud of points, or a folder of them, cannot be read.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// What was given for images is none.
    #[error(transparent)]
    Input(#[from] InputError),
    /// An image file cannot be read.
    #[error(transparent)]
    ImageFile(#[from] ImageFileError),
    /// A video cannot be read.
    #[error(transparent)]
    Video(#[from] VideoError),
    /// Keypoints cannot be read.
    #[error(transparent)]
    Keypoints(#[from] KeypointError),
    /// A table, cut list or model of the cyclic tracker cannot be used.
    #[error(transparent)]
    Cyclic(#[from] CyclicError),
    /// An input of a run could be listed, and the operating system refuses to read it.
    #[error("{0}; once it can be read again, the run can go on")]
    Unreadable(String),
    /// The operating system refused a file or folder.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// An image cannot be encoded or decoded.
    #[error(transparent)]
    Image(#[from] image::ImageError),
    /// A plot cannot be drawn.
    #[cfg(feature = "plots")]
    #[error(transparent)]
    Plot(#[from] conversions::PlotError),
    /// A table cannot be read or written.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// JSON cannot be read or written.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// TOML cannot be read.
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    /// A whole number cannot be read.
    #[error(transparent)]
    Number(#[from] std::num::ParseIntError),
    /// A whole number is too large for its place.
    #[error(transparent)]
    Range(#[from] std::num::TryFromIntError),
    /// The threads of a run cannot be started.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A row of a recording for the Rerun viewer cannot be made.
    #[cfg(feature = "rerun")]
    #[error(transparent)]
    ViewerRow(#[from] re_chunk::ChunkError),
    /// A recording for the Rerun viewer cannot be encoded.
    #[cfg(feature = "rerun")]
    #[error(transparent)]
    ViewerFile(#[from] re_log_encoding::EncodeError),
    /// Another process writes the same results.
    #[error("`{}` is in use by {owner}; wait until it ends, or give another --out", .output.display())]
    InUse {
        /// The folder or file.
        output: PathBuf,
        /// Command and number of the process.
        owner: String,
    },
    /// SIGINT, SIGTERM or SIGHUP ended the run.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
    /// A file or folder of results cannot be written.
    #[error(fmt = with_causes)]
    Write {
        /// What cannot be written, and the remedy.
        context: String,
        /// Why.
        source: Box<Error>,
    },
    /// A run failed midway, and its results until then are written.
    #[error("{}; {kept}", error.chain())]
    Unfinished {
        /// Why it failed.
        error: Box<Error>,
        /// How much is written, and where.
        kept: String,
    },
    /// An error with what was being done.
    #[error(fmt = with_causes)]
    Context {
        /// What was being done.
        context: String,
        /// What failed.
        source: Box<Error>,
    },
}

impl Error {
    /// A broken rule with the text of another error, which has no cause of its own.
    pub(crate) fn invalid(error: impl Display) -> Self {
        Self::Invalid(error.to_string())
    }

    /// The error and its causes, each after a colon: what the command prints.
    pub fn chain(&self) -> String {
        let mut text = self.to_string();
        let mut cause = std::error::Error::source(self);
        while let Some(error) = cause {
            text.push_str(": ");
            text.push_str(&error.to_string());
            cause = error.source();
        }
        text
    }
}
