//! What a phase-coupled filter takes the first row for: the paper's is exact, a user's is as noisy as the rest, and a person, or
//! whoever placed the joints, may hold some angles otherwise than any walker of the training.

use crate::cyclic::{AngleMeasurement, MotionModel};
use crate::error::ParameterError;
use crate::math::{max, min, sqrt, wrap_angle};

/// Least standard deviation of the angles of the first row, rad: the cyclic filters' initial variance of 1e-4 rad^2.
const MIN_STD_RAD: f32 = 0.01;
/// By how much training widens the spread between people (`inflation` of the model files).
const SPREAD_INFLATION: f32 = 4.0;
/// Median of the square of a standard normal.
const MEDIAN_CHI_SQUARE: f32 = 0.454_9;
/// Noise too small to be seen beside the spread between people, rad.
const SMALL_STD_RAD: f32 = 0.025;
/// An angle this many standard deviations of spread and noise off the mean pose is held otherwise.
const MIN_UNUSUAL_SIGMAS: f32 = 2.0;

/// The first row, judged by the mean pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct InitialMeasurement<const N: usize> {
    /// Its angles with the noise that they show.
    pub(super) measurement: AngleMeasurement<N>,
    /// Squared distance from the mean pose of each angle that is held otherwise; zero for all others.
    pub(super) unusual_offset_rad2: [f32; N],
}

impl<const N: usize> InitialMeasurement<N> {
    /// The row `first` of somebody at cycle position `position`.
    ///
    /// Its noise is what the distance from the mean pose shows beyond the spread between people: at most its own, that of the rows to
    /// come; at least half of that where it is small. The middle one of the angles tells, since noise moves them all, and another way
    /// to hold or place them only some.
    ///
    /// # Errors
    /// Those of [`AngleMeasurement::with_std`].
    pub(super) fn of(
        model: &MotionModel<'_>,
        first: &AngleMeasurement<N>,
        position: f32,
    ) -> Result<Self, ParameterError> {
        let pose = model.mean_pose_rad::<N>(model.point(position));
        let spread = model.deviation_std_rad::<N>();
        let count = model.angle_count().min(N);
        let mut unusual_offset_rad2 = [0.0; N];
        let mut excess: heapless::Vec<f32, N> = heapless::Vec::new();
        for i in 0..count {
            if let Some(angle) = first.angle_rad(i) {
                let off = wrap_angle(angle - pose[i]);
                unusual_offset_rad2[i] = off * off;
                let _ = excess.push(off * off / MEDIAN_CHI_SQUARE - spread[i] * spread[i] / SPREAD_INFLATION);
            }
        }
        let looks = sqrt(median(&excess));
        let std_rad = first.std_rad().map(|std| max(min(std, looks), max(min(0.5 * std, SMALL_STD_RAD), MIN_STD_RAD)));
        let within = MIN_UNUSUAL_SIGMAS * MIN_UNUSUAL_SIGMAS;
        for ((square, spread), std) in unusual_offset_rad2.iter_mut().zip(spread).zip(std_rad) {
            if *square <= within * (spread * spread + std * std) {
                *square = 0.0;
            }
        }
        Ok(Self { measurement: AngleMeasurement::with_std(first.angles_rad(), &std_rad)?, unusual_offset_rad2 })
    }
}

/// The value with as many below it as above, the greater of two; at least 0.
fn median(values: &[f32]) -> f32 {
    let below = |&value: &f32| values.iter().filter(|&&other| other < value).count() <= values.len() / 2;
    values.iter().copied().filter(below).fold(0.0, max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic;
    use crate::random::Stream;

    /// Frames of the first row's angles about the mean pose, with `noise_rad` on all of them and the third one `held_rad` away.
    fn row(noise_rad: f32, held_rad: f32, seed: u64) -> InitialMeasurement<13> {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let mut stream = Stream::new(seed, 0, 0);
        let pose_rad = model.mean_pose_rad::<13>(model.point(0.0));
        let mut angles_rad = pose_rad.map(|angle| Some(wrap_angle(angle + noise_rad * stream.normal())));
        angles_rad[2] = Some(wrap_angle(pose_rad[2] + held_rad));
        InitialMeasurement::of(&model, &AngleMeasurement::new(&angles_rad, 1.0).unwrap(), 0.0).unwrap()
    }

    #[test]
    fn one_angle_held_otherwise_is_no_noise() {
        for seed in 0..20 {
            let row = row(0.02, 1.2, seed);
            assert!(
                row.unusual_offset_rad2.iter().enumerate().all(|(i, &square)| (i == 2) == (square > 0.0)),
                "{row:?}"
            );
            assert!((row.unusual_offset_rad2[2] - 1.44).abs() < 0.01);
            assert!(row.measurement.std_rad()[0] < 0.3, "{row:?}");
        }
    }

    #[test]
    fn a_noisy_row_is_as_noisy_as_it_looks() {
        let rows: [InitialMeasurement<13>; 40] = core::array::from_fn(|seed| row(0.6, 0.6, seed as u64));
        let mean_std_rad = rows.iter().map(|row| row.measurement.std_rad()[0]).sum::<f32>() / 40.0;
        assert!((0.45..0.75).contains(&mean_std_rad), "{mean_std_rad}");
        let otherwise = rows.iter().flat_map(|row| row.unusual_offset_rad2).filter(|&square| square > 0.0).count();
        assert!((5..80).contains(&otherwise), "of 520 angles {otherwise} lie beyond two standard deviations");
    }
}
