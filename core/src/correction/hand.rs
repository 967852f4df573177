//! From a blob's centre to a hand in space (arm paper, section 3.2, whose text is incomplete).
//!
//! The predicted hand is projected on the camera's ray through the blob's centre. Around that foot
//! H1 the corrected hand is drawn: wide along the ray, since one camera does not measure depth, and
//! narrow across it.
//!
//! ```
//! use sinew_core::correction::hand::ReachableShell;
//! use sinew_core::math::Vec3;
//!
//! // What a hand can reach that is 0.35 m beyond an elbow 0.3 m beyond the shoulder.
//! let shell = ReachableShell { centre_m: Vec3::zeros(), inner_m: 0.05, outer_m: 0.65 };
//! let too_far = Vec3::new(0.0, 0.0, 2.0);
//! assert!(!shell.contains(&too_far));
//! assert!((shell.nearest(&too_far) - Vec3::new(0.0, 0.0, 0.65)).norm() < 1e-5);
//! ```

use crate::camera::Ray;
use crate::math::{Vec3, abs, clamp, length, min, sqrt, unit};
use crate::random::Stream;

/// Where the hand can be: between two spheres around the shoulder.
///
/// ```
/// use sinew_core::camera::Ray;
/// use sinew_core::correction::hand::ReachableShell;
/// use sinew_core::math::Vec3;
///
/// // A shoulder on the optical axis, a metre before the camera.
/// let shell =
///     ReachableShell { centre_m: Vec3::new(0.0, 0.0, 1.0), inner_m: 0.05, outer_m: 0.65 };
/// let ray = Ray { origin: Vec3::zeros(), direction: Vec3::z() };
/// // No hand is two metres away: it comes back along the ray that it was seen on.
/// let hand_m = shell.along_ray(&Vec3::new(0.0, 0.0, 2.0), &ray);
/// assert!((hand_m.z - 1.65).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachableShell {
    /// Shoulder, metres.
    pub centre_m: Vec3,
    /// Smallest distance, from |upper arm - forearm| or the elbow's limit; metres.
    pub inner_m: f32,
    /// Greatest distance, metres.
    pub outer_m: f32,
}

impl ReachableShell {
    /// Whether `point` lies in the shell.
    #[must_use]
    pub fn contains(&self, point: &Vec3) -> bool {
        let distance = length(&(point - self.centre_m));
        distance >= self.inner_m && distance <= self.outer_m
    }

    /// The shell's nearest point to `point`.
    #[must_use]
    pub fn nearest(&self, point: &Vec3) -> Vec3 {
        let offset = point - self.centre_m;
        let distance = length(&offset);
        let wanted = clamp(distance, self.inner_m, self.outer_m);
        match unit(offset) {
            Some(direction) => self.centre_m + direction * wanted,
            None => self.centre_m + Vec3::z() * -wanted,
        }
    }

    /// `point` if the hand can be there, else the nearest reachable point of `ray` in front of the
    /// camera. Where the ray misses the shell, it is the shell's nearest point to the ray.
    #[must_use]
    pub fn along_ray(&self, point: &Vec3, ray: &Ray) -> Vec3 {
        if self.contains(point) {
            return *point;
        }
        let wanted = (point - ray.origin).dot(&ray.direction);
        let middle = (self.centre_m - ray.origin).dot(&ray.direction);
        let foot = ray.origin + ray.direction * middle;
        let off_axis = length(&(foot - self.centre_m));
        let half = |radius: f32| sqrt(radius * radius - off_axis * off_axis);
        if off_axis >= self.outer_m {
            return self.nearest(&foot);
        }
        let outer = half(self.outer_m);
        // The stretch of the ray inside the outer sphere, less the part inside the inner one.
        let mut best = clamp(wanted, middle - outer, middle + outer);
        if off_axis < self.inner_m {
            let inner = half(self.inner_m);
            if abs(best - middle) < inner {
                best = if best < middle { middle - inner } else { middle + inner };
            }
        }
        if best < MIN_DEPTH_M {
            best = min(MIN_DEPTH_M, middle + outer);
        }
        ray.origin + ray.direction * best
    }
}

