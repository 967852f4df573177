//! The paper's protocol: a filter over one cut cycle, its errors against the true angles (cyclic
//! paper, section 4).

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::tracking::{Tracked, TrackingOptions, track};
use sinew::cyclic::{AngleRow, AngleTable, CutList, CyclicModel};
use std::f64::consts::TAU;

/// Angles of the long parts, trunk, arms and legs: links of hips and shoulders are short in a side
/// view.
pub const LONG_ANGLES: [usize; 9] = [0, 2, 3, 5, 6, 8, 9, 11, 12];

/// What the measurement is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Protocol {
    /// The true angle; sigma is only the noise that the filter assumes (the paper's protocol).
    ExactMean,
    /// The true angle with Gaussian noise of that sigma, from the second frame on.
    Noisy,
}

impl Protocol {
    /// Name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ExactMean => "exact-mean",
            Self::Noisy => "noisy",
        }
    }
}

/// One cut cycle with its true angles.
#[derive(Debug, Clone, PartialEq)]
pub struct TestCycle {
    /// File and first frame.
    pub name: String,
    /// True angles, one row a frame.
    pub truth: AngleTable,
}

/// The cycles of a list.
///
/// # Errors
/// A table that cannot be read, a cut outside its table, a cycle of fewer than two frames.
pub fn test_cycles(list: &CutList) -> Result<Vec<TestCycle>> {
    list.cuts()
        .iter()
        .map(|cut| {
            let path = list.table_path(cut);
            let table = AngleTable::read(&path)?;
            let rows: Vec<AngleRow> = table
                .rows()
                .iter()
                .filter(|row| (cut.start_frame..cut.end_frame).contains(&row.frame))
                .map(|row| AngleRow { extra: Vec::new(), ..row.clone() })
                .collect();
            let (first, end) = (table.first_frame(), table.end_frame());
            ensure!(
                cut.start_frame >= first && cut.end_frame <= end,
                "{}:{}: frames {} to {} lie outside of `{}`, which has {first} to {end}",
                list.path().display(),
                cut.line,
                cut.start_frame,
                cut.end_frame,
                path.display()
            );
            ensure!(rows.len() > 1, "{}:{}: a test cycle needs two frames", list.path().display(), cut.line);
            let truth = AngleTable::new(rows, Vec::new()).with_context(|| path.display().to_string())?;
            Ok(TestCycle { name: format!("{}:{}", cut.file, cut.start_frame), truth })
        })
        .collect()
}

/// Sums of errors of one or many runs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Errors {
    /// Sum of absolute errors of each angle, degrees.
    sum_deg: [f64; ANGLES],
    /// Errors that were summed, of each angle.
    count: [f64; ANGLES],
    /// Of these, those inside the 90 % band.
    inside_90: [f64; ANGLES],
    /// Sum over all angles by frame after the first, degrees, with the count.
    by_frame: Vec<(f64, f64)>,
}

/// Half width of a normal's 90 % band, standard deviations.
const HALF_90: f64 = 1.644_853_626_951;

impl Errors {
    /// Those of every frame after the first, row by row against `truth`.
    #[must_use]
    pub fn of(tracked: &Tracked, truth: &AngleTable) -> Self {
        let mut errors = Self::default();
        for (index, (frame, row)) in tracked.frames.iter().zip(truth.rows()).enumerate().skip(1) {
            for (angle, truth) in row.angles_rad.iter().enumerate() {
                let Some(truth) = truth else { continue };
                let error = frame.angles_rad[angle] - truth;
                let error = error - TAU * (error / TAU).round();
                let std = f64::from(frame.estimate.angle_variance_rad2[angle]).max(0.0).sqrt();
                errors.add(index - 1, angle, error, std);
            }
        }
        errors
    }

    fn add(&mut self, index: usize, angle: usize, error_rad: f64, std_rad: f64) {
        let size = error_rad.abs();
        self.sum_deg[angle] += size.to_degrees();
        self.count[angle] += 1.0;
        self.inside_90[angle] += f64::from(u8::from(size <= HALF_90 * std_rad));
        if self.by_frame.len() <= index {
            self.by_frame.resize(index + 1, (0.0, 0.0));
        }
        self.by_frame[index].0 += size.to_degrees();
        self.by_frame[index].1 += 1.0;
    }

    /// Adds the sums of another run.
    pub fn merge(&mut self, other: &Self) {
        for i in 0..ANGLES {
            self.sum_deg[i] += other.sum_deg[i];
            self.count[i] += other.count[i];
            self.inside_90[i] += other.inside_90[i];
        }
        if self.by_frame.len() < other.by_frame.len() {
            self.by_frame.resize(other.by_frame.len(), (0.0, 0.0));
        }
        for (mine, theirs) in self.by_frame.iter_mut().zip(&other.by_frame) {
            mine.0 += theirs.0;
            mine.1 += theirs.1;
        }
    }

    /// Mean absolute error over `angles`, degrees.
    #[must_use]
    pub fn mean_deg(&self, angles: &[usize]) -> f64 {
        let (sum, count) = angles.iter().fold((0.0, 0.0), |(s, c), &i| (s + self.sum_deg[i], c + self.count[i]));
        sum / count
    }

    /// Mean absolute error over all 13 angles, degrees.
    #[must_use]
    pub fn all_deg(&self) -> f64 {
        self.sum_deg.iter().sum::<f64>() / self.count.iter().sum::<f64>()
    }

