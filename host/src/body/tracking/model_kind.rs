//! The motion models that the command knows by name.

use serde::{Deserialize, Serialize};
use sinew_core::tracker::body::modes::MAX_MODES;
use std::str::FromStr;

/// How particles move from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum BodyModelKind {
    /// Goals of head, hands and feet go on linearly; poses by probabilistic inverse kinematics.
    EndEffector,
    /// As end-effector, with the points pulling at each pose before it is drawn: for few particles.
    #[default]
    Guided,
    /// A few hypotheses, each a mode of the guided model's density: the leading one, and limbs
    /// exchanged or the pelvis turned.
    Modes,
    /// Each angle goes on by itself: the baseline of the PIK paper.
    Angular,
    /// As end-effector, with both hands on a stick whose ends are known.
    Stick,
    /// Hands, feet and head stay; the pelvis goes up and down over the floor.
    PelvicLift,
    /// End-effector with the PIK paper's structure; `[paper]` has the numbers that it leaves open.
    EndEffectorPaper,
    /// Angular with the PIK paper's structure; `[paper]` has the numbers that it leaves open.
    AngularPaper,
}

impl BodyModelKind {
    /// All models, in the order of texts.
    pub const ALL: [Self; 8] = [
        Self::EndEffector,
        Self::Guided,
        Self::Modes,
        Self::Angular,
        Self::Stick,
        Self::PelvicLift,
        Self::EndEffectorPaper,
        Self::AngularPaper,
    ];

    /// Default number of particles, or of modes.
    #[must_use]
    pub fn default_particles(self) -> usize {
        match self {
            Self::Guided => 30,
            Self::Modes => MAX_MODES,
            _ => 500,
        }
    }

    /// Whether it is a model with the PIK paper's structure, which sees the points as they are.
    #[must_use]
    pub fn is_printed(self) -> bool {
        matches!(self, Self::EndEffectorPaper | Self::AngularPaper)
    }

    /// The name by which the command knows it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::EndEffector => "end-effector",
            Self::Guided => "guided",
            Self::Modes => "modes",
            Self::Angular => "angular",
            Self::Stick => "stick",
            Self::PelvicLift => "pelvic-lift",
            Self::EndEffectorPaper => "end-effector-paper",
            Self::AngularPaper => "angular-paper",
        }
    }
}

impl FromStr for BodyModelKind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|kind| kind.name() == text);
        named.ok_or_else(|| format!("has to be one of {}, not `{text}`", Self::ALL.map(Self::name).join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_files_and_of_the_command() {
        for kind in BodyModelKind::ALL {
            assert_eq!(kind.name().parse(), Ok(kind));
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.name());
            #[cfg(feature = "command")]
            assert_eq!(clap::ValueEnum::to_possible_value(&kind).unwrap().get_name(), kind.name());
        }
        assert!("guidde".parse::<BodyModelKind>().unwrap_err().contains("guided, modes"));
    }
}
