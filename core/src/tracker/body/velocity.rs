//! How fast the estimate moves: what motion models go on with.
//!
//! A velocity from the last two frames is that of half a frame ago, and a limb that swings has
//! another one by the next. Where it changed by as much as from the frame before it, it is likely
//! to go on changing.

use crate::math::{Vec3, min};
use crate::pik::motion::BodyParticle;

/// Velocities are not followed for longer than this across a gap, seconds; the noise grows all the
/// same. Chosen: a limb turns back within a few tenths of a second.
const MAX_STRIDE_S: f32 = 0.2;

/// Velocities of one frame, by coordinate and by bone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Velocity<const BONES: usize, const ANGLES: usize> {
    /// Of the pose's coordinates, a second.
    pub(super) angles_per_s: [f32; ANGLES],
    /// Of the bones' ends, metres a second.
    pub(super) ends_m_per_s: [Vec3; BONES],
}

impl<const BONES: usize, const ANGLES: usize> Velocity<BONES, ANGLES> {
    const ZERO: Self = Self { angles_per_s: [0.0; ANGLES], ends_m_per_s: [Vec3::new(0.0, 0.0, 0.0); BONES] };

    /// From one pose to the next.
    fn between(before: &BodyParticle<BONES, ANGLES>, now: &BodyParticle<BONES, ANGLES>, dt_s: f32) -> Self {
        Self {
            angles_per_s: core::array::from_fn(|i| (now.angles_rad[i] - before.angles_rad[i]) / dt_s),
            ends_m_per_s: core::array::from_fn(|bone| (now.ends_m[bone] - before.ends_m[bone]) / dt_s),
        }
    }

    /// Itself and `share` of `other`, all times `factor`.
    fn plus(&self, other: &Self, share: f32, factor: f32) -> Self {
        Self {
            angles_per_s: core::array::from_fn(|i| factor * (self.angles_per_s[i] + share * other.angles_per_s[i])),
            ends_m_per_s: core::array::from_fn(|bone| {
                (self.ends_m_per_s[bone] + other.ends_m_per_s[bone] * share) * factor
            }),
        }
    }
}

/// The last velocity of the estimates, and by how much it changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EstimateVelocity<const BONES: usize, const ANGLES: usize> {
    pub(super) last: Velocity<BONES, ANGLES>,
    pub(super) change: Velocity<BONES, ANGLES>,
    /// Whether there was a velocity before, so that a change is known.
    pub(super) is_known: bool,
}

impl<const BONES: usize, const ANGLES: usize> EstimateVelocity<BONES, ANGLES> {
    /// Nothing moved yet.
    pub(super) const REST: Self = Self { last: Velocity::ZERO, change: Velocity::ZERO, is_known: false };

    /// Takes in the way from one estimate to the next. The first velocity is no change: who is in
    /// motion when tracking begins did not start just then.
    pub(super) fn follow(
        &mut self,
        before: &BodyParticle<BONES, ANGLES>,
        now: &BodyParticle<BONES, ANGLES>,
        dt_s: f32,
    ) {
        let next = Velocity::between(before, now, dt_s);
        self.change = if self.is_known { next.plus(&self.last, -1.0, 1.0) } else { Velocity::ZERO };
        (self.last, self.is_known) = (next, true);
    }

    /// What is gone on with over a frame of `dt_s`: the last velocity and `acceleration_share` of
    /// its change.
    pub(super) fn expected(&self, acceleration_share: f32, dt_s: f32) -> Velocity<BONES, ANGLES> {
        self.last.plus(&self.change, acceleration_share, min(1.0, MAX_STRIDE_S / dt_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::ArmGeometry;
    use crate::skeleton::Side;
    use crate::skeleton::arm::FOREARM;
    use proptest::prelude::*;

    const DT_S: f32 = 1.0 / 15.0;

    /// The velocity of an arm whose elbow bends by these angles, frame after frame.
    fn followed(elbow_rad: &[f32]) -> EstimateVelocity<2, 4> {
        let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35).unwrap().skeleton().unwrap();
        let at = |elbow_rad: f32| BodyParticle::at(&skeleton, [0.5, 0.1, 0.1, elbow_rad]);
        let mut velocity = EstimateVelocity::REST;
        for pair in elbow_rad.windows(2) {
            velocity.follow(&at(pair[0]), &at(pair[1]), DT_S);
        }
        velocity
    }

    #[test]
    fn what_speeds_up_is_expected_to_go_on_so() {
        // By 0.1, then by 0.2 rad: 3 rad/s, from 1.5.
        let velocity = followed(&[1.0, 1.1, 1.3]);
        let elbow_rad = |share| velocity.expected(share, DT_S).angles_per_s[3] * DT_S;
        assert!((elbow_rad(0.0) - 0.2).abs() < 1.0e-5 && (elbow_rad(1.0) - 0.3).abs() < 1.0e-5);
        assert!((elbow_rad(0.5) - 0.25).abs() < 1.0e-5);
        let hand_m = |share| velocity.expected(share, DT_S).ends_m_per_s[FOREARM].norm() * DT_S;
        assert!((hand_m(0.0) - 0.07).abs() < 1.0e-3 && (hand_m(0.5) - 0.0875).abs() < 2.0e-3, "a forearm of 35 cm");
    }

    #[test]
    fn a_first_velocity_is_no_change() {
        let velocity = followed(&[1.0, 1.2]);
        assert_eq!(velocity.expected(1.0, DT_S), velocity.last);
        assert_eq!(followed(&[1.0]), EstimateVelocity::REST);
    }

    proptest! {
        #[test]
        fn a_gap_is_not_crossed_farther_than_the_longest_stride(
            first_rad in 0.5_f32..1.5, second_rad in 0.5_f32..1.5, share in 0.0_f32..1.0, gap_s in 0.2_f32..10.0,
        ) {
            let velocity = followed(&[1.0, first_rad, second_rad]);
            let way_rad = |dt_s: f32| velocity.expected(share, dt_s).angles_per_s[3] * dt_s;
            let longest_rad = way_rad(MAX_STRIDE_S);
            prop_assert!((way_rad(gap_s) - longest_rad).abs() < 1.0e-4 * (1.0 + longest_rad.abs()));
        }
    }
}
