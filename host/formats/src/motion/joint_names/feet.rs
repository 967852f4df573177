//! Heel and toe of each foot, where a recording has them.

use super::given::GivenNames;
use crate::motion::joint_table::{HEELS, TOES};
use crate::motion::markers::middle;
use crate::motion::name_forms::NameForms;
use sinew_core::math::Vec3;

/// Heel and toe of the left and the right foot, metres; `None` where one was not seen.
pub type FootPoints = [[Option<Vec3>; 2]; 2];

/// Which points of a file are heel and toe of one foot.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FootSources {
    heel_and_toe: [Option<Vec<usize>>; 2],
}

impl FootSources {
    pub fn find(known: &NameForms, given: &GivenNames, left: bool) -> Self {
        let [heel, toe] = given.foot(left);
        let found = |given: Option<usize>, patterns: &[&str]| {
            given.map(|point| vec![point]).or_else(|| known.points(patterns, left))
        };
        Self { heel_and_toe: [found(heel, HEELS), found(toe, TOES)] }
    }

    /// Heel and toe in one frame.
    pub fn points(&self, positions_m: &[Option<Vec3>]) -> [Option<Vec3>; 2] {
        let point = |points: &Option<Vec<usize>>| middle(points.as_ref()?.iter().map(|&point| positions_m[point]));
        self.heel_and_toe.each_ref().map(point)
    }
}