    /// Mean absolute error of each angle, degrees.
    #[must_use]
    pub fn each_deg(&self) -> [f64; ANGLES] {
        std::array::from_fn(|i| self.sum_deg[i] / self.count[i])
    }

    /// Share of the truth inside the 90 % band, over all angles and for each.
    #[must_use]
    pub fn inside_90(&self) -> (f64, [f64; ANGLES]) {
        let pooled = self.inside_90.iter().sum::<f64>() / self.count.iter().sum::<f64>();
        (pooled, std::array::from_fn(|i| self.inside_90[i] / self.count[i]))
    }

    /// Mean absolute error over all angles from the frame `first` after the start on, degrees.
    #[must_use]
    pub fn from_frame_deg(&self, first: usize) -> f64 {
        let late = self.by_frame.get(first..).unwrap_or(&[]);
        let (sum, count) = late.iter().fold((0.0, 0.0), |(s, c), frame| (s + frame.0, c + frame.1));
        sum / count
    }
}

/// The measurements of `truth` under `protocol`; the first row stays as it is, since it gives the
/// first state.
#[must_use]
pub fn measurements(truth: &AngleTable, protocol: Protocol, sigma_rad: f64, seed: u64) -> AngleTable {
    match protocol {
        Protocol::ExactMean => AngleTable::new(truth.rows().to_vec(), truth.extra_columns().to_vec())
            .expect("the rows are those of a table")
            .at_rate(truth.rate_hz()),
        Protocol::Noisy => truth.with_noise(sigma_rad, seed),
    }
}

/// Tracks one cycle and scores every frame after the first.
///
/// # Errors
/// As [`track`].
pub fn run(cycle: &TestCycle, model: &CyclicModel, protocol: Protocol, options: &TrackingOptions) -> Result<Errors> {
    let measured = measurements(&cycle.truth, protocol, options.sigma_rad, options.seed);
    Ok(Errors::of(&track(&measured, model, options)?, &cycle.truth))
}

/// Errors of one cycle with one seed.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleRun {
    /// Which of the cycles.
    pub cycle: usize,
    /// The seed.
    pub seed: u64,
    /// The errors.
    pub errors: Errors,
}

/// All cycles with all seeds; a cycle starts at position 0 of the model. The same on any number of
/// threads.
///
/// # Errors
/// As [`run`].
pub fn runs(
    cycles: &[TestCycle],
    model: &CyclicModel,
    protocol: Protocol,
    options: &TrackingOptions,
    seeds: u64,
) -> Result<Vec<CycleRun>> {
    // Without noise and particles every seed gives the same.
    let seeds = if protocol == Protocol::ExactMean && !options.filter.is_random() { 1 } else { seeds };
    let jobs: Vec<(usize, u64)> =
        (0..cycles.len()).flat_map(|cycle| (1..=seeds).map(move |seed| (cycle, seed))).collect();
    jobs.into_par_iter()
        .map(|(cycle, seed)| {
            let options = TrackingOptions { seed: seed * 1000 + cycle as u64, ..options.clone() };
            Ok(CycleRun { cycle, seed, errors: run(&cycles[cycle], model, protocol, &options)? })
        })
        .collect()
}

/// The sums of `runs`.
#[must_use]
pub fn sum<'a>(runs: impl IntoIterator<Item = &'a CycleRun>) -> Errors {
    let mut sum = Errors::default();
    runs.into_iter().for_each(|run| sum.merge(&run.errors));
    sum
}

/// [`runs`], pooled.
///
/// # Errors
/// As [`run`].
pub fn pooled(
    cycles: &[TestCycle],
    model: &CyclicModel,
    protocol: Protocol,
    options: &TrackingOptions,
    seeds: u64,
) -> Result<Errors> {
    Ok(sum(&runs(cycles, model, protocol, options, seeds)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth() -> AngleTable {
        AngleTable::from_angles(0, &vec![[Some(0.5); ANGLES]; 400]).unwrap()
    }

    #[test]
    fn noise_has_its_sigma_and_spares_the_first_row() {
        let noisy = measurements(&truth(), Protocol::Noisy, 0.2, 3);
        assert_eq!(noisy.rows()[0], truth().rows()[0]);
        let errors: Vec<f64> =
            noisy.rows()[1..].iter().flat_map(|row| row.angles_rad).map(|angle| angle.unwrap() - 0.5).collect();
        let std = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        assert!((0.19..0.21).contains(&std), "{std}");
        assert_eq!(measurements(&truth(), Protocol::ExactMean, 0.2, 3), truth());
    }

    #[test]
    fn errors_are_pooled_over_runs_and_counted_inside_the_band() {
        let mut one = Errors::default();
        one.add(0, 0, 0.1, 0.1);
        one.add(1, 0, -0.3, 0.1);
        let mut two = Errors::default();
        two.add(0, 1, 0.2, 0.2);
        one.merge(&two);
        assert!((one.all_deg() - 0.2_f64.to_degrees()).abs() < 1.0e-12);
        assert!((one.inside_90().0 - 2.0 / 3.0).abs() < 1.0e-12);
        assert!((one.from_frame_deg(1) - 0.3_f64.to_degrees()).abs() < 1.0e-12);
        assert!((one.mean_deg(&[1]) - 0.2_f64.to_degrees()).abs() < 1.0e-12);
    }
}
