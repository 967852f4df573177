//! Parquet files, which the feature `parquet` reads and writes.

use super::content::Cells;
use crate::cli::data_error;
use std::path::Path;

/// The rows of a manifest.
///
/// # Errors
/// This build reads no Parquet.
pub fn cells(path: &Path) -> anyhow::Result<Cells> {
    Err(data_error(format!(
        "`{}`: this program reads no Parquet; give CSV or JSON lines, use `sinew.batch` of Python, or build with \
         --features parquet",
        path.display()
    )))
}
