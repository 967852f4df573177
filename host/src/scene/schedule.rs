//! When something happens: runs of frames that fill a given share of a sequence.

use sinew_core::random::Stream;

/// A whole number in `low..=high`.
fn between(stream: &mut Stream, low: usize, high: usize) -> usize {
    low + stream.below((high - low + 1) as u32) as usize
}

/// Marks `round(fraction * frames)` of `frames` frames, in runs of `shortest..=longest` frames at
/// random places.
///
/// The count is exact. Two runs may touch, and the last one may be shorter than `shortest` where
/// the count asks for it.
#[must_use]
pub fn runs(stream: &mut Stream, frames: usize, fraction: f32, shortest: usize, longest: usize) -> Vec<bool> {
    let wanted = ((fraction * frames as f32 + 0.5) as usize).min(frames);
    let mut lengths = Vec::new();
    let mut left = wanted;
    while left > 0 {
        let length = between(stream, shortest, longest).min(left);
        // What remains is either nothing or a run of full length.
        let length = if left - length < shortest && left <= longest { left } else { length };
        lengths.push(length);
        left -= length;
    }
    // The free frames are dealt out to the gaps before, between and after the runs.
    let mut gaps = vec![0_usize; lengths.len() + 1];
    let places = gaps.len() as u32;
    for _ in 0..frames - wanted {
        gaps[stream.below(places) as usize] += 1;
    }
    let mut marks = Vec::with_capacity(frames);
    for (index, gap) in gaps.into_iter().enumerate() {
        marks.resize(marks.len() + gap, false);
        marks.resize(marks.len() + lengths.get(index).copied().unwrap_or(0), true);
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_share_is_exact(seed in 0_u64..500, frames in 1_usize..400, fraction in 0.0_f32..=1.0) {
            let marks = runs(&mut Stream::new(seed, 0, 0), frames, fraction, 3, 10);
            prop_assert_eq!(marks.len(), frames);
            let marked = marks.iter().filter(|&&m| m).count();
            prop_assert!((marked as f32 - fraction * frames as f32).abs() <= 0.51);
        }
    }

    #[test]
    fn runs_are_of_the_lengths_that_were_asked_for() {
        let marks = runs(&mut Stream::new(1, 0, 0), 1000, 0.1, 3, 10);
        let lengths: Vec<usize> = marks.split(|&m| !m).map(<[bool]>::len).filter(|&n| n > 0).collect();
        assert!(lengths.len() >= 10, "100 frames in {} runs", lengths.len());
        assert!(lengths[..lengths.len() - 1].iter().all(|&n| n >= 3), "{lengths:?}");
    }
}
