//! Mean and covariance over the training cycles at each position of the reference cycle (cyclic
//! paper, section 2.3).

use super::cycle::TrainingCycle;
use crate::cyclic::turns::{circular_mean, unwrap_along_time};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Numbers of one position.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionStatistics {
    /// Mean angular acceleration, rad per reference frame squared.
    pub mean_acceleration: Vec<f64>,
    /// Covariance of the acceleration as a packed lower triangle, rad^2 per reference frame^4;
    /// divided by cycles - 1 where all have the same weight.
    pub acceleration_covariance: Vec<f64>,
    /// Mean angles, radians; see [`mean_pose`].
    pub mean_pose_rad: Vec<f64>,
    /// Mean angular velocity, rad per reference frame.
    pub mean_velocity: Vec<f64>,
}

/// Statistics at each of `length` positions. Derivatives are central differences over one reference
/// frame, 1 / `length` of a cycle, for which k = v / `v_ref` is 1. The acceleration is the
/// difference of differences.
#[must_use]
pub fn of_positions(cycles: &[TrainingCycle], length: usize) -> Vec<PositionStatistics> {
    let poses = mean_pose(cycles, length);
    (0..length)
        .map(|position| {
            let derivatives: Vec<Derivatives> =
                cycles.iter().map(|cycle| derivatives(cycle, position, length)).collect();
            let accelerations: Vec<&[f64]> = derivatives.iter().map(|d| d.acceleration.as_slice()).collect();
            let velocities: Vec<&[f64]> = derivatives.iter().map(|d| d.velocity.as_slice()).collect();
            let weights: Vec<f64> = cycles.iter().map(TrainingCycle::weight).collect();
            let mean_acceleration = mean(&accelerations, &weights);
            PositionStatistics {
                acceleration_covariance: covariance(&accelerations, &weights, &mean_acceleration),
                mean_acceleration,
                mean_pose_rad: poses[position].clone(),
                mean_velocity: mean(&velocities, &weights),
            }
        })
        .collect()
}

/// Mean angles at positions 0 to `length`, both included, radians. At each position it is the mean
/// on the circle, so that cycles whose angles differ by whole turns agree. The means are unwrapped
/// along the cycle. The last row is where the mean cycle ends.
///
/// A limb that points at the camera may turn either way, so an angle may wind in some cycles only.
/// Then it is the mean of the cycles with the commonest number of turns. The mean of both ways is a
/// pose that does not occur.
#[must_use]
pub fn mean_pose(cycles: &[TrainingCycle], length: usize) -> Vec<Vec<f64>> {
    let count = angle_count(cycles);
    let mut poses = vec![vec![0.0; count]; length + 1];
    for angle in 0..count {
        let usual = usual_cycles(cycles, angle);
        let at = |position: usize| {
            let place = position as f64 / length as f64;
            circular_mean(&usual.iter().map(|cycle| (cycle.angle_at(angle, place), cycle.weight())).collect::<Vec<_>>())
        };
        let mut series: Vec<Option<f64>> = (0..=length).map(at).collect();
        unwrap_along_time(&mut series);
        for (pose, value) in poses.iter_mut().zip(series) {
            pose[angle] = value.unwrap_or(0.0);
        }
    }
    poses
}

/// The cycles in which an angle makes as many whole turns as in most; all where no number is the
/// most frequent one.
fn usual_cycles(cycles: &[TrainingCycle], angle: usize) -> Vec<&TrainingCycle> {
    let turns =
        |cycle: &TrainingCycle| ((cycle.angle_at(angle, 1.0) - cycle.angle_at(angle, 0.0)) / TAU).round() as i32;
    let mut groups: BTreeMap<i32, Vec<&TrainingCycle>> = BTreeMap::new();
    for cycle in cycles {
        groups.entry(turns(cycle)).or_default().push(cycle);
    }
    let most = groups.values().map(Vec::len).max().unwrap_or(0);
    let mut largest = groups.into_values().filter(|group| group.len() == most);
    match (largest.next(), largest.next()) {
        (Some(group), None) => group,
        _ => cycles.iter().collect(),
    }
}

/// Angles that all the cycles have.
#[must_use]
pub fn angle_count(cycles: &[TrainingCycle]) -> usize {
    cycles.iter().map(TrainingCycle::angle_count).min().unwrap_or(0)
}

/// Whole turns that each angle of the mean cycle makes.
#[must_use]
pub fn turns_per_cycle(cycles: &[TrainingCycle], length: usize) -> Vec<i8> {
    let poses = mean_pose(cycles, length);
    let ends = poses[length].iter().zip(&poses[0]);
    ends.map(|(last, first)| ((last - first) / TAU).round() as i8).collect()
}

