//! The baseline: angles extrapolated one by one, von Mises noise, box limits (PIK (31) and PIK
//! (32)).

use super::goal::GoalMemory;
use super::motion::{BodyMotion, BodyParticle, FramePast, Proposed};
use super::root::RootProcess;
use crate::random::Stream;
use crate::skeleton::Limit;

/// Draws that are thrown away for breaking a limit before the cut normal distribution takes over.
const MAX_TRIES: usize = 8;

/// Independent angles.
///
/// ```
/// use sinew_core::pik::angular::AngularMotion;
/// use sinew_core::pik::example::{arm_past, arm_scene};
/// use sinew_core::pik::goal::MEMORY;
/// use sinew_core::pik::motion::{BodyMotion, BodyParticle, FramePast};
/// use sinew_core::pik::root::RootProcess;
/// use sinew_core::random::Stream;
///
/// let scene = arm_scene()?;
/// let ancestor = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
/// let past = arm_past(&scene, &ancestor, &[]);
/// // The elbow bends by two radians a second, and went on for a tenth of a second: 0.2 rad on the mean.
/// let past = FramePast { angle_velocity_per_s: [0.0, 0.0, 0.0, 2.0], ..past };
/// let root = RootProcess::FIXED;
/// let motion = AngularMotion { root, persistence: 1.0, angle_std_rad_per_sqrt_s: [0.3; 4], own_velocity: false };
/// let mut mean_rad = 0.0;
/// for particle in 0..400 {
///     let moved = motion.propose(&past, &ancestor, &mut [0.0; MEMORY], &mut Stream::new(1, 0, particle));
///     mean_rad += moved.angles_rad[3] / 400.0;
/// }
/// assert!((mean_rad - 1.2).abs() < 0.02, "{mean_rad}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngularMotion<const ANGLES: usize> {
    /// The root's own process.
    pub root: RootProcess,
    /// Share of the velocity that goes on; 1 is the paper's.
    pub persistence: f32,
    /// Standard deviation of each angle after one second, radians; kappa = 1 / (std^2 dt). Entries
    /// of a free root are not read.
    pub angle_std_rad_per_sqrt_s: [f32; ANGLES],
    /// Whether the velocity is the particle's own, theta_t - theta_t-1, as printed, and not the
    /// filter's.
    pub own_velocity: bool,
}

impl<const BONES: usize, const ANGLES: usize> BodyMotion<BONES, ANGLES> for AngularMotion<ANGLES> {
    fn root(&self) -> &RootProcess {
        &self.root
    }

    fn propose(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        ancestor: &BodyParticle<BONES, ANGLES>,
        memory: &mut GoalMemory,
        stream: &mut Stream,
    ) -> Proposed<BONES, ANGLES> {
        let skeleton = &past.scene.skeleton;
        let mut angles_rad = ancestor.angles_rad;
        let std_rad = past.angle_std_rad(&self.angle_std_rad_per_sqrt_s);
        self.root.draw(skeleton, &mut angles_rad, &past.shared_change, past.dt_s, stream);
        for i in skeleton.root_coordinates()..ANGLES {
            let before = ancestor.angles_rad[i];
            let mut change = past.change(i, self.persistence);
            if self.own_velocity {
                let own = memory.get(i).filter(|_| !past.is_first).map_or(before, |&before_that| before_that);
                change = self.persistence * (before - own);
            }
            angles_rad[i] = draw_inside(before + change, std_rad[i], &skeleton.limits()[i], stream);
        }
        if self.own_velocity {
            for (kept, angle) in memory.iter_mut().zip(&ancestor.angles_rad) {
                *kept = *angle;
            }
        }
        Proposed { angles_rad, posture: past.scene.posture(&angles_rad), log_ratio: 0.0 }
    }
}

/// A von Mises draw around `mean_rad` that keeps its limit: rejection while the tries last, then a
/// normal draw cut to it.
fn draw_inside(mean_rad: f32, std_rad: f32, limit: &Limit, stream: &mut Stream) -> f32 {
    if !(std_rad > 0.0) {
        return limit.clamp(mean_rad);
    }
    for _ in 0..MAX_TRIES {
        let drawn = stream.von_mises(mean_rad, 1.0 / (std_rad * std_rad));
        if drawn >= limit.low_rad && drawn <= limit.high_rad {
            return drawn;
        }
    }
    let z = stream.truncated_normal((limit.low_rad - mean_rad) / std_rad, (limit.high_rad - mean_rad) / std_rad);
    limit.clamp(mean_rad + std_rad * z)
}
