//! What a name of an output stands for.

use crate::error::{Result, WriteContext, bail_output};
use std::fs::{self, FileType};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The name that stands for standard output.
const STANDARD_OUTPUT: &str = "-";
/// Maximum number of links that are followed; what Linux follows.
const MAX_LINKS: usize = 40;

/// Where an output goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// A regular file, or a name that is free; links are followed.
    File(PathBuf),
    /// A FIFO, which is written through.
    Fifo(PathBuf),
    /// Standard output.
    Standard,
}

impl Target {
    /// What `path` stands for.
    ///
    /// # Errors
    /// It is a folder, a device or a socket, or links lead in a circle.
    pub fn of(path: &Path) -> Result<Self> {
        if path.as_os_str() == STANDARD_OUTPUT {
            return Ok(Self::Standard);
        }
        let kind = match fs::metadata(path) {
            Ok(facts) => facts.file_type(),
            // Whoever makes the folder above says what is wrong with it.
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
                return Ok(Self::File(followed(path)?));
            }
            Err(error) => return Err(error).writing(|| format!("output `{}` cannot be used", path.display())),
        };
        if kind.is_file() {
            return Ok(Self::File(followed(path)?));
        }
        if kind.is_dir() {
            bail_output!("output `{}` is a folder; give the name of a file", path.display());
        }
        if is_fifo(kind) {
            return Ok(Self::Fifo(path.to_path_buf()));
        }
        bail_output!("output `{}` is neither a file nor a FIFO; give a file, or - for standard output", path.display())
    }
}

#[cfg(unix)]
fn is_fifo(kind: FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&kind)
}

#[cfg(not(unix))]
fn is_fifo(_: FileType) -> bool {
    false
}

/// The path at the end of a chain of links, whose target need not exist.
fn followed(path: &Path) -> Result<PathBuf> {
    let mut place = path.to_path_buf();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&place) {
            Ok(next) => place = place.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(place),
        }
    }
    bail_output!("output `{}` is a link that leads in a circle; remove it", path.display())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_lead_to_files_that_are_there_or_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("file"), "").unwrap();
        symlink("file", at("link")).unwrap();
        symlink(at("link"), at("second")).unwrap();
        symlink("nothing", at("dangling")).unwrap();
        symlink("circle", at("circle")).unwrap();
        assert_eq!(Target::of(&at("second")).unwrap(), Target::File(at("file")));
        assert_eq!(Target::of(&at("dangling")).unwrap(), Target::File(at("nothing")));
        assert_eq!(Target::of(&at("new")).unwrap(), Target::File(at("new")));
        assert_eq!(Target::of(Path::new("-")).unwrap(), Target::Standard);
        assert!(Target::of(&at("circle")).is_err());
        assert!(Target::of(folder.path()).unwrap_err().to_string().contains("is a folder"));
    }

    #[test]
    fn a_socket_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        let _socket = std::os::unix::net::UnixListener::bind(&path).unwrap();
        let message = Target::of(&path).unwrap_err().to_string();
        assert!(message.contains("neither a file nor a FIFO"), "{message}");
    }
}
