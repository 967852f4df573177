//! Any motion at all: each angle walks at random, so that nothing is expected of it but to go on from where it was.

use super::AngleMeasurement;
use crate::math::{ln, min, wrap_angle};
use core::f32::consts::{PI, TAU};

/// Standard deviation of the walk, rad per square root of a second: three degrees in a sixtieth of one.
///
/// About the speed of a walker's shank. A slower walk would be a poor guess of quick motions, so that a motion of the bank were named
/// for any of them; a quicker one a poor guess of slow ones.
const WALK_STD_RAD: f32 = 0.40;
/// Greatest variance: that of an angle of which nothing is known.
const MAX_VARIANCE: f32 = PI * PI / 3.0;

/// Where each angle is, by a random walk seen in noise. `N` is a capacity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AngleWalk<const N: usize> {
    /// Mean and variance of each angle; `None` where it was never seen.
    angles: [Option<(f32, f32)>; N],
}

impl<const N: usize> Default for AngleWalk<N> {
    fn default() -> Self {
        Self { angles: [None; N] }
    }
}

impl<const N: usize> AngleWalk<N> {
    /// Goes on by `step_s` seconds and takes in the measurement; gives ln of its density given those before. An angle that is seen
    /// for the first time is uniform on the circle.
    pub(super) fn step(&mut self, measurement: &AngleMeasurement<N>, step_s: f32) -> f32 {
        let mut log_likelihood = 0.0;
        for (i, angle) in self.angles.iter_mut().enumerate() {
            let noise = measurement.std_rad()[i] * measurement.std_rad()[i];
            if let Some((_, variance)) = angle {
                *variance = min(*variance + step_s * WALK_STD_RAD * WALK_STD_RAD, MAX_VARIANCE);
            }
            let Some(seen) = measurement.angle_rad(i) else { continue };
            let Some((mean, variance)) = angle else {
                *angle = Some((seen, noise));
                log_likelihood -= ln(TAU);
                continue;
            };
            let total = *variance + noise;
            let residual = wrap_angle(seen - *mean);
            log_likelihood -= 0.5 * (residual * residual / total + ln(TAU * total));
            *mean = wrap_angle(*mean + *variance / total * residual);
            *variance *= noise / total;
        }
        log_likelihood
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn a_walk_is_likelier_than_uniform_angles_and_the_other_way_about() {
        let mut stream = Stream::new(5, 0, 0);
        let (mut smooth, mut wild) = (AngleWalk::<2>::default(), AngleWalk::<2>::default());
        let (mut sum, mut wild_sum, mut angle) = (0.0, 0.0, 3.0_f32);
        for frame in 0..500_u16 {
            angle += WALK_STD_RAD / 60.0_f32.sqrt() * stream.normal();
            let seen = angle + 0.1 * stream.normal();
            let (first, wild_seen) = (TAU * stream.uniform(), TAU * stream.uniform());
            let at = |seen: f32, other: f32| AngleMeasurement::new(&[Some(seen), Some(other)], 0.1).unwrap();
            let gain = smooth.step(&at(seen, seen), 1.0 / 60.0);
            sum += if frame > 0 { gain } else { 0.0 };
            wild_sum += wild.step(&at(first, wild_seen), 1.0 / 60.0);
        }
        // Of the stationary filter: P = (w^2 + sqrt(w^4 + 4 w^2 s^2)) / 2 before the measurement, entropy of the innovation.
        let (w2, s2) = (WALK_STD_RAD * WALK_STD_RAD / 60.0, 0.01);
        let total = 0.5 * (w2 + (w2 * w2 + 4.0 * w2 * s2).sqrt()) + s2;
        let wanted = -0.5 * (1.0 + (TAU * total).ln());
        assert!((sum / 998.0 - wanted).abs() < 0.1, "{} is not about {wanted}", sum / 998.0);
        assert!(wild_sum < -1000.0 * TAU.ln() - 1000.0, "{wild_sum}");
        assert_eq!(AngleWalk::<2>::default().step(&AngleMeasurement::nothing(), 1.0), 0.0);
    }
}
