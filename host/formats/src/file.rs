//! Files as bytes and as text: the one loader of all readers, with their limits.

use crate::limits::{MAX_LINE_BYTES, MAX_TEXT_BYTES};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Bytes that some programs write before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A file that cannot be read, or is beyond the limits of its kind.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The operating system refused the file.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The file has more bytes than its kind may have.
    #[error("it has more than {max_bytes} bytes, the most that is read; cut it into parts")]
    TooLarge {
        /// The limit.
        max_bytes: u64,
    },
    /// A line has more bytes than a line may have.
    #[error("a line has {bytes} bytes, and {MAX_LINE_BYTES} is the most that is read")]
    LongLine {
        /// The line, counted from 1.
        line: usize,
        /// Its length.
        bytes: usize,
    },
}

impl FileError {
    /// The line that is too long, counted from 1; 0 for what concerns the file as a whole.
    #[must_use]
    pub fn line(&self) -> usize {
        match self {
            Self::LongLine { line, .. } => *line,
            Self::Io(_) | Self::TooLarge { .. } => 0,
        }
    }
}

/// The name that stands for standard input.
pub const STANDARD_INPUT: &str = "-";

/// A file, or standard input for [`STANDARD_INPUT`], to be read bit by bit.
///
/// # Errors
/// The operating system refuses the file.
pub fn open(path: &Path) -> io::Result<Box<dyn Read>> {
    if path.as_os_str() == STANDARD_INPUT {
        return Ok(Box::new(io::stdin()));
    }
    Ok(Box::new(File::open(path)?))
}

/// Reads a file, or standard input for [`STANDARD_INPUT`], of at most `max_bytes`.
///
/// # Errors
/// The operating system refuses the file, or it has more bytes.
pub fn read_bytes(path: &Path, max_bytes: u64) -> Result<Vec<u8>, FileError> {
    let too_large = FileError::TooLarge { max_bytes };
    let mut bytes = Vec::new();
    if path.as_os_str() == STANDARD_INPUT {
        io::stdin().lock().take(max_bytes + 1).read_to_end(&mut bytes)?;
    } else {
        let file = File::open(path)?;
        if file.metadata()?.len() > max_bytes {
            return Err(too_large);
        }
        // Devices and pipes have no size.
        file.take(max_bytes + 1).read_to_end(&mut bytes)?;
    }
    if bytes.len() as u64 > max_bytes { Err(too_large) } else { Ok(bytes) }
}

/// Reads a text file of at most [`MAX_TEXT_BYTES`]. A byte order mark is dropped, and bytes that
/// are not UTF-8, as in old comments, are replaced.
///
/// # Errors
/// The operating system refuses the file, or it has more bytes.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    read_text_within(path, MAX_TEXT_BYTES)
}

/// As [`read_text`], of at most `max_bytes`.
///
/// # Errors
/// As [`read_text`].
pub fn read_text_within(path: &Path, max_bytes: u64) -> Result<String, FileError> {
    Ok(text(read_bytes(path, max_bytes)?))
}

/// As [`read_text`], for formats of lines: none has more than [`MAX_LINE_BYTES`].
///
/// # Errors
/// As [`read_text`]; or a line is longer.
pub fn read_lines(path: &Path) -> Result<String, FileError> {
    let text = read_text(path)?;
    check_lines(&text)?;
    Ok(text)
}

fn text(mut bytes: Vec<u8>) -> String {
    if bytes.starts_with(BYTE_ORDER_MARK) {
        bytes.drain(..BYTE_ORDER_MARK.len());
    }
    String::from_utf8(bytes).unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned())
}

fn check_lines(text: &str) -> Result<(), FileError> {
    let long = text.lines().enumerate().find(|(_, line)| line.len() > MAX_LINE_BYTES);
    long.map_or(Ok(()), |(index, line)| Err(FileError::LongLine { line: index + 1, bytes: line.len() }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_byte_order_mark_is_dropped_once_and_wrong_bytes_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        for (bytes, wanted) in [
            (&b"\xef\xbb\xbfab"[..], "ab"),
            (b"\xef\xbb\xbf\xef\xbb\xbfab", "\u{feff}ab"),
            (b"a\xffb", "a\u{fffd}b"),
            (b"", ""),
        ] {
            fs::write(&path, bytes).unwrap();
            assert_eq!(read_text(&path).unwrap(), wanted);
        }
    }

    #[test]
    fn what_is_beyond_the_limits_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        assert!(matches!(read_text(&path), Err(FileError::Io(_))));
        assert!(matches!(read_text(folder.path()), Err(FileError::Io(_))));
        fs::write(&path, format!("a\n{}\n", "b".repeat(MAX_LINE_BYTES + 1))).unwrap();
        assert!(read_text(&path).is_ok());
        let error = read_lines(&path).unwrap_err();
        assert_eq!((error.line(), error.to_string().contains("1048577 bytes")), (2, true));
        assert!(matches!(read_bytes(&path, 100), Err(FileError::TooLarge { max_bytes: 100 })));
        // A file with holes: nothing of it is on the disk.
        File::create(&path).unwrap().set_len(MAX_TEXT_BYTES + 1).unwrap();
        assert!(matches!(read_text(&path), Err(FileError::TooLarge { .. })));
        #[cfg(unix)]
        assert!(matches!(read_bytes(Path::new("/dev/zero"), 1000), Err(FileError::TooLarge { .. })));
    }
}