/// Smallest depth of a hand, metres.
///
/// Chosen: keeps a drawn hand in front of the camera.
pub const MIN_DEPTH_M: f32 = 0.05;

/// How a corrected hand spreads around H1.
///
/// ```
/// use sinew_core::camera::Ray;
/// use sinew_core::correction::hand::{HandSpread, log_density_on_ray};
/// use sinew_core::math::Vec3;
///
/// // One camera measures a hand well across its ray, and badly along it.
/// let spread = HandSpread { along_std_m: 0.10, across_std_m: 0.01 };
/// let ray = Ray { origin: Vec3::zeros(), direction: Vec3::z() };
/// let log_density = |x, z| {
///     log_density_on_ray(&Vec3::new(x, 0.0, z), &Vec3::new(0.0, 0.0, 0.8), &ray, &spread)
/// };
/// let (deeper, beside) = (log_density(0.0, 0.85), log_density(0.05, 0.8));
/// assert!(
///     deeper > beside + 12.0,
///     "five centimetres are little along the ray and much across"
/// );
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandSpread {
    /// Standard deviation along the ray, metres.
    pub along_std_m: f32,
    /// Standard deviation across the ray, metres at the hand's depth.
    pub across_std_m: f32,
}

/// A draw around `mean_m` (a point on the ray): normal along and across `ray`.
///
/// ```
/// use sinew_core::camera::Ray;
/// use sinew_core::correction::hand::{HandSpread, draw_on_ray};
/// use sinew_core::math::Vec3;
/// use sinew_core::random::Stream;
///
/// let ray = Ray { origin: Vec3::zeros(), direction: Vec3::z() };
/// let spread = HandSpread { along_std_m: 0.10, across_std_m: 0.01 };
/// let (mut along_m2, mut across_m2) = (0.0, 0.0);
/// for particle in 0..1000 {
///     let mut stream = Stream::new(7, 0, particle);
///     let off = draw_on_ray(&Vec3::new(0.0, 0.0, 0.8), &ray, &spread, &mut stream)
///         - Vec3::new(0.0, 0.0, 0.8);
///     along_m2 += off.z * off.z / 1000.0;
///     across_m2 += off.x * off.x / 1000.0;
/// }
/// assert!((along_m2 / 0.0100 - 1.0).abs() < 0.15 && (across_m2 / 0.0001 - 1.0).abs() < 0.15);
/// ```
#[must_use]
pub fn draw_on_ray(mean_m: &Vec3, ray: &Ray, spread: &HandSpread, stream: &mut Stream) -> Vec3 {
    let noise = stream.normal3();
    let along = ray.direction * noise.dot(&ray.direction);
    let across = noise - along;
    mean_m + along * spread.along_std_m + across * spread.across_std_m
}

