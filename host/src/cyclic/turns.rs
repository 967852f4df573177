//! Angles and their whole turns: unwrapping along time, and the nearest equal angle.

use std::f64::consts::{PI, TAU};

/// The difference `angle_rad` in (-pi, pi].
#[must_use]
pub fn wrapped(angle_rad: f64) -> f64 {
    let rest = angle_rad.rem_euclid(TAU);
    if rest > PI { rest - TAU } else { rest }
}

/// The angle in [-pi, pi] that differs from `angle_rad` by whole turns.
#[must_use]
pub fn least_angle(angle_rad: f64) -> f64 {
    angle_rad - TAU * nearest_integer(angle_rad / TAU)
}

/// The integer nearest to `number`: the sum has no place for a fraction. The plainest x86-64 has no
/// instruction that rounds, and a call for each angle takes longer than all else.
fn nearest_integer(number: f64) -> f64 {
    /// 1.5 times 2^52.
    const NO_FRACTION: f64 = 6_755_399_441_055_744.0;
    (number + NO_FRACTION) - NO_FRACTION
}

/// The angle equal to `angle_rad` up to whole turns that is nearest to `reference_rad`.
#[must_use]
pub fn nearest_turn(angle_rad: f64, reference_rad: f64) -> f64 {
    angle_rad - nearest_integer((angle_rad - reference_rad) / TAU) * TAU
}

/// Adds whole turns so that each angle is nearest to the one before it that is there.
pub fn unwrap_along_time<'a>(angles_rad: impl IntoIterator<Item = &'a mut Option<f64>>) {
    let mut before = None;
    for angle in angles_rad.into_iter().flatten() {
        if let Some(before) = before {
            *angle = nearest_turn(*angle, before);
        }
        before = Some(*angle);
    }
}

/// Mean of angles on the circle, each with its weight: the arithmetic mean after each was moved to
/// the turn nearest to the mean direction.
///
/// `None` where there is no angle. Where the angles cancel, the mean direction is that of the
/// first.
#[must_use]
pub fn circular_mean(weighted_rad: &[(f64, f64)]) -> Option<f64> {
    let (first, _) = *weighted_rad.first()?;
    let total: f64 = weighted_rad.iter().map(|(_, weight)| weight).sum();
    let along = |(s, c), (angle, weight): &(f64, f64)| (s + weight * angle.sin(), c + weight * angle.cos());
    let (sine, cosine) = weighted_rad.iter().fold((0.0, 0.0), along);
    let cancel = f64::hypot(sine, cosine) < 1.0e-9 * total;
    let direction = if cancel { first } else { sine.atan2(cosine) };
    let sum: f64 = weighted_rad.iter().map(|(angle, weight)| weight * wrapped(angle - direction)).sum();
    Some(direction + sum / total)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_series_is_unwrapped_over_its_gaps() {
        let mut series = [Some(3.0), None, Some(-3.0), Some(-2.0), None, Some(3.0 - TAU)];
        unwrap_along_time(&mut series);
        assert!((series[2].unwrap() - (TAU - 3.0)).abs() < 1.0e-12);
        assert!((series[3].unwrap() - (TAU - 2.0)).abs() < 1.0e-12);
        assert!((series[5].unwrap() - 3.0).abs() < 1.0e-12);
    }

    #[test]
    fn the_mean_does_not_break_at_the_seam() {
        let mean = circular_mean(&[PI - 0.1, -PI + 0.3, TAU * 3.0 - PI].map(|angle| (angle, 2.0))).unwrap();
        assert!(wrapped(mean - (PI + 0.2 / 3.0)).abs() < 1.0e-12, "{mean}");
        assert_eq!(circular_mean(&[]), None);
        assert!(circular_mean(&[(0.0, 1.0), (PI, 1.0)]).unwrap().is_finite());
    }

    proptest! {
        #[test]
        fn wrapping_changes_whole_turns_only(angle in -100.0..100.0_f64, reference in -100.0..100.0_f64) {
            let rest = wrapped(angle);
            prop_assert!(rest > -PI - 1.0e-12 && rest <= PI + 1.0e-12);
            prop_assert!((((angle - rest) / TAU).round() * TAU - (angle - rest)).abs() < 1.0e-9);
            prop_assert!((nearest_turn(angle, reference) - reference).abs() <= PI + 1.0e-9);
        }
    }
}
