//! What is wrong with a cloud's file or folder.

use super::file_size::MAX_FILE_BYTES;
use crate::registry::{Kind, extensions};
use std::path::PathBuf;

/// A cloud, or a folder of clouds, that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CloudError {
    /// The operating system refused the file or folder.
    #[error("`{}` cannot be read ({reason}); check the path", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's reason.
        reason: std::io::Error,
    },
    /// The file ending is none of those that are read.
    #[error("`{}` is no cloud of points that can be read; files that end in {} are", path.display(), extension_list())]
    UnknownKind {
        /// The file.
        path: PathBuf,
    },
    /// The file is beyond all that one frame can hold.
    #[error(
        "`{}` has {bytes} bytes, and a frame's points may have {MAX_FILE_BYTES} at most; write one file for each frame",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
    },
    /// The content breaks a rule of the format.
    #[error("`{}` is no cloud of points that can be read: {rule}; write the file again, or leave it out", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The rule, with what was found instead.
        rule: String,
    },
    /// The path is a file.
    #[error("`{}` is not a folder; give the folder that holds one file of points for each frame", .0.display())]
    NotAFolder(PathBuf),
    /// The folder holds nothing at all.
    #[error("`{}` is empty; put one file of points for each frame there ({})", .0.display(), extension_list())]
    Empty(PathBuf),
    /// The folder holds files, but no cloud.
    #[error("`{}` holds no points; files that end in {} are read, and it holds {found}", folder.display(), extension_list())]
    NoCloud {
        /// The folder.
        folder: PathBuf,
        /// What was found instead, in words.
        found: String,
    },
    /// Clouds of more than one kind.
    #[error("`{}` holds {found}; keep the frames of one run in one kind of file, and other tables elsewhere", folder.display())]
    MixedKinds {
        /// The folder.
        folder: PathBuf,
        /// How many of which, in words.
        found: String,
    },
    /// The names hold no frame number.
    #[error(
        "the names in `{}` do not number the frames: `{name}` {rule}; name the files like frame_000001.ply",
        folder.display()
    )]
    NoFrameNumber {
        /// The folder.
        folder: PathBuf,
        /// The first file that breaks the rule.
        name: String,
        /// The rule.
        rule: &'static str,
    },
}

fn extension_list() -> String {
    extensions(&[Kind::Cloud])
}
