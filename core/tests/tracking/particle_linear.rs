//! The particle filter against the exact posterior where that is known: a linear model with normal
//! noise.

use sinew_core::cyclic::particle::moments::ParticleMoments;
use sinew_core::cyclic::particle::propose::{
    CyclicParticle, ParticleOptions, factors_len, fill_factors, first_particle,
};
use sinew_core::cyclic::particle::sweep::{CHUNK, sweep};
use sinew_core::cyclic::particle::tracker::resampling_offset;
use sinew_core::cyclic::particle::{resample::Comb, weigh::ParticleTarget, weights::WeightShare};
use sinew_core::cyclic::{
    AngleMeasurement, CycleStart, Deviation, KalmanFilter, KalmanOptions, ModelParts, MotionModel,
};
use sinew_core::numeric::semi_definite::{packed_index, packed_len};
use sinew_core::random::Stream;

const N: usize = 13;
const POSITIONS: usize = 4;
const FRAMES: u32 = 20;
/// Standard deviation of the accelerations, rad per frame^2, and of the first angles (rad) and
/// velocities (rad per frame).
const ACCELERATION_STD: f32 = 0.002;
const START_STD: f32 = 0.002;
/// Noise that leaves room for many particles to agree with a measurement, and no angle beyond half
/// a turn.
const MEASUREMENT_STD_RAD: f32 = 200.0 * ACCELERATION_STD;
/// Largest distance of 100,000 particles from the exact mean, posterior standard deviations.
const MAX_DISTANCE: f64 = 0.15;
const ZEROS: [f32; POSITIONS * N] = [0.0; POSITIONS * N];

/// Correlated accelerations with the same covariance everywhere in the cycle; half of each is
/// common to all.
fn covariance() -> Vec<f32> {
    let mut packed = vec![0.0; packed_len(N)];
    for i in 0..N {
        for j in 0..=i {
            let correlation = if i == j { 1.0 } else { 0.5 };
            packed[packed_index(i, j)] = ACCELERATION_STD * ACCELERATION_STD * correlation;
        }
    }
    packed.repeat(POSITIONS)
}

fn model(covariance: &[f32]) -> MotionModel<'_> {
    MotionModel::new(ModelParts {
        angle_count: N,
        mean_acceleration: &ZEROS,
        acceleration_covariance: covariance,
        mean_pose_rad: &ZEROS,
        mean_velocity: &ZEROS,
        turns_per_cycle: &[0; N],
        mean_duration_frames: POSITIONS as f32,
        rate_hz: 60.0,
        deviation: Deviation::default(),
    })
    .expect("a sound model")
}

/// Noisy measurements of one motion drawn from the model.
fn measurements() -> Vec<AngleMeasurement<N>> {
    let (mut angles, mut velocities) = ([0.0; N], [0.0; N]);
    (1..=FRAMES)
        .map(|frame| {
            let mut stream = Stream::new(11, u64::from(frame), 0);
            let common = stream.normal();
            let seen = std::array::from_fn(|i| {
                let acceleration = ACCELERATION_STD * 0.5_f32.sqrt() * (common + stream.normal());
                angles[i] += velocities[i] + 0.5 * acceleration;
                velocities[i] += acceleration;
                Some(angles[i] + MEASUREMENT_STD_RAD * stream.normal())
            });
            AngleMeasurement::new(&seen, MEASUREMENT_STD_RAD).expect("a positive deviation")
        })
        .collect()
}

/// Means of angles and velocities by `count` particles after the last frame.
fn particle_means(model: &MotionModel<'_>, start: &CycleStart<N>, count: usize) -> [f64; 2 * N] {
    let options = ParticleOptions {
        start_std: START_STD,
        position_std: 0.0,
        velocity_std: 0.0,
        temporal_acceleration_std: 0.0,
        ..ParticleOptions::default()
    };
    let mut factors = vec![0.0; factors_len(model)];
    fill_factors(model, &mut factors);
    let draw = |index| first_particle(model, &[], start, &options, (1, index));
    let mut particles: Vec<CyclicParticle<N>> = (0..count as u32).map(draw).collect();
    let mut next = particles.clone();
    let (mut weights, mut shares) = (vec![0.0; count], Vec::<WeightShare>::new());
    let mut last = start.estimate();
    for (frame, measurement) in (1..).zip(measurements()) {
        let target = ParticleTarget::new(&measurement, N, &last);
        let mut all = ParticleMoments::nothing();
        shares.clear();
        for (chunk, (particles, weights)) in particles.chunks_mut(CHUNK).zip(weights.chunks_mut(CHUNK)).enumerate() {
            let key = (1, frame, (chunk * CHUNK) as u32);
            let moments = sweep(model, &factors, &options, (&target, 1.0), key, particles, weights);
            shares.push(moments.share());
            all.merge(&moments);
        }
        last = all.estimate(&target);
        let comb = Comb::new(all.share(), resampling_offset(1, frame), count);
        let chunks = particles.chunks(CHUNK).zip(weights.chunks_mut(CHUNK)).zip(&shares);
        for (((particles, weights), share), teeth) in chunks.zip(comb.teeth(&shares)) {
            comb.choose(particles, weights, &teeth, &mut next[teeth.first..teeth.first + teeth.count]);
            let scale = share.scale(all.share().greatest_log_weight);
            weights.iter_mut().for_each(|weight| *weight *= scale);
        }
        if frame < u64::from(FRAMES) {
            std::mem::swap(&mut particles, &mut next);
        }
    }
    let total: f64 = weights.iter().map(|&weight| f64::from(weight)).sum();
    let mean = |value: &dyn Fn(&CyclicParticle<N>) -> f32| {
        let weighted = particles.iter().zip(&weights).map(|(particle, &w)| f64::from(w) * f64::from(value(particle)));
        weighted.sum::<f64>() / total
    };
    std::array::from_fn(|i| if i < N { mean(&|p| p.angles_rad[i]) } else { mean(&|p| p.velocities[i - N]) })
}

#[test]
fn many_particles_agree_with_the_kalman_filter_on_a_linear_model() {
    let covariance = covariance();
    let model = model(&covariance);
    let start = CycleStart::standard(&model, &[Some(0.0); N], Some(0.0), None).expect("a sound start");
    let options = KalmanOptions {
        angle_variance: START_STD * START_STD,
        velocity_variance: START_STD * START_STD,
        ..KalmanOptions::default()
    };
    let mut kalman = KalmanFilter::new(&model, &options, &start).expect("a sound filter");
    let mut angles = [0.0; N];
    for measurement in measurements() {
        angles = kalman.step(&model, &options, &measurement).angles_rad;
    }
    assert!(angles.iter().all(|angle| angle.abs() < 2.0), "no angle wraps: {angles:?}");
    let distance = |count: usize| {
        let means = particle_means(&model, &start, count);
        let off = |i: usize| {
            let exact = if i < N { angles[i] } else { kalman.velocities()[i - N] };
            (means[i] - f64::from(exact)).abs() / f64::from(kalman.covariance().entry(i, i)).sqrt()
        };
        (0..2 * N).map(off).fold(0.0, f64::max)
    };
    let [few, many] = [1_000, 100_000].map(distance);
    println!("greatest distance in standard deviations: {few:.3} with 1000 particles, {many:.3} with 100,000");
    assert!(many > 0.002 && many <= MAX_DISTANCE, "{many}");
    // A hundred times as many: a tenth of the distance, give or take a half of it for chance.
    assert!((3.0..30.0).contains(&(few / many)) && few < 1.0, "{few} beside {many}");
}
