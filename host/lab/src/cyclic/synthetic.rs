//! Test cycles drawn from a model: people who move as the model says, each in their own way. For
//! trying the command without recordings; the errors say nothing about real people.

use super::protocol::TestCycle;
use anyhow::Result;
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::{AngleTable, CyclicModel, SyntheticPerson};

/// Number of cycles.
pub const CYCLES: u64 = 13;

/// [`CYCLES`] cycles at `rate_hz`: the mean cycle, a constant and a swing of each angle drawn from
/// the model's spread.
///
/// # Errors
/// A model without a spread between people.
pub fn cycles(model: &CyclicModel, rate_hz: f64) -> Result<Vec<TestCycle>> {
    (1..=CYCLES)
        .map(|seed| {
            let person = SyntheticPerson::draw(model, rate_hz, seed)?;
            let angles: Vec<[Option<f64>; ANGLES]> =
                (0..person.cycle_frames() as u64).map(|frame| person.pose_rad(frame as f64).map(Some)).collect();
            Ok(TestCycle { name: format!("synthetic:{seed}"), truth: AngleTable::from_angles(0, &angles)? })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_differ_in_pace_and_pose_and_are_the_same_again() {
        let model = CyclicModel::from_option("walking").unwrap();
        let [first, again] = [(); 2].map(|()| cycles(&model, 60.0).unwrap());
        assert_eq!(first, again);
        assert_eq!(first.len() as u64, CYCLES);
        let frames: Vec<usize> = first.iter().map(|cycle| cycle.truth.rows().len()).collect();
        assert!(frames.iter().min() < frames.iter().max(), "{frames:?}");
        assert!(first[0].truth.rows()[0] != first[1].truth.rows()[0]);
    }
}
