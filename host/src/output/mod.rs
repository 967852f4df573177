//! Outputs that appear whole or not at all.
//!
//! A file is written under another name in the same folder, synced, and renamed. The tables of a
//! run grow for as long as it runs ([`PendingFile`]), and get their names together
//! ([`finish_all`]). Links lead to their target, FIFOs and `-` are written through ([`Target`]).

mod file;
mod folder;
mod growing;
mod lock;
mod pending;
mod target;

pub use file::{check_writable_file, write_atomically};
pub use folder::{OutputDir, Series};
pub use growing::GrowingOutput;
pub use lock::OutputLock;
pub use pending::{Mark, PendingFile, finish_all, finished_table, mark};
pub use target::Target;

/// Prefix of temporary files that live for one write.
const TEMPORARY_PREFIX: &str = ".sinew-";
/// Name of the file that says who writes into a folder; for one table with its name after it.
const LOCK_PREFIX: &str = ".sinew-lock";
