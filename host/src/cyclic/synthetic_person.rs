//! People drawn from a motion model, who move as it says, each in their own way: for trying things
//! without recordings. What is measured on them says nothing about real people.

use super::angle_table::{ANGLES, AngleTable};
use super::model::CyclicModel;
use crate::error::{Context, Result};
use sinew_core::cyclic::MotionModel;
use sinew_core::random::Stream;
use std::f64::consts::TAU;

/// Largest relative difference of a cycle's duration from the model's mean.
const DURATION_SPREAD: f64 = 0.1;

/// One person: the model's mean cycle at their own pace, with a constant and a swing of each angle
/// drawn from the model's spread.
#[derive(Debug, Clone)]
pub struct SyntheticPerson<'m> {
    model: MotionModel<'m>,
    cycle_frames: f64,
    rate_hz: f64,
    /// Constant, cosine and sine part of each angle's own deviation, radians.
    parts_rad: [[f64; 3]; ANGLES],
}

impl<'m> SyntheticPerson<'m> {
    /// The person of number `seed`, seen with `rate_hz` frames per second.
    ///
    /// # Errors
    /// A model without a spread between people.
    pub fn draw(model: &'m CyclicModel, rate_hz: f64, seed: u64) -> Result<Self> {
        let spread = model.numbers().deviation.as_ref().context(
            "the model does not say how people differ, so no cycles can be drawn from it; train it anew, or give recorded cycles",
        )?;
        let view = model.view();
        let mean_frames = f64::from(model.numbers().mean_duration_frames) * rate_hz / f64::from(view.rate_hz());
        // The stored spread is that of unseen people, wider than the one among those that were
        // seen.
        let narrow = f64::from(spread.inflation.max(1.0)).sqrt();
        let mut stream = Stream::new(seed, 0, 0);
        let pace = 1.0 + DURATION_SPREAD * (2.0 * f64::from(stream.uniform()) - 1.0);
        let parts_rad = std::array::from_fn(|i| {
            let mut draw = |std: f32| f64::from(std) / narrow * f64::from(stream.normal());
            [draw(spread.offset_std_rad[i]), draw(spread.cosine_std_rad[i]), draw(spread.sine_std_rad[i])]
        });
        Ok(Self { model: view, cycle_frames: (mean_frames * pace).round().max(2.0), rate_hz, parts_rad })
    }

    /// Duration of a cycle, whole frames.
    #[must_use]
    pub fn cycle_frames(&self) -> f64 {
        self.cycle_frames
    }

    /// Angles at a frame, radians; frame 0 begins a cycle.
    #[must_use]
    pub fn pose_rad(&self, frame: f64) -> [f64; ANGLES] {
        let position = frame / self.cycle_frames;
        let mean = self.model.mean_pose_rad::<ANGLES>(self.model.point(position.fract() as f32));
        let (sine, cosine) = (TAU * position).sin_cos();
        std::array::from_fn(|i| {
            let [constant, p, q] = self.parts_rad[i];
            f64::from(mean[i]) + constant + p * cosine + q * sine
        })
    }

    /// What a detector would measure over some cycles: independent normal errors of `noise_rad`,
    /// and missing angles.
    ///
    /// # Errors
    /// Zero cycles.
    pub fn measured(&self, cycles: u32, noise_rad: f64, missing_share: f64, seed: u64) -> Result<AngleTable> {
        let frames = (f64::from(cycles) * self.cycle_frames) as u64;
        let angles: Vec<[Option<f64>; ANGLES]> = (0..frames)
            .map(|frame| {
                // Index 1: index 0 of this frame may have drawn the person.
                let mut stream = Stream::new(seed, frame, 1);
                self.pose_rad(frame as f64).map(|angle_rad| {
                    let measured_rad = angle_rad + noise_rad * f64::from(stream.normal());
                    (f64::from(stream.uniform()) >= missing_share).then_some(measured_rad)
                })
            })
            .collect();
        Ok(AngleTable::from_angles(0, &angles)?.at_rate(Some(self.rate_hz)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_and_gaps_are_as_wide_as_was_asked_for() {
        let model = CyclicModel::from_option("running").unwrap();
        let person = SyntheticPerson::draw(&model, 60.0, 3).unwrap();
        let table = person.measured(20, 0.1, 0.25, 3).unwrap();
        assert_eq!(table.rows().len(), 20 * person.cycle_frames() as usize);
        let errors: Vec<f64> = (0..)
            .zip(table.rows())
            .flat_map(|(frame, row): (u32, _)| {
                let truth = person.pose_rad(f64::from(frame));
                row.angles_rad.into_iter().zip(truth).filter_map(|(angle, truth)| Some(angle? - truth))
            })
            .collect();
        let share = errors.len() as f64 / (ANGLES * table.rows().len()) as f64;
        let std = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
        assert!((0.72..0.78).contains(&share) && (0.095..0.105).contains(&std), "{share} {std}");
    }

    #[test]
    fn a_person_without_noise_returns_after_each_cycle() {
        let model = CyclicModel::from_option("walking").unwrap();
        let person = SyntheticPerson::draw(&model, 60.0, 1).unwrap();
        let table = person.measured(2, 0.0, 0.0, 1).unwrap();
        let period = person.cycle_frames() as usize;
        let (first, again) = (&table.rows()[7].angles_rad, &table.rows()[7 + period].angles_rad);
        assert!(first.iter().zip(again).all(|(a, b)| (a.unwrap() - b.unwrap()).abs() < 1.0e-4), "{first:?} {again:?}");
    }
}
