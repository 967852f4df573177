//! The cyclic filters' steps: `paper` and `coupled` against dense filters of other crates; the particle filter by stage, on one
//! thread and two, and beside numpy and the Python package `particles` where they are installed.
//!
//! Medians taken in turns in this process, on one thread unless said otherwise, and ratios of them. The Python filters run
//! between two halves of the particle filter's rounds; `PYTHON` names the interpreter (default: python3).

mod dense_peers;
mod particle_step;
mod particle_threads;
mod python_peers;
mod walk;

use dense_peers::{KfilterPeer, minikalman_step};
use particle_step::{ParticleStep, STAGES};
use sinew::cyclic::model::CyclicModel;
use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
use sinew_core::cyclic::{CycleStart, KalmanFilter, KalmanOptions, MotionModel};
use std::hint::black_box;
use std::time::Instant;
use walk::{ANGLES, Walk};

/// Rounds of which medians are taken.
const ROUNDS: usize = 101;
/// Steps of a round of the Kalman filters.
const STEPS: usize = 50;
/// Rounds and particles of the particle filter.
const PARTICLE_ROUNDS: usize = 31;
const PARTICLES: usize = 100_000;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Microseconds of one step, the mean over [`STEPS`] of them from frame `first` on.
fn microseconds<T>(first: usize, mut step: impl FnMut(usize) -> T) -> f64 {
    let start = Instant::now();
    for frame in first..first + STEPS {
        black_box(step(frame));
    }
    start.elapsed().as_secs_f64() * 1.0e6 / STEPS as f64
}

/// One round of every filter in turn: `paper`, `coupled`, `kfilter`, `minikalman`.
fn kalman_rounds(model: &MotionModel<'_>, walk: &Walk) -> Vec<[f64; 4]> {
    let options = KalmanOptions::default();
    let start = CycleStart::standard(model, walk.angles(0), None, None).expect("a sound start");
    let mut paper = KalmanFilter::new(model, &options, &start).expect("sound options");
    let first = AngleMeasurement::new(walk.angles(0), walk::STD_RAD).expect("positive noise");
    let mut coupled = CoupledFilter::<ANGLES>::new(model, &first, None, None).expect("a model with spread");
    let (mut kfilter, mut minikalman) = (KfilterPeer::new(), minikalman_step());
    let round = |round: usize| {
        let first = 1 + round * STEPS;
        [
            microseconds(first, |frame| paper.step(model, &options, &walk.measurement(frame))),
            microseconds(first, |frame| coupled.step(model, &walk.measurement(frame))),
            microseconds(first, |frame| kfilter.step(walk.angles(frame))),
            microseconds(first, |frame| minikalman(walk.angles(frame))),
        ]
    };
    (0..ROUNDS).map(round).collect()
}

fn print_kalman(model: &MotionModel<'_>, walk: &Walk) {
    let rounds = kalman_rounds(model, walk);
    let paper = median(rounds.iter().map(|round| round[0]).collect());
    println!("{:<22}{:>10}{:>18}", "filter, one step", "us", "times `paper`");
    for (i, name) in ["paper", "coupled", "kfilter", "minikalman"].into_iter().enumerate() {
        let time = median(rounds.iter().map(|round| round[i]).collect());
        println!("{name:<22}{time:>10.2}{:>18.2}", time / paper);
    }
}

fn print_particles(model: &MotionModel<'_>, walk: &Walk) {
    let mut filter = ParticleStep::new(*model, walk, PARTICLES);
    let mut rounds: Vec<_> = (0..PARTICLE_ROUNDS).map(|_| filter.run()).collect();
    let peers = python_peers::run(PARTICLES, PARTICLE_ROUNDS);
    rounds.extend((0..PARTICLE_ROUNDS).map(|_| filter.run()));
    println!("\n{:<24}{:>10}{:>18}", "100,000 particles", "ms", "times `particle`");
    for (i, name) in STAGES.iter().enumerate() {
        println!("{name:<24}{:>10.2}", 1.0e3 * median(rounds.iter().map(|round| round[i]).collect()));
    }
    let step = 1.0e3 * median(rounds.iter().map(|round| round.iter().sum()).collect());
    println!("{:<24}{step:>10.2}{:>18.2}", "particle", 1.0);
    for (name, milliseconds) in peers {
        println!("{name:<24}{milliseconds:>10.2}{:>18.2}", milliseconds / step);
    }
    let [one, two] = particle_threads::milliseconds(model, walk, PARTICLES, PARTICLE_ROUNDS).map(median);
    println!("\none thread {one:.2} ms, two threads {two:.2} ms: {:.2} times as fast", one / two);
}

fn main() {
    let shipped = CyclicModel::from_option("walking").expect("a shipped model");
    let model = shipped.view();
    let walk = Walk::new(&model, 600);
    if !std::env::args().any(|argument| argument == "--test") {
        print_kalman(&model, &walk);
        print_particles(&model, &walk);
    }
}
