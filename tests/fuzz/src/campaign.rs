//! Many executions of one target.

use crate::Target;
use crate::execution::{Execution, Failure, execute};
use crate::keeping::{Progress, keep};
use crate::mutation::input;
use crate::shrinking::shrunk;
use std::io;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Different failures of a target that are kept.
const MAX_KEPT: usize = 10;

/// When a target has had enough.
#[derive(Debug, Clone, Copy)]
pub enum Amount {
    /// After so many executions.
    Executions(u64),
    /// After this time.
    Time(Duration),
}

/// What came of the executions.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    /// How many there were.
    pub executions: u64,
    /// How many failed.
    pub crashes: u64,
    /// The longest time.
    pub slowest: Duration,
    /// The largest memory, bytes.
    pub peak_bytes: usize,
    /// Different failures, each with its shortened input's file.
    pub failures: Vec<(Failure, PathBuf)>,
}

/// Runs `target` on the inputs that `seed` gives.
///
/// # Errors
/// A file beside the failures cannot be written.
pub fn run(target: &Target, amount: Amount, seed: u64) -> io::Result<Outcome> {
    let inputs = Inputs::new(target, seed);
    let mut progress = Progress::begin(target.name)?;
    let (start, mut outcome) = (Instant::now(), Outcome::default());
    while match amount {
        Amount::Executions(most) => outcome.executions < most,
        // All seeds are run at least.
        Amount::Time(time) => outcome.executions < inputs.seeds.len() as u64 || start.elapsed() < time,
    } {
        let input = inputs.input(outcome.executions);
        progress.before(outcome.executions, &input)?;
        let execution = execute(target, &input);
        outcome.add(target, &input, execution)?;
    }
    progress.end()?;
    Ok(outcome)
}

/// The inputs that a seed gives to a target.
#[derive(Debug, Clone)]
pub struct Inputs {
    seeds: Vec<Vec<u8>>,
    seed: u64,
}

impl Inputs {
    /// The inputs of `target`.
    #[must_use]
    pub fn new(target: &Target, seed: u64) -> Self {
        let name = u64::from(sinew_core::checksum::crc32(target.name.as_bytes()));
        Self { seeds: (target.seeds)(), seed: seed ^ name << 32 }
    }

    /// Input `number`.
    #[must_use]
    pub fn input(&self, number: u64) -> Vec<u8> {
        input(&self.seeds, self.seed, number)
    }
}

impl Outcome {
    fn add(&mut self, target: &Target, input: &[u8], execution: Execution) -> io::Result<()> {
        self.executions += 1;
        self.slowest = self.slowest.max(execution.time);
        self.peak_bytes = self.peak_bytes.max(execution.peak_bytes);
        let Some(failure) = execution.failure else { return Ok(()) };
        self.crashes += 1;
        if self.failures.len() < MAX_KEPT && !self.failures.iter().any(|(known, _)| known.is_like(&failure)) {
            let path = keep(target.name, &shrunk(target, input, &failure))?;
            self.failures.push((failure, path));
        }
        Ok(())
    }
}
