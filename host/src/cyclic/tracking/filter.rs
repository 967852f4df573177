//! The core's filters behind one type.

use super::options::{FilterName, StartName, TrackingOptions};
use super::particles::ParticleFilter;
use crate::cyclic::smoothing::{CoupledState, KalmanState, Smoothed, backward};
use anyhow::Result;
use sinew_core::angle::split_turns;
use sinew_core::cyclic::particle::{ParticleOptions, Spread};
use sinew_core::cyclic::{
    AngleMeasurement, CoupledFilter, CycleStart, CyclicEstimate, KalmanFilter, KalmanOptions, MotionModel,
};
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;

type Angles = [Option<f32>; HUMAN_ANGLES];

/// A filter with its model and its first state.
#[derive(Debug)]
pub struct Filter<'m> {
    model: MotionModel<'m>,
    start: CycleStart<HUMAN_ANGLES>,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Kalman(Box<KalmanFilter<HUMAN_ANGLES>>, KalmanOptions),
    Particle(Box<ParticleFilter>),
    Coupled(Box<CoupledFilter<HUMAN_ANGLES>>),
}

impl<'m> Filter<'m> {
    /// The filter of `options` at its first state; `first` is the first row, `step_frames` a frame of the recording in frames
    /// of the model.
    ///
    /// # Errors
    /// A position or velocity out of range.
    pub fn new(model: MotionModel<'m>, options: &TrackingOptions, first: &Angles, step_frames: f64) -> Result<Self> {
        let position = options.initial_cycle_position.map(|position| position as f32);
        let velocity = options.initial_cycle_velocity.map(|velocity| (velocity / step_frames) as f32);
        let start = CycleStart::standard(&model, first, position, velocity)?;
        let kind = match options.filter {
            FilterName::Paper => {
                let kalman = KalmanOptions::default();
                Kind::Kalman(Box::new(KalmanFilter::new(&model, &kalman, &start)?), kalman)
            }
            FilterName::PaperCut => {
                let kalman = KalmanOptions::cut();
                Kind::Kalman(Box::new(KalmanFilter::new(&model, &kalman, &start)?), kalman)
            }
            FilterName::Particle => {
                let spread = match options.start {
                    StartName::Standard => Spread::Standard,
                    StartName::Uniform => Spread::UniformPosition,
                    StartName::Random => Spread::Random,
                };
                let particle = ParticleOptions { spread, ..ParticleOptions::default() };
                let first = first_estimate(&start);
                let filter = ParticleFilter::new(&model, particle, &start, first, options.particles, options.seed);
                Kind::Particle(Box::new(filter))
            }
            FilterName::Coupled => Kind::Coupled(Box::new(CoupledFilter::new(&model, first, position, velocity)?)),
        };
        Ok(Self { model, start, kind })
    }

    /// The first state as an estimate.
    #[must_use]
    pub fn first_estimate(&self) -> CyclicEstimate<HUMAN_ANGLES> {
        first_estimate(&self.start)
    }

    /// One frame.
    pub fn step(&mut self, measurement: &AngleMeasurement<HUMAN_ANGLES>) -> CyclicEstimate<HUMAN_ANGLES> {
        match &mut self.kind {
            Kind::Kalman(filter, options) => filter.step(&self.model, options, measurement),
            Kind::Particle(filter) => filter.step(&self.model, measurement),
            Kind::Coupled(filter) => filter.step(&self.model, measurement),
        }
    }
}

/// The states of a run, for the way back.
#[derive(Debug)]
pub struct Pass<'m> {
    model: MotionModel<'m>,
    states: States,
    measurements: Vec<AngleMeasurement<HUMAN_ANGLES>>,
}

#[derive(Debug)]
enum States {
    Kalman(Vec<KalmanState<HUMAN_ANGLES>>),
    Coupled(Vec<CoupledState<HUMAN_ANGLES>>),
}

impl<'m> Pass<'m> {
    /// A pass from the first state of `filter` on; `None` for a filter that cannot be smoothed.
    #[must_use]
    pub fn begin(filter: &Filter<'m>) -> Option<Self> {
        let states = match &filter.kind {
            Kind::Kalman(..) => States::Kalman(Vec::new()),
            Kind::Coupled(_) => States::Coupled(Vec::new()),
            Kind::Particle(_) => return None,
        };
        let mut pass = Self { model: filter.model, states, measurements: Vec::new() };
        pass.keep(filter);
        Some(pass)
    }

    /// Keeps the state that `filter` came to by `measurement`.
    pub fn add(&mut self, filter: &Filter<'m>, measurement: AngleMeasurement<HUMAN_ANGLES>) {
        self.measurements.push(measurement);
        self.keep(filter);
    }

    fn keep(&mut self, filter: &Filter<'m>) {
        match (&mut self.states, &filter.kind) {
            (States::Kalman(states), Kind::Kalman(filter, options)) => {
                states.push(KalmanState { filter: **filter, options: *options });
            }
            (States::Coupled(states), Kind::Coupled(filter)) => states.push(CoupledState(**filter)),
            // `begin` took the kind from the same filter.
            _ => {}
        }
    }

    /// What each state tells given all measurements.
    #[must_use]
    pub fn smoothed(&self) -> Vec<Smoothed<HUMAN_ANGLES>> {
        match &self.states {
            States::Kalman(states) => backward(&self.model, states, &self.measurements),
            States::Coupled(states) => backward(&self.model, states, &self.measurements),
        }
    }
}

fn first_estimate(start: &CycleStart<HUMAN_ANGLES>) -> CyclicEstimate<HUMAN_ANGLES> {
    let split = start.angles_rad.map(split_turns);
    CyclicEstimate {
        angles_rad: split.map(|(angle, _)| angle),
        turns: split.map(|(_, turns)| turns),
        angle_variance_rad2: start.extra_variance_rad2,
        cycle_position: start.cycle_position,
        cycle_position_variance: 0.0,
        cycle_velocity_per_frame: start.cycle_velocity,
        cycle_velocity_variance: 0.0,
        log_likelihood: 0.0,
        outlier: false,
    }
}
