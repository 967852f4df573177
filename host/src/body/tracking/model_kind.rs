//! The motion models that the command knows by name.

use serde::{Deserialize, Serialize};

/// How particles move from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum BodyModelKind {
    /// Goals of head, hands and feet go on linearly; poses by probabilistic inverse kinematics.
    EndEffector,
    /// As end-effector, with the points pulling at each pose before it is drawn: for few particles.
    Guided,
    /// Each angle goes on by itself: the baseline of the PIK paper.
    Angular,
    /// As end-effector, with both hands on a stick whose ends are known.
    Stick,
    /// Hands, feet and head stay; the pelvis goes up and down over the floor.
    PelvicLift,
    /// The end-effector model with the settings that the paper prints.
    EndEffectorPaper,
    /// The angular model with the settings that the paper prints.
    AngularPaper,
}

impl BodyModelKind {
    /// Whether it is a model with the settings that the paper prints, which sees the points as they
    /// are.
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
            Self::Angular => "angular",
            Self::Stick => "stick",
            Self::PelvicLift => "pelvic-lift",
            Self::EndEffectorPaper => "end-effector-paper",
            Self::AngularPaper => "angular-paper",
        }
    }
}