struct Derivatives {
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

fn derivatives(cycle: &TrainingCycle, position: usize, length: usize) -> Derivatives {
    let place = |step: f64| (position as f64 + step) / length as f64;
    let count = cycle.angle_count();
    let at = |step: f64| -> Vec<f64> { (0..count).map(|angle| cycle.angle_at(angle, place(step))).collect() };
    let (before, after) = (at(-1.0), at(1.0));
    let (far_before, here, far_after) = (at(-2.0), at(0.0), at(2.0));
    Derivatives {
        velocity: (0..count).map(|i| 0.5 * (after[i] - before[i])).collect(),
        // The central filter applied twice.
        acceleration: (0..count).map(|i| 0.25 * (far_after[i] - 2.0 * here[i] + far_before[i])).collect(),
    }
}

fn mean(rows: &[&[f64]], weights: &[f64]) -> Vec<f64> {
    let count = rows.first().map_or(0, |row| row.len());
    let total: f64 = weights.iter().sum();
    (0..count).map(|i| rows.iter().zip(weights).map(|(row, weight)| weight * row[i]).sum::<f64>() / total).collect()
}

/// The unbiased covariance of weighted rows.
fn covariance(rows: &[&[f64]], weights: &[f64], mean: &[f64]) -> Vec<f64> {
    let total: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    let entry = |i: usize, j: usize| {
        let weighted = rows.iter().zip(weights);
        let sum: f64 = weighted.map(|(row, weight)| weight * (row[i] - mean[i]) * (row[j] - mean[j])).sum();
        sum / (total - squares / total)
    };
    (0..mean.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::angle_table::ANGLES;
    use crate::cyclic::angle_table::AngleTable;
    use crate::cyclic::cuts::Cut;

    /// A swing of `amplitude` whose angles are all `turns` whole turns off, and an angle that
    /// winds.
    fn cycle(amplitude: f64, turns: f64, frames: u64) -> TrainingCycle {
        let row = |frame: u64| {
            let phase = TAU * frame as f64 / frames as f64;
            let mut angles = [Some(TAU * turns + amplitude * phase.sin()); ANGLES];
            angles[3] = Some(amplitude - phase);
            angles
        };
        let table = AngleTable::from_angles(0, &(0..3 * frames).map(row).collect::<Vec<_>>()).unwrap();
        TrainingCycle::new(
            &table,
            &Cut { file: String::new(), start_frame: frames, end_frame: 2 * frames, person: None, line: 2 },
        )
        .unwrap()
    }

    #[test]
    fn people_have_the_same_weight_however_many_cycles_each_has() {
        let one = [cycle(0.5, 0.0, 50), cycle(1.0, 0.0, 50)];
        let own = |cycle: &TrainingCycle, person: &str| cycle.clone().of_person(person);
        let mut many = [own(&one[0], "a"), own(&one[0], "a"), own(&one[0], "a"), own(&one[1], "b")];
        crate::cyclic::training::cycle::weigh_people(&mut many);
        for (few, many) in of_positions(&one, 100).iter().zip(of_positions(&many, 100)) {
            for (few, many) in few.mean_pose_rad.iter().zip(&many.mean_pose_rad) {
                assert!((few - many).abs() < 1.0e-9);
            }
            for (few, many) in few.mean_acceleration.iter().zip(&many.mean_acceleration) {
                assert!((few - many).abs() < 1.0e-9);
            }
        }
    }

    #[test]
    fn amplitudes_of_half_and_whole_give_their_mean_and_spread() {
        let cycles = [cycle(0.5, 0.0, 50), cycle(1.0, 3.0, 80)];
        let statistics = of_positions(&cycles, 100);
        let step = TAU / 100.0;
        for (position, found) in statistics.iter().enumerate() {
            let sine = (step * position as f64).sin();
            let (acceleration, spread) = (-0.75 * step * step * sine, 0.125 * (step * step * sine).powi(2));
            assert!((found.mean_acceleration[0] - acceleration).abs() < 1.0e-5, "{position}");
            assert!((found.acceleration_covariance[0] - spread).abs() < 2.0e-7, "{position}");
            assert!((found.mean_pose_rad[0] - 0.75 * sine).abs() < 1.0e-4, "{position}: {}", found.mean_pose_rad[0]);
            assert!((found.mean_velocity[0] - 0.75 * step * (step * position as f64).cos()).abs() < 1.0e-4);
            assert!((found.mean_velocity[3] + step).abs() < 1.0e-9);
        }
        assert_eq!(turns_per_cycle(&cycles, 100)[..5], [0, 0, 0, -1, 0]);
    }
}
