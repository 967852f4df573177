//! First measurement of the phase-coupled filter: its noise, and how far its angles are off.
//!
//! The paper's first row is exact (cyclic paper, section 3.2). A user's first row is as noisy as
//! the rest. A person or a joint placement may have offsets beyond the spread of the training.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::kalman::ANGLE_VARIANCE_RAD2;
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::error::ParameterError;
use crate::math::{max, min, sqrt, wrap_angle};
use crate::numeric::rolled::rolled;

/// Median of chi-square with one degree of freedom (tables: 0.454936).
const MEDIAN_CHI_SQUARE: f32 = 0.454_9;

/// The first row with its noise and its offsets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InitialMeasurement<const N: usize> {
    /// Its angles with the noise estimated from the row.
    pub(crate) measurement: AngleMeasurement<N>,
    /// Squared distance of each angle from the mean pose beyond the variances of spread and noise,
    /// rad^2; zero of a smaller one.
    pub(crate) offset_excess_rad2: [f32; N],
}

impl<const N: usize> InitialMeasurement<N> {
    /// The row `first` at cycle position `position`.
    ///
    /// The noise is the distance from the mean pose beyond the spread between people, at most the
    /// stated noise. The median over the angles decides, since noise moves all of them and an
    /// offset only some.
    ///
    /// # Errors
    /// Those of [`AngleMeasurement::with_std`].
    pub(crate) fn of(
        model: &CoupledModel<'_>,
        first: &AngleMeasurement<N>,
        position: f32,
    ) -> Result<Self, ParameterError> {
        let pose = model.mean_pose_rad::<N>(model.point(position));
        let spread = model.deviation_std_rad::<N>();
        let count = model.angle_count().min(N);
        let mut offset_excess_rad2 = [0.0; N];
        let mut excess: heapless::Vec<f32, N> = heapless::Vec::new();
        let angles = offset_excess_rad2.iter_mut().zip(pose).zip(spread).enumerate().take(rolled(count));
        for (i, ((square, pose), spread)) in angles {
            if let Some(angle) = first.angle_rad(i) {
                let off = wrap_angle(angle - pose);
                *square = off * off;
                let _ = excess.push(off * off / MEDIAN_CHI_SQUARE - spread * spread);
            }
        }
        let row_std_rad = if is_on(Part::FirstRowNoise) { sqrt(median(&excess)) } else { f32::MAX };
        // No first row is trusted more than that of the paper's filter.
        let least_std_rad = sqrt(ANGLE_VARIANCE_RAD2);
        let mut std_rad = *first.std_rad();
        for std in std_rad.iter_mut().take(rolled(N)) {
            *std = max(min(*std, row_std_rad), least_std_rad);
        }
        for ((square, spread), std) in offset_excess_rad2.iter_mut().zip(spread).zip(std_rad).take(rolled(N)) {
            let excess = max(*square - spread * spread - std * std, 0.0);
            *square = if is_on(Part::FirstRowOffset) { excess } else { 0.0 };
        }
        Ok(Self { measurement: AngleMeasurement::with_std(first.angles_rad(), &std_rad)?, offset_excess_rad2 })
    }
}

/// Median of `values`, the greater of the two middle ones, at least 0.
fn median(values: &[f32]) -> f32 {
    let below = |&value: &f32| values.iter().filter(|&&other| other < value).count() <= values.len() / 2;
    values.iter().copied().filter(below).fold(0.0, max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic;
    use crate::random::Stream;

    /// First row about the mean pose with noise of `noise_rad`, and an offset of `offset_rad` of
    /// the third angle.
    fn row(noise_rad: f32, offset_rad: f32, seed: u64) -> InitialMeasurement<13> {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let mut stream = Stream::new(seed, 0, 0);
        let pose_rad = model.mean_pose_rad::<13>(model.point(0.0));
        let mut angles_rad = pose_rad.map(|angle| Some(wrap_angle(angle + noise_rad * stream.normal())));
        angles_rad[2] = Some(wrap_angle(pose_rad[2] + offset_rad));
        InitialMeasurement::of(&model, &AngleMeasurement::new(&angles_rad, 1.0).unwrap(), 0.0).unwrap()
    }

    #[test]
    fn an_offset_of_one_angle_is_not_taken_for_noise() {
        for seed in 0..20 {
            let row = row(0.02, 1.2, seed);
            let others = row.offset_excess_rad2.iter().enumerate().filter(|(i, _)| *i != 2);
            assert!(others.map(|(_, &excess)| excess).fold(0.0, max) < 0.01, "{row:?}");
            assert!((1.3..1.44).contains(&row.offset_excess_rad2[2]), "{row:?}");
            assert!(row.measurement.std_rad()[0] < 0.3, "{row:?}");
        }
    }

    #[test]
    fn the_noise_of_a_row_is_estimated_from_it() {
        let rows: [InitialMeasurement<13>; 40] = core::array::from_fn(|seed| row(0.6, 0.6, seed as u64));
        let mean_std_rad = rows.iter().map(|row| row.measurement.std_rad()[0]).sum::<f32>() / 40.0;
        assert!((0.45..0.75).contains(&mean_std_rad), "{mean_std_rad}");
        let beyond = rows.iter().flat_map(|row| row.offset_excess_rad2).filter(|&excess| excess > 0.0).count();
        assert!((110..220).contains(&beyond), "of 520 angles {beyond} lie beyond a standard deviation");
    }
}
