//! How many particles each blob gets: arm (4), (5).
//!
//! ```
//! use sinew_core::correction::allocation::allot;
//!
//! // 50 particles and three blobs, one of which is surely no hand.
//! let mut counts = [0; 3];
//! let free = allot(50, &[0.8, 0.4, 0.0], &mut counts);
//! assert_eq!(usize::from(counts[0] + counts[1]) + free, 50);
//! assert!(counts[0] > counts[1] && counts[2] == 0);
//! ```

/// Share T of the particles that ignore the blobs, arm (5); `best_likelihood` is k.
///
/// ```
/// use sinew_core::correction::allocation::free_share;
///
/// // A blob that is surely a hand leaves a tenth of the particles free, a doubtful one leaves most
/// // of them.
/// assert_eq!(free_share(0.95), 0.1);
/// assert_eq!(free_share(0.25), 0.75);
/// assert_eq!(free_share(0.0), 1.0);
/// ```
#[must_use]
pub fn free_share(best_likelihood: f32) -> f32 {
    if best_likelihood > 0.9 {
        0.1
    } else if best_likelihood > 0.0 {
        1.0 - best_likelihood
    } else {
        1.0
    }
}

/// Allots `total` particles: writes one count a blob into `counts` and returns how many ignore the
/// blobs.
///
/// `likelihoods` are p(hand | blob); those that are not above zero get nothing. Whole numbers by
/// largest remainder, so that all counts and the returned number sum to `total` (property-tested).
/// Blobs beyond `counts` get nothing.
///
/// ```
/// use sinew_core::correction::allocation::allot;
///
/// // The better blob is 40 % a hand, so 20 of 50 particles follow the blobs: two thirds of them
/// // the better one.
/// let mut counts = [0; 2];
/// assert_eq!(allot(50, &[0.4, 0.2], &mut counts), 30);
/// assert_eq!(counts, [13, 7]);
/// // No blob, no followers.
/// assert_eq!(allot(50, &[], &mut counts), 50);
/// ```
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
pub fn allot(total: usize, likelihoods: &[f32], counts: &mut [u16]) -> usize {
    counts.fill(0);
    let usable = |i: usize| likelihoods.get(i).copied().filter(|p| *p > 0.0 && p.is_finite());
    let (mut best, mut sum) = (0.0, 0.0);
    for p in (0..counts.len()).filter_map(usable) {
        sum += p;
        if p > best {
            best = p;
        }
    }
    if !(sum > 0.0) {
        return total;
    }
    let free = crate::math::round(free_share(best) * total as f32) as usize;
    let driven = total.saturating_sub(free);
    let share = |i: usize| usable(i).map_or(0.0, |p| driven as f32 * p / sum);
    let mut given = 0;
    for (i, count) in counts.iter_mut().enumerate() {
        *count = (share(i) as usize).min(driven - given) as u16;
        given += usize::from(*count);
    }
    // Rounding down leaves less than one particle a blob; each goes to the greatest remainder.
    while given < driven {
        let mut chosen = 0;
        let mut greatest = f32::NEG_INFINITY;
        for (i, count) in counts.iter().enumerate() {
            let remainder = share(i) - f32::from(*count);
            if remainder > greatest {
                (chosen, greatest) = (i, remainder);
            }
        }
        match counts.get_mut(chosen) {
            Some(count) => *count += 1,
            None => break,
        }
        given += 1;
    }
    total - given
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_counts_sum_to_the_particles(total in 0_usize..5000, likelihoods in prop::collection::vec(-0.2_f32..1.0, 0..12)) {
            let mut counts = [0_u16; 10];
            let free = allot(total, &likelihoods, &mut counts);
            let given: usize = counts.iter().map(|&c| usize::from(c)).sum();
            prop_assert_eq!(free + given, total);
            for (count, likelihood) in counts.iter().zip(&likelihoods) {
                prop_assert!(*likelihood > 0.0 || *count == 0);
            }
        }
    }

    #[test]
    fn the_paper_s_shares_come_out() {
        let mut counts = [0_u16; 2];
        assert_eq!(allot(50, &[0.95, 0.05], &mut counts), 5);
        assert_eq!(counts, [43, 2]);
        assert_eq!(allot(50, &[0.4, 0.4], &mut counts), 30);
        assert_eq!(counts, [10, 10]);
    }

    #[test]
    fn without_a_blob_all_particles_are_free() {
        assert_eq!(allot(50, &[], &mut [0; 4]), 50);
        assert_eq!(allot(50, &[0.0, f32::NAN], &mut [0; 4]), 50);
    }
}
