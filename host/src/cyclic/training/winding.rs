//! Angles that wind in some training cycles and not in others: their mean is that of no cycle.

use super::TrainingCycle;
use super::statistics::angle_count;
use crate::cyclic::angle_table::angle_columns;
use std::collections::BTreeMap;
use std::fmt;

/// An angle about whose whole turns the cycles disagree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnevenTurns {
    /// Name of the angle's column.
    pub angle: &'static str,
    /// Cycles of each number of whole turns.
    pub cycles_of_turns: BTreeMap<i32, usize>,
}

/// Every angle that makes more whole turns in one cycle than in another, in the order of the
/// columns.
#[must_use]
pub fn uneven_turns(cycles: &[TrainingCycle]) -> Vec<UnevenTurns> {
    let all = angle_columns().take(angle_count(cycles)).enumerate().map(|(index, angle)| {
        let mut cycles_of_turns = BTreeMap::new();
        for cycle in cycles {
            *cycles_of_turns.entry(cycle.turns(index)).or_insert(0) += 1;
        }
        UnevenTurns { angle, cycles_of_turns }
    });
    all.filter(|angle| angle.cycles_of_turns.len() > 1).collect()
}

impl fmt::Display for UnevenTurns {
    /// As a sentence for people.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` winds unevenly:", self.angle)?;
        for (index, (turns, cycles)) in self.cycles_of_turns.iter().enumerate() {
            let comma = if index > 0 { "," } else { "" };
            write!(f, "{comma} {turns} turns in {cycles} of the cycles")?;
        }
        write!(f, "; the model holds what most do, so cut apart what moves differently")
    }
}
