//! How much of a body is seen and tracked: all of it, or what a camera behind a desk sees.

use serde::{Deserialize, Serialize};
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES};
use sinew_core::skeleton::upper_body::{UPPER_BONES, UPPER_COORDINATES};
use std::str::FromStr;

/// A whole body, or its upper part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum BodyPart {
    /// 17 bones, 16 capsules, 30 coordinates.
    #[default]
    Whole,
    /// Pelvis, trunk, head and arms: 9 bones, 8 capsules, 17 coordinates.
    Upper,
}

/// Places of all coordinates of a whole body.
const ALL_COORDINATES: [usize; BODY_ANGLES] = {
    let mut all = [0; BODY_ANGLES];
    let mut index = 0;
    while index < BODY_ANGLES {
        all[index] = index;
        index += 1;
    }
    all
};

impl BodyPart {
    /// Both, in the order of texts.
    pub const ALL: [Self; 2] = [Self::Whole, Self::Upper];

    /// The name by which the command knows it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Upper => "upper",
        }
    }

    /// How many of a whole body's first bones it has.
    #[must_use]
    pub fn bones(self) -> usize {
        match self {
            Self::Whole => BODY_BONES,
            Self::Upper => UPPER_BONES,
        }
    }

    /// Which of a whole body's coordinates it has; the first three are shifts.
    #[must_use]
    pub fn coordinates(self) -> &'static [usize] {
        match self {
            Self::Whole => &ALL_COORDINATES,
            Self::Upper => &UPPER_COORDINATES,
        }
    }

    /// Radii of a whole body's capsules, metres; zero for what is not part of it.
    #[must_use]
    pub fn fleshed(self, radii_m: &[f32; BODY_BONES]) -> [f32; BODY_BONES] {
        let mut radii_m = *radii_m;
        radii_m[self.bones()..].fill(0.0);
        radii_m
    }
}

impl FromStr for BodyPart {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|part| part.name() == text);
        named.ok_or_else(|| format!("has to be one of {}, not `{text}`", Self::ALL.map(Self::name).join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_files_and_of_the_command() {
        for part in BodyPart::ALL {
            assert_eq!(part.name().parse(), Ok(part));
            assert_eq!(serde_json::to_value(part).unwrap(), part.name());
            #[cfg(feature = "command")]
            assert_eq!(clap::ValueEnum::to_possible_value(&part).unwrap().get_name(), part.name());
        }
        assert!("lower".parse::<BodyPart>().unwrap_err().contains("whole, upper"));
    }
}
