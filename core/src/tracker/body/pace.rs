//! How far a limb may stray from where its motion takes it: at rest less than when it is swung, and
//! unseen more and more.
//!
//! A motion model has one noise for each joint, wide enough for a hand that is thrown. Most limbs
//! rest most of the time, and particles that are drawn that wide about them mostly measure their
//! own sparsity.

use crate::error::{ParameterError, Rule, positive};
use crate::math::{Vec3, exp, max, min, sqrt};
use crate::pik::guided::LOOSE_SHARE;
use crate::skeleton::Limbs;
use crate::skeleton::limbs::{MAX_GROUPS, TRUNK_GROUP};

/// A limb is unseen if fewer than this share of its bones with flesh are observed.
/// Chosen: one of an arm's two bones still holds it.
const MIN_OBSERVED: f32 = 0.5;
/// Greatest multiple of the noise of a motion model that options may ask for.
/// Chosen: bounds a mistyped option.
const MAX_SCALE: f32 = 100.0;

/// How the noise of a limb follows its pace; the trunk's is always the motion model's own.
///
/// ```
/// use sinew_core::tracker::body::SpeedScaledNoise;
///
/// let noise = SpeedScaledNoise {
///     rest_share: 0.4,
///     full_speed_m_per_s: 1.3,
///     max_scale_seen: 2.5,
///     fade_s: 0.3,
///     unseen_growth_s: 0.5,
///     max_scale_unseen: 2.0,
/// };
/// assert!(noise.checked().is_ok());
/// // At rest two fifths of the model's noise, in full swing all of it, and two and a half times that of a runner's foot.
/// assert_eq!(noise.share(0.0), 0.4);
/// assert!(noise.share(0.6) > 0.55 && noise.share(0.6) < 0.65);
/// assert!(noise.share(1.3) > 1.0 && noise.share(1.3) < 1.1);
/// assert_eq!(noise.share(5.0), 2.5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SpeedScaledNoise {
    /// Noise of a limb at rest, as a share of the motion model's; in (0, 1].
    pub rest_share: f32,
    /// Speed that would alone make all of the noise, metres a second: root mean square over the
    /// ends of a limb's bones, against the root.
    pub full_speed_m_per_s: f32,
    /// The noise of a limb that is seen is no more than this many times the model's; 1 to 100.
    pub max_scale_seen: f32,
    /// Time in which the noise of a limb that comes to rest falls to its e-th part, seconds.
    pub fade_s: f32,
    /// Time in which the noise of a limb that is not seen grows by the model's own, seconds.
    pub unseen_growth_s: f32,
    /// It grows no further than this many times the model's; 1 to 100.
    pub max_scale_unseen: f32,
}

impl SpeedScaledNoise {
    /// Itself.
    ///
    /// # Errors
    /// Names the number that broke its rule.
    pub fn checked(self) -> Result<Self, ParameterError> {
        if positive("rest_share", self.rest_share)? > 1.0 {
            return Err(ParameterError::new("rest_share", Rule::Within { low: 0.0, high: 1.0 }));
        }
        positive("full_speed_m_per_s", self.full_speed_m_per_s)?;
        positive("fade_s", self.fade_s)?;
        positive("unseen_growth_s", self.unseen_growth_s)?;
        for (name, most) in [("max_scale_seen", self.max_scale_seen), ("max_scale_unseen", self.max_scale_unseen)] {
            if !(1.0..=MAX_SCALE).contains(&most) {
                return Err(ParameterError::new(name, Rule::Within { low: 1.0, high: MAX_SCALE }));
            }
        }
        Ok(self)
    }

    /// Share of the model's noise for a limb that keeps this speed.
    #[must_use]
    pub fn share(&self, speed_m_per_s: f32) -> f32 {
        let swing = speed_m_per_s / self.full_speed_m_per_s;
        min(self.max_scale_seen, sqrt(self.rest_share * self.rest_share + swing * swing))
    }

    /// The share one frame on. It is at once what a faster limb asks for, and by and by what a
    /// slower one does. Of an unseen limb it is more.
    fn follow(&self, share: f32, speed_m_per_s: Option<f32>, dt_s: f32) -> f32 {
        let Some(speed_m_per_s) = speed_m_per_s else {
            return min(max(share, self.max_scale_unseen), share + dt_s / self.unseen_growth_s);
        };
        let now = self.share(speed_m_per_s);
        max(now, now + (share - now) * exp(-dt_s / self.fade_s))
    }
}

