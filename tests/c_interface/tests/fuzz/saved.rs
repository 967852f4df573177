//! Saved states, whole, changed, and forged with a right checksum.

use proptest::prelude::*;
use sinew_core::c_api::status::SinewStatus;
use sinew_core::checksum::crc32;

/// What is done to a saved state before it is restored.
#[derive(Debug, Clone)]
pub enum Damage {
    /// Nothing.
    None,
    /// Bytes that were never a state.
    Foreign(Vec<u8>),
    /// One byte changed.
    Changed { at: usize, by: u8 },
    /// Cut off.
    Cut { at: usize },
    /// A word replaced, and the checksum made anew.
    Forged { at: usize, word: u32 },
}

pub fn damage() -> impl Strategy<Value = Damage> {
    let forged_word = prop_oneof![any::<u32>(), any::<f32>().prop_map(f32::to_bits), 0_u32..100];
    prop_oneof![
        Just(Damage::None),
        prop::collection::vec(any::<u8>(), 0..64).prop_map(Damage::Foreign),
        (any::<usize>(), 1_u8..=255).prop_map(|(at, by)| Damage::Changed { at, by }),
        any::<usize>().prop_map(|at| Damage::Cut { at }),
        (any::<usize>(), forged_word).prop_map(|(at, word)| Damage::Forged { at, word }),
    ]
}

impl Damage {
    /// The state after it.
    pub fn applied(&self, state: &[u8]) -> Vec<u8> {
        let mut bytes = state.to_vec();
        match self {
            Self::None => {}
            Self::Foreign(other) => bytes.clone_from(other),
            Self::Changed { at, by } => {
                let at = at % bytes.len();
                bytes[at] ^= by;
            }
            Self::Cut { at } => bytes.truncate(at % bytes.len()),
            Self::Forged { at, word } => {
                let (words, end) = (bytes.len() / 4 - 1, bytes.len() - 4);
                let at = 4 * (at % words);
                bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
                let sum = crc32(&bytes[..end]);
                bytes[end..].copy_from_slice(&sum.to_le_bytes());
            }
        }
        bytes
    }

    /// What restoring may answer.
    pub fn allows(&self, status: SinewStatus) -> bool {
        match self {
            Self::None => status == SinewStatus::Ok,
            Self::Foreign(_) | Self::Changed { .. } | Self::Cut { .. } => status == SinewStatus::BadState,
            Self::Forged { .. } => matches!(
                status,
                SinewStatus::Ok | SinewStatus::BadState | SinewStatus::StateVersion | SinewStatus::ForeignState
            ),
        }
    }
}
