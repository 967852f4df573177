//! What stands around a saved state: whose it is, which version, how long, and whether it is whole.
//!
//! | word | what |
//! |---|---|
//! | 0 | `SNWS` |
//! | 1 | kind (low half), version (high half) |
//! | 2 | length of all, bytes |
//! | 3 | fingerprint of what does not change (model, options): a state belongs to it |
//! | then | the state |
//! | last | CRC-32 of all words before |

use super::visitors::{Counter, Reader, Writer};
use super::{SavedState, StateVisitor};
use crate::checksum::crc32;
use core::fmt;

/// First word of a saved state.
const MAGIC: u32 = u32::from_le_bytes(*b"SNWS");
/// Version of the states; it grows whenever a state gets other numbers, which
/// `core/tests/saved_states.rs` notices.
pub const VERSION: u16 = 8;
/// Words before the state.
pub const HEADER_WORDS: usize = 4;

/// Whose state.
///
/// ```
/// use sinew_core::cyclic::events::CycleCounter;
/// use sinew_core::saved_state::{StateError, StateKind, restore, save};
///
/// // Two trackers share a flash memory; neither takes the other's state for its own.
/// let mut counter = CycleCounter::zero();
/// let mut bytes = [0; 64];
/// let length = save(StateKind::Cyclic, 7, &mut counter, &mut bytes)?;
/// assert_eq!(restore(StateKind::Arm, 7, &mut counter, &bytes[..length]), Err(StateError::Corrupt));
/// # Ok::<(), StateError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u16)]
pub enum StateKind {
    /// Of a cyclic tracker.
    Cyclic = 1,
    /// Of the tracker of one arm.
    Arm = 2,
    /// Of the trackers of both arms.
    ArmPair = 3,
    /// Of the front end: its skin table.
    Vision = 4,
    /// Of the tracker of a body.
    Body = 5,
    /// Of both hands over time.
    Hands = 6,
    /// Of a cyclic particle filter.
    CyclicParticles = 7,
}

/// Why a state was not saved, or not restored.
///
/// ```
/// use sinew_core::cyclic::events::CycleCounter;
/// use sinew_core::saved_state::{StateError, StateKind, restore, save};
///
/// let mut counter = CycleCounter::new(0.25);
/// assert_eq!(save(StateKind::Cyclic, 7, &mut counter, &mut [0; 8]), Err(StateError::Room { needed: 32 }));
/// // An empty flash memory is an ordinary case: start without a state.
/// let erased = [0xFF; 32];
/// assert_eq!(restore(StateKind::Cyclic, 7, &mut counter, &erased), Err(StateError::Corrupt));
/// assert_eq!(counter, CycleCounter::new(0.25), "as before");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StateError {
    /// So many bytes are needed.
    Room {
        /// The number of bytes.
        needed: usize,
    },
    /// The bytes are no state of this kind, were cut, or were changed.
    Corrupt,
    /// Saved by another version.
    Version,
    /// Saved with another model or other options.
    Foreign,
    /// Whole, but with a number that cannot be. What it was read into is neither the old state nor
    /// the new.
    Illegal,
}

impl fmt::Display for StateError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Room { needed } => write!(formatter, "the saved state needs {needed} bytes"),
            Self::Corrupt => write!(formatter, "the saved state is not whole; start without it"),
            Self::Version => write!(formatter, "the state was saved by another version; start without it"),
            Self::Foreign => write!(formatter, "the state was saved with another model or other options"),
            Self::Illegal => write!(formatter, "the saved state holds a number that cannot be; start without it"),
        }
    }
}

impl core::error::Error for StateError {}

/// Bytes that saving `state` takes at the moment.
///
/// ```
/// use sinew_core::particle::Weights;
/// use sinew_core::saved_state::{StateKind, save, saved_bytes};
///
/// // A page of flash: does the state fit?
/// let mut weights = Weights::<50>::uniform(50)?;
/// let needed = saved_bytes(&mut weights);
/// assert_eq!(needed, 4 * (4 + 1 + 50 + 1), "header, number of weights, weights, checksum");
/// assert_eq!(save(StateKind::Arm, 7, &mut weights, &mut [0; 256]), Ok(needed));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub fn saved_bytes(state: &mut impl SavedState) -> usize {
    let mut counter = Counter::default();
    state.visit(&mut counter);
    4 * (HEADER_WORDS + counter.words + 1)
}

