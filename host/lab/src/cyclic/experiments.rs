//! The experiments of the cyclic paper's section 4: its two tables and what its figures show.

use super::protocol::{CycleRun, Errors, LONG_ANGLES, Protocol, TestCycle, runs, sum};
use crate::body::Measured;
use anyhow::Result;
use serde::{Deserialize, Serialize};
use serde_json::json;
use sinew::cyclic::CyclicModel;
use sinew::cyclic::angle_table::ANGLES;
use sinew::cyclic::tracking::{FilterName, ScalingName, StartName, TrackingOptions, Updates};
use sinew::resume::{Cells, crc32_of};
use std::collections::BTreeSet;

/// Measurement noises of the paper's table 1, degrees.
pub const SIGMAS_DEG: [f64; 6] = [1.0, 3.0, 6.0, 29.0, 57.0, 115.0];
/// Filters without particles.
pub const FILTERS: [FilterName; 3] = [FilterName::Paper, FilterName::PaperCut, FilterName::Coupled];
/// Both protocols.
pub const PROTOCOLS: [Protocol; 2] = [Protocol::ExactMean, Protocol::Noisy];
/// Frames between two measurements in figures 4b and 5a.
pub const SKIPS: [u64; 8] = [1, 2, 3, 5, 8, 12, 20, 30];
/// Frame after the start from which figure 5b counts errors.
pub const LATE_FRAME: usize = 5;

/// One cell of a table.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Cell {
    /// Protocol.
    pub protocol: Protocol,
    /// Filter.
    pub filter: FilterName,
    /// First state.
    pub start: StartName,
    /// Measurement noise, degrees.
    pub sigma_deg: f64,
    /// Particles; none for the Kalman filters.
    pub particles: Option<usize>,
    /// What is measured: every frame, every k-th, or two updates a cycle.
    pub updates: String,
    /// Mean absolute error over all 13 angles, degrees.
    pub error_deg: f64,
    /// The same over the nine long parts.
    pub long_error_deg: f64,
    /// The same over all angles, from the fifth frame after the start on.
    pub late_error_deg: f64,
    /// Mean absolute error of each angle, degrees.
    pub each_deg: [f64; ANGLES],
    /// Standard deviation of the error over cycles, degrees.
    pub cycle_std_deg: f64,
    /// The same of each angle.
    pub each_cycle_std_deg: [f64; ANGLES],
    /// Standard deviation of the error over seeds, degrees; zero where nothing is drawn.
    pub seed_std_deg: f64,
    /// The same from the fifth frame after the start on.
    pub late_seed_std_deg: f64,
    /// Share of the truth inside the 90 % band.
    pub inside_90: f64,
    /// Share of the truth inside the 90 % band, for each angle.
    pub each_inside_90: [f64; ANGLES],
}

/// What is measured with, and on what.
#[derive(Debug)]
pub struct Setting<'a> {
    /// Cycles with true angles.
    pub cycles: &'a [TestCycle],
    /// Trained motion.
    pub model: &'a CyclicModel,
    /// Frames per second of the tables.
    pub rate_hz: f64,
    /// Repetitions where noise or particles are drawn.
    pub seeds: u64,
    /// Where the cells of all tables are kept.
    pub cells: &'a Cells<'a>,
}

/// Which measurements of a cycle are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Density {
    /// Every k-th frame after the first.
    Every(u64),
    /// A quarter and three quarters through the cycle.
    TwoInACycle,
}

/// The sums of runs that `key` puts together.
fn groups(runs: &[CycleRun], key: impl Fn(&CycleRun) -> u64) -> Vec<Errors> {
    let keys: BTreeSet<u64> = runs.iter().map(&key).collect();
    keys.into_iter().map(|wanted| sum(runs.iter().filter(|run| key(run) == wanted))).collect()
}

/// Standard deviation of a number over groups; zero of one group.
fn std_of(groups: &[Errors], value: impl Fn(&Errors) -> f64) -> f64 {
    Measured::of(&groups.iter().map(value).collect::<Vec<_>>()).std
}

