//! The contents of inputs, and the cells of a manifest.

use crate::cyclic::about::About;
use crate::error::{Context, Result};
use crate::motion::{asf, needs_skeleton};
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Each line with its number and its cells by name, or the line that is broken with its rule.
pub type Cells = Result<Vec<(usize, Vec<(String, String)>)>, (usize, String)>;

/// SHA-256 of a file, or names and contents of what is in a folder.
///
/// # Errors
/// The operating system refuses a file.
pub fn of(path: &Path) -> Result<String> {
    if path.is_dir() {
        let named = |name: String| Ok(format!("{name}\0{}\n", of(&path.join(&name))?));
        return names_in(path)?.into_iter().map(named).collect();
    }
    let mut hash = Sha256::new();
    File::open(path).and_then(|mut file| io::copy(&mut file, &mut hash)).with_context(|| cannot_read(path))?;
    Ok(format!("{:x}", hash.finalize()))
}

/// The ending of a file's name, which decides how it is read, in lower case; nothing of a folder.
pub fn ending(path: &Path) -> String {
    let ending = path.extension().filter(|_| !path.is_dir()).unwrap_or_default();
    format!(".{}\0", ending.to_string_lossy().to_ascii_lowercase())
}

/// As [`of`] the skeleton in the folder of `motion` that is read with it; nothing where none is.
///
/// # Errors
/// As [`of`].
pub fn of_skeleton_beside(motion: &Path) -> Result<String> {
    let skeleton = if needs_skeleton(motion) { asf::beside(motion).ok() } else { None };
    skeleton.map_or_else(|| Ok(String::new()), |skeleton| of(&skeleton))
}

/// As [`of`] what `sinew angles` wrote beside `table`; nothing where that is not there.
///
/// # Errors
/// As [`of`].
pub fn of_about_beside(table: &Path) -> Result<String> {
    let about = About::path_beside(table).filter(|about| about.is_file());
    about.map_or_else(|| Ok(String::new()), |about| of(&about))
}

/// Names of what is in `folder`, sorted.
///
/// # Errors
/// The operating system refuses the folder.
pub fn names_in(folder: &Path) -> Result<Vec<String>> {
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
    let name = |entry: &fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.with_context(|| cannot_read(folder))?.iter().map(name).collect();
    names.sort_unstable();
    Ok(names)
}

/// What is said of a file or folder that the operating system refuses.
pub fn cannot_read(path: &Path) -> String {
    format!("`{}` cannot be read; check the path", path.display())
}
