//! Changes of bytes, whatever they stand for.

use super::repeated;
use crate::random::Random;

/// Numbers at the ends of their types.
const WORDS: [u64; 22] = [
    0,
    1,
    2,
    0x7f,
    0x80,
    0xff,
    0x100,
    0x7fff,
    0x8000,
    0xffff,
    0x1_0000,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x1_0000_0000,
    u64::MAX,
    // 1, -1, infinity, NaN, the greatest number and the smallest one of `f32`.
    0x3f80_0000,
    0xbf80_0000,
    0x7f80_0000,
    0x7fc0_0000,
    0x7f7f_ffff,
    0x0000_0001,
];
/// Most repetitions of a part.
const MAX_REPETITIONS: usize = 50;

/// Changes `input`; `other` is another valid input.
pub fn change(input: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = random.below(input.len());
    match random.below(9) {
        0 => set(input, at, |byte| byte ^ 1 << random.below(8)),
        1 => set(input, at, |_| random.bits() as u8),
        2 => set(input, at, |byte| byte.wrapping_add(random.choose(&[1, 255, 16, 240]).to_owned())),
        3 => word(input, at, random),
        4 => {
            let count = random.below(16);
            let bytes: Vec<u8> = (0..count).map(|_| random.bits() as u8).collect();
            input.splice(at..at, bytes);
        }
        5 => drop(input.drain(part(input.len(), at, random))),
        6 => {
            let copy = input[part(input.len(), at, random)].to_vec();
            let to = random.below(input.len() + 1);
            let times = if random.one_in(4) { random.below(MAX_REPETITIONS) } else { 1 };
            input.splice(to..to, repeated(&copy, times));
        }
        7 => {
            let from = random.below(other.len());
            input.truncate(at);
            input.extend_from_slice(&other[from..]);
        }
        _ => input.truncate(at),
    }
}

fn set(input: &mut [u8], at: usize, new: impl FnOnce(u8) -> u8) {
    if let Some(byte) = input.get_mut(at) {
        *byte = new(*byte);
    }
}

/// Puts a number of 1, 2, 4 or 8 bytes at `at`, in either order.
fn word(input: &mut [u8], at: usize, random: &mut Random) {
    let size = 1 << random.below(4);
    // Fields of files lie at even places.
    let at = if random.one_in(2) { at & !(size - 1) } else { at };
    let word = if random.one_in(4) { random.bits() } else { *random.choose(&WORDS) };
    let Some(place) = input.get_mut(at..at + size) else { return };
    place.copy_from_slice(&word.to_le_bytes()[..size]);
    if random.one_in(4) {
        place.reverse();
    }
}

/// A part that begins at `at`: mostly short, seldom up to the end.
fn part(len: usize, at: usize, random: &mut Random) -> std::ops::Range<usize> {
    let most = if random.one_in(4) { len } else { 32 };
    at..at + random.below(most.min(len - at) + 1)
}
