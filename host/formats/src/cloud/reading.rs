//! Reads any cloud, by the ending of its file's name.

use super::error::CloudError;
use super::file_size::MAX_FILE_BYTES;
use super::point_cloud::PointCloud;
use crate::registry::{Kind, Reader, find};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Reads the points of one file. A file without points is an empty cloud.
///
/// # Errors
/// Names the file, the rule that it broke, and the remedy.
pub fn read(path: &Path) -> Result<PointCloud, CloudError> {
    let Some(Reader::Cloud(parser)) = find(path, &[Kind::Cloud]).map(|format| format.reader) else {
        return Err(CloudError::UnknownKind { path: path.to_path_buf() });
    };
    let unreadable = |reason| CloudError::Unreadable { path: path.to_path_buf(), reason };
    let bytes_there = std::fs::metadata(path).map_err(unreadable)?.len();
    if bytes_there > MAX_FILE_BYTES {
        return Err(CloudError::TooLarge { path: path.to_path_buf(), bytes: bytes_there });
    }
    parse(parser, &std::fs::read(path).map_err(unreadable)?)
        .map_err(|rule| CloudError::Broken { path: path.to_path_buf(), rule })
}

/// Parses the content of a file. A parser of another crate may panic on a damaged file: that is an
/// error too.
fn parse(parser: fn(&[u8]) -> Result<PointCloud, String>, bytes: &[u8]) -> Result<PointCloud, String> {
    let parsed = catch_unwind(AssertUnwindSafe(|| parser(bytes)));
    parsed.unwrap_or_else(|_| Err("it is damaged in a way that its reader does not know".to_owned()))
}