impl Setting<'_> {
    fn options(&self, filter: FilterName, sigma_deg: f64) -> TrackingOptions {
        TrackingOptions {
            filter,
            sigma_rad: sigma_deg.to_radians(),
            initial_cycle_position: Some(0.0),
            rate_hz: Some(self.rate_hz),
            ..TrackingOptions::default()
        }
    }

    fn measure(&self, protocol: Protocol, options: &TrackingOptions, density: Density) -> Result<Cell> {
        // Tables that share a cell measure it once.
        let key = json!([protocol, format!("{options:?}"), format!("{density:?}"), crc32_of(&self.cycles)]);
        self.cells.cell(&key, || self.measured(protocol, options, density))
    }

    fn measured(&self, protocol: Protocol, options: &TrackingOptions, density: Density) -> Result<Cell> {
        let runs = match density {
            Density::Every(every) => {
                let options = TrackingOptions { updates: Updates::Every(every), ..options.clone() };
                runs(self.cycles, self.model, protocol, &options, self.seeds)?
            }
            Density::TwoInACycle => {
                let mut all = Vec::new();
                for (index, cycle) in self.cycles.iter().enumerate() {
                    let (first, end) = (cycle.truth.first_frame(), cycle.truth.end_frame());
                    let at = [1, 3].map(|quarter| first + quarter * (end - first) / 4);
                    let options = TrackingOptions { updates: Updates::At(at.to_vec()), ..options.clone() };
                    let one = runs(std::slice::from_ref(cycle), self.model, protocol, &options, self.seeds)?;
                    all.extend(one.into_iter().map(|run| CycleRun { cycle: index, ..run }));
                }
                all
            }
        };
        let errors = sum(&runs);
        let by_cycle: Vec<Errors> = groups(&runs, |run| run.cycle as u64);
        let by_seed: Vec<Errors> = groups(&runs, |run| run.seed);
        let (inside_90, each_inside_90) = errors.inside_90();
        Ok(Cell {
            protocol,
            filter: options.filter,
            start: options.start,
            sigma_deg: options.sigma_rad.to_degrees(),
            particles: options.filter.is_random().then_some(options.particles),
            updates: match density {
                Density::Every(every) => format!("every {every}"),
                Density::TwoInACycle => "two in a cycle".into(),
            },
            error_deg: errors.all_deg(),
            long_error_deg: errors.mean_deg(&LONG_ANGLES),
            late_error_deg: errors.from_frame_deg(LATE_FRAME),
            each_deg: errors.each_deg(),
            cycle_std_deg: std_of(&by_cycle, Errors::all_deg),
            each_cycle_std_deg: std::array::from_fn(|angle| std_of(&by_cycle, |errors| errors.mean_deg(&[angle]))),
            seed_std_deg: std_of(&by_seed, Errors::all_deg),
            late_seed_std_deg: std_of(&by_seed, |errors| errors.from_frame_deg(LATE_FRAME)),
            inside_90,
            each_inside_90,
        })
    }

    /// Table 1: every filter with every sigma, under both protocols.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn noise_table(&self) -> Result<Vec<Cell>> {
        let mut cells = Vec::new();
        for protocol in PROTOCOLS {
            for filter in FILTERS {
                for sigma in SIGMAS_DEG {
                    cells.push(self.measure(protocol, &self.options(filter, sigma), Density::Every(1))?);
                }
            }
        }
        Ok(cells)
    }

    /// One row of table 1.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn of_filter(&self, filter: FilterName, protocol: Protocol) -> Result<Vec<Cell>> {
        SIGMAS_DEG
            .iter()
            .map(|&sigma| self.measure(protocol, &self.options(filter, sigma), Density::Every(1)))
            .collect()
    }

    /// Exact-mean with a measurement every so many frames.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn skipping(&self, filter: FilterName, sigma_deg: f64, every: u64) -> Result<Cell> {
        self.measure(Protocol::ExactMean, &self.options(filter, sigma_deg), Density::Every(every))
    }

    /// Beside table 1: `paper` with the covariance scaled by k^2, as the paper words it.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn worded(&self, protocol: Protocol) -> Result<Vec<Cell>> {
        let covariance_scaling = ScalingName::Square;
        let options = |sigma| TrackingOptions { covariance_scaling, ..self.options(FilterName::Paper, sigma) };
        SIGMAS_DEG.map(|sigma| self.measure(protocol, &options(sigma), Density::Every(1))).into_iter().collect()
    }

    /// Beside table 1: `coupled` with the whole recording known (`--smooth`).
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn smoothed(&self) -> Result<Vec<Cell>> {
        let jobs = PROTOCOLS.into_iter().flat_map(|protocol| SIGMAS_DEG.map(|sigma| (protocol, sigma)));
        jobs.map(|(protocol, sigma)| {
            let options = TrackingOptions { smooth: true, ..self.options(FilterName::Coupled, sigma) };
            self.measure(protocol, &options, Density::Every(1))
        })
        .collect()
    }

    /// Table 2: the particle filter at sigma 29 degrees with more and more particles.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn particle_table(&self, particles: &[usize]) -> Result<Vec<Cell>> {
        particles.iter().map(|&particles| self.particles(particles, StartName::Standard, 1)).collect()
    }

    fn particles(&self, particles: usize, start: StartName, every: u64) -> Result<Cell> {
        // A uniform start knows no position.
        let initial_cycle_position = (start == StartName::Standard).then_some(0.0);
        let options =
            TrackingOptions { particles, start, initial_cycle_position, ..self.options(FilterName::Particle, 29.0) };
        self.measure(Protocol::ExactMean, &options, Density::Every(every))
    }

    /// Figure 4b: fewer and fewer measurements at sigma 29 degrees, and two a cycle at sigma 6, for
    /// the Kalman filters.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn sparse_measurements(&self) -> Result<Vec<Cell>> {
        let mut cells = Vec::new();
        for filter in FILTERS {
            for protocol in PROTOCOLS {
                for skip in SKIPS {
                    cells.push(self.measure(protocol, &self.options(filter, 29.0), Density::Every(skip))?);
                }
                cells.push(self.measure(protocol, &self.options(filter, 6.0), Density::TwoInACycle)?);
            }
        }
        Ok(cells)
    }

    /// Figure 5a: fewer and fewer measurements with particles.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn sparse_particles(&self, particles: &[usize]) -> Result<Vec<Cell>> {
        let jobs = particles.iter().flat_map(|&count| SKIPS.map(|skip| (count, skip)));
        jobs.map(|(count, skip)| self.particles(count, StartName::Standard, skip)).collect()
    }

    /// Figure 5b: the three ways to start, with more and more particles.
    ///
    /// # Errors
    /// As [`runs`] and [`Cells::cell`].
    pub fn starts(&self, particles: &[usize]) -> Result<Vec<Cell>> {
        let starts = [StartName::Standard, StartName::Uniform, StartName::Random];
        let jobs = starts.into_iter().flat_map(|start| particles.iter().map(move |&count| (start, count)));
        jobs.map(|(start, count)| self.particles(count, start, 1)).collect()
    }
}
