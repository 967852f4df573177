//! Limbs that the camera finds no points on for some frames.

use serde::Serialize;
use sinew_core::skeleton::full_body::{FEET, FOREARMS, SHANKS, THIGHS, UPPER_ARMS};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// An arm or a leg, the person's own side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Limb {
    /// Left upper arm and forearm.
    LArm,
    /// Right upper arm and forearm.
    RArm,
    /// Left thigh, shank and foot.
    LLeg,
    /// Right thigh, shank and foot.
    RLeg,
}

impl Limb {
    /// Whether the limb has this bone.
    #[must_use]
    pub fn has(self, bone: usize) -> bool {
        let (side, is_arm) = match self {
            Self::LArm => (0, true),
            Self::RArm => (1, true),
            Self::LLeg => (0, false),
            Self::RLeg => (1, false),
        };
        let arm = [UPPER_ARMS[side], FOREARMS[side]];
        let leg = [THIGHS[side], SHANKS[side], FEET[side]];
        if is_arm { arm.contains(&bone) } else { leg.contains(&bone) }
    }
}

/// A limb whose points are left out.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Hidden {
    /// The limb.
    pub limb: Limb,
    /// First and last frame.
    pub frames: RangeInclusive<usize>,
}

impl Hidden {
    /// Whether `bone` has no points in `frame`.
    #[must_use]
    pub fn hides(&self, bone: usize, frame: usize) -> bool {
        self.frames.contains(&frame) && self.limb.has(bone)
    }
}

impl FromStr for Hidden {
    type Err = String;

    /// Reads `l_arm:30-44`: no points on the left arm from frame 30 to frame 44.
    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = || {
            let (limb, frames) = text.split_once(':')?;
            let limb = match limb {
                "l_arm" => Limb::LArm,
                "r_arm" => Limb::RArm,
                "l_leg" => Limb::LLeg,
                "r_leg" => Limb::RLeg,
                _ => return None,
            };
            let (first, last) = frames.split_once('-')?;
            let (first, last) = (first.parse().ok()?, last.parse().ok()?);
            (first <= last).then_some(Self { limb, frames: first..=last })
        };
        parsed().ok_or_else(|| {
            "l_arm, r_arm, l_leg or r_leg and its first and last frame were expected, as in l_arm:30-44".to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limb_is_hidden_from_its_first_to_its_last_frame() {
        let hidden: Hidden = "r_arm:5-7".parse().unwrap();
        assert!(hidden.hides(FOREARMS[1], 5) && hidden.hides(UPPER_ARMS[1], 7));
        assert!(!hidden.hides(FOREARMS[1], 4) && !hidden.hides(FOREARMS[1], 8) && !hidden.hides(FOREARMS[0], 6));
        assert!("l_leg:0-0".parse::<Hidden>().unwrap().hides(FEET[0], 0));
        for wrong in ["arm:1-2", "l_arm", "l_arm:4", "l_arm:5-4", "l_arm:a-b"] {
            assert!(wrong.parse::<Hidden>().unwrap_err().contains("l_arm:30-44"), "{wrong}");
        }
    }
}
