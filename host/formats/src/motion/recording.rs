//! Positions of named joints over time: what the readers of skeleton motions give.

use super::shortfall::Shortfall;
use sinew_core::math::Vec3;

/// Positions of named joints over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Frames in a second.
    pub frames_per_second: f32,
    /// Names, in the file's order.
    pub joints: Vec<String>,
    /// Place of each joint's parent among them; `None` of a root.
    pub parents: Vec<Option<usize>>,
    /// Positions in metres, `frames` rows of `joints.len()`, row by row; axes as in the file.
    pub positions_m: Vec<Vec3>,
    /// How many frames its header promises, where these are more than there are.
    pub shortfall: Option<Shortfall>,
}

impl Motion {
    /// How many frames there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions_m.len().checked_div(self.joints.len()).unwrap_or(0)
    }

    /// Whether there is no frame.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Positions of all joints in one frame, metres.
    ///
    /// # Panics
    /// If `frame` is not below [`Motion::len`].
    #[must_use]
    pub fn frame(&self, frame: usize) -> &[Vec3] {
        let joints = self.joints.len();
        &self.positions_m[frame * joints..(frame + 1) * joints]
    }

    /// Index of the joint called `name`, whatever the case and whatever stands before a colon.
    #[must_use]
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.rsplit(':').next().is_some_and(|j| j.eq_ignore_ascii_case(name)))
    }
}