/// ln density of [`draw_on_ray`] at `point`, per cubic metre.
///
/// ```
/// use sinew_core::camera::Ray;
/// use sinew_core::correction::hand::{HandSpread, log_density_on_ray};
/// use sinew_core::math::Vec3;
///
/// let ray = Ray { origin: Vec3::zeros(), direction: Vec3::z() };
/// let spread = HandSpread { along_std_m: 0.10, across_std_m: 0.01 };
/// let mean_m = Vec3::new(0.0, 0.0, 0.8);
/// let at = |point_m: Vec3| log_density_on_ray(&point_m, &mean_m, &ray, &spread);
/// // One standard deviation in any direction costs a half.
/// assert!((at(mean_m) - at(mean_m + Vec3::new(0.0, 0.0, 0.10)) - 0.5).abs() < 1e-4);
/// assert!((at(mean_m) - at(mean_m + Vec3::new(0.0, 0.01, 0.0)) - 0.5).abs() < 1e-4);
/// ```
#[must_use]
pub fn log_density_on_ray(point: &Vec3, mean_m: &Vec3, ray: &Ray, spread: &HandSpread) -> f32 {
    use crate::math::ln;
    use crate::random::normal::LOG_SQRT_TAU;
    let offset = point - mean_m;
    let along = offset.dot(&ray.direction);
    let across = crate::math::max(offset.dot(&offset) - along * along, 0.0);
    -0.5 * (along * along / (spread.along_std_m * spread.along_std_m)
        + across / (spread.across_std_m * spread.across_std_m))
        - ln(spread.along_std_m)
        - 2.0 * ln(spread.across_std_m)
        - 3.0 * LOG_SQRT_TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Pixel};
    use proptest::prelude::*;

    const SHELL: ReachableShell = ReachableShell { centre_m: Vec3::new(0.2, -0.1, 1.2), inner_m: 0.2, outer_m: 0.65 };

    proptest! {
        #[test]
        fn a_corrected_hand_is_reachable_and_on_the_ray_where_the_ray_allows(
            u in 0.0_f32..640.0, v in 0.0_f32..480.0, depth in 0.05_f32..3.0,
        ) {
            let camera = Camera::from_field_of_view(640, 480, 1.05).unwrap();
            let ray = camera.back_project(Pixel::new(u, v));
            let hand = SHELL.along_ray(&(ray.direction * depth), &ray);
            let distance = (hand - SHELL.centre_m).norm();
            prop_assert!(distance > SHELL.inner_m - 1.0e-4 && distance < SHELL.outer_m + 1.0e-4);
            let middle = SHELL.centre_m.dot(&ray.direction);
            if (ray.direction * middle - SHELL.centre_m).norm() < SHELL.outer_m {
                prop_assert!((ray.project(&hand) - hand).norm() < 1.0e-4, "the hand left the ray");
            }
        }
    }

    #[test]
    fn the_nearest_reachable_point_of_the_ray_is_taken() {
        let ray = Ray { origin: Vec3::zeros(), direction: Vec3::z() };
        let shell = ReachableShell { centre_m: Vec3::new(0.0, 0.0, 1.0), inner_m: 0.1, outer_m: 0.5 };
        assert!((shell.along_ray(&Vec3::new(0.0, 0.0, 0.2), &ray).z - 0.5).abs() < 1.0e-6);
        assert!((shell.along_ray(&Vec3::new(0.0, 0.0, 2.0), &ray).z - 1.5).abs() < 1.0e-6);
        assert!((shell.along_ray(&Vec3::new(0.0, 0.0, 1.02), &ray).z - 1.1).abs() < 1.0e-6);
        let aside = Ray { origin: Vec3::zeros(), direction: Vec3::x() };
        assert!((shell.along_ray(&Vec3::x(), &aside) - Vec3::new(0.0, 0.0, 0.5)).norm() < 1.0e-6);
    }

    #[test]
    fn draws_follow_their_density() {
        let ray = Ray { origin: Vec3::zeros(), direction: unit(Vec3::new(0.3, -0.2, 1.0)).unwrap() };
        let spread = HandSpread { along_std_m: 0.1, across_std_m: 0.02 };
        let mean = ray.direction * 0.8;
        let mut stream = Stream::new(6, 0, 0);
        let n = 40_000_u16;
        let (mut entropy, mut along) = (0.0_f64, 0.0_f64);
        for _ in 0..n {
            let hand = draw_on_ray(&mean, &ray, &spread, &mut stream);
            entropy -= f64::from(log_density_on_ray(&hand, &mean, &ray, &spread));
            along += f64::from((hand - mean).dot(&ray.direction)).powi(2);
        }
        // Entropy of a normal in three dimensions: 3/2 (1 + ln 2 pi) + ln of the product of
        // standard deviations.
        let exact = 1.5 * (1.0 + std::f64::consts::TAU.ln()) + (0.1_f64 * 0.02 * 0.02).ln();
        assert!((entropy / f64::from(n) - exact).abs() < 0.025);
        assert!(((along / f64::from(n)).sqrt() - 0.1).abs() < 0.002);
    }
}
