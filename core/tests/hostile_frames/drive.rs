//! Drives one tracker and its twin through bursts of hostile frames.

use crate::corners::Corners;

/// Hostile frames of a tracker in the short form: ten seconds of all trackers on two busy cores.
const SHORT_FRAMES: usize = 150;
/// So many hostile frames have clean ones after each burst.
const OFTEN_FRAMES: usize = 2000;
/// Then one clean frame ends a burst, and only one burst in so many has them all.
const SELDOM: usize = 16;
/// Most hostile frames in a row.
const MAX_BURST: usize = 4;
/// Failures that a message shows.
const SHOWN: usize = 5;

/// A tracker and its twin.
pub trait Subject {
    /// Gives the tracker a hostile frame, and the twin nothing, or the frame without what is
    /// refused. Says what is wrong with state and estimate.
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String>;

    /// Gives both the same clean frame.
    fn clean(&mut self);

    /// How far apart both estimates are, in units of what is allowed.
    fn apart(&mut self) -> f32;
}

/// Hostile frames of one tracker.
fn frames() -> usize {
    let wanted = std::env::var("SINEW_HOSTILE_FRAMES").ok().and_then(|frames| frames.parse().ok());
    wanted.unwrap_or(SHORT_FRAMES)
}

/// After which hostile frames a tracker is that of its twin again.
#[derive(Clone, Copy, PartialEq)]
pub enum Recovery {
    /// After all of them.
    FromAll,
    /// After frames whose hostile numbers are refused. A number within its range that is wrong can
    /// draw all particles, or the hands of both arms, to a wrong place.
    FromRefused,
}

/// Bursts of hostile frames, each followed by `clean_frames`.
pub fn drive<S: Subject>(name: &str, clean_frames: usize, recovery: Recovery, new: impl Fn() -> S) {
    let passes: &[bool] = if recovery == Recovery::FromAll { &[false] } else { &[false, true] };
    for &only_refused in passes {
        let mut corners = Corners::new(
            name.bytes().fold(7, |sum: u64, byte| sum.wrapping_mul(31).wrapping_add(u64::from(byte))),
            only_refused,
        );
        let is_compared = only_refused || recovery == Recovery::FromAll;
        let (driven, mut failures) = bursts(frames() / passes.len(), (&mut corners, is_compared), clean_frames, &new);
        println!("{name}: {driven} hostile frames, {} failed bursts", failures.len());
        failures.truncate(SHOWN);
        assert!(failures.is_empty(), "{name}: {}", failures.join("\n"));
    }
}

/// The hostile frames driven, and what failed; a subject that failed begins anew.
fn bursts<S: Subject>(
    frames: usize,
    (corners, is_compared): (&mut Corners, bool),
    clean_frames: usize,
    new: impl Fn() -> S,
) -> (usize, Vec<String>) {
    let begin = || {
        let mut subject = new();
        (0..clean_frames).for_each(|_| subject.clean());
        subject
    };
    let (mut subject, mut driven, mut bursts, mut failures) = (begin(), 0, 0, Vec::new());
    while driven < frames {
        let mut outcome = Ok(());
        for _ in 0..=corners.below(MAX_BURST) {
            driven += 1;
            outcome = outcome.and(subject.hostile(corners));
        }
        bursts += 1;
        let has_all = is_compared && (driven < OFTEN_FRAMES || bursts % SELDOM == 0);
        (0..if has_all { clean_frames } else { 1 }).for_each(|_| subject.clean());
        let apart = if has_all { subject.apart() } else { 0.0 };
        if outcome.is_ok() && !(apart <= 1.0) {
            outcome = Err(format!("{apart} times as far apart as allowed"));
        }
        if let Err(message) = outcome {
            failures.push(format!("until hostile frame {driven}: {message}"));
            subject = begin();
        }
    }
    (driven, failures)
}

/// An error where a rule does not hold.
pub fn holds(is_so: bool, message: impl FnOnce() -> String) -> Result<(), String> {
    if is_so { Ok(()) } else { Err(message()) }
}
