//! Systematic resampling, and the permutation of its ordered ancestors.

use crate::random::Stream;

/// Writes the ancestors of a new generation into `ancestors`: systematic resampling with one
/// uniform number.
///
/// `weights` sum to one; `offset` lies in [0, 1). Invariants: the ancestors are in ascending order.
/// An ancestor of weight w is taken floor(n w) or ceil(n w) times. Over a uniform offset it is
/// taken n w times on average.
///
/// ```
/// use sinew_core::particle::resampling::systematic;
/// use sinew_core::random::Stream;
///
/// // The second of three particles has half of the weight, so it takes half of the places.
/// let offset = Stream::new(1, 0, u32::MAX).uniform();
/// let mut ancestors = [0; 8];
/// systematic(&[0.25, 0.5, 0.25], offset, &mut ancestors);
/// assert_eq!(ancestors, [0, 0, 1, 1, 1, 1, 2, 2]);
/// ```
pub fn systematic(weights: &[f32], offset: f32, ancestors: &mut [u16]) {
    let count = ancestors.len() as f32;
    let last = weights.len().saturating_sub(1);
    let mut index = 0;
    let mut cumulative = weights.first().copied().unwrap_or(1.0);
    for (i, ancestor) in ancestors.iter_mut().enumerate() {
        let position = (i as f32 + offset) / count;
        // Rounding may leave the last sum below one: the last ancestor takes what remains.
        while position >= cumulative && index < last {
            index += 1;
            cumulative += weights.get(index).copied().unwrap_or(0.0);
        }
        *ancestor = index as u16;
    }
}

/// Shuffles `items` (Fisher and Yates), so that the order of resampling does not decide which
/// particles follow a blob.
///
/// ```
/// use sinew_core::particle::resampling::permute;
/// use sinew_core::random::Stream;
///
/// let mut ancestors = [0, 0, 1, 1, 1, 1, 2, 2];
/// permute(&mut ancestors, &mut Stream::new(1, 0, 0));
/// assert_ne!(ancestors, [0, 0, 1, 1, 1, 1, 2, 2], "another order");
/// assert_eq!(
///     ancestors.iter().filter(|&&ancestor| ancestor == 1).count(),
///     4,
///     "of the same numbers"
/// );
/// ```
pub fn permute<T>(items: &mut [T], stream: &mut Stream) {
    for i in (1..items.len()).rev() {
        let other = stream.below(i as u32 + 1) as usize;
        let Some((last, before)) = items.get_mut(..=i).and_then(<[T]>::split_last_mut) else { continue };
        // The last itself is not before it: it stays.
        if let Some(other) = before.get_mut(other) {
            core::mem::swap(last, other);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn each_ancestor_is_taken_its_share_rounded(
            raw in prop::collection::vec(0.0_f32..1.0, 1..40),
            offset in 0.0_f32..1.0,
        ) {
            let sum: f32 = raw.iter().sum();
            prop_assume!(sum > 0.1);
            let weights: Vec<f32> = raw.iter().map(|w| w / sum).collect();
            let mut ancestors = [0_u16; 50];
            systematic(&weights, offset, &mut ancestors);
            prop_assert!(ancestors.windows(2).all(|pair| pair[0] <= pair[1]));
            for (i, w) in weights.iter().enumerate() {
                let taken = ancestors.iter().filter(|&&a| usize::from(a) == i).count() as f32;
                prop_assert!((taken - 50.0 * w).abs() < 1.001, "weight {} taken {} times", w, taken);
            }
        }
    }

    #[test]
    fn resampling_is_unbiased() {
        let weights = [0.05_f32, 0.4, 0.25, 0.3];
        let mut counts = [0.0_f64; 4];
        let runs = 20_000_u32;
        let mut stream = Stream::new(2, 0, 0);
        for _ in 0..runs {
            let mut ancestors = [0_u16; 7];
            systematic(&weights, stream.uniform(), &mut ancestors);
            for ancestor in ancestors {
                counts[usize::from(ancestor)] += 1.0;
            }
        }
        for (count, weight) in counts.iter().zip(weights) {
            let mean = count / f64::from(runs);
            let tolerance = 4.0 * 0.5 / f64::from(runs).sqrt();
            assert!((mean - 7.0 * f64::from(weight)).abs() < tolerance, "{mean} instead of {}", 7.0 * weight);
        }
    }

    #[test]
    fn every_permutation_is_equally_likely() {
        let mut counts = [0_u32; 6];
        let mut stream = Stream::new(3, 0, 0);
        for _ in 0..60_000 {
            let mut items = [0_u8, 1, 2];
            permute(&mut items, &mut stream);
            let code = usize::from(items[0]) * 2 + usize::from(items[1] > items[2]);
            counts[code] += 1;
        }
        assert!(counts.iter().all(|&count| (9_600..10_400).contains(&count)), "{counts:?}");
    }

    #[test]
    fn weights_that_do_not_reach_one_are_no_trap() {
        let mut ancestors = [0_u16; 5];
        systematic(&[0.2, 0.2], 0.99, &mut ancestors);
        assert_eq!(ancestors[4], 1);
        systematic(&[], 0.5, &mut ancestors);
        assert_eq!(ancestors, [0; 5]);
    }
}