/// Shares of the motion model's noise, by group of bones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LimbNoise {
    pub(super) shares: [f32; MAX_GROUPS],
    /// Which of them the last frame did not show.
    pub(super) is_unseen: [bool; MAX_GROUPS],
}

impl LimbNoise {
    /// As the motion model has it.
    pub(super) const FULL: Self = Self { shares: [1.0; MAX_GROUPS], is_unseen: [false; MAX_GROUPS] };

    /// Whether a limb is fast: it may have got farther than points reach.
    pub(super) fn is_any_fast(&self, limbs: usize) -> bool {
        let limbs = (0..limbs.min(MAX_GROUPS)).filter(|&group| group != TRUNK_GROUP && !self.is_let_loose(group));
        limbs.map(|group| self.shares[group]).any(|share| share >= LOOSE_SHARE)
    }

    /// Whether the limb has been unseen for so long that it has more than the model's noise.
    pub(super) fn is_let_loose(&self, group: usize) -> bool {
        self.is_unseen.get(group).is_some_and(|is_unseen| *is_unseen) && self.shares[group] > 1.0
    }

    /// The shares by bone.
    pub(super) fn per_bone<const BONES: usize>(&self, limbs: &Limbs<BONES>) -> [f32; BONES] {
        core::array::from_fn(|bone| self.shares.get(limbs.group(bone)).copied().unwrap_or(1.0))
    }

