//! The cyclic filters: the paper's, the phase-coupled one, particles, and the bank of motions.

use crate::corners::Corners;
use crate::drive::{Recovery, Subject, drive, holds};
use sinew_core::cyclic::example::{swing_pose_rad, swing_table};
use sinew_core::cyclic::model::ModelTable;
use sinew_core::cyclic::particle::propose::{ParticleOptions, factors_len, fill_factors};
use sinew_core::cyclic::particle::tracker::ParticleTables;
use sinew_core::cyclic::phase::position_difference;
use sinew_core::cyclic::recognition::bank::MotionBank;
use sinew_core::cyclic::{
    AngleMeasurement, CoupledFilter, CycleStart, CyclicEstimate, KalmanFilter, KalmanOptions, MotionModel,
    ParticleTracker,
};
use sinew_core::math::wrap_angle;
use sinew_core::saved_state::SavedState;

/// Noise of the clean measurements, rad.
pub const STD_RAD: f32 = 0.05;
/// An angle of the twin, rad: two standard deviations of a measurement.
const MAX_APART_RAD: f32 = 0.1;

pub type Table = ModelTable<100, 2, 3>;
type Measurement = AngleMeasurement<2>;

/// What was seen at `frame` of a motion of 60 frames a cycle.
pub fn seen(frame: f32) -> Measurement {
    Measurement::new(&swing_pose_rad(frame / 60.0).map(Some), STD_RAD).unwrap()
}

/// A measurement with hostile angles, deviations and step; `None` where its border refuses it.
pub fn hostile_measurement(corners: &mut Corners, frame: f32) -> Option<Measurement> {
    let angles_rad = swing_pose_rad(frame / 60.0).map(|angle| (!corners.one_in(4)).then(|| corners.number(angle)));
    let one_std = corners.number(STD_RAD);
    let measurement = if corners.one_in(2) {
        Measurement::new(&angles_rad, one_std)
    } else {
        Measurement::with_std(&angles_rad, &[one_std, corners.number(STD_RAD)])
    };
    measurement.and_then(|measurement| measurement.after(corners.number(1.0))).ok()
}

/// Whether numbers are finite and variances not negative.
pub fn sound(estimate: &CyclicEstimate<2>) -> Result<(), String> {
    let numbers = [estimate.cycle_position, estimate.cycle_velocity_per_frame, estimate.log_likelihood];
    let variances = [estimate.cycle_position_variance, estimate.cycle_velocity_variance];
    let is_sound = estimate.angles_rad.iter().chain(&numbers).all(|x| x.is_finite())
        && estimate.angle_variance_rad2.iter().chain(&variances).all(|x| *x >= 0.0 && x.is_finite());
    holds(is_sound, || format!("{estimate:?}"))
}

/// How far apart two estimates are, in units of what is allowed.
pub fn estimates_apart(one: &CyclicEstimate<2>, twin: &CyclicEstimate<2>) -> f32 {
    let angles = (0..2).map(|i| wrap_angle(one.angles_rad[i] - twin.angles_rad[i]).abs() / MAX_APART_RAD);
    let phase = position_difference(one.cycle_position, twin.cycle_position).abs() / 0.05;
    angles.chain([phase]).fold(0.0, |sum, apart| if apart <= sum { sum } else { apart })
}

/// A filter of the cycle with its own step.
trait Filter: SavedState {
    fn step(&mut self, model: &MotionModel<'_>, measurement: &Measurement) -> CyclicEstimate<2>;
}

struct Cyclic<F> {
    table: Table,
    filters: [F; 2],
    last: Option<[CyclicEstimate<2>; 2]>,
    frame: f32,
}

impl<F: Filter + Clone> Cyclic<F> {
    fn new(begin: impl FnOnce(&MotionModel<'_>) -> F) -> Self {
        let table = swing_table();
        let filter = begin(&table.model().unwrap());
        Self { filters: [filter.clone(), filter], table, last: None, frame: 0.0 }
    }
}

impl<F: Filter> Subject for Cyclic<F> {
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String> {
        let model = self.table.model().unwrap();
        let Some(hostile) = hostile_measurement(corners, self.frame + 1.0) else { return Ok(()) };
        self.frame += hostile.step_frames();
        let missing = Measurement::nothing().after(hostile.step_frames()).unwrap();
        let [one, twin] = &mut self.filters;
        twin.step(&model, &missing);
        sound(&one.step(&model, &hostile)).map_err(|message| format!("{message} by {hostile:?}"))?;
        holds(one.is_finite(), || format!("the state by {hostile:?}"))
    }

    fn clean(&mut self) {
        let model = self.table.model().unwrap();
        self.frame = (self.frame + 1.0) % 60.0;
        let clean = seen(self.frame);
        self.last = Some(self.filters.each_mut().map(|filter| filter.step(&model, &clean)));
    }

