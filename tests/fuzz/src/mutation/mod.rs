//! Input made from small valid files: bytes, words, numbers and lines are changed, left out,
//! repeated and mixed.
//!
//! The input depends on the seeds, the seed of the random numbers and its own number only, so that
//! any one can be made again.

mod bytes;
mod text;

use crate::random::Random;

/// Longest input, bytes. Chosen: longer ones find the same and cost more.
pub const MAX_BYTES: usize = 1 << 16;
/// Most changes of one input.
const MAX_CHANGES: usize = 6;

/// Input `number` of `seed`, made from `seeds`; number 0 and on are the seeds as they are.
#[must_use]
pub fn input(seeds: &[Vec<u8>], seed: u64, number: u64) -> Vec<u8> {
    if let Some(whole) = usize::try_from(number).ok().and_then(|number| seeds.get(number)) {
        return whole.clone();
    }
    let mut random = Random::new(seed, number);
    let mut input = seeds.get(random.below(seeds.len())).cloned().unwrap_or_default();
    let other = seeds.get(random.below(seeds.len())).map(Vec::as_slice).unwrap_or_default();
    let is_text = std::str::from_utf8(&input).is_ok();
    // Most inputs have few changes: after many, nothing gets past the first check of a reader.
    for _ in 0..=random.below(MAX_CHANGES).min(random.below(MAX_CHANGES)) {
        if is_text && !random.one_in(4) {
            text::change(&mut input, other, &mut random);
        } else {
            bytes::change(&mut input, other, &mut random);
        }
        input.truncate(MAX_BYTES);
    }
    input
}

/// `part` so many times, as far as an input has room.
fn repeated(part: &[u8], times: usize) -> Vec<u8> {
    part.repeat(times.min(MAX_BYTES / part.len().max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn inputs_begin_with_the_seeds_and_then_differ() {
        let seeds = [b"a 1 2\nb 3 4\n".to_vec(), vec![0, 255, 3, 4, 5, 6, 7, 8, 9, 10]];
        assert_eq!([input(&seeds, 1, 0), input(&seeds, 1, 1)], seeds);
        let all: BTreeSet<Vec<u8>> = (0..1000).map(|number| input(&seeds, 1, number)).collect();
        assert!(all.len() > 800, "{}", all.len());
        assert_eq!(input(&seeds, 1, 77), input(&seeds, 1, 77));
        assert!(all.iter().all(|input| input.len() <= MAX_BYTES));
        assert!((0..100).all(|number| input(&[Vec::new()], 1, number).len() < MAX_BYTES));
    }
}
