//! Why a table shows no gait.

use super::strides::Foot;
use std::fmt;

/// Why there are no foot strikes and toe-offs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoGait {
    /// The table leaves out nearly all frames between its first and its last, or has too few a
    /// second for the filter.
    TooFewFrames,
    /// No leg is seen.
    NoLeg,
    /// No foot is seen from a strike to its next one.
    NoStride,
    /// The feet do not take turns.
    NoTurns,
    /// No stride shows the leg of this foot, and the other one does not go forward through the air
    /// and back on the ground.
    Unseen(Foot),
}

impl fmt::Display for NoGait {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("no foot strikes and toe-offs: ")?;
        match self {
            Self::TooFewFrames => f.write_str("the table has too few frames for its time; see --input-rate"),
            Self::NoLeg => f.write_str("no knee and ankle are seen; film the legs, too"),
            Self::NoStride => {
                f.write_str("no leg is seen from a strike of its foot to the next one without a gap; record longer")
            }
            Self::NoTurns => f.write_str("the feet do not take turns as in a walk or a run"),
            Self::Unseen(foot) => {
                let name = foot.name();
                write!(f, "the {name} leg is not seen, and the other foot does not step; film the {name} side, too")
            }
        }
    }
}
