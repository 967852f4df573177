//! How people differ from the mean cycle, learned from a few cycles of a few people (see
//! [`sinew_core::cyclic::Deviation`]).
//!
//! Each cycle's deviation from the mean is split into a constant, a cosine and a sine with the
//! cycle's own period, and a rest. Variances are taken from pairs of cycles: half the squared
//! difference of two is an unbiased estimate. Two cycles of one person say little about the next
//! one, so pairs of different people are used, each person with the same weight. Where it is not
//! known whose cycle it is, the half of the pairs that differ most is used.

use super::cycle::TrainingCycle;
use super::statistics::{angle_count, mean_pose};
use crate::cyclic::model::DeviationNumbers;
use crate::cyclic::turns::wrapped;
use std::f64::consts::TAU;

/// Factor of the variances of constant, cosine and sine, where it is not known whose cycle it is.
///
/// Chosen: they come from about three people. The spread of a new person is that of a t
/// distribution with few degrees of freedom, and the mean cycle is as uncertain.
const INFLATION: f64 = 4.0;
/// So many people have no variance of their t distribution.
const FEW_PEOPLE: usize = 3;
/// Part of the variance of constant, cosine and sine that is replaced by the mean over the angles.
const SHRINKAGE: f64 = 0.2;
/// The same for the rest, which differs from cycle to cycle as well and is known from more than a
/// few cycles.
const REST_INFLATION: f64 = 2.0;
/// The same part of the rest's variance. It is more, since how much of an angle's fine movement is
/// a person's own depends on how the joints were placed. For short links that differs most between
/// sources.
const REST_SHRINKAGE: f64 = 0.35;
/// Smallest standard deviation, radians (a third of a degree): labels are no better.
const MIN_STD_RAD: f64 = 0.006;
/// Bounds of the rest's rate per cycle: slower is a swing, faster is noise.
const RATE_PER_CYCLE: (f64, f64) = (6.0, 60.0);

/// Constant, cosine and sine of one angle in one cycle, and the rest at each position.
struct Parts {
    coefficients: [f64; 3],
    rest: Vec<f64>,
}

/// Learns the deviation's spread from two or more cycles at `length` positions.
#[must_use]
pub fn of_cycles(cycles: &[TrainingCycle], length: usize) -> DeviationNumbers {
    let (poses, count) = (mean_pose(cycles, length), angle_count(cycles));
    let parts: Vec<Vec<Parts>> =
        cycles.iter().map(|cycle| (0..count).map(|angle| split(cycle, angle, &poses, length)).collect()).collect();
    let people = people(cycles);
    let (pairs, inflation, rest_inflation) = if people < 2 {
        (far_pairs(&parts), INFLATION, REST_INFLATION)
    } else {
        let factor = new_person_factor(people);
        (pairs_of_people(cycles), factor, factor.min(REST_INFLATION))
    };
    let total: f64 = pairs.iter().map(|(_, weight)| weight).sum();
    let over_pairs = |value: &dyn Fn(&Parts, &Parts) -> f64, angle: usize| {
        pairs.iter().map(|&((i, k), weight)| weight * value(&parts[i][angle], &parts[k][angle])).sum::<f64>() / total
    };
    let coefficient = |which: usize| -> Vec<f64> {
        let of_angle = |angle| over_pairs(&|a, b| half_square(a.coefficients[which] - b.coefficients[which]), angle);
        (0..count).map(of_angle).collect()
    };
    let offset = coefficient(0);
    let (cosine, sine) = swing(coefficient(1), coefficient(2), people);
    let rest: Vec<f64> = (0..count).map(|angle| over_pairs(&rest_variance, angle)).collect();
    let rate = |angle: usize| {
        let slope = over_pairs(&slope_variance, angle);
        (slope / rest[angle].max(f64::MIN_POSITIVE)).sqrt().clamp(RATE_PER_CYCLE.0, RATE_PER_CYCLE.1)
    };
    DeviationNumbers {
        inflation: inflation as f32,
        shrinkage: SHRINKAGE as f32,
        offset_std_rad: stds(&offset, inflation, SHRINKAGE),
        cosine_std_rad: stds(&cosine, inflation, SHRINKAGE),
        sine_std_rad: stds(&sine, inflation, SHRINKAGE),
        rest_std_rad: stds(&rest, rest_inflation, REST_SHRINKAGE),
        rest_rate_per_cycle: (0..count).map(|angle| rate(angle) as f32).collect(),
    }
}

