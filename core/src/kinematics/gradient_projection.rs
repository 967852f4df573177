//! Gradient projection with a line search, the PIK paper's own solver (section 5.2.1), as an
//! alternative.

use super::forward::Posture;
use super::inverse::{Mode, PoseObjective, Stop};
use crate::math::{abs, max, sqrt};

/// Largest number of halvings of a step; the bound of the work.
const MAX_HALVINGS: usize = 16;
/// Smallest gain of a step relative to that of the slope (Armijo's rule).
///
/// Nocedal and Wright, Numerical Optimization, section 3.1: c1 = 1e-4.
const MIN_GAIN_SHARE: f32 = 1.0e-4;
/// A step shorter than this ends the search, radians.
///
/// Chosen: a tenth of the tolerance of [`super::inverse`], since gradient steps are shorter.
const STEP_TOLERANCE_RAD: f32 = 1.0e-4;
/// Length of the first step tried, radians; later ones begin at twice the last that climbed.
///
/// Chosen: only a start, since the line search halves it and doubles it.
const FIRST_STEP_RAD: f32 = 0.2;

/// Climbs from the objective's start to its mode in at most `max_steps` steps along the gradient,
/// cut to the limits.
///
/// ```
/// use sinew_core::kinematics::gradient_projection::mode_by_gradient;
/// use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
/// use sinew_core::math::{Mat3, Vec3};
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// let goals = [Goal {
///     bone: FOREARM,
///     position_m: Vec3::new(0.3, 0.3, -0.2),
///     precision: Mat3::identity() * 400.0,
/// }];
/// # let (root_m, previous_rad) = (Vec3::zeros(), [0.6, 0.1, 0.1, 0.9]);
/// let density = PoseDensity {
///     skeleton: &arm,
///     root_m,
///     goals: &goals,
///     previous_rad,
///     stiffness: [4.0; 4],
///     held: 0,
/// };
/// // The same mode as by Gauss-Newton steps, which need far fewer of them.
/// let (slow, fast) = (mode_by_gradient(&density, 400), density.mode(10));
/// assert!((slow.log_density - fast.log_density).abs() < 0.05);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[must_use]
pub fn mode_by_gradient<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    max_steps: usize,
) -> Mode<ANGLES> {
    let (skeleton, held) = (objective.skeleton(), objective.held());
    let mut angles_rad = skeleton.clamp(objective.start_rad());
    let mut here = objective.posture(&angles_rad);
    let mut log_density = objective.log_density(&angles_rad, &here);
    let (mut gradient, mut hessian) = objective.derivatives(&angles_rad, &here);
    let mut stop = Stop::StepsUsed;
    let mut reach_rad = FIRST_STEP_RAD;
    for _ in 0..max_steps {
        let slope = sqrt(gradient.iter().skip(held).map(|g| g * g).sum());
        if !(slope > 0.0) {
            stop = Stop::LittleGain;
            break;
        }
        let Some(step) = line_search(objective, &angles_rad, &gradient, log_density, reach_rad / slope) else {
            stop = Stop::NoClimb;
            break;
        };
        let mut longest = 0.0;
        for i in 0..ANGLES {
            longest = max(longest, abs(step.angles_rad[i] - angles_rad[i]));
        }
        (angles_rad, here, log_density) = (step.angles_rad, step.posture, step.log_density);
        (gradient, hessian) = objective.derivatives(&angles_rad, &here);
        reach_rad = 2.0 * step.scale * slope;
        if longest < STEP_TOLERANCE_RAD {
            stop = Stop::ShortStep;
            break;
        }
    }
    Mode { angles_rad, gradient, hessian, log_density, residual_m: objective.residual_m(&here), stop, held }
}

struct Step<const BONES: usize, const ANGLES: usize> {
    angles_rad: [f32; ANGLES],
    posture: Posture<BONES, ANGLES>,
    log_density: f32,
    scale: f32,
}

/// The longest of the step `scale` times the gradient and its halvings, cut to the limits, that
/// climbs enough.
fn line_search<const BONES: usize, const ANGLES: usize>(
    objective: &(impl PoseObjective<BONES, ANGLES> + ?Sized),
    angles_rad: &[f32; ANGLES],
    gradient: &[f32; ANGLES],
    log_density: f32,
    mut scale: f32,
) -> Option<Step<BONES, ANGLES>> {
    for _ in 0..=MAX_HALVINGS {
        let mut next = *angles_rad;
        for i in objective.held()..ANGLES {
            next[i] += scale * gradient[i];
        }
        let next = objective.skeleton().clamp(next);
        let promised: f32 = (0..ANGLES).map(|i| gradient[i] * (next[i] - angles_rad[i])).sum();
        let posture = objective.posture(&next);
        let log_next = objective.log_density(&next, &posture);
        if promised > 0.0 && log_next >= log_density + MIN_GAIN_SHARE * promised {
            return Some(Step { angles_rad: next, posture, log_density: log_next, scale });
        }
        scale *= 0.5;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::kinematics::inverse::{Goal, PoseDensity, Solve};
    use crate::math::{Mat3, Vec3};
    use crate::skeleton::arm::FOREARM;
    use crate::skeleton::{ArmGeometry, Side};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn both_solvers_find_modes_that_are_alike(
            change in prop::array::uniform4(-0.25_f32..0.25),
        ) {
            let skeleton = ArmGeometry::new(Side::Left, 0.3, 0.35).unwrap().skeleton().unwrap();
            let previous_rad = [0.6, 0.1, 0.1, 0.9];
            let there = core::array::from_fn(|i| previous_rad[i] + change[i]);
            let position_m = posture(&skeleton, &Vec3::zeros(), &there).ends[FOREARM];
            let goals = [Goal { bone: FOREARM, position_m, precision: Mat3::identity() * 400.0 }];
            let density = PoseDensity {
                skeleton: &skeleton,
                root_m: Vec3::zeros(),
                goals: &goals,
                previous_rad,
                stiffness: [4.0; 4],
                held: 0,
            };
            let (slow, fast) = (mode_by_gradient(&density, 400), density.mode(30));
            prop_assert!((slow.log_density - fast.log_density).abs() < 0.05, "{} {}", slow.log_density, fast.log_density);
            prop_assert_eq!(skeleton.clamp(slow.angles_rad), slow.angles_rad);
        }
    }
}
