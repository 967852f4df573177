//! State that outlives a loss of power: saved as bytes with a version and a checksum, checked whole
//! before it is used again.
//!
//! A type says once, in [`SavedState::visit`], which numbers it consists of and what range each
//! has. Writing, counting, reading and checking are visitors of that one list, so they cannot
//! disagree. All is little-endian words of four bytes; a state saved on one processor is read by
//! any other.
//!
//! ```
//! use sinew_core::cyclic::events::CycleCounter;
//! use sinew_core::saved_state::{StateError, StateKind, restore, save};
//!
//! let mut counter = CycleCounter::new(0.9);
//! counter.advance(0.1, 0.2, 1.0);
//! let fingerprint = 7; // of the model and the options that the state belongs to
//! let mut bytes = [0; 64];
//! let length = save(StateKind::Cyclic, fingerprint, &mut counter, &mut bytes)?;
//!
//! let mut again = CycleCounter::zero();
//! restore(StateKind::Cyclic, fingerprint, &mut again, &bytes[..length])?;
//! assert_eq!(again, counter);
//!
//! // Another model refuses it.
//! let foreign = restore(StateKind::Cyclic, 8, &mut again, &bytes[..length]);
//! assert_eq!(foreign, Err(StateError::Foreign));
//! # Ok::<(), StateError>(())
//! ```

mod envelope;
mod visitors;

pub use envelope::{HEADER_WORDS, StateError, StateKind, VERSION, restore, save, saved_bytes};

use core::ops::RangeInclusive;
use heapless::Vec;

/// Any finite number.
pub const FINITE: RangeInclusive<f32> = f32::MIN..=f32::MAX;
/// Zero or more, finite.
pub const NOT_NEGATIVE: RangeInclusive<f32> = 0.0..=f32::MAX;

/// What has a state to save.
///
/// ```
/// use sinew_core::saved_state::{NOT_NEGATIVE, SavedState, StateKind, StateVisitor, restore, save};
///
/// /// What an application keeps beside a tracker.
/// #[derive(Debug, PartialEq)]
/// struct Exercise {
///     repetitions: u64,
///     reach_m: f32,
/// }
///
/// impl SavedState for Exercise {
///     fn visit(&mut self, visitor: &mut impl StateVisitor) {
///         visitor.long(&mut self.repetitions);
///         visitor.real(&mut self.reach_m, &NOT_NEGATIVE);
///     }
/// }
///
/// let mut bytes = [0; 64];
/// let length = save(StateKind::Arm, 7, &mut Exercise { repetitions: 12, reach_m: 0.4 }, &mut bytes)?;
/// let mut again = Exercise { repetitions: 0, reach_m: 0.0 };
/// restore(StateKind::Arm, 7, &mut again, &bytes[..length])?;
/// assert_eq!(again, Exercise { repetitions: 12, reach_m: 0.4 });
/// // The ranges also serve a self-test.
/// assert!(again.is_finite());
/// assert!(!Exercise { repetitions: 0, reach_m: f32::NAN }.is_finite());
/// # Ok::<(), sinew_core::saved_state::StateError>(())
/// ```
pub trait SavedState {
    /// Shows all numbers of the state, always in the same order.
    ///
    /// A reader replaces them as it goes, so a state that is refused half way is left mixed.
    fn visit(&mut self, visitor: &mut impl StateVisitor);

    /// Whether every number lies within its range, as [`restore`] asks. NaN and infinity never do.
    ///
    /// Each step of a tracker keeps this, whatever its frame holds. Nothing is changed.
    fn is_finite(&mut self) -> bool
    where
        Self: Sized,
    {
        let mut check = RangeCheck::default();
        self.visit(&mut check);
        !check.is_refused
    }
}

/// Goes through the numbers of a state.
///
/// ```
/// use sinew_core::checksum::Crc32;
/// use sinew_core::cyclic::events::CycleCounter;
/// use sinew_core::saved_state::{SavedState, StateVisitor};
///
/// /// Sums up a state: two machines compare theirs by one number.
/// struct Sum(Crc32);
///
/// impl StateVisitor for Sum {
///     fn word(&mut self, word: &mut u32) {
///         self.0 = self.0.and_word(*word);
///     }
///
///     fn refuse(&mut self) {}
/// }
///
/// let sum = |mut counter: CycleCounter| {
///     let mut sum = Sum(Crc32::new());
///     counter.visit(&mut sum);
///     sum.0.value()
/// };
/// assert_eq!(sum(CycleCounter::new(0.25)), sum(CycleCounter::new(1.25)));
/// assert_ne!(sum(CycleCounter::new(0.25)), sum(CycleCounter::new(0.26)));
/// ```
pub trait StateVisitor {
    /// One word; a reader replaces it.
    fn word(&mut self, word: &mut u32);

    /// Says that a number cannot be: the state is refused.
    fn refuse(&mut self);

    /// How many words can still be read. A list of any length compares its length with it before
    /// it takes memory.
    fn words_left(&self) -> usize {
        usize::MAX
    }

    /// A number within `range`.
    fn real(&mut self, value: &mut f32, range: &RangeInclusive<f32>) {
        let mut bits = value.to_bits();
        self.word(&mut bits);
        *value = f32::from_bits(bits);
        if !range.contains(value) {
            self.refuse();
        }
    }

    /// Numbers within `range`.
    fn reals(&mut self, values: &mut [f32], range: &RangeInclusive<f32>) {
        for value in values {
            self.real(value, range);
        }
    }

    /// A whole number.
    fn integer(&mut self, value: &mut i32) {
        let mut word = value.cast_unsigned();
        self.word(&mut word);
        *value = word.cast_signed();
    }

    /// A whole number in two words.
    fn long(&mut self, value: &mut u64) {
        let (mut low, mut high) = (*value as u32, (*value >> 32) as u32);
        self.word(&mut low);
        self.word(&mut high);
        *value = u64::from(high) << 32 | u64::from(low);
    }

    /// A whole number that may be missing, in three words.
    fn optional_long(&mut self, value: &mut Option<u64>) {
        let (mut is_there, mut number) = (value.is_some(), value.unwrap_or_default());
        self.flag(&mut is_there);
        self.long(&mut number);
        *value = is_there.then_some(number);
    }

    /// Yes or no.
    fn flag(&mut self, value: &mut bool) {
        let mut word = u32::from(*value);
        self.word(&mut word);
        *value = word == 1;
        if word > 1 {
            self.refuse();
        }
    }

    /// A number from 0 to `most`.
    fn index(&mut self, value: &mut usize, most: usize) {
        let mut word = *value as u32;
        self.word(&mut word);
        *value = word as usize;
        if *value > most {
            *value = 0;
            self.refuse();
        }
    }

    /// The length of `list`, which a reader fills up with `fill` or cuts; its elements are to be
    /// shown after.
    fn length<T: Clone, const CAPACITY: usize>(&mut self, list: &mut Vec<T, CAPACITY>, fill: T) {
        let mut len = list.len();
        self.index(&mut len, CAPACITY);
        // It is not more than fits.
        let _ = list.resize(len, fill);
    }
}

/// Checks the numbers of a state.
#[derive(Debug, Default)]
struct RangeCheck {
    /// Whether a number lies outside of its range.
    is_refused: bool,
}

impl StateVisitor for RangeCheck {
    fn word(&mut self, _: &mut u32) {}

    fn refuse(&mut self) {
        self.is_refused = true;
    }
}
