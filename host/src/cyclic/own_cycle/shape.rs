//! The shape of a cycle: harmonics of the phase for each angle.

use super::seen::Seen;
use crate::cyclic::CyclicModel;
use crate::cyclic::turns::least_angle;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Harmonics: ten hold the mean cycles of the shipped models within 0.2 degrees on the mean.
const HARMONICS: usize = 10;
/// Constant, cosines, sines.
const TERMS: usize = 2 * HARMONICS + 1;
/// Parts of a cycle in which measurements are averaged before the fit. A hundredth of a walker's
/// cycle is shorter than a frame at 60 frames a second.
const BINS: usize = 100;
/// Weight of the prior on harmonic h, in cycles of measurements over h^4. The higher a harmonic,
/// the less one cycle says against the model's. Chosen: a tenth of what leaves a knee's fourth
/// harmonic to the data after one cycle.
const PRIOR_CYCLES: f64 = 1.0e-4;
/// Entries of the table that the shape is read from, by straight lines between them: their error is
/// below a hundredth of a degree.
const ENTRIES: usize = 400;

/// Harmonics and their slopes at the phases of the table.
static EVEN_BASES: LazyLock<Vec<([f64; TERMS], [f64; TERMS])>> =
    LazyLock::new(|| (0..=ENTRIES).map(|index| bases(index as f64 / ENTRIES as f64)).collect());

/// Angles as functions of the phase, in cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape<const N: usize> {
    /// Turns that each angle winds in a cycle.
    turns: [f64; N],
    /// Harmonics of each angle without its winding.
    terms: Vec<[f64; TERMS]>,
    /// Angles and their slopes by the phase at even phases.
    entries: Vec<([f64; N], [f64; N])>,
}

impl<const N: usize> Shape<N> {
    /// The model's mean cycle.
    #[must_use]
    pub fn of_model(model: &CyclicModel) -> Self {
        let winding = &model.numbers().turns_per_cycle;
        let turns: [f64; N] = std::array::from_fn(|angle| winding.get(angle).map_or(0.0, |turns| f64::from(*turns)));
        let model = model.view();
        let phases: Vec<f64> = (0..BINS).map(|bin| bin as f64 / BINS as f64).collect();
        let poses: Vec<[f32; N]> = phases.iter().map(|phase| model.mean_pose_rad(model.point(*phase as f32))).collect();
        let fit = Fit::new(0.0, &phases.iter().map(|phase| (*phase, 1.0)).collect::<Vec<_>>());
        let terms = (0..N).map(|angle| {
            let mut before = f64::from(poses[0][angle]);
            let unwound = phases.iter().zip(&poses).map(|(phase, pose)| {
                let flat = f64::from(pose[angle]) - TAU * turns[angle] * phase;
                before += least_angle(flat - before);
                before
            });
            fit.solved(unwound)
        });
        Self::new(turns, terms.collect())
    }

    fn new(turns: [f64; N], terms: Vec<[f64; TERMS]>) -> Self {
        // All angles beside each other, term by term.
        let by_term: [[f64; N]; TERMS] = std::array::from_fn(|term| std::array::from_fn(|angle| terms[angle][term]));
        let sums = |basis: &[f64; TERMS], mut sums: [f64; N]| {
            for (factor, terms) in basis.iter().zip(&by_term) {
                sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += factor * term);
            }
            sums
        };
        let winding = turns.map(|turns| TAU * turns);
        let entry = |(value, slope): &([f64; TERMS], [f64; TERMS])| (sums(value, [0.0; N]), sums(slope, winding));
        let entries = EVEN_BASES.iter().map(entry).collect();
        Self { turns, terms, entries }
    }

    /// Angles and their slopes at a phase, radians and radians per cycle.
    #[must_use]
    pub fn at(&self, phase: f64) -> ([f64; N], [f64; N]) {
        let place = phase.rem_euclid(1.0) * ENTRIES as f64;
        let index = (place as usize).min(ENTRIES - 1);
        let share = place - index as f64;
        let [(a, a_slope), (b, b_slope)] = [&self.entries[index], &self.entries[index + 1]];
        let between = |a: f64, b: f64| a + share * (b - a);
        let winding = |angle: usize| TAU * self.turns[angle] * phase;
        (
            std::array::from_fn(|angle| between(a[angle], b[angle]) + winding(angle)),
            std::array::from_fn(|angle| between(a_slope[angle], b_slope[angle])),
        )
    }

    /// This shape, as a prior, moved to what was seen at these phases; where nothing was, it stays.
    #[must_use]
    pub fn fitted(&self, seen: &Seen<N>, phases: &[f64]) -> Self {
        let poses: Vec<[f64; N]> = phases.iter().map(|phase| self.at(*phase).0).collect();
        // Angles that were seen in the same frames share a fit.
        let mut shared: Option<(Vec<(f64, f64)>, Fit)> = None;
        let terms = (0..N).map(|angle| {
            let bins = bins(seen, phases, angle, |frame, angle_rad| least_angle(angle_rad - poses[frame][angle]));
            let places = places(&bins);
            let (_, fit) = match shared.take().filter(|(before, _)| *before == places) {
                Some(same) => shared.insert(same),
                None => {
                    let fit = Fit::of_seen(phases, &places);
                    shared.insert((places, fit))
                }
            };
            let change = fit.solved(bins.iter().map(|(count, _, off)| off / count));
            std::array::from_fn(|term| self.terms[angle][term] + change[term])
        });
        Self::new(self.turns, terms.collect())
    }
}

