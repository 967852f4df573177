//! How a free root moves: the same in every motion model, drawn before the pose.
//!
//! Beyond the PIK paper, whose subjects stay in place.
//!
//! ```
//! use sinew_core::pik::root::RootProcess;
//!
//! // A pelvis that goes up and down over a floor 0.9 m below the camera, four times as far as it goes aside.
//! let lift = RootProcess::pelvic_lift(0.1, 0.2, 0.9);
//! assert!((lift.std(1, 1.0) - 4.0 * lift.std(0, 1.0)).abs() < 1e-6);
//! assert_eq!(lift.shift_limits_m[1][1], 0.9);
//! assert_eq!(RootProcess::FIXED.std(0, 1.0), 0.0);
//! ```

use crate::math::{max, sqrt};
use crate::random::Stream;
use crate::skeleton::Skeleton;
use crate::skeleton::tree::{FREE_ROOT_COORDINATES, SHIFTS};

/// Linear extrapolation of shifts and angles with normal noise, inside the limits.
///
/// ```
/// use sinew_core::pik::root::{NO_PLANES, RootProcess};
/// use sinew_core::random::Stream;
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{BODY_ANGLES, full_body};
///
/// // Somebody who walks a metre a second to the left of the picture, above a floor that the hips keep 0.9 m away from.
/// let mut shift_limits_m = NO_PLANES;
/// shift_limits_m[1][1] = 0.1;
/// let walk = RootProcess { persistence: 0.5, std_per_sqrt_s: [0.1; 6], shift_limits_m };
/// let mut velocity = [0.0; BODY_ANGLES];
/// velocity[0] = -1.0;
/// let change = walk.expected_change(&velocity, 0.1);
/// assert!((change[0] + 0.05).abs() < 1e-6, "half of the velocity goes on");
/// let person = full_body(&BodyMeasures::of_height(1.75)?)?;
/// let shared = core::array::from_fn(|index| change.get(index).copied());
/// for particle in 0..100 {
///     let mut pose = [0.0; BODY_ANGLES];
///     walk.draw(&person, &mut pose, &shared, 0.1, &mut Stream::new(1, 0, particle));
///     assert!(pose[0] < 0.1 && pose[1] <= 0.1 && pose[6..] == [0.0; 24], "only the root moves");
/// }
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootProcess {
    /// Share of the filter's velocity that goes on, in [0, 1].
    pub persistence: f32,
    /// Standard deviations after one second: metres for the shifts, radians for the angles; they
    /// grow with the root of time. Zero holds a coordinate.
    pub std_per_sqrt_s: [f32; FREE_ROOT_COORDINATES],
    /// Lowest and highest first, second and third shift, metres: the ground plane; infinite where
    /// nothing is known.
    pub shift_limits_m: [[f32; 2]; SHIFTS],
}

/// No plane anywhere.
pub const NO_PLANES: [[f32; 2]; SHIFTS] = [[f32::NEG_INFINITY, f32::INFINITY]; SHIFTS];

impl RootProcess {
    /// A root that stays where it is.
    pub const FIXED: Self =
        Self { persistence: 0.0, std_per_sqrt_s: [0.0; FREE_ROOT_COORDINATES], shift_limits_m: NO_PLANES };

    /// The pelvic lift's root (PIK (39)) over a floor at `floor_y_m`, camera axes with y down. The
    /// standard deviations are `std` across and four times as much up and down, metres by root
    /// second.
    #[must_use]
    pub fn pelvic_lift(std_m_per_sqrt_s: f32, turn_std_rad_per_sqrt_s: f32, floor_y_m: f32) -> Self {
        let (s, t) = (std_m_per_sqrt_s, turn_std_rad_per_sqrt_s);
        let mut shift_limits_m = NO_PLANES;
        shift_limits_m[1][1] = floor_y_m;
        Self { persistence: 0.0, std_per_sqrt_s: [s, 4.0 * s, s, t, t, t], shift_limits_m }
    }

    /// How the root goes on without evidence of points: a share of the filter's velocity.
    #[must_use]
    pub fn expected_change<const ANGLES: usize>(
        &self,
        velocity_per_s: &[f32; ANGLES],
        dt_s: f32,
    ) -> [f32; FREE_ROOT_COORDINATES] {
        let mut change = [0.0; FREE_ROOT_COORDINATES];
        for (index, (slot, velocity)) in change.iter_mut().zip(velocity_per_s).enumerate() {
            if self.std(index, dt_s) > 0.0 {
                *slot = self.persistence * velocity * dt_s;
            }
        }
        change
    }

    /// Standard deviation of coordinate `index` after `dt_s`.
    #[must_use]
    pub fn std(&self, index: usize, dt_s: f32) -> f32 {
        self.std_per_sqrt_s.get(index).map_or(0.0, |std| std * sqrt(max(dt_s, 0.0)))
    }

    /// Draws the root's coordinates, the first of `angles_rad`, in place; `change` is what
    /// coordinates are expected to change by.
    pub fn draw<const BONES: usize, const ANGLES: usize>(
        &self,
        skeleton: &Skeleton<BONES, ANGLES>,
        angles_rad: &mut [f32; ANGLES],
        change: &[Option<f32>; ANGLES],
        dt_s: f32,
        stream: &mut Stream,
    ) {
        for index in 0..skeleton.root_coordinates() {
            let std = self.std(index, dt_s);
            let mean = angles_rad[index] + change.get(index).copied().flatten().unwrap_or(0.0);
            let (low, high) = self.limits(skeleton, index);
            let drawn = if std > 0.0 {
                mean + std * stream.truncated_normal((low - mean) / std, (high - mean) / std)
            } else {
                mean
            };
            angles_rad[index] = crate::math::clamp(drawn, low, high);
        }
    }

    /// The skeleton's limits of a coordinate, and the planes.
    fn limits<const BONES: usize, const ANGLES: usize>(
        &self,
        skeleton: &Skeleton<BONES, ANGLES>,
        index: usize,
    ) -> (f32, f32) {
        let limit = &skeleton.limits()[index];
        let [low, high] = self.shift_limits_m.get(index).copied().unwrap_or([f32::NEG_INFINITY, f32::INFINITY]);
        (max(limit.low_rad, low), crate::math::min(limit.high_rad, high))
    }
}
