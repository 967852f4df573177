//! Tables of earlier versions, in which left and right of a person who faces left were exchanged.

use super::columns::ANGLES;
use crate::cyclic::facing::{FACING, Facing};
use sinew_core::skeleton::stick_figure::HUMAN;

/// Column that said `1` where left and right were exchanged.
const EXCHANGED: &str = "mirrored";

/// How the rows of such a table get their own sides back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnSides {
    column: usize,
    /// Pairs of extra columns, left and right.
    pairs: Vec<[usize; 2]>,
}

impl OwnSides {
    /// Of a table with the column `mirrored`, which is then named as in new ones.
    #[must_use]
    pub fn of_old_table(extra_columns: &mut [String]) -> Option<Self> {
        let column = extra_columns.iter().position(|name| name == EXCHANGED)?;
        FACING.clone_into(&mut extra_columns[column]);
        let right = |left: &str| Some(format!("r_{}", left.strip_prefix("l_")?));
        let pair = |(index, name): (usize, &String)| {
            let other = right(name)?;
            Some([index, extra_columns.iter().position(|name| *name == other)?])
        };
        let pairs = extra_columns.iter().enumerate().filter_map(pair).collect();
        Some(Self { column, pairs })
    }

    /// Gives a row's angles and its extra cells their own sides back.
    pub fn restore(&self, angles_rad: &mut [Option<f64>; ANGLES], extra: &mut [String]) {
        let facing = if extra[self.column] == "1" { Facing::Left } else { Facing::Right };
        facing.name().clone_into(&mut extra[self.column]);
        if facing == Facing::Right {
            return;
        }
        self.pairs.iter().for_each(|[left, right]| extra.swap(*left, *right));
        *angles_rad = sides_exchanged(angles_rad);
    }
}

/// What belongs to the angles, with left and right exchanged.
#[must_use]
pub fn sides_exchanged<T: Clone>(of_angles: &[T; ANGLES]) -> [T; ANGLES] {
    // Joint 0 is the root, which has no angle.
    std::array::from_fn(|angle| of_angles[usize::from(HUMAN.joints()[angle + 1].mirror) - 1].clone())
}
