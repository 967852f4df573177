//! What is wrong with a cloud's file or folder.

use crate::file::FileError;
use crate::limits::MAX_FILE_BYTES;
use crate::registry::{Kind, extensions};
use std::path::{Path, PathBuf};

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
    #[error("`{}` is no cloud of points that can be read; files that end in {} are", path.display(), extension_list(Kind::Cloud))]
    UnknownKind {
        /// The file.
        path: PathBuf,
    },
    /// The file is beyond all that one frame can hold.
    #[error(
        "`{}` has more than {MAX_FILE_BYTES} bytes, the most that a frame's points may have; write one file for each frame",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// The content breaks a rule of the format.
    #[error("`{}` is no cloud of points that can be read: {rule}; write the file again, or leave it out", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The rule, with what was found instead.
        rule: String,
    },
    /// The camera of depth images is none.
    #[error("`{}` is no camera of depth images: {rule}; give one as docs/track_body.md shows", path.display())]
    Camera {
        /// The file.
        path: PathBuf,
        /// The rule, with what was found instead.
        rule: String,
    },
    /// The path is a file.
    #[error("`{}` is not a folder; give the folder that holds one file of points for each frame", .0.display())]
    NotAFolder(PathBuf),
    /// The folder holds nothing at all.
    #[error("`{}` is empty; put one file of points for each frame there ({})", folder.display(), extension_list(*kind))]
    Empty {
        /// The folder.
        folder: PathBuf,
        /// What was looked for.
        kind: Kind,
    },
    /// The folder holds files, but no cloud.
    #[error("`{}` holds no points; files that end in {} are read, and it holds {found}", folder.display(), extension_list(*kind))]
    NoCloud {
        /// The folder.
        folder: PathBuf,
        /// What was found instead, in words.
        found: String,
        /// What was looked for.
        kind: Kind,
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

impl CloudError {
    pub(crate) fn of_file(path: &Path, error: FileError) -> Self {
        let path = path.to_path_buf();
        match error {
            FileError::Io(reason) => Self::Unreadable { path, reason },
            FileError::TooLarge { .. } | FileError::LongLine { .. } => Self::TooLarge { path },
        }
    }

    /// Whether the operating system refused the file or folder, whatever its content.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Unreadable { .. })
    }
}

fn extension_list(kind: Kind) -> String {
    extensions(&[kind])
}
