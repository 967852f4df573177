//! The Laplace proposal of a pose, cut to the limits (PIK (18) to (22)).
//!
//! With H = L L' an angle is drawn after those behind it, each from a one-dimensional normal cut to
//! its limits. The density of such a draw is N(theta; m, H^-1) / prod M_i. There M_i is the mass
//! that the limits leave to angle i given the angles behind it. Where a limit is active the
//! gradient at the mode is not zero, so the expansion is centred at m = theta* + H^-1 gradient.

use crate::kinematics::cholesky::Cholesky;
use crate::kinematics::inverse::Mode;
use crate::math::{exp, ln};
use crate::random::Stream;
use crate::random::normal::{LOG_SQRT_TAU, log_interval_mass};
use crate::skeleton::Limit;

/// A normal approximation of a pose's density.
///
/// ```
/// use sinew_core::kinematics::inverse::Solve;
/// use sinew_core::pik::example::{hand_goal, reaching_arm, right_arm};
/// use sinew_core::pik::proposal::LaplaceProposal;
/// use sinew_core::random::Stream;
///
/// let (skeleton, goals) = (right_arm()?, hand_goal());
/// let density = reaching_arm(&skeleton, &goals);
/// let mode = density.mode(10);
/// let proposal = LaplaceProposal::new(&mode).expect("a mode has curvature");
/// // No limit is near: the normal's centre is the mode, and so is the mean of what is drawn.
/// let mut mean_rad = 0.0;
/// for particle in 0..500 {
///     let draw = proposal.draw(skeleton.limits(), &mut Stream::new(1, 0, particle));
///     mean_rad += draw.angles_rad[3] / 500.0;
/// }
/// assert!((mean_rad - proposal.centre_rad()[3]).abs() < 0.02);
/// assert!((proposal.centre_rad()[3] - mode.angles_rad[3]).abs() < 0.01);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaplaceProposal<const ANGLES: usize> {
    centre_rad: [f32; ANGLES],
    factor: Cholesky<ANGLES>,
    mode_log_density: f32,
    /// Half of gradient' H^-1 gradient: what the expansion's top lies above the mode.
    rise: f32,
    held: usize,
}

/// A pose drawn from a [`LaplaceProposal`].
///
/// ```
/// use sinew_core::kinematics::inverse::Solve;
/// use sinew_core::pik::example::{hand_goal, reaching_arm, right_arm};
/// use sinew_core::pik::proposal::LaplaceProposal;
/// use sinew_core::random::Stream;
///
/// let (skeleton, goals) = (right_arm()?, hand_goal());
/// let density = reaching_arm(&skeleton, &goals);
/// let proposal = LaplaceProposal::new(&density.mode(10)).expect("a mode has curvature");
/// let mut mean_distance = 0.0;
/// for particle in 0..1000 {
///     let draw = proposal.draw(skeleton.limits(), &mut Stream::new(1, 0, particle));
///     assert_eq!(skeleton.clamp(draw.angles_rad), draw.angles_rad, "no draw leaves the limits");
///     mean_distance += draw.squared_distance / 1000.0;
/// }
/// assert!((mean_distance - 4.0).abs() < 0.4, "chi-squared of four angles: {mean_distance}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseDraw<const ANGLES: usize> {
    /// The pose, inside the limits.
    pub angles_rad: [f32; ANGLES],
    /// Squared Mahalanobis distance from the centre.
    pub squared_distance: f32,
    /// Sum of ln M_i.
    pub log_mass: f32,
}

