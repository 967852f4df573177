//! The host in place of the board: the same images' code, with input and output in memory.

use sinew_firmware_sim::port::{Port, Sink};

/// Bytes that are kept.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Kept(pub Vec<u8>);

impl Sink for Kept {
    fn write(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }
}

/// Input and output in memory; nothing costs anything.
#[derive(Debug, Clone, Default)]
pub struct HostPort<'a> {
    input: &'a [u8],
    /// The answers.
    pub results: Kept,
    /// The costs.
    pub costs: Kept,
}

impl<'a> HostPort<'a> {
    /// Plays `input`.
    #[must_use]
    pub fn new(input: &'a [u8]) -> Self {
        Self { input, ..Self::default() }
    }
}

impl<'a> Port for HostPort<'a> {
    type Input = &'a [u8];
    type Output = Kept;

    fn split(&mut self) -> (&mut &'a [u8], &mut Kept, &mut Kept) {
        (&mut self.input, &mut self.results, &mut self.costs)
    }

    fn instructions() -> u32 {
        0
    }
}
