//! The trackers of a cycle with parameters and frames from bytes.

use super::cyclic_files::swing;
use super::models::walking;
use crate::Target;
use crate::numbers::{Numbers, seeds};
use sinew::cyclic::tracking::{FilterName, ScalingName, StartName, TableRun, TrackingOptions, Updates};
use sinew::cyclic::{AngleTable, CyclicModel};
use sinew_core::cyclic::example::{swing_pose_rad, swing_table};
use sinew_core::cyclic::filter::{CyclicFilter, FilterChoice};
use sinew_core::cyclic::model::ModelTable;
use sinew_core::cyclic::particle::propose::{ParticleOptions, factors_len, fill_factors};
use sinew_core::cyclic::particle::tracker::ParticleTables;
use sinew_core::cyclic::{
    AngleMeasurement, CycleStart, CyclicEstimate, KalmanOptions, MotionModel, ParticleTracker, PlaceOptions,
};
use sinew_core::saved_state::SavedState;
use sinew_core::tracker::cyclic::{CyclicFrameInput, CyclicTracker, CyclicTrackerOptions, FirstPhase};
use std::path::Path;
use std::sync::OnceLock;

/// The filters, the tracker of a figure, and a run over a table.
pub const TARGETS: &[Target] = &[
    Target { name: "cyclic_filters", run: filters, seeds: || seeds(120) },
    Target { name: "cyclic_particles", run: particles, seeds: || seeds(80) },
    Target { name: "cyclic_tracker", run: tracker, seeds: || seeds(160) },
    Target { name: "cyclic_table_run", run: table_run, seeds: || seeds(40) },
];

/// Most frames of an execution.
const FRAMES: u8 = 12;
/// Noise of the clean measurements, rad.
const STD_RAD: f32 = 0.05;

type Measurement = AngleMeasurement<2>;

/// A model of two angles.
pub fn model_table() -> ModelTable<100, 2, 3> {
    swing_table()
}

/// What is seen in `frame`.
pub fn seen(frame: u8) -> Measurement {
    Measurement::new(&swing_pose_rad(f32::from(frame) / 60.0).map(Some), STD_RAD).expect("it is built in")
}

/// Panics where an estimate has no number, or a variance below zero.
pub fn check(estimate: &CyclicEstimate<2>) {
    check_numbers(estimate);
    let variances = [estimate.cycle_position_variance, estimate.cycle_velocity_variance];
    assert!(estimate.angle_variance_rad2.iter().chain(&variances).all(|variance| *variance >= 0.0), "{estimate:?}");
}

/// Panics where an estimate has no number.
pub fn check_numbers(estimate: &CyclicEstimate<2>) {
    let numbers = [estimate.cycle_position, estimate.cycle_velocity_per_frame, estimate.log_likelihood];
    let variances = [estimate.cycle_position_variance, estimate.cycle_velocity_variance];
    let all = estimate.angles_rad.iter().chain(&numbers).chain(&estimate.angle_variance_rad2).chain(&variances);
    assert!(all.into_iter().all(|number| number.is_finite()), "{estimate:?}");
}

/// A measurement from `numbers`; `None` where its border refuses it.
fn measured(numbers: &mut Numbers<'_>, frame: u8) -> Option<Measurement> {
    let clean = swing_pose_rad(f32::from(frame) / 60.0);
    let angles_rad = clean.map(|angle| (numbers.below(8) != 7).then(|| numbers.number(angle)));
    let std_rad = [numbers.number(STD_RAD), numbers.number(STD_RAD)];
    Measurement::with_std(&angles_rad, &std_rad).and_then(|seen| seen.after(numbers.number(1.0))).ok()
}

fn choice(numbers: &mut Numbers<'_>) -> FilterChoice {
    let mut options = if numbers.flag() { KalmanOptions::cut() } else { KalmanOptions::default() };
    if numbers.below(3) == 0 {
        return FilterChoice::Coupled;
    }
    numbers.change(&mut [
        &mut options.temporal_acceleration_std,
        &mut options.angle_variance,
        &mut options.velocity_variance,
        &mut options.cycle_position_variance,
        &mut options.cycle_velocity_variance,
        &mut options.gate_sigmas,
    ]);
    options.protect_from_outliers = numbers.flag();
    FilterChoice::Kalman(options)
}

fn first_phase(numbers: &mut Numbers<'_>) -> FirstPhase {
    let position = numbers.flag().then(|| numbers.number(0.1));
    let velocity_per_frame = numbers.flag().then(|| numbers.number(1.0 / 60.0));
    FirstPhase { position, velocity_per_frame }
}

fn filters(bytes: &[u8]) {
    let (table, mut numbers) = (model_table(), Numbers::new(bytes));
    let (model, choice, first) =
        (table.model().expect("it is built in"), choice(&mut numbers), first_phase(&mut numbers));
    let new = CyclicFilter::new(&model, &choice, &seen(0), first.position, first.velocity_per_frame);
    let Ok(mut filter) = new else { return };
    for frame in 1..FRAMES {
        let Some(measurement) = measured(&mut numbers, frame) else { continue };
        check(&filter.step(&model, &choice, &measurement));
        assert!(filter.is_finite(), "the state after {measurement:?}");
    }
}