/// Whether the mass that limits cut off is part of an importance ratio.
///
/// ```
/// use sinew_core::kinematics::inverse::{PoseObjective, Solve};
/// use sinew_core::pik::example::{hand_goal, reaching_arm, right_arm};
/// use sinew_core::pik::proposal::{LaplaceProposal, LimitMass};
/// use sinew_core::random::Stream;
///
/// let (skeleton, goals) = (right_arm()?, hand_goal());
/// let density = reaching_arm(&skeleton, &goals);
/// let proposal = LaplaceProposal::new(&density.mode(10)).expect("a mode has curvature");
/// let mut stream = Stream::new(1, 0, 0);
/// let draw = proposal.draw(skeleton.limits(), &mut stream);
/// let log_density = density.log_density(&draw.angles_rad, &density.posture(&draw.angles_rad));
/// // Far from all limits nothing is cut off, and counting the mass changes nothing.
/// let log_box = proposal.log_box(skeleton.limits(), 8, &mut stream);
/// let ratio = |limits| proposal.log_importance_ratio(&draw, log_density, limits);
/// assert!((ratio(LimitMass::Counted { log_box }) - ratio(LimitMass::Neglected)).abs() < 1e-3);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LimitMass {
    /// Neither M_box nor the M_i: right where no limit is active. Where one is, poses count as the
    /// sequential draw makes them, not as PIK (12) cut to the limits does. Both are the same if the
    /// angles at limits do not depend on others.
    Neglected,
    /// Both: ln M_box is given, the M_i are known from the draw.
    Counted {
        /// ln of the mass of N(m, H^-1) inside the limits.
        log_box: f32,
    },
}

impl<const ANGLES: usize> LaplaceProposal<ANGLES> {
    /// The second-order expansion around `mode`; `None` where its Hessian is not positive definite.
    #[must_use]
    pub fn new(mode: &Mode<ANGLES>) -> Option<Self> {
        let factor = Cholesky::from(&mode.hessian, mode.held)?;
        let shift = factor.solve_from(&mode.gradient, mode.held);
        let mut centre_rad = mode.angles_rad;
        let mut rise = 0.0;
        for i in 0..ANGLES {
            centre_rad[i] += shift[i];
            rise += 0.5 * shift[i] * mode.gradient[i];
        }
        Some(Self { centre_rad, factor, mode_log_density: mode.log_density, rise, held: mode.held })
    }

    /// ln of the density of a draw, N(theta; m, H^-1) / prod M_i.
    #[must_use]
    pub fn log_density(&self, draw: &PoseDraw<ANGLES>) -> f32 {
        let drawn = (ANGLES - self.held) as f32;
        0.5 * (self.factor.log_determinant_from(self.held) - draw.squared_distance)
            - drawn * LOG_SQRT_TAU
            - draw.log_mass
    }

    /// Centre m of the normal, radians; it may lie outside the limits.
    #[must_use]
    pub fn centre_rad(&self) -> &[f32; ANGLES] {
        &self.centre_rad
    }

    /// Draws a pose inside `limits`, from the last angle back.
    #[must_use]
    pub fn draw(&self, limits: &[Limit; ANGLES], stream: &mut Stream) -> PoseDraw<ANGLES> {
        let lower = &self.factor.lower;
        let mut offset = [0.0; ANGLES];
        let mut result = PoseDraw { angles_rad: self.centre_rad, squared_distance: 0.0, log_mass: 0.0 };
        for i in (0..ANGLES).rev() {
            if i < self.held {
                break;
            }
            // Always there: the compiler sees by it that `i` is in bounds, at opt-level z too.
            let Some(limit) = limits.get(i) else { continue };
            let mut pull = 0.0;
            for j in i + 1..ANGLES {
                pull += lower[j][i] * offset[j];
            }
            let low = (limit.low_rad - self.centre_rad[i]) * lower[i][i] + pull;
            let high = (limit.high_rad - self.centre_rad[i]) * lower[i][i] + pull;
            let z = stream.truncated_normal(low, high);
            offset[i] = (z - pull) / lower[i][i];
            result.angles_rad[i] = limit.clamp(self.centre_rad[i] + offset[i]);
            result.squared_distance += z * z;
            result.log_mass += log_interval_mass(low, high);
        }
        result
    }

