//! One execution: what breaks a limit, how long it takes and how much memory it asks for.

use crate::Target;
use crate::allocation::peak_during;
use std::cell::RefCell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::sync::Once;
use std::time::{Duration, Instant};

/// Longest time of an execution.
pub const MAX_TIME: Duration = Duration::from_secs(2);
/// Largest memory of an execution, bytes.
pub const MAX_BYTES: usize = 256 << 20;
/// Executions of which the fastest counts, where one took too long: another program may have had
/// the processor.
const TRIES: usize = 3;

/// What an execution broke.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Failure {
    /// It panicked, with this message and place.
    Panic(String),
    /// It took too long.
    Slow(Duration),
    /// It asked for too many bytes.
    Memory(usize),
}

impl Failure {
    /// Whether both are of the same cause, as far as is known.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Panic(one), Self::Panic(two)) => place(one) == place(two),
            (Self::Slow(_), Self::Slow(_)) | (Self::Memory(_), Self::Memory(_)) => true,
            _ => false,
        }
    }
}

/// Where a panic was: the first line of its report.
fn place(report: &str) -> &str {
    report.lines().next().unwrap_or_default()
}

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panic(report) => write!(formatter, "panicked at {report}"),
            Self::Slow(time) => write!(formatter, "took {:.1} s", time.as_secs_f64()),
            Self::Memory(bytes) => write!(formatter, "asked for {} MB", bytes >> 20),
        }
    }
}

/// An execution that ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Execution {
    /// How long it took.
    pub time: Duration,
    /// How much memory it asked for at most, bytes; 0 where [`crate::allocation::Counting`] is not
    /// the program's allocator.
    pub peak_bytes: usize,
    /// What it broke.
    pub failure: Option<Failure>,
}

thread_local! {
    /// Place and message of the thread's last panic: targets may run side by side.
    static REPORT: RefCell<String> = const { RefCell::new(String::new()) };
}
static HOOK: Once = Once::new();

/// Runs `target` on `input`.
pub fn execute(target: &Target, input: &[u8]) -> Execution {
    let mut execution = once(target, input);
    for _ in 1..TRIES {
        if execution.time <= MAX_TIME {
            break;
        }
        let again = once(target, input);
        execution.time = execution.time.min(again.time);
    }
    if execution.failure.is_none() && execution.time > MAX_TIME {
        execution.failure = Some(Failure::Slow(execution.time));
    }
    execution
}

fn once(target: &Target, input: &[u8]) -> Execution {
    HOOK.call_once(|| {
        set_hook(Box::new(|panic| {
            let payload = panic.payload();
            let text = payload.downcast_ref::<&str>().copied();
            let message = text.or(payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
            let place = panic.location().map(ToString::to_string).unwrap_or_default();
            REPORT.set(format!("{place}\n{message}"));
        }));
    });
    let start = Instant::now();
    let (result, peak_bytes) = peak_during(|| catch_unwind(AssertUnwindSafe(|| (target.run)(input))));
    let time = start.elapsed();
    let failure = match result {
        Err(_) => Some(Failure::Panic(REPORT.take())),
        Ok(()) if peak_bytes > MAX_BYTES => Some(Failure::Memory(peak_bytes)),
        Ok(()) => None,
    };
    Execution { time, peak_bytes, failure }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_caught_with_its_place() {
        let target = Target { name: "test", run: |bytes| assert!(bytes.is_empty(), "not empty"), seeds: Vec::new };
        assert_eq!(execute(&target, &[]).failure, None);
        let failure = execute(&target, &[1]).failure.unwrap();
        assert!(failure.to_string().contains("execution.rs") && failure.to_string().contains("not empty"));
        assert!(failure.is_like(&execute(&target, &[2]).failure.unwrap()));
        assert!(!failure.is_like(&Failure::Memory(1)));
    }
}