    fn apart(&mut self) -> f32 {
        self.last.as_ref().map_or(f32::INFINITY, |[one, twin]| estimates_apart(one, twin))
    }
}

#[derive(Clone)]
struct Paper {
    filter: KalmanFilter<2>,
    options: KalmanOptions,
}

impl SavedState for Paper {
    fn visit(&mut self, visitor: &mut impl sinew_core::saved_state::StateVisitor) {
        self.filter.visit(visitor);
    }
}

impl Filter for Paper {
    fn step(&mut self, model: &MotionModel<'_>, measurement: &Measurement) -> CyclicEstimate<2> {
        self.filter.step(model, &self.options, measurement)
    }
}

#[test]
fn the_papers_filter_survives_hostile_frames() {
    for (name, options) in [("paper", KalmanOptions::default()), ("paper-cut", KalmanOptions::cut())] {
        drive(name, 120, Recovery::FromAll, || {
            Cyclic::new(|model| {
                let start = CycleStart::standard(model, seen(0.0).angles_rad(), Some(0.0), None).unwrap();
                Paper { filter: KalmanFilter::new(model, &options, &start).unwrap(), options }
            })
        });
    }
}

impl Filter for CoupledFilter<2> {
    fn step(&mut self, model: &MotionModel<'_>, measurement: &Measurement) -> CyclicEstimate<2> {
        self.step(model, measurement)
    }
}

#[test]
fn the_coupled_filter_survives_hostile_frames() {
    drive("coupled", 120, Recovery::FromAll, || {
        Cyclic::new(|model| CoupledFilter::new(model, &seen(0.0), None, None).unwrap())
    });
}

#[derive(Clone)]
struct Particles {
    tracker: Box<ParticleTracker<2, 200>>,
    factors: Vec<f32>,
}

impl SavedState for Particles {
    fn visit(&mut self, visitor: &mut impl sinew_core::saved_state::StateVisitor) {
        self.tracker.visit(visitor);
    }
}

impl Filter for Particles {
    fn step(&mut self, model: &MotionModel<'_>, measurement: &Measurement) -> CyclicEstimate<2> {
        self.tracker.step(model, ParticleTables { factors: &self.factors, positions: &[] }, measurement)
    }
}

#[test]
fn the_particle_filter_survives_hostile_frames() {
    drive("particles", 120, Recovery::FromRefused, || {
        Cyclic::new(|model| {
            let mut factors = vec![0.0; factors_len(model)];
            fill_factors(model, &mut factors);
            let tables = ParticleTables { factors: &factors, positions: &[] };
            let start = CycleStart::standard(model, seen(0.0).angles_rad(), Some(0.0), None).unwrap();
            let tracker = Box::new(ParticleTracker::new(model, tables, ParticleOptions::default(), &start, 1));
            Particles { tracker, factors }
        })
    });
}

struct Bank {
    table: Table,
    banks: [MotionBank<2, 2>; 2],
    frame: f32,
}

impl Bank {
    fn add(&mut self, one: &Measurement, twin: &Measurement, position: f32) {
        let models = [self.table.model().unwrap(); 2];
        for (bank, measurement) in self.banks.iter_mut().zip([one, twin]) {
            bank.add(&models, measurement, &[position, 0.5 * position]);
        }
    }
}

impl Subject for Bank {
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String> {
        let Some(hostile) = hostile_measurement(corners, self.frame + 1.0) else { return Ok(()) };
        self.frame += hostile.step_frames();
        let missing = Measurement::nothing().after(hostile.step_frames()).unwrap();
        self.add(&hostile, &missing, corners.number(self.frame / 60.0));
        let bank = &mut self.banks[0];
        let sum = bank.probabilities().iter().sum::<f32>() + bank.none_probability();
        holds((sum - 1.0).abs() < 1.0e-4, || format!("probabilities sum to {sum} by {hostile:?}"))?;
        holds(bank.is_finite(), || format!("the state by {hostile:?}"))
    }

    fn clean(&mut self) {
        self.frame = (self.frame + 1.0) % 60.0;
        let clean = seen(self.frame);
        self.add(&clean, &clean, self.frame / 60.0);
    }

    fn apart(&mut self) -> f32 {
        let [one, twin] = self.banks.each_ref().map(MotionBank::probabilities);
        if self.banks[0].likeliest() == self.banks[1].likeliest() {
            (one[0] - twin[0]).abs() / 0.1
        } else {
            f32::INFINITY
        }
    }
}

#[test]
fn the_bank_of_motions_survives_hostile_frames() {
    drive("bank", 240, Recovery::FromAll, || {
        let table = swing_table();
        let bank = MotionBank::new(&[table.model().unwrap(); 2]);
        Bank { table, banks: [bank; 2], frame: 0.0 }
    });
}