    /// Estimate of ln M_box, where M_box is the mass of N(m, H^-1) inside `limits`. It takes
    /// `count` draws of its own: the mean of prod M_i over draws is M_box. Zero, the greatest there
    /// is, without draws.
    #[must_use]
    pub fn log_box(&self, limits: &[Limit; ANGLES], count: usize, stream: &mut Stream) -> f32 {
        let mut greatest = f32::NEG_INFINITY;
        // Sum of the masses over the greatest so far, so that none underflows.
        let mut sum = 0.0;
        for _ in 0..count {
            let log_mass = self.draw(limits, stream).log_mass;
            if !log_mass.is_finite() {
                continue;
            }
            if log_mass > greatest {
                sum = sum * exp(greatest - log_mass) + 1.0;
                greatest = log_mass;
            } else {
                sum += exp(log_mass - greatest);
            }
        }
        if sum > 0.0 { greatest + ln(sum / count as f32) } else { 0.0 }
    }

    /// ln of the importance ratio PIK (18) of a draw whose PIK (12) density is `log_density`.
    ///
    /// ln |H| and (2 pi)^(n/2) stand in both densities and cancel.
    #[must_use]
    pub fn log_importance_ratio(&self, draw: &PoseDraw<ANGLES>, log_density: f32, limits: LimitMass) -> f32 {
        let plain = log_density - self.mode_log_density - self.rise + 0.5 * draw.squared_distance;
        match limits {
            LimitMass::Neglected => plain,
            LimitMass::Counted { log_box } => plain + draw.log_mass - log_box,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::inverse::{Goal, PoseDensity, PoseObjective, Solve};
    use crate::math::{Mat3, Vec3};
    use crate::skeleton::{Bone, Joint, Skeleton};

    fn planar_arm(limits: [Limit; 2]) -> Skeleton<2, 2> {
        let hinge = |parent| Bone { parent, joint: Joint::Hinge(Vec3::z()), offset_m: Vec3::x() * 0.4 };
        Skeleton::new([hinge(None), hinge(Some(0))], limits).unwrap()
    }

    /// Mean of both angles under PIK (12), by a grid over the box, and the log of its integral.
    fn grid(density: &PoseDensity<'_, 2, 2>) -> ([f64; 2], f64) {
        let limits = density.skeleton.limits();
        let steps = 800;
        let place = |i: usize, a: usize| {
            limits[a].low_rad + (limits[a].high_rad - limits[a].low_rad) * (i as f32 + 0.5) / steps as f32
        };
        let (mut mass, mut mean) = (0.0, [0.0; 2]);
        for i in 0..steps {
            for j in 0..steps {
                let angles = [place(i, 0), place(j, 1)];
                let p = f64::from(density.log_density(&angles, &density.posture(&angles))).exp();
                mass += p;
                mean[0] += p * f64::from(angles[0]);
                mean[1] += p * f64::from(angles[1]);
            }
        }
        let cell: f64 =
            (0..2).map(|a| f64::from(limits[a].high_rad - limits[a].low_rad) / f64::from(steps as u32)).product();
        (mean.map(|m| m / mass), (mass * cell).ln())
    }

    #[test]
    fn weighted_moments_with_an_active_limit_are_those_of_a_grid() {
        let skeleton = planar_arm([Limit::from_degrees(-60.0, 20.0), Limit::from_degrees(0.0, 120.0)]);
        let goals = [Goal { bone: 1, position_m: Vec3::new(0.6, 0.5, 0.0), precision: Mat3::identity() * 150.0 }];
        let density = PoseDensity {
            skeleton: &skeleton,
            root_m: Vec3::zeros(),
            goals: &goals,
            previous_rad: [0.2, 0.15],
            stiffness: [4.0, 4.0],
            held: 0,
        };
        let mode = density.mode(20);
        assert!(mode.gradient.iter().any(|g| g.abs() > 0.1), "no limit is active: {:?}", mode.gradient);
        let proposal = LaplaceProposal::new(&mode).unwrap();
        let mut stream = Stream::new(8, 0, 0);
        let draws: Vec<_> = (0..60_000).map(|_| proposal.draw(skeleton.limits(), &mut stream)).collect();
        let mean_mass = draws.iter().map(|d| f64::from(exp(d.log_mass))).sum::<f64>() / draws.len() as f64;
        let log_box = proposal.log_box(skeleton.limits(), 60_000, &mut Stream::new(8, 1, 0));
        assert!((f64::from(log_box) - mean_mass.ln()).abs() < 0.01, "{log_box} {mean_mass}");
        let limit_mass = LimitMass::Counted { log_box };
        let (mut total, mut mean, mut square) = (0.0, [0.0; 2], 0.0);
        for draw in &draws {
            let log_density = density.log_density(&draw.angles_rad, &density.posture(&draw.angles_rad));
            let ratio = f64::from(exp(proposal.log_importance_ratio(draw, log_density, limit_mass)));
            total += ratio;
            square += ratio * ratio;
            for a in 0..2 {
                mean[a] += ratio * f64::from(draw.angles_rad[a]);
            }
        }
        let (exact, log_integral) = grid(&density);
        let ess = total * total / square;
        for a in 0..2 {
            let error = (mean[a] / total - exact[a]).abs();
            assert!(error < 4.0 * 0.3 / ess.sqrt(), "angle {a}: off by {error}, {ess} effective draws");
        }
        // The mean ratio is the true integral over log Z's: near one where the expansion is good.
        let log_z = f64::from(proposal.mode_log_density + proposal.rise)
            + mean_mass.ln()
            + f64::from(core::f32::consts::TAU).ln()
            - 0.5 * f64::from(proposal.factor.log_determinant());
        let mean_ratio = total / draws.len() as f64;
        assert!((mean_ratio.ln() - (log_integral - log_z)).abs() < 0.03, "{mean_ratio} {log_integral} {log_z}");
    }

    #[test]
    fn without_limits_on_a_linear_map_every_ratio_is_one() {
        // No goal: PIK (12) is then exactly the normal of the stiffness.
        let wide = planar_arm([Limit::from_degrees(-36_000.0, 36_000.0); 2]);
        let density = PoseDensity {
            skeleton: &wide,
            root_m: Vec3::zeros(),
            goals: &[],
            previous_rad: [0.3, -0.2],
            stiffness: [9.0, 25.0],
            held: 0,
        };
        let proposal = LaplaceProposal::new(&density.mode(5)).unwrap();
        let mut stream = Stream::new(9, 0, 0);
        for _ in 0..200 {
            let draw = proposal.draw(wide.limits(), &mut stream);
            let log_density = density.log_density(&draw.angles_rad, &density.posture(&draw.angles_rad));
            for limits in [LimitMass::Neglected, LimitMass::Counted { log_box: 0.0 }] {
                let ratio = proposal.log_importance_ratio(&draw, log_density, limits);
                assert!(ratio.abs() < 1.0e-4, "log ratio {ratio}");
            }
        }
    }

    #[test]
    fn draws_keep_their_limits_however_far_the_goal() {
        let skeleton = planar_arm([Limit::from_degrees(-10.0, 10.0), Limit::from_degrees(0.0, 90.0)]);
        let goals = [Goal { bone: 1, position_m: Vec3::new(-3.0, -3.0, 0.0), precision: Mat3::identity() * 400.0 }];
        let density = PoseDensity {
            skeleton: &skeleton,
            root_m: Vec3::zeros(),
            goals: &goals,
            previous_rad: [0.0, 0.5],
            stiffness: [1.0; 2],
            held: 0,
        };
        let proposal = LaplaceProposal::new(&density.mode(4)).unwrap();
        let mut stream = Stream::new(10, 0, 0);
        for _ in 0..1000 {
            let draw = proposal.draw(skeleton.limits(), &mut stream);
            assert_eq!(skeleton.clamp(draw.angles_rad), draw.angles_rad);
            assert!(draw.squared_distance.is_finite());
        }
    }
}
