//! Files of the host by semihosting.

#![expect(unsafe_code, reason = "a call of the host is a breakpoint with registers set")]

use crate::port::Sink;
use cortex_m_semihosting::syscall;
use sinew_record::Source;

/// Modes of the call OPEN: `rb` and `wb`.
const READ: usize = 1;
const WRITE: usize = 5;

/// A file of the host.
#[derive(Debug)]
pub struct File {
    handle: usize,
}

/// A file to read from.
#[derive(Debug)]
pub struct InputFile(pub File);

impl File {
    /// Opens `name` in the emulator's folder.
    pub fn open(name: &str, write: bool) -> Option<Self> {
        let mut path = [0_u8; 32];
        path.get_mut(..name.len())?.copy_from_slice(name.as_bytes());
        let mode = if write { WRITE } else { READ };
        // SAFETY: the path is ended by a zero and lives until the call is answered.
        let handle = unsafe { syscall!(OPEN, path.as_ptr(), mode, name.len()) };
        (handle != usize::MAX).then_some(Self { handle })
    }

    /// Closes it; what was written is then there.
    pub fn close(self) {
        // SAFETY: the handle is one that was given.
        unsafe { syscall!(CLOSE, self.handle) };
    }
}

impl Sink for File {
    fn write(&mut self, bytes: &[u8]) {
        // SAFETY: pointer and length are those of a slice that lives until the call is answered.
        unsafe { syscall!(WRITE, self.handle, bytes.as_ptr(), bytes.len()) };
    }
}

impl Source for InputFile {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        // SAFETY: pointer and length are those of a slice without another owner. The answer is what
        // was not read.
        let left = unsafe { syscall!(READ, self.0.handle, bytes.as_mut_ptr(), bytes.len()) };
        bytes.len().saturating_sub(left)
    }
}