    /// Follows the limbs through a frame: how fast their bones' ends went, and which bones were
    /// observed of those that have flesh.
    pub(super) fn follow<const BONES: usize>(
        &mut self,
        (noise, limbs): (&SpeedScaledNoise, &Limbs<BONES>),
        velocity_m_per_s: &[Vec3; BONES],
        (observed, radii_m): (&[bool; BONES], &[f32; BONES]),
        dt_s: f32,
    ) {
        let root = velocity_m_per_s.first().copied().unwrap_or_default();
        let of_limbs = self.shares.iter_mut().zip(&mut self.is_unseen).enumerate().take(limbs.count());
        for (group, (share, is_unseen)) in of_limbs.filter(|&(group, _)| group != TRUNK_GROUP) {
            let (mut squared, mut bones, mut fleshed, mut seen) = (0.0, 0.0, 0.0, 0.0);
            for bone in (0..BONES).filter(|&bone| limbs.group(bone) == group) {
                let against_root = velocity_m_per_s[bone] - root;
                squared += against_root.dot(&against_root);
                bones += 1.0;
                if radii_m[bone] > 0.0 {
                    fleshed += 1.0;
                    seen += if observed[bone] { 1.0 } else { 0.0 };
                }
            }
            *is_unseen = seen < MIN_OBSERVED * fleshed;
            let speed_m_per_s = (!*is_unseen).then(|| sqrt(squared / max(bones, 1.0)));
            *share = noise.follow(*share, speed_m_per_s, dt_s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{BODY_BONES, FEET, FOREARMS, PELVIS, TRUNK, UPPER_ARMS, body_radii_m, full_body};
    use proptest::prelude::*;

    const NOISE: SpeedScaledNoise = SpeedScaledNoise {
        rest_share: 0.4,
        full_speed_m_per_s: 1.3,
        max_scale_seen: 1.5,
        fade_s: 0.3,
        unseen_growth_s: 0.5,
        max_scale_unseen: 2.0,
    };
    const DT_S: f32 = 1.0 / 15.0;

    /// Shares by bone after `frames` of a body whose left forearm's end goes at `speed_m_per_s`,
    /// and of whose right arm nothing is seen.
    fn followed(frames: usize, speed_m_per_s: f32, noise: LimbNoise) -> (LimbNoise, [f32; BODY_BONES]) {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (limbs, radii_m) = (Limbs::of(&full_body(&measures).unwrap()), body_radii_m(&measures));
        // The whole body goes on, which is the root's pace alone.
        let mut velocity = [Vec3::new(0.0, 0.0, 1.5); BODY_BONES];
        velocity[FOREARMS[0]].x = speed_m_per_s;
        let mut observed = [true; BODY_BONES];
        (observed[UPPER_ARMS[1]], observed[FOREARMS[1]]) = (false, false);
        let mut noise = noise;
        for _ in 0..frames {
            noise.follow((&NOISE, &limbs), &velocity, (&observed, &radii_m), DT_S);
        }
        (noise, noise.per_bone(&limbs))
    }

    #[test]
    fn a_limb_at_rest_has_its_share_and_one_that_is_swung_all() {
        let (swung, shares) = followed(60, 5.0, LimbNoise::FULL);
        assert_eq!([shares[FOREARMS[0]], shares[UPPER_ARMS[0]]], [1.5; 2], "the whole limb");
        assert_eq!([shares[PELVIS], shares[TRUNK]], [1.0; 2]);
        assert!((shares[FEET[0]] - 0.4).abs() < 1.0e-3, "{shares:?}");
        // Comes to rest: not at once.
        let share = |frames| followed(frames, 0.0, swung).1[FOREARMS[0]];
        let fading = 0.4 + 1.1 * libm::expf(-3.0 * DT_S / 0.3);
        assert!((share(3) - fading).abs() < 1.0e-4 && (share(60) - 0.4).abs() < 1.0e-3, "{} {fading}", share(3));
        // Starts: at once.
        let rested = followed(60, 0.0, swung).0;
        assert_eq!(followed(1, 5.0, rested).1[FOREARMS[0]], 1.5);
    }

    #[test]
    fn an_unseen_limb_is_let_loose_and_taken_back() {
        let (rested, _) = followed(0, 0.0, LimbNoise { shares: [0.4; MAX_GROUPS], ..LimbNoise::FULL });
        let unseen = |frames| followed(frames, 0.0, rested).1[FOREARMS[1]];
        assert!((unseen(3) - (0.4 + 3.0 * DT_S / 0.5)).abs() < 1.0e-4, "{}", unseen(3));
        assert_eq!(unseen(40), 2.0);
        assert!((NOISE.follow(2.0, Some(0.0), DT_S) - (0.4 + 1.6 * libm::expf(-DT_S / 0.3))).abs() < 1.0e-4);
    }

    #[test]
    fn a_fast_limb_is_told_from_an_unseen_one() {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let limbs = Limbs::of(&full_body(&measures).unwrap());
        let of = |left: f32, (right, is_right_unseen): (f32, bool)| {
            let mut noise = LimbNoise { shares: [0.4; MAX_GROUPS], ..LimbNoise::FULL };
            noise.shares[TRUNK_GROUP] = 1.0;
            noise.shares[limbs.group(FOREARMS[0])] = left;
            noise.shares[limbs.group(FOREARMS[1])] = right;
            noise.is_unseen[limbs.group(FOREARMS[1])] = is_right_unseen;
            let is_let_loose = FOREARMS.map(|bone| noise.is_let_loose(limbs.group(bone)));
            (noise.is_any_fast(limbs.count()), is_let_loose)
        };
        assert_eq!(of(0.4, (0.7, false)), (false, [false; 2]), "the trunk's own noise is no limb's pace");
        assert_eq!(of(0.9, (0.4, false)), (true, [false; 2]));
        assert_eq!(of(0.4, (1.4, false)), (true, [false; 2]), "fast, and seen");
        assert_eq!(of(0.4, (1.4, true)), (false, [false, true]));
        assert_eq!(of(1.0, (1.4, true)), (true, [false, true]));
        assert_eq!(of(0.4, (0.9, true)), (true, [false; 2]), "swung when it was last seen");
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let broken = |noise: SpeedScaledNoise| noise.checked().unwrap_err().parameter;
        assert_eq!(broken(SpeedScaledNoise { rest_share: 0.0, ..NOISE }), "rest_share");
        assert_eq!(broken(SpeedScaledNoise { full_speed_m_per_s: f32::NAN, ..NOISE }), "full_speed_m_per_s");
        assert_eq!(broken(SpeedScaledNoise { max_scale_seen: 0.9, ..NOISE }), "max_scale_seen");
        assert_eq!(broken(SpeedScaledNoise { fade_s: 0.0, ..NOISE }), "fade_s");
        assert_eq!(broken(SpeedScaledNoise { unseen_growth_s: -1.0, ..NOISE }), "unseen_growth_s");
        assert_eq!(broken(SpeedScaledNoise { max_scale_unseen: 0.5, ..NOISE }), "max_scale_unseen");
    }

    proptest! {
        #[test]
        fn shares_stay_between_rest_and_most(
            share in 0.4_f32..2.0, speed_m_per_s in 0.0_f32..10.0, is_seen: bool, dt_s in 1.0e-4_f32..10.0,
        ) {
            let next = NOISE.follow(share, is_seen.then_some(speed_m_per_s), dt_s);
            prop_assert!((0.4 - 1.0e-6..=2.0).contains(&next), "{}", next);
            if is_seen {
                prop_assert!(next >= NOISE.share(speed_m_per_s) && next <= max(share, NOISE.share(speed_m_per_s)));
            } else {
                prop_assert!(next >= share);
            }
        }
    }
}
