//! `sinew track cyclic`: angles, phase and cadence from an angle table.

mod args;
mod motions;
mod place;
mod stream;
mod summary_line;
mod whole;

pub use args::TrackCyclicArgs;

use super::console::Console;
use super::signals::stop_flag;
use anyhow::Result;
use std::sync::atomic::AtomicBool;

/// Tracks the table, writes the estimates, prints cycles and cadence.
///
/// # Errors
/// A table or model that cannot be used, an option out of range, an output that cannot be written,
/// or [`Interrupted`](crate::resume::Interrupted).
pub fn run(args: &TrackCyclicArgs, console: &Console) -> Result<()> {
    let ended = run_until(args, console, stop_flag()?, &mut |_| ());
    if args.is_read_once() { ended } else { console.resumable(ended) }
}

/// As [`run`], ended by `stop` in the place of a signal; `notify` gets the number of finished rows.
///
/// # Errors
/// As [`run`].
pub fn run_until(
    args: &TrackCyclicArgs,
    console: &Console,
    stop: &AtomicBool,
    notify: &mut dyn FnMut(usize),
) -> Result<()> {
    let options = args.options();
    options.check()?;
    args.check()?;
    if args.is_online()? {
        stream::track(args, options, console, stop, notify)
    } else {
        whole::track(args, options, console, stop, notify)
    }
}