/// Squared distance of one more measurement from the fitted shape in each frame, over the mean of
/// those that it was fitted to: n / (n - p) (1 + b' G^-1 b), for n measurements that determine p
/// terms, with the harmonics b of the frame's phase and the normal matrix G. It is large where few
/// were seen near that phase.
#[must_use]
pub fn distances_over_fitted<const N: usize>(seen: &Seen<N>, phases: &[f64], angle: usize) -> Vec<f64> {
    let places = places(&bins(seen, phases, angle, |_, _| 0.0));
    let count: f64 = places.iter().map(|(_, weight)| weight).sum();
    let fit = Fit::of_seen(phases, &places);
    let leverage = |phase: f64| fit.leverage(&DVector::from_column_slice(&bases(phase).0));
    let determined: f64 = places.iter().map(|(phase, weight)| weight * leverage(*phase)).sum();
    let left = (count - determined).max(1.0);
    let over_bins: Vec<f64> = (0..BINS).map(|bin| 1.0 + leverage((bin as f64 + 0.5) / BINS as f64)).collect();
    phases.iter().map(|phase| count / left * over_bins[bin_of(*phase)]).collect()
}

/// The part of the cycle that a phase lies in.
fn bin_of(phase: f64) -> usize {
    ((phase.rem_euclid(1.0) * BINS as f64) as usize).min(BINS - 1)
}

/// Measurements of an angle in each part of the cycle that has any: their number, and the sums of
/// their phases and of a number of each.
fn bins<const N: usize>(
    seen: &Seen<N>,
    phases: &[f64],
    angle: usize,
    number: impl Fn(usize, f64) -> f64,
) -> Vec<(f64, f64, f64)> {
    let mut bins = vec![(0.0, 0.0, 0.0); BINS];
    for (frame, (pose, phase)) in seen.angles_rad.iter().zip(phases).enumerate() {
        let Some(angle_rad) = pose[angle] else { continue };
        let bin = &mut bins[bin_of(*phase)];
        *bin = (bin.0 + 1.0, bin.1 + phase.rem_euclid(1.0), bin.2 + number(frame, angle_rad));
    }
    bins.retain(|bin| bin.0 > 0.0);
    bins
}

/// Mean phase of each part, and its number of measurements.
fn places(bins: &[(f64, f64, f64)]) -> Vec<(f64, f64)> {
    bins.iter().map(|(count, phase, _)| (phase / count, *count)).collect()
}

/// Values of the harmonics at a phase, and their slopes.
fn bases(phase: f64) -> ([f64; TERMS], [f64; TERMS]) {
    let (mut value, mut slope) = ([0.0; TERMS], [0.0; TERMS]);
    value[0] = 1.0;
    for harmonic in 1..=HARMONICS {
        let rate = TAU * harmonic as f64;
        let (sine, cosine) = (rate * phase).sin_cos();
        (value[2 * harmonic - 1], value[2 * harmonic]) = (cosine, sine);
        (slope[2 * harmonic - 1], slope[2 * harmonic]) = (-rate * sine, rate * cosine);
    }
    (value, slope)
}

/// Least squares with a prior at zero, of values at the same phases.
struct Fit {
    /// Harmonics at each phase, and its weight.
    bases: Vec<(DVector<f64>, f64)>,
    factor: Option<Cholesky<f64, Dyn>>,
}

impl Fit {
    /// Of phases with their weights; `pull` times h^4 pulls harmonic h to zero.
    fn new(pull: f64, places: &[(f64, f64)]) -> Self {
        let bases: Vec<(DVector<f64>, f64)> =
            places.iter().map(|(phase, weight)| (DVector::from_column_slice(&bases(*phase).0), *weight)).collect();
        let pull = |term: usize| pull * (term.div_ceil(2) as f64).powi(4) + 1.0e-9;
        let mut gram = DMatrix::from_diagonal(&DVector::from_fn(TERMS, |term, _| pull(term)));
        bases.iter().for_each(|(basis, weight)| gram.ger(*weight, basis, basis, 1.0));
        Self { bases, factor: gram.cholesky() }
    }

    /// With the prior, of what was seen at these places in a recording of these phases.
    fn of_seen(phases: &[f64], places: &[(f64, f64)]) -> Self {
        let cycles = (phases[phases.len() - 1] - phases[0]).abs().max(1.0);
        let count: f64 = places.iter().map(|(_, weight)| weight).sum();
        Self::new(PRIOR_CYCLES * (count / cycles).max(1.0), places)
    }

    /// Variance of the fit at a phase with these harmonics, over that of a measurement.
    fn leverage(&self, basis: &DVector<f64>) -> f64 {
        self.factor.as_ref().map_or(f64::INFINITY, |factor| basis.dot(&factor.solve(basis)))
    }

    /// The harmonics of a value at each phase; zero where there is none.
    fn solved(&self, values: impl Iterator<Item = f64>) -> [f64; TERMS] {
        let mut right = DVector::zeros(TERMS);
        for ((basis, weight), value) in self.bases.iter().zip(values) {
            right.axpy(weight * value, basis, 1.0);
        }
        let solved = self.factor.as_ref().map(|factor| factor.solve(&right));
        std::array::from_fn(|term| solved.as_ref().map_or(0.0, |solved| solved[term]))
    }
}