/// Least-squares fit of constant, cosine and sine to the deviation at equidistant positions, where
/// they are orthogonal.
fn split(cycle: &TrainingCycle, angle: usize, poses: &[Vec<f64>], length: usize) -> Parts {
    let place = |position: usize| position as f64 / length as f64;
    let mut deviation: Vec<f64> =
        (0..length).map(|position| wrapped(cycle.angle_at(angle, place(position)) - poses[position][angle])).collect();
    let mean = |weight: &dyn Fn(f64) -> f64| {
        deviation.iter().enumerate().map(|(i, value)| value * weight(TAU * place(i))).sum::<f64>() / length as f64
    };
    let coefficients = [mean(&|_| 1.0), 2.0 * mean(&f64::cos), 2.0 * mean(&f64::sin)];
    for (i, value) in deviation.iter_mut().enumerate() {
        let phase = TAU * place(i);
        *value -= coefficients[0] + coefficients[1] * phase.cos() + coefficients[2] * phase.sin();
    }
    Parts { coefficients, rest: deviation }
}

/// Variances of cosine and sine, rad^2. Few people do not show which of them differs more, so that
/// both have their mean.
fn swing(cosine: Vec<f64>, sine: Vec<f64>, people: usize) -> (Vec<f64>, Vec<f64>) {
    if people > FEW_PEOPLE {
        return (cosine, sine);
    }
    let mean: Vec<f64> = cosine.iter().zip(&sine).map(|(cosine, sine)| 0.5 * (cosine + sine)).collect();
    (mean.clone(), mean)
}

/// Number of people; 0 where it is not known whose cycles these are.
fn people(cycles: &[TrainingCycle]) -> usize {
    let mut people: Vec<_> = cycles.iter().filter_map(TrainingCycle::person).collect();
    people.sort_unstable();
    people.dedup();
    people.len()
}

/// Ratio of the variance of a new person about the mean of `people` to the variance between people:
/// that of a t distribution with `people` - 1 degrees of freedom, about a mean that is uncertain by
/// one part in `people`. At most that of unknown people, which few people would exceed.
fn new_person_factor(people: usize) -> f64 {
    let n = people as f64;
    if people <= FEW_PEOPLE { INFLATION } else { ((1.0 + 1.0 / n) * (n - 1.0) / (n - 3.0)).min(INFLATION) }
}

/// Two cycles, and the weight of what they differ by.
type Pair = ((usize, usize), f64);

/// The pairs of cycles of different people.
fn pairs_of_people(cycles: &[TrainingCycle]) -> Vec<Pair> {
    let all = (0..cycles.len()).flat_map(|i| (0..i).map(move |k| (i, k)));
    all.filter(|&(i, k)| cycles[i].person() != cycles[k].person())
        .map(|(i, k)| ((i, k), cycles[i].weight() * cycles[k].weight()))
        .collect()
}

