//! Folds for cross-validation, drawn from a seed.

use sinew_core::random::Stream;

/// Assigns each of `count` items to one of `folds` folds of nearly equal size, in an order drawn
/// from `seed`.
#[must_use]
pub fn assign(count: usize, folds: usize, seed: u64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    let mut stream = Stream::new(seed, 0, 0);
    for last in (1..count).rev() {
        let other = stream.below(u32::try_from(last + 1).unwrap_or(u32::MAX)) as usize;
        order.swap(last, other);
    }
    let mut fold_of = vec![0; count];
    for (place, item) in order.into_iter().enumerate() {
        fold_of[item] = place % folds.max(1);
    }
    fold_of
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folds_are_balanced_seeded_and_shuffled() {
        let folds = assign(103, 5, 7);
        assert_eq!(folds, assign(103, 5, 7));
        assert_ne!(folds, assign(103, 5, 8));
        for fold in 0..5 {
            let size = folds.iter().filter(|&&f| f == fold).count();
            assert!((20..=21).contains(&size), "{size}");
        }
        assert!(folds.iter().enumerate().any(|(i, &fold)| fold != i % 5));
    }
}
