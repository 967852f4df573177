//! The cyclic trackers over a made-up motion.

use super::SEED;
use super::bits::Bits;
use super::motion::{POSITIONS, Person, Table, table};
use sinew_core::cyclic::particle::propose::{ParticleOptions, Spread, factors_len, fill_factors, fill_positions};
use sinew_core::cyclic::particle::tracker::ParticleTables;
use sinew_core::cyclic::{
    AngleMeasurement, CycleStart, CyclicEstimate, FilterChoice, KalmanOptions, MotionModel, ParticleTracker,
    PlaceOptions,
};
use sinew_core::error::{ParameterError, Rule};
use sinew_core::skeleton::stick_figure::{HUMAN, HUMAN_ANGLES, HUMAN_JOINTS, ImagePoint};
use sinew_core::tracker::cyclic::{CyclicFrame, CyclicFrameInput, CyclicTracker, CyclicTrackerOptions, FirstPhase};

const ANGLES: usize = HUMAN_ANGLES;
const PARTICLES: usize = 64;
/// Numbers of the factors of a model of [`POSITIONS`] positions and [`ANGLES`] angles.
const FACTORS: usize = 208 * POSITIONS;
/// Standard deviation of each keypoint, pixels.
const KEYPOINT_STD_PX: f32 = 2.0;
const NOISE_RAD: f32 = 0.05;

fn model(table: &Table) -> Result<MotionModel<'_>, ParameterError> {
    table.model().map_err(|error| error.error)
}

/// The coupled filter from joints in a picture.
pub fn coupled(frames: u32) -> Result<u64, ParameterError> {
    let (table, mut bits, mut person) = (table(SEED), Bits::new(), Person::new(SEED));
    let model = model(&table)?;
    let place = PlaceOptions::of_person(60.0, 0.008, NOISE_RAD, 60.0)?;
    let options = CyclicTrackerOptions { place: Some(place), ..CyclicTrackerOptions::default() };
    let first = CyclicFrameInput::from_joints(&HUMAN, &joints(&mut person, 0).0, KEYPOINT_STD_PX)?;
    let mut tracker = CyclicTracker::<ANGLES>::new(&model, options, &first, FirstPhase::default())?;
    let mut places = [None; HUMAN_JOINTS];
    for frame in 1..=frames {
        let (joints, step_frames) = joints(&mut person, frame);
        let input = CyclicFrameInput::from_joints(&HUMAN, &joints, KEYPOINT_STD_PX)?.after(step_frames)?;
        let answer = tracker.step(&model, &input);
        take_frame(&mut bits, &answer);
        tracker.joints_px(&HUMAN, &answer.estimate, &mut places);
        for joint in places {
            bits.present(joint.is_some());
            bits.numbers(&joint.unwrap_or_default());
        }
    }
    Ok(bits.digest())
}

/// Joints in the picture; one whose segment's angle is missing is missing too.
fn joints(person: &mut Person, frame: u32) -> ([Option<ImagePoint>; HUMAN_JOINTS], f32) {
    let shown = person.show(frame, NOISE_RAD);
    let pose = person.pose_rad();
    let angles: [f32; ANGLES] =
        core::array::from_fn(|i| shown.angles_rad[i].filter(|a| a.is_finite()).unwrap_or(pose[i]));
    let mut points = [[0.0; 2]; HUMAN_JOINTS];
    HUMAN.joint_positions([100.0 + 0.5 * frame as f32, 200.0], &[60.0; ANGLES], &angles, &mut points);
    let present = |joint: usize| joint == 0 || shown.angles_rad.get(joint.wrapping_sub(1)).is_some_and(Option::is_some);
    (core::array::from_fn(|joint| present(joint).then_some(points[joint])), shown.step_frames)
}

