//! The three ways of going through a state.

use super::StateVisitor;
use crate::checksum::Crc32;

/// Counts the words of a state.
#[derive(Debug, Default)]
pub(super) struct Counter {
    /// Words so far.
    pub(super) words: usize,
}

impl StateVisitor for Counter {
    fn word(&mut self, _: &mut u32) {
        self.words += 1;
    }

    fn refuse(&mut self) {}
}

/// Writes the words of a state, and sums them up.
#[derive(Debug)]
pub(super) struct Writer<'a> {
    free: &'a mut [[u8; 4]],
    /// Checksum of what was written.
    pub(super) sum: Crc32,
    /// Whether a word found no room.
    pub(super) is_full: bool,
}

impl<'a> Writer<'a> {
    /// Writes into `free`.
    #[must_use]
    pub(super) const fn new(free: &'a mut [[u8; 4]]) -> Self {
        Self { free, sum: Crc32::new(), is_full: false }
    }
}

impl StateVisitor for Writer<'_> {
    fn word(&mut self, word: &mut u32) {
        if let Some((slot, rest)) = core::mem::take(&mut self.free).split_first_mut() {
            *slot = word.to_le_bytes();
            self.free = rest;
            self.sum = self.sum.and_word(*word);
        } else {
            self.is_full = true;
        }
    }

    fn refuse(&mut self) {}
}

/// Reads the words of a state.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    left: &'a [[u8; 4]],
    is_refused: bool,
}

impl<'a> Reader<'a> {
    /// Reads `left`.
    #[must_use]
    pub(super) const fn new(left: &'a [[u8; 4]]) -> Self {
        Self { left, is_refused: false }
    }

    /// Whether all words were read, none was missing and no number refused.
    #[must_use]
    pub(super) const fn is_sound(&self) -> bool {
        self.left.is_empty() && !self.is_refused
    }
}

impl StateVisitor for Reader<'_> {
    fn word(&mut self, word: &mut u32) {
        if let Some((bytes, rest)) = self.left.split_first() {
            *word = u32::from_le_bytes(*bytes);
            self.left = rest;
        } else {
            *word = 0;
            self.is_refused = true;
        }
    }

    fn refuse(&mut self) {
        self.is_refused = true;
    }

    fn words_left(&self) -> usize {
        self.left.len()
    }
}