const fn kind_and_version(kind: StateKind) -> u32 {
    kind as u32 | (VERSION as u32) << 16
}

/// Saves `state` into the first of `bytes` and gives their number. The state is not changed.
///
/// ```
/// use sinew_core::cyclic::events::CycleCounter;
/// use sinew_core::saved_state::{StateKind, save};
///
/// // 120 cycles were counted; the battery is taken out.
/// let mut counter = CycleCounter::zero();
/// for _ in 0..120 {
///     counter.advance(0.0, 0.1, 10.0);
/// }
/// let mut page = [0xFF; 64];
/// let length = save(StateKind::Cyclic, 7, &mut counter, &mut page)?;
/// assert_eq!(&page[..4], b"SNWS");
/// assert_eq!((length, counter.completed()), (32, 120), "the counter is as before");
/// # Ok::<(), sinew_core::saved_state::StateError>(())
/// ```
///
/// # Errors
/// [`StateError::Room`].
pub fn save(
    kind: StateKind,
    fingerprint: u32,
    state: &mut impl SavedState,
    bytes: &mut [u8],
) -> Result<usize, StateError> {
    let needed = saved_bytes(state);
    let room = StateError::Room { needed };
    let bytes = bytes.get_mut(..needed).ok_or(room)?;
    let mut writer = Writer::new(bytes.as_chunks_mut::<4>().0);
    for mut word in [MAGIC, kind_and_version(kind), needed as u32, fingerprint] {
        writer.word(&mut word);
    }
    state.visit(&mut writer);
    let mut sum = writer.sum.value();
    writer.word(&mut sum);
    if writer.is_full { Err(room) } else { Ok(needed) }
}

/// Restores `state` from `bytes`, all of them.
///
/// ```
/// use sinew_core::cyclic::events::CycleCounter;
/// use sinew_core::saved_state::{StateError, StateKind, restore, save};
///
/// let mut page = [0; 64];
/// let length = save(StateKind::Cyclic, 7, &mut CycleCounter::new(0.25), &mut page)?;
/// let mut counter = CycleCounter::zero();
/// restore(StateKind::Cyclic, 7, &mut counter, &page[..length])?;
/// assert_eq!(counter, CycleCounter::new(0.25));
/// // Flash lost a bit.
/// page[20] ^= 1;
/// assert_eq!(restore(StateKind::Cyclic, 7, &mut counter, &page[..length]), Err(StateError::Corrupt));
/// # Ok::<(), StateError>(())
/// ```
///
/// # Errors
/// All but [`StateError::Room`]; the state is as before unless it is [`StateError::Illegal`].
pub fn restore(kind: StateKind, fingerprint: u32, state: &mut impl SavedState, bytes: &[u8]) -> Result<(), StateError> {
    let (words, []) = bytes.as_chunks::<4>() else { return Err(StateError::Corrupt) };
    let ([magic, kind_then_version, length, saved_with, content @ ..], [sum]) =
        words.split_last_chunk::<1>().ok_or(StateError::Corrupt)?
    else {
        return Err(StateError::Corrupt);
    };
    let word = |bytes: &[u8; 4]| u32::from_le_bytes(*bytes);
    if word(magic) != MAGIC || word(length) as usize != bytes.len() {
        return Err(StateError::Corrupt);
    }
    let before = bytes.split_last_chunk::<4>().map_or(bytes, |(before, _)| before);
    if word(sum) != crc32(before) {
        return Err(StateError::Corrupt);
    }
    if word(kind_then_version) >> 16 != u32::from(VERSION) {
        return Err(StateError::Version);
    }
    if word(kind_then_version) != kind_and_version(kind) {
        return Err(StateError::Corrupt);
    }
    if word(saved_with) != fingerprint {
        return Err(StateError::Foreign);
    }
    let mut reader = Reader::new(content);
    state.visit(&mut reader);
    if reader.is_sound() { Ok(()) } else { Err(StateError::Illegal) }
}