/// The half of the pairs of cycles that differ most, each coefficient of each angle relative to its
/// own spread.
fn far_pairs(parts: &[Vec<Parts>]) -> Vec<Pair> {
    let all: Vec<(usize, usize)> = (0..parts.len()).flat_map(|i| (0..i).map(move |k| (i, k))).collect();
    let squares = |&(i, k): &(usize, usize)| -> Vec<f64> {
        let both = parts[i].iter().zip(&parts[k]);
        both.flat_map(|(a, b)| (0..3).map(|c| half_square(a.coefficients[c] - b.coefficients[c]))).collect()
    };
    let table: Vec<Vec<f64>> = all.iter().map(squares).collect();
    let scale: Vec<f64> = (0..table.first().map_or(0, Vec::len))
        .map(|column| table.iter().map(|row| row[column]).sum::<f64>() / table.len() as f64 + f64::MIN_POSITIVE)
        .collect();
    let distance = |row: &Vec<f64>| row.iter().zip(&scale).map(|(value, scale)| value / scale).sum::<f64>();
    let mut ranked: Vec<(f64, (usize, usize))> = table.iter().map(distance).zip(all).collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.truncate(ranked.len().div_ceil(2));
    ranked.into_iter().map(|(_, pair)| (pair, 1.0)).collect()
}

fn half_square(difference: f64) -> f64 {
    0.5 * difference * difference
}

/// Half the mean squared difference of two rests.
fn rest_variance(a: &Parts, b: &Parts) -> f64 {
    a.rest.iter().zip(&b.rest).map(|(a, b)| half_square(a - b)).sum::<f64>() / a.rest.len() as f64
}

/// The same of their slopes per cycle, from central differences inside the cycle.
fn slope_variance(a: &Parts, b: &Parts) -> f64 {
    let length = a.rest.len();
    let difference: Vec<f64> = a.rest.iter().zip(&b.rest).map(|(a, b)| a - b).collect();
    let slope = |window: &[f64]| half_square(0.5 * (window[2] - window[0]) * length as f64);
    difference.windows(3).map(slope).sum::<f64>() / (length - 2) as f64
}

