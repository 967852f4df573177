//! Goal processes: where an end-effector wants to be next.

use crate::math::{Vec3, sqrt};
use crate::random::Stream;

/// A stochastic process of one end-effector's goal. Users may write their own.
pub trait GoalProcess {
    /// Draws the next goal, metres, from the place that was `reached_m`, `dt_s` seconds later.
    fn draw(&self, reached_m: &Vec3, velocity_m_per_s: &Vec3, dt_s: f32, stream: &mut Stream) -> Vec3;

    /// Mean of the draw.
    fn mean(&self, reached_m: &Vec3, velocity_m_per_s: &Vec3, dt_s: f32) -> Vec3;

    /// Standard deviation of the draw along each axis, metres.
    fn std_m(&self, dt_s: f32) -> f32;
}

/// Linear extrapolation (PIK paper, eq. 33) of the reached place, with a velocity that fades and white noise.
///
/// The velocity is that of the filter's estimate, not of the particle: DESIGN.md section 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearExtrapolation {
    /// Share of the velocity that goes on, in [0, 1]; 1 is the paper's.
    pub persistence: f32,
    /// Standard deviation along each axis after one second, metres; it grows with the root of time.
    pub std_m_per_sqrt_s: f32,
}

impl GoalProcess for LinearExtrapolation {
    fn draw(&self, reached_m: &Vec3, velocity_m_per_s: &Vec3, dt_s: f32, stream: &mut Stream) -> Vec3 {
        self.mean(reached_m, velocity_m_per_s, dt_s) + stream.normal3() * self.std_m(dt_s)
    }

    fn mean(&self, reached_m: &Vec3, velocity_m_per_s: &Vec3, dt_s: f32) -> Vec3 {
        reached_m + velocity_m_per_s * (self.persistence * dt_s)
    }

    fn std_m(&self, dt_s: f32) -> f32 {
        self.std_m_per_sqrt_s * sqrt(dt_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_have_the_stated_mean_and_spread() {
        let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
        let velocity = Vec3::new(1.0, 0.0, 0.0);
        let mut stream = Stream::new(4, 0, 0);
        let n = 20_000_u16;
        let (mut sum, mut square) = (Vec3::zeros(), 0.0);
        for _ in 0..n {
            let miss = process.draw(&Vec3::z(), &velocity, 0.25, &mut stream) - Vec3::new(0.125, 0.0, 1.0);
            sum += miss;
            square += miss.norm_squared();
        }
        let n = f32::from(n);
        assert!((sum / n).norm() < 4.0 * 0.1 * 3.0_f32.sqrt() / n.sqrt());
        assert!((square / n / 3.0 / 0.01 - 1.0).abs() < 0.03);
    }
}