#[cfg(test)]
mod tests {
    use super::super::FINITE;
    use super::*;
    use heapless::Vec;
    use proptest::prelude::*;

    #[derive(Debug, Clone, PartialEq, Default)]
    struct Sample {
        real: f32,
        flag: bool,
        long: u64,
        list: Vec<i32, 5>,
    }

    impl SavedState for Sample {
        fn visit(&mut self, visitor: &mut impl StateVisitor) {
            visitor.real(&mut self.real, &FINITE);
            visitor.flag(&mut self.flag);
            visitor.long(&mut self.long);
            visitor.length(&mut self.list, 0);
            self.list.iter_mut().for_each(|value| visitor.integer(value));
        }
    }

    fn saved(sample: &mut Sample) -> std::vec::Vec<u8> {
        let mut bytes = vec![0; 200];
        let count = save(StateKind::Arm, 7, sample, &mut bytes).unwrap();
        assert_eq!(count, saved_bytes(sample));
        assert_eq!(save(StateKind::Arm, 7, sample, &mut bytes[..count - 1]), Err(StateError::Room { needed: count }));
        bytes.truncate(count);
        bytes
    }

    proptest! {
        #[test]
        fn a_state_comes_back(real in -1.0e30_f32..1.0e30, flag: bool, long: u64, values in prop::collection::vec(any::<i32>(), 0..=5)) {
            let mut sample = Sample { real, flag, long, list: values.iter().copied().collect() };
            let bytes = saved(&mut sample);
            let mut back = Sample::default();
            prop_assert_eq!(restore(StateKind::Arm, 7, &mut back, &bytes), Ok(()));
            prop_assert_eq!(back, sample);
        }

        #[test]
        fn a_state_with_any_byte_changed_is_refused(at in 0_usize..48, by in 1_u8..=255) {
            let mut sample = Sample { real: 2.5, list: Vec::from_slice(&[1, -2]).unwrap(), ..Sample::default() };
            let mut bytes = saved(&mut sample);
            let index = at % bytes.len();
            bytes[index] ^= by;
            let mut back = Sample::default();
            prop_assert!(restore(StateKind::Arm, 7, &mut back, &bytes).is_err());
            prop_assert_eq!(back, Sample::default());
        }

        #[test]
        fn arbitrary_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..100)) {
            prop_assert!(restore(StateKind::Arm, 7, &mut Sample::default(), &bytes).is_err());
        }
    }

    #[test]
    fn each_refusal_says_why() {
        let bytes = saved(&mut Sample::default());
        let mut back = Sample::default();
        assert_eq!(restore(StateKind::Arm, 8, &mut back, &bytes), Err(StateError::Foreign));
        assert_eq!(restore(StateKind::Cyclic, 7, &mut back, &bytes), Err(StateError::Corrupt));
        let forged = |word: usize, value: u32| {
            let mut forged = bytes.clone();
            forged[4 * word..4 * word + 4].copy_from_slice(&value.to_le_bytes());
            let end = forged.len() - 4;
            let sum = crc32(&forged[..end]);
            forged[end..].copy_from_slice(&sum.to_le_bytes());
            restore(StateKind::Arm, 7, &mut Sample::default(), &forged)
        };
        assert_eq!(forged(1, 2 | 9 << 16), Err(StateError::Version));
        assert_eq!(forged(4, f32::NAN.to_bits()), Err(StateError::Illegal));
        assert_eq!(forged(5, 2), Err(StateError::Illegal));
        assert_eq!(forged(8, 6), Err(StateError::Illegal), "a list over capacity");
        assert_eq!(forged(8, 1), Err(StateError::Illegal), "words are missing");
        assert_eq!(forged(4, 1.0_f32.to_bits()), Ok(()));
    }
}
