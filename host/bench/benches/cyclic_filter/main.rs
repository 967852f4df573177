//! The cyclic filters' steps: `paper` and `coupled`, as the command runs them and with SSE2 alone,
//! against dense filters of other crates. Also the particle filter by stage, on one thread and two.
//! It is compared with numpy and the Python package `particles` where they are installed.
//!
//! Medians and smallest times, measured in turns in this process, and their ratios. One thread
//! where no other number is given. The Python filters run between two halves of the particle
//! filter's rounds; `PYTHON` names the interpreter (default: python3).

mod dense_peers;
mod particle_step;
mod particle_threads;
mod python_peers;
mod walk;

use dense_peers::{KfilterPeer, minikalman_step};
use particle_step::{ParticleStep, STAGES};
use sinew::cyclic::model::CyclicModel;
use sinew::cyclic::tracking::wide_vectors::{coupled_step, kalman_step};
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

/// Median and least of some times. The least is what other programs on the machine disturb least.
fn median_and_least(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [values[values.len() / 2], values[0]]
}

/// A line of the tables: both times, and how many times those of `unit` they are.
fn print_line(name: &str, [median, least]: [f64; 2], unit: [f64; 2]) {
    println!("{name:<24}{median:>10.2}{:>10.2}{least:>12.2}{:>10.2}", median / unit[0], least / unit[1]);
}

fn print_heading(name: &str, unit: &str) {
    println!(
        "\n{name:<24}{:>10}{:>10}{:>12}{:>10}",
        format!("{unit} median"),
        "ratio",
        format!("{unit} least"),
        "ratio"
    );
}

/// Microseconds of one step, the mean over [`STEPS`] of them from frame `first` on.
fn microseconds<T>(first: usize, mut step: impl FnMut(usize) -> T) -> f64 {
    let start = Instant::now();
    for frame in first..first + STEPS {
        black_box(step(frame));
    }
    start.elapsed().as_secs_f64() * 1.0e6 / STEPS as f64
}

/// One round of every filter in turn: `paper`, `coupled`, `kfilter`, `minikalman`, and the first
/// two with SSE2 alone.
fn kalman_rounds(model: &MotionModel<'_>, walk: &Walk) -> Vec<[f64; 6]> {
    let options = KalmanOptions::default();
    let start = CycleStart::standard(model, walk.angles(0), None, None).expect("a sound start");
    let mut paper = KalmanFilter::new(model, &options, &start).expect("sound options");
    let first = AngleMeasurement::new(walk.angles(0), walk::STD_RAD).expect("positive noise");
    let mut coupled = CoupledFilter::<ANGLES>::new(model, &first, None, None).expect("a model with spread");
    let (mut narrow_paper, mut narrow_coupled) = (paper, coupled);
    let (mut kfilter, mut minikalman) = (KfilterPeer::new(), minikalman_step());
    let round = |round: usize| {
        let first = 1 + round * STEPS;
        [
            microseconds(first, |frame| kalman_step(&mut paper, model, &options, &walk.measurement(frame))),
            microseconds(first, |frame| coupled_step(&mut coupled, model, &walk.measurement(frame))),
            microseconds(first, |frame| kfilter.step(walk.angles(frame))),
            microseconds(first, |frame| minikalman(walk.angles(frame))),
            microseconds(first, |frame| narrow_paper.step(model, &options, &walk.measurement(frame))),
            microseconds(first, |frame| narrow_coupled.step(model, &walk.measurement(frame))),
        ]
    };
    (0..ROUNDS).map(round).collect()
}

fn print_kalman(model: &MotionModel<'_>, walk: &Walk) {
    let rounds = kalman_rounds(model, walk);
    let times = |i: usize| median_and_least(rounds.iter().map(|round| round[i]).collect());
    print_heading("filter, one step", "us");
    let names = ["paper", "coupled", "kfilter", "minikalman", "paper, SSE2", "coupled, SSE2"];
    for (i, name) in names.into_iter().enumerate() {
        print_line(name, times(i), times(0));
    }
}

fn print_particles(model: &MotionModel<'_>, walk: &Walk) {
    let mut filter = ParticleStep::new(*model, walk, PARTICLES);
    let mut rounds: Vec<_> = (0..PARTICLE_ROUNDS).map(|_| filter.run()).collect();
    let peers = python_peers::run(PARTICLES, PARTICLE_ROUNDS);
    rounds.extend((0..PARTICLE_ROUNDS).map(|_| filter.run()));
    print_heading("100,000 particles", "ms");
    let step = median_and_least(rounds.iter().map(|round| 1.0e3 * round.iter().sum::<f64>()).collect());
    for (i, name) in STAGES.iter().enumerate() {
        print_line(name, median_and_least(rounds.iter().map(|round| 1.0e3 * round[i]).collect()), step);
    }
    print_line("particle", step, step);
    for (name, milliseconds) in peers {
        print_line(&name, milliseconds, step);
    }
    print_heading("the host's filter", "ms");
    let [one, two] = particle_threads::milliseconds(model, walk, PARTICLES, PARTICLE_ROUNDS).map(median_and_least);
    print_line("one thread", one, two);
    print_line("two threads", two, two);
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
