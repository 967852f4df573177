//! The shape of a cycle: harmonics of the phase for each angle.

use super::seen::Seen;
use crate::cyclic::CyclicModel;
use crate::cyclic::turns::least_angle;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

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
        let terms = (0..N).map(|angle| {
            let mut fit = Fit::new(0.0);
            let mut before = f64::from(poses[0][angle]);
            for (phase, pose) in phases.iter().zip(&poses) {
                let flat = f64::from(pose[angle]) - TAU * turns[angle] * phase;
                before += least_angle(flat - before);
                fit.add(*phase, before, 1.0);
            }
            fit.solved()
        });
        Self::new(turns, terms.collect())
    }

    fn new(turns: [f64; N], terms: Vec<[f64; TERMS]>) -> Self {
        let entry = |index: usize| {
            let phase = index as f64 / ENTRIES as f64;
            let (value, slope) = bases(phase);
            let sum =
                |basis: &[f64; TERMS], angle: usize| basis.iter().zip(&terms[angle]).map(|(b, t)| b * t).sum::<f64>();
            let slopes = std::array::from_fn(|angle| sum(&slope, angle) + TAU * turns[angle]);
            (std::array::from_fn(|angle| sum(&value, angle)), slopes)
        };
        let entries = (0..=ENTRIES).map(entry).collect();
        Self { turns, terms, entries }
    }

    /// Angles and their slopes at a phase, radians and radians per cycle.
    #[must_use]
    pub fn at(&self, phase: f64) -> ([f64; N], [f64; N]) {
        let place = phase.rem_euclid(1.0) * ENTRIES as f64;
        let index = (place.floor() as usize).min(ENTRIES - 1);
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
        let cycles = (phases[phases.len() - 1] - phases[0]).abs().max(1.0);
        let terms = (0..N).map(|angle| {
            let mut bins = [(0.0, 0.0, 0.0); BINS];
            for (frame, phase) in seen.angles_rad.iter().zip(phases) {
                let Some(angle_rad) = frame[angle] else { continue };
                let part = phase.rem_euclid(1.0);
                let bin = &mut bins[((part * BINS as f64) as usize).min(BINS - 1)];
                *bin = (bin.0 + 1.0, bin.1 + part, bin.2 + least_angle(angle_rad - self.at(*phase).0[angle]));
            }
            let count: f64 = bins.iter().map(|bin| bin.0).sum();
            let mut fit = Fit::new(PRIOR_CYCLES * (count / cycles).max(1.0));
            for (count, part, off) in bins.into_iter().filter(|bin| bin.0 > 0.0) {
                fit.add(part / count, off / count, count);
            }
            let change = fit.solved();
            std::array::from_fn(|term| self.terms[angle][term] + change[term])
        });
        Self::new(self.turns, terms.collect())
    }
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

/// Least squares with a prior at zero.
struct Fit {
    gram: DMatrix<f64>,
    right: DVector<f64>,
}

impl Fit {
    /// `weight` times h^4 pulls harmonic h to zero.
    fn new(weight: f64) -> Self {
        let pull = |term: usize| weight * (term.div_ceil(2) as f64).powi(4) + 1.0e-9;
        let gram = DMatrix::from_diagonal(&DVector::from_fn(TERMS, |term, _| pull(term)));
        Self { gram, right: DVector::zeros(TERMS) }
    }

    fn add(&mut self, phase: f64, value: f64, weight: f64) {
        let basis = DVector::from_column_slice(&bases(phase).0);
        self.gram.ger(weight, &basis, &basis, 1.0);
        self.right.axpy(weight * value, &basis, 1.0);
    }

    /// The harmonics; zero where nothing was added.
    fn solved(self) -> [f64; TERMS] {
        let solved = self.gram.cholesky().map(|factor| factor.solve(&self.right));
        std::array::from_fn(|term| solved.as_ref().map_or(0.0, |solved| solved[term]))
    }
}
