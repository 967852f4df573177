//! What cannot be written as a motion.

use std::io;

/// A motion that cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The skeleton is not a tree that the format can hold.
    #[error("joint {joint} of the skeleton (`{name}`) {rule}")]
    Layout {
        /// Index of the joint.
        joint: usize,
        /// Its name.
        name: String,
        /// The rule that it broke, and the remedy.
        rule: &'static str,
    },
    /// A frame does not fit the skeleton.
    #[error("frame {frame} of the motion {rule}")]
    Frame {
        /// Index of the frame.
        frame: usize,
        /// The rule that it broke, with what was found.
        rule: String,
    },
    /// A value that was handed in cannot be used.
    #[error("`{parameter}` {rule}")]
    Parameter {
        /// Its name.
        parameter: &'static str,
        /// The rule that it broke.
        rule: String,
    },
    /// The output cannot be written.
    #[error("the motion cannot be written ({0}); check the disk's space and permissions")]
    Io(#[from] io::Error),
}
