//! The core's filters behind one type.

use super::options::{FilterName, ScalingName, StartName, TrackingOptions};
use super::particles::ParticleFilter;
use super::wide_vectors::{coupled_step, kalman_step};
use crate::cyclic::smoothing::{CoupledState, KalmanState, Smoothed, backward};
use crate::error::Result;
use sinew_core::cyclic::particle::propose::{ParticleOptions, Spread};
use sinew_core::cyclic::{
    AngleMeasurement, CoupledFilter, CovarianceScaling, CycleStart, CyclicEstimate, KalmanFilter, KalmanOptions,
    MotionModel,
};
use sinew_core::saved_state::{SavedState, StateVisitor};

/// A filter with its model and its first state.
#[derive(Debug)]
pub struct Filter<'m, const N: usize> {
    model: MotionModel<'m>,
    first: CyclicEstimate<N>,
    kind: Kind<N>,
}

#[derive(Debug)]
enum Kind<const N: usize> {
    Kalman(Box<KalmanFilter<N>>, KalmanOptions),
    Particle(Box<ParticleFilter<N>>),
    Coupled(Box<CoupledFilter<N>>),
}

impl<'m, const N: usize> Filter<'m, N> {
    /// The filter of `options` at its first state; `first` is the first row, `step_frames` a frame
    /// of the recording in frames of the model.
    ///
    /// # Errors
    /// A position or velocity out of range.
    pub fn new(
        model: MotionModel<'m>,
        options: &TrackingOptions,
        first: &[Option<f32>; N],
        step_frames: f64,
    ) -> Result<Self> {
        let position = options.initial_cycle_position.map(|position| position as f32);
        let velocity = options.initial_cycle_velocity.map(|velocity| (velocity / step_frames) as f32);
        let start = CycleStart::standard(&model, first, position, velocity)?;
        let mut first_told = start.estimate();
        let kind = match options.filter {
            FilterName::Paper => {
                let kalman = paper_options(KalmanOptions::default(), options);
                Kind::Kalman(Box::new(KalmanFilter::new(&model, &kalman, &start)?), kalman)
            }
            FilterName::PaperCut => {
                let kalman = paper_options(KalmanOptions::cut(), options);
                Kind::Kalman(Box::new(KalmanFilter::new(&model, &kalman, &start)?), kalman)
            }
            FilterName::Particle => {
                let spread = match options.start {
                    StartName::Standard => Spread::Standard,
                    StartName::Uniform => Spread::UniformPosition,
                    StartName::Random => Spread::Random,
                };
                let usual = ParticleOptions::default();
                let temporal_acceleration_std =
                    options.temporal_std.map_or(usual.temporal_acceleration_std, |std| std as f32);
                let particle = ParticleOptions { spread, temporal_acceleration_std, ..usual };
                let filter = ParticleFilter::new(&model, particle, &start, first_told, options.particles, options.seed);
                Kind::Particle(Box::new(filter))
            }
            FilterName::Coupled => {
                let first = AngleMeasurement::new(first, options.sigma_rad as f32)?;
                let filter = match options.start {
                    StartName::Standard => CoupledFilter::new(&model, &first, position, velocity)?,
                    StartName::Uniform | StartName::Random => {
                        let mut filter = CoupledFilter::anywhere(&model, &first)?;
                        first_told = filter.current_estimate(&model, &first);
                        filter
                    }
                };
                Kind::Coupled(Box::new(filter))
            }
        };
        Ok(Self { model, first: first_told, kind })
    }

    /// The first state as an estimate.
    #[must_use]
    pub const fn first_estimate(&self) -> CyclicEstimate<N> {
        self.first
    }

    /// One frame.
    pub fn step(&mut self, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        match &mut self.kind {
            Kind::Kalman(filter, options) => kalman_step(filter, &self.model, options, measurement),
            Kind::Particle(filter) => filter.step(&self.model, measurement),
            Kind::Coupled(filter) => coupled_step(filter, &self.model, measurement),
        }
    }
}

impl<const N: usize> Filter<'_, N> {
    /// Covariance of the angles after the last step, rad^2; `None` while the phase is unknown, and
    /// for particles.
    #[must_use]
    pub fn angle_covariance_rad2(&self) -> Option<[[f32; N]; N]> {
        match &self.kind {
            Kind::Coupled(filter) => filter.angle_covariance_rad2(&self.model),
            Kind::Kalman(filter, _) => {
                let entry = |i, j| filter.covariance().entry(i, j);
                Some(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
            }
            Kind::Particle(_) => None,
        }
    }
}

/// `usual` with what `options` has of the paper's filter.
fn paper_options(usual: KalmanOptions, options: &TrackingOptions) -> KalmanOptions {
    let scaling = match options.covariance_scaling {
        ScalingName::FourthPower => CovarianceScaling::FourthPower,
        ScalingName::Square => CovarianceScaling::Square,
    };
    let temporal_acceleration_std = options.temporal_std.map_or(usual.temporal_acceleration_std, |std| std as f32);
    KalmanOptions { scaling, temporal_acceleration_std, ..usual }
}

impl<const N: usize> SavedState for Filter<'_, N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        match &mut self.kind {
            Kind::Kalman(filter, _) => filter.visit(visitor),
            Kind::Particle(filter) => filter.visit(visitor),
            Kind::Coupled(filter) => filter.visit(visitor),
        }
    }
}

/// The states of a run, for the way back.
#[derive(Debug)]
pub struct Pass<'m, const N: usize> {
    model: MotionModel<'m>,
    states: States<N>,
    measurements: Vec<AngleMeasurement<N>>,
}

#[derive(Debug)]
enum States<const N: usize> {
    Kalman(Vec<KalmanState<N>>),
    Coupled(Vec<CoupledState<N>>),
}

impl<'m, const N: usize> Pass<'m, N> {
    /// A pass from the first state of `filter` on; `None` for a filter that cannot be smoothed.
    #[must_use]
    pub fn begin(filter: &Filter<'m, N>) -> Option<Self> {
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
    pub fn add(&mut self, filter: &Filter<'m, N>, measurement: AngleMeasurement<N>) {
        self.measurements.push(measurement);
        self.keep(filter);
    }

    fn keep(&mut self, filter: &Filter<'m, N>) {
        match (&mut self.states, &filter.kind) {
            (States::Kalman(states), Kind::Kalman(filter, options)) => {
                states.push(KalmanState { filter: **filter, options: *options });
            }
            (States::Coupled(states), Kind::Coupled(filter)) => states.push(CoupledState(**filter)),
            // `begin` took the kind from the same filter.
            _ => {}
        }
    }

    /// The estimate of each state given all measurements, `None` where the forward one stays.
    #[must_use]
    pub fn smoothed(&self) -> Vec<Option<Smoothed<N>>> {
        match &self.states {
            States::Kalman(states) => backward(&self.model, states, &self.measurements),
            States::Coupled(states) => backward(&self.model, states, &self.measurements),
        }
    }
}
