//! The one list of file formats: names, endings, how a file begins, and the reader of each.
//!
//! Every dispatcher, folder filter, help text and error message takes formats from [`FORMATS`].
//! A new format is a row of that table and the file with its reader.

mod format;
mod lookup;
mod table;
mod text;

pub use format::{Format, JointReader, Kind, MarkerReader, Reader, Signature};
pub use lookup::{MEASURABLE, MOTION, endings, find, find_by_content, formats, sniff};
pub use table::FORMATS;
pub use text::{choice, described, extensions};
