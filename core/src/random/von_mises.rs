//! Draws from the von Mises distribution, the normal distribution's counterpart on the circle.

use super::Stream;
use crate::math::{acos, sqrt, wrap_angle};
use core::f32::consts::PI;

/// Rejection tries before the last proposal is taken as it is. The acceptance rate is at least
/// 0.65, so that happens less than once in 10^14 draws.
pub const MAX_TRIES: usize = 32;

impl Stream {
    /// A draw from the von Mises distribution with mean direction `mean_rad` and concentration
    /// kappa, in (-pi, pi].
    ///
    /// Best and Fisher (1979) with a bounded number of tries. A `concentration` of zero or less, or
    /// NaN, gives the uniform distribution; above 10^5 the wrapped normal with variance 1 /
    /// kappa is used.
    pub fn von_mises(&mut self, mean_rad: f32, concentration: f32) -> f32 {
        if !(concentration > 1.0e-6) {
            return wrap_angle(PI * (2.0 * self.uniform() - 1.0));
        }
        if concentration > 1.0e5 {
            return wrap_angle(mean_rad + self.normal() / sqrt(concentration));
        }
        let kappa = concentration;
        let tau = 1.0 + sqrt(1.0 + 4.0 * kappa * kappa);
        let rho = (tau - sqrt(2.0 * tau)) / (2.0 * kappa);
        let r = if kappa < 1.0e-3 { 1.0 / kappa } else { (1.0 + rho * rho) / (2.0 * rho) };
        let mut cosine = 1.0;
        for _ in 0..MAX_TRIES {
            let z = crate::math::sin_cos(PI * self.uniform()).1;
            cosine = (1.0 + r * z) / (r + z);
            let c = kappa * (r - cosine);
            let u = self.open_uniform();
            if c * (2.0 - c) - u > 0.0 || crate::math::ln(c / u) + 1.0 - c >= 0.0 {
                break;
            }
        }
        let offset = acos(cosine);
        wrap_angle(if self.bits() & 1 == 0 { mean_rad + offset } else { mean_rad - offset })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean resultant length I1(kappa) / I0(kappa) by numeric integration.
    fn resultant(kappa: f64) -> f64 {
        let steps = 20_000;
        let (mut top, mut bottom) = (0.0, 0.0);
        for i in 0..steps {
            let angle = std::f64::consts::PI * (f64::from(i) + 0.5) / f64::from(steps);
            let density = (kappa * (angle.cos() - 1.0)).exp();
            top += density * angle.cos();
            bottom += density;
        }
        top / bottom
    }

    #[test]
    fn draws_have_the_mean_direction_and_the_resultant_length() {
        for (case, kappa) in [0.0_f32, 0.0005, 0.3, 2.0, 30.0, 500.0, 2.0e5].into_iter().enumerate() {
            let n = 100_000_u32;
            let mut stream = Stream::new(31, case as u64, 0);
            let (mut cosine, mut sine) = (0.0_f64, 0.0_f64);
            for _ in 0..n {
                let offset = f64::from(stream.von_mises(2.5, kappa)) - 2.5;
                cosine += offset.cos();
                sine += offset.sin();
            }
            let (cosine, sine) = (cosine / f64::from(n), sine / f64::from(n));
            let exact = resultant(f64::from(kappa));
            let tolerance = 4.0 / f64::from(n).sqrt() * (1.0 - exact * exact).sqrt().max(0.003);
            assert!((cosine - exact).abs() < tolerance, "kappa {kappa}: {cosine} instead of {exact}");
            assert!(sine.abs() < tolerance, "kappa {kappa}: direction off by {sine}");
        }
    }
}