/// Standard deviations of variances, moved by the part `shrinkage` to their mean and multiplied by
/// `factor`.
fn stds(variances: &[f64], factor: f64, shrinkage: f64) -> Vec<f32> {
    let mean = variances.iter().sum::<f64>() / variances.len() as f64;
    let std = |variance: &f64| (factor * ((1.0 - shrinkage) * variance + shrinkage * mean)).sqrt().max(MIN_STD_RAD);
    variances.iter().map(|variance| std(variance) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::angle_table::ANGLES;
    use crate::cyclic::angle_table::AngleTable;
    use crate::cyclic::cuts::Cut;

    /// Angle 0 differs by `offset`, angle 1 by `swing` times a cosine, angle 2 by a ripple of three
    /// periods a cycle.
    fn cycle(offset: f64, swing: f64, ripple: f64) -> TrainingCycle {
        let row = |frame: u32| {
            let phase = TAU * f64::from(frame) / 60.0;
            let mut angles = [Some(0.5 * phase.sin()); ANGLES];
            angles[0] = angles[0].map(|value| value + offset);
            angles[1] = angles[1].map(|value| value + swing * phase.cos());
            angles[2] = angles[2].map(|value| value + ripple * (3.0 * phase).sin());
            angles
        };
        let table = AngleTable::from_angles(0, &(0..180).map(row).collect::<Vec<_>>()).unwrap();
        TrainingCycle::new(&table, &Cut { file: String::new(), start_frame: 60, end_frame: 120, person: None, line: 2 })
            .unwrap()
    }

    #[test]
    fn each_part_goes_where_it_belongs() {
        let numbers = of_cycles(&[cycle(0.0, 0.0, 0.0), cycle(0.4, 0.3, 0.2)], 100);
        let part = |own: f64, of: f64, share: f64| (1.0 - share) * own + share * of / ANGLES as f64;
        let pooled = |own: f64, of: f64| (INFLATION * part(own, of, SHRINKAGE)).sqrt() as f32;
        let offset = half_square(0.4);
        assert!((numbers.offset_std_rad[0] - pooled(offset, offset)).abs() < 1.0e-3);
        assert!((numbers.offset_std_rad[1] - pooled(0.0, offset)).abs() < 1.0e-3);
        let swing = 0.5 * half_square(0.3);
        assert!((numbers.cosine_std_rad[1] - pooled(swing, swing)).abs() < 1.0e-3);
        assert_eq!(numbers.cosine_std_rad, numbers.sine_std_rad, "one pair does not show which differs more");
        let rest = 0.5 * half_square(0.2);
        let wanted = (REST_INFLATION * part(rest, rest, REST_SHRINKAGE)).sqrt() as f32;
        assert!((numbers.rest_std_rad[2] - wanted).abs() < 1.0e-3);
        assert!((f64::from(numbers.rest_rate_per_cycle[2]) - 3.0 * TAU).abs() < 0.5, "a sine has its own rate");
    }

    /// Three cycles of one person and one of another: the pairs of both people count, those of one
    /// do not.
    #[test]
    fn cycles_of_one_person_do_not_hide_how_people_differ() {
        let cycles = [cycle(0.0, 0.0, 0.0), cycle(0.01, 0.0, 0.0), cycle(0.02, 0.0, 0.0), cycle(0.8, 0.0, 0.0)];
        let numbers = of_cycles(&cycles, 100);
        let mean = (half_square(0.8) + half_square(0.79) + half_square(0.78)) / 3.0;
        let wanted = (INFLATION * mean * (0.8 + 0.2 / ANGLES as f64)).sqrt();
        assert!((f64::from(numbers.offset_std_rad[0]) - wanted).abs() < 0.02, "{numbers:?}");
    }

    /// The more people, the nearer the spread of the next one is to that of those seen.
    #[test]
    fn the_spread_of_a_new_person_shrinks_with_the_number_of_people() {
        let factors: Vec<f64> = (2..40).map(new_person_factor).collect();
        assert!(factors.windows(2).all(|pair| pair[1] <= pair[0] && pair[1] > 1.0), "{factors:?}");
        assert!((new_person_factor(8) - 1.575).abs() < 1.0e-12);
        assert_eq!(new_person_factor(3).to_bits(), INFLATION.to_bits());
    }

    /// Four people with offsets of -3, -1, 1 and 3 twentieths of a radian: cycles of one person do
    /// not count, nor does how many there are.
    #[test]
    fn the_spread_between_people_is_that_of_their_cycles() {
        let offsets = [("a", -0.15), ("b", -0.05), ("b", -0.05), ("b", -0.05), ("c", 0.05), ("d", 0.15)];
        let mut cycles: Vec<_> =
            offsets.iter().map(|&(person, offset)| cycle(offset, 0.0, 0.0).of_person(person)).collect();
        crate::cyclic::training::cycle::weigh_people(&mut cycles);
        let numbers = of_cycles(&cycles, 100);
        let variance = (2.0 * 0.15_f64.powi(2) + 2.0 * 0.05_f64.powi(2)) / 3.0;
        let wanted = (new_person_factor(4) * variance * (0.8 + 0.2 / ANGLES as f64)).sqrt();
        assert!((f64::from(numbers.offset_std_rad[0]) - wanted).abs() < 1.0e-3, "{numbers:?} {wanted}");
    }

    #[test]
    fn cosine_and_sine_differ_as_they_do_between_people() {
        let swings = [("a", -0.15), ("b", -0.05), ("c", 0.05), ("d", 0.15)];
        let cycles: Vec<_> = swings.iter().map(|&(person, swing)| cycle(0.0, swing, 0.0).of_person(person)).collect();
        let numbers = of_cycles(&cycles, 100);
        assert!(numbers.cosine_std_rad[1] > 0.2, "{numbers:?}");
        assert!(numbers.sine_std_rad.iter().all(|&std| f64::from(std) < 1.01 * MIN_STD_RAD), "{numbers:?}");
    }

    #[test]
    fn equal_cycles_still_leave_some_doubt() {
        let numbers = of_cycles(&[cycle(0.1, 0.0, 0.0), cycle(0.1, 0.0, 0.0)], 100);
        assert!(numbers.offset_std_rad.iter().all(|&std| f64::from(std) >= 0.99 * MIN_STD_RAD && std < 0.01));
        assert!(numbers.rest_rate_per_cycle.iter().all(|rate| (6.0..=60.0).contains(rate)));
    }
}
