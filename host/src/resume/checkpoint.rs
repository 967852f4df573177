//! When a run saves its state.

use std::time::{Duration, Instant};

/// Work that a killed run loses at most, unless an option says otherwise.
pub const DEFAULT_CHECKPOINT: Duration = Duration::from_secs(10);

/// A clock that says when a checkpoint is due. Results do not depend on it.
#[derive(Debug, Clone, Copy)]
pub struct Checkpoints {
    every: Duration,
    last: Option<Instant>,
}

impl Checkpoints {
    /// One at once, and then at least so often.
    #[must_use]
    pub fn every(every: Duration) -> Self {
        Self { every, last: None }
    }

    /// One after each such time: for work of which less is soon done again.
    #[must_use]
    pub fn after_each(every: Duration) -> Self {
        Self { every, last: Some(Instant::now()) }
    }

    /// Whether one is due, which then counts as made.
    pub fn is_due(&mut self) -> bool {
        let is_due = self.last.is_none_or(|last| last.elapsed() >= self.every);
        if is_due {
            self.last = Some(Instant::now());
        }
        is_due
    }
}

impl Default for Checkpoints {
    fn default() -> Self {
        Self::every(DEFAULT_CHECKPOINT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_is_due_at_once_and_the_next_one_later() {
        let mut hourly = Checkpoints::every(Duration::from_secs(3600));
        assert_eq!([hourly.is_due(), hourly.is_due()], [true, false]);
        assert!(!Checkpoints::after_each(Duration::from_secs(3600)).is_due());
        let mut always = Checkpoints::every(Duration::ZERO);
        assert_eq!([always.is_due(), always.is_due()], [true, true]);
    }
}
