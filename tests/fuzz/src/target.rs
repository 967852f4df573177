//! One target.

use std::fmt;

/// Code that has to take any bytes.
#[derive(Clone, Copy)]
pub struct Target {
    /// Its name on the command line and of its folder of regressions.
    pub name: &'static str,
    /// Gives the code the bytes; panics where a rule does not hold.
    pub run: fn(&[u8]),
    /// Small valid input, at least one.
    pub seeds: fn() -> Vec<Vec<u8>>,
}

impl fmt::Debug for Target {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Target").field("name", &self.name).finish_non_exhaustive()
    }
}
