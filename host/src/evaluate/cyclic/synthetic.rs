//! Test cycles drawn from a model: people who move as the model says, each in their own way. For trying the command without
//! recordings; the errors say nothing about real people.

use super::protocol::TestCycle;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::{AngleTable, CyclicModel};
use anyhow::{Context, Result};
use sinew_core::random::Stream;
use std::f64::consts::TAU;

/// Number of cycles.
pub const CYCLES: u64 = 13;
/// Greatest relative difference of a cycle's duration from the model's mean.
const DURATION_SPREAD: f64 = 0.1;

/// [`CYCLES`] cycles at `rate_hz`: the mean cycle, a constant and a swing of each angle drawn from the model's spread.
///
/// # Errors
/// A model without a spread between people.
pub fn cycles(model: &CyclicModel, rate_hz: f64) -> Result<Vec<TestCycle>> {
    let spread = model.numbers().deviation.as_ref().context(
        "the model does not say how people differ, so no test cycles can be drawn from it; give a list with --test",
    )?;
    let view = model.view();
    let mean_duration = f64::from(model.numbers().mean_duration_frames) * rate_hz / f64::from(view.rate_hz());
    // The stored spread is that of unseen people, wider than the one among those that were seen.
    let narrow = f64::from(spread.inflation.max(1.0)).sqrt();
    (1..=CYCLES)
        .map(|seed| {
            let mut stream = Stream::new(seed, 0, 0);
            let pace = 1.0 + DURATION_SPREAD * (2.0 * f64::from(stream.uniform()) - 1.0);
            let duration = (mean_duration * pace).round().max(2.0);
            let parts: [[f64; 3]; ANGLES] = std::array::from_fn(|i| {
                let mut draw = |std: f32| f64::from(std) / narrow * f64::from(stream.normal());
                [draw(spread.offset_std_rad[i]), draw(spread.swing_std_rad[i]), draw(spread.swing_std_rad[i])]
            });
            let pose = |frame: u64| {
                let position = frame as f64 / duration;
                let mean = view.mean_pose_rad::<ANGLES>(view.point(position as f32));
                let (sine, cosine) = (TAU * position).sin_cos();
                std::array::from_fn(|i| {
                    let [constant, p, q] = parts[i];
                    Some(f64::from(mean[i]) + constant + p * cosine + q * sine)
                })
            };
            let angles: Vec<[Option<f64>; ANGLES]> = (0..duration as u64).map(pose).collect();
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
