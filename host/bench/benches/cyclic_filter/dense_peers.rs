//! Dense filters of other crates on the same 28 states and 13 measurements, single precision.
//!
//! Their process noise is constant, which spares them the model's covariance that the cyclic
//! filters rebuild in every step.

use kfilter::kalman::{KalmanLinearNoInput, KalmanPredict, KalmanUpdate};
use kfilter::measurement::{LinearMeasurement, Measurement};
use minikalman::prelude::*;
use minikalman::regular::builder::KalmanFilterBuilder;
use nalgebra_for_kfilter::{SMatrix, SVector};

use super::walk::{ANGLES, STD_RAD};

/// Angles, their velocities, cycle position and velocity.
pub const STATES: usize = 2 * (ANGLES + 1);

/// Entry of the transition matrix: each quantity moves by its velocity.
fn transition(row: usize, column: usize) -> f32 {
    let half = STATES / 2;
    f32::from(u8::from(row == column || (row < half && column == row + half)))
}

/// Entry of the process noise of an acceleration with covariance 1e-5, half of it common to all.
fn noise(row: usize, column: usize) -> f32 {
    let half = STATES / 2;
    let reach = |index: usize| if index < half { 0.5 } else { 1.0 };
    let common = if row % half == column % half { 1.0 } else { 0.5 };
    1.0e-5 * reach(row) * reach(column) * common
}

/// A filter of the crate `kfilter`.
pub struct KfilterPeer {
    filter: KalmanLinearNoInput<f32, STATES>,
    measurement: LinearMeasurement<f32, STATES, ANGLES>,
}

impl KfilterPeer {
    pub fn new() -> Self {
        let filter = KalmanLinearNoInput::<f32, STATES>::new(
            SMatrix::from_fn(transition),
            SMatrix::from_fn(noise),
            SVector::zeros(),
            SMatrix::identity() * 1.0e-4,
        );
        let observation = SMatrix::from_fn(|row, column| f32::from(u8::from(row == column)));
        let noise = SMatrix::identity() * (STD_RAD * STD_RAD);
        Self { filter, measurement: LinearMeasurement::new(observation, noise, SVector::zeros()) }
    }

    /// Predicts and updates; returns the first angle.
    pub fn step(&mut self, angles_rad: &[Option<f32>; ANGLES]) -> f32 {
        self.measurement.set_measurement(SVector::from_fn(|i, _| angles_rad[i].unwrap_or(0.0)));
        self.filter.predict().expect("a linear system");
        self.filter.update(&self.measurement).expect("positive definite noise")[0]
    }
}

/// A predict-and-update step of the crate `minikalman`; returns the first angle.
pub fn minikalman_step() -> impl FnMut(&[Option<f32>; ANGLES]) -> f32 {
    let builder = KalmanFilterBuilder::<STATES, f32>::default();
    let mut filter = builder.build();
    let mut observation = builder.observations().build::<ANGLES>();
    filter.state_transition_mut().apply(|matrix| {
        (0..STATES * STATES).for_each(|i| matrix.set_at(i / STATES, i % STATES, transition(i / STATES, i % STATES)));
    });
    filter.direct_process_noise_mut().apply(|matrix| {
        (0..STATES * STATES).for_each(|i| matrix.set_at(i / STATES, i % STATES, noise(i / STATES, i % STATES)));
    });
    filter.estimate_covariance_mut().apply(|matrix| matrix.make_scalar(1.0e-4));
    observation.observation_matrix_mut().apply(|matrix| (0..ANGLES).for_each(|i| matrix.set_at(i, i, 1.0)));
    observation.measurement_noise_covariance_mut().apply(|matrix| matrix.make_scalar(STD_RAD * STD_RAD));
    move |angles_rad| {
        observation.measurement_vector_mut().apply(|vector| {
            (0..ANGLES).for_each(|i| vector[i] = angles_rad[i].unwrap_or(0.0));
        });
        filter.predict();
        filter.correct(&mut observation);
        filter.state_vector()[0]
    }
}