fn particles(bytes: &[u8]) {
    let (table, mut numbers) = (model_table(), Numbers::new(bytes));
    let model = table.model().expect("it is built in");
    let first = first_phase(&mut numbers);
    let start = CycleStart::standard(&model, seen(0).angles_rad(), first.position, first.velocity_per_frame);
    let Ok(start) = start else { return };
    let mut factors = vec![0.0; factors_len(&model)];
    fill_factors(&model, &mut factors);
    let tables = ParticleTables { factors: &factors, positions: &[] };
    let options = ParticleOptions::default();
    let mut tracker = ParticleTracker::<2, 32>::new(&model, tables, options, &start, numbers.long());
    for frame in 1..FRAMES {
        let Some(measurement) = measured(&mut numbers, frame) else { continue };
        check(&tracker.step(&model, tables, &measurement));
        assert!(tracker.is_finite(), "the state after {measurement:?}");
    }
}

fn input(numbers: &mut Numbers<'_>, frame: u8) -> Option<CyclicFrameInput<2>> {
    let root_px = numbers.flag().then(|| [300.0, 200.0].map(|coordinate| numbers.number(coordinate)));
    let lengths_px = [80.0, 60.0].map(|length| (numbers.below(5) != 4).then(|| numbers.number(length)));
    Some(CyclicFrameInput { angles: measured(numbers, frame)?, root_px, lengths_px })
}

fn place(numbers: &mut Numbers<'_>) -> Option<PlaceOptions> {
    let clean = PlaceOptions::of_person(100.0, 0.005, STD_RAD, 60.0).expect("it is built in");
    let mut place = PlaceOptions::of_person(
        numbers.number(100.0),
        numbers.number(0.005),
        numbers.number(STD_RAD),
        numbers.number(60.0),
    )
    .unwrap_or(clean);
    numbers.change(&mut [
        &mut place.keypoint_std_px,
        &mut place.root_acceleration_px,
        &mut place.length_walk,
        &mut place.lost_std_px,
    ]);
    (!numbers.flag()).then_some(place)
}

fn tracker(bytes: &[u8]) {
    let (table, mut numbers) = (model_table(), Numbers::new(bytes));
    let model: MotionModel<'_> = table.model().expect("it is built in");
    let options = CyclicTrackerOptions { filter: choice(&mut numbers), place: place(&mut numbers) };
    let Some(first) = input(&mut numbers, 0) else { return };
    let Ok(mut tracker) = CyclicTracker::new(&model, options, &first, first_phase(&mut numbers)) else { return };
    for frame in 1..FRAMES {
        let Some(input) = input(&mut numbers, frame) else { continue };
        let answer = tracker.step(&model, &input);
        check(&answer.estimate);
        assert!(answer.cadence_per_min.is_finite() && answer.cadence_std_per_min >= 0.0, "{answer:?}");
        assert!(tracker.is_finite(), "the state after {input:?}");
    }
}

/// Options of a run from `numbers`.
pub fn tracking_options(numbers: &mut Numbers<'_>) -> TrackingOptions {
    let filters = [FilterName::Coupled, FilterName::Paper, FilterName::PaperCut, FilterName::Particle];
    let starts = [StartName::Standard, StartName::Uniform, StartName::Random];
    TrackingOptions {
        filter: filters[numbers.below(filters.len())],
        start: starts[numbers.below(5).min(numbers.below(starts.len()))],
        sigma_rad: f64::from(numbers.number(0.1)),
        initial_cycle_position: numbers.flag().then(|| f64::from(numbers.number(0.2))),
        initial_cycle_velocity: numbers.flag().then(|| f64::from(numbers.number(0.01))),
        covariance_scaling: if numbers.flag() { ScalingName::Square } else { ScalingName::FourthPower },
        temporal_std: numbers.flag().then(|| f64::from(numbers.number(1.0e-3))),
        updates: if numbers.flag() { Updates::Every(u64::from(numbers.byte())) } else { Updates::All },
        rate_hz: numbers.flag().then(|| f64::from(numbers.number(60.0))),
        particles: 40,
        seed: numbers.long(),
        smooth: numbers.flag(),
    }
}

/// The same model twice.
pub fn two_models() -> &'static [CyclicModel; 2] {
    static MODELS: OnceLock<[CyclicModel; 2]> = OnceLock::new();
    MODELS.get_or_init(|| [walking().clone(), walking().clone()])
}

/// A short table.
pub fn angle_table() -> AngleTable {
    AngleTable::parse(&swing(8), Path::new("t.csv")).expect("it is built in")
}

fn table_run(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let options = tracking_options(&mut numbers);
    let (table, models) = (angle_table(), two_models());
    let models = &models[..1 + numbers.below(2)];
    let Ok(mut run) = TableRun::begin(&table, models, &options) else { return };
    run.run(&|| false, &mut |_| ()).expect("all rows are legal");
    let (tracked, _) = run.answered().expect("all rows are answered");
    let angles = tracked.frames.iter().flat_map(|frame| frame.angles_rad.iter());
    assert!(angles.into_iter().all(|angle| angle.is_finite()), "{options:?}");
}
