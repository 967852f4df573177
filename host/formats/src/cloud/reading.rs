//! Reads any cloud, by the ending of its file's name.

use super::error::CloudError;
use super::point_cloud::PointCloud;
use crate::file::read_bytes;
use crate::limits::MAX_FILE_BYTES;
use crate::quiet_panic::catch_quietly;
use crate::quote::with_short_quotes;
use crate::registry::{Kind, Reader, find};
use std::path::Path;

/// Reads the points of one file. A file without points is an empty cloud.
///
/// # Errors
/// Names the file, the rule that it broke, and the remedy.
pub fn read(path: &Path) -> Result<PointCloud, CloudError> {
    read_noting(path, |_| ())
}

/// As [`read`]; `note` is shown the bytes of the file first, such as for a checksum.
///
/// # Errors
/// As [`read`].
pub fn read_noting(path: &Path, note: impl FnOnce(&[u8])) -> Result<PointCloud, CloudError> {
    let Some(Reader::Cloud(parser)) = find(path, &[Kind::Cloud]).map(|format| format.reader) else {
        return Err(CloudError::UnknownKind { path: path.to_path_buf() });
    };
    read_with(path, note, parser)
}

/// Reads a file's content by `parser`.
pub(super) fn read_with(
    path: &Path,
    note: impl FnOnce(&[u8]),
    parser: impl Fn(&[u8]) -> Result<PointCloud, String>,
) -> Result<PointCloud, CloudError> {
    let bytes = read_bytes(path, MAX_FILE_BYTES).map_err(|error| CloudError::of_file(path, error))?;
    note(&bytes);
    parse(parser, &bytes).map_err(|rule| {
        let rule = with_short_quotes(&rule);
        CloudError::Broken { path: path.to_path_buf(), rule }
    })
}

/// Parses the content of a file. A parser of another crate may panic on a damaged file: that is an
/// error too.
fn parse(parser: impl Fn(&[u8]) -> Result<PointCloud, String>, bytes: &[u8]) -> Result<PointCloud, String> {
    let parsed = catch_quietly(|| parser(bytes));
    parsed.unwrap_or_else(|| Err("it is damaged in a way that its reader does not know".to_owned()))
}