/// The paper's filter, full gain and cut gain.
pub fn paper(frames: u32) -> Result<u64, ParameterError> {
    let (table, mut bits) = (table(SEED), Bits::new());
    let model = model(&table)?;
    for options in [KalmanOptions::default(), KalmanOptions::cut()] {
        let mut person = Person::new(SEED);
        let options = CyclicTrackerOptions { filter: FilterChoice::Kalman(options), place: None };
        let first = AngleMeasurement::new(&person.show(0, NOISE_RAD).angles_rad, NOISE_RAD)?.into();
        let mut tracker = CyclicTracker::<ANGLES>::new(&model, options, &first, FirstPhase::default())?;
        for frame in 1..=frames {
            let shown = person.show(frame, NOISE_RAD);
            let input = AngleMeasurement::new(&shown.angles_rad, NOISE_RAD)?.after(shown.step_frames)?;
            take_frame(&mut bits, &tracker.step(&model, &input.into()));
        }
    }
    Ok(bits.digest())
}

/// The particle filter from an unknown position in the cycle.
pub fn particles(frames: u32) -> Result<u64, ParameterError> {
    let (table, mut bits, mut person) = (table(SEED), Bits::new(), Person::new(SEED));
    let model = model(&table)?;
    if factors_len(&model) != FACTORS {
        return Err(ParameterError::new("factors", Rule::SameLength { expected: factors_len(&model) }));
    }
    let (mut factors, mut positions) = ([0.0; FACTORS], [0.0; POSITIONS]);
    fill_factors(&model, &mut factors);
    let start = CycleStart::standard(&model, &person.show(0, NOISE_RAD).angles_rad, None, None)?;
    fill_positions(&model, &start, &mut positions);
    let tables = ParticleTables { factors: &factors, positions: &positions };
    let options = ParticleOptions { spread: Spread::UniformPosition, ..ParticleOptions::default() };
    let mut tracker = ParticleTracker::<ANGLES, PARTICLES>::new(&model, tables, options, &start, SEED);
    for frame in 1..=frames {
        let shown = person.show(frame, NOISE_RAD);
        let measurement = AngleMeasurement::new(&shown.angles_rad, 4.0 * NOISE_RAD)?.after(shown.step_frames)?;
        take_estimate(&mut bits, &tracker.step(&model, tables, &measurement));
        let particle = &tracker.particles()[frame as usize % PARTICLES];
        bits.numbers(&particle.angles_rad);
        bits.numbers(&particle.velocities);
        bits.numbers(&[particle.cycle_position, particle.cycle_velocity]);
    }
    Ok(bits.digest())
}

fn take_frame(bits: &mut Bits, frame: &CyclicFrame<ANGLES>) {
    take_estimate(bits, &frame.estimate);
    bits.word(frame.cycles_completed as u32);
    bits.numbers(&[frame.cadence_per_min, frame.cadence_std_per_min]);
    bits.numbers(&[frame.cycle_step.from, frame.cycle_step.advance, frame.cycle_step.step_frames]);
    bits.number(frame.cycle_step.passed(0.25).unwrap_or(-1.0));
}

fn take_estimate(bits: &mut Bits, estimate: &CyclicEstimate<ANGLES>) {
    bits.numbers(&estimate.angles_rad);
    estimate.turns.iter().for_each(|&turns| bits.word(turns as u32));
    bits.numbers(&estimate.angle_variance_rad2);
    bits.numbers(&[estimate.cycle_position, estimate.cycle_position_variance]);
    bits.numbers(&[estimate.cycle_velocity_per_frame, estimate.cycle_velocity_variance]);
    bits.number(estimate.log_likelihood);
    bits.present(estimate.outlier);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_person_can_be_followed_through_gaps() {
        let table = table(SEED);
        let (model, mut person) = (model(&table).unwrap(), Person::new(SEED));
        let first = AngleMeasurement::new(&person.show(0, NOISE_RAD).angles_rad, NOISE_RAD).unwrap().into();
        let mut tracker =
            CyclicTracker::<ANGLES>::new(&model, CyclicTrackerOptions::default(), &first, FirstPhase::default())
                .unwrap();
        let mut near = 0;
        for frame in 1..=500 {
            let shown = person.show(frame, NOISE_RAD);
            let input = AngleMeasurement::new(&shown.angles_rad, NOISE_RAD).unwrap();
            let answer = tracker.step(&model, &input.after(shown.step_frames).unwrap().into());
            let off = person.pose_rad()[3] - answer.estimate.angles_rad[3];
            near += u32::from(sinew_core::math::wrap_angle(off).abs() < 0.2);
        }
        assert!(near > 470, "{near} of 500 frames");
    }
}
