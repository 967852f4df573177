//! What the book says about the particle filter's accuracy on real walkers. Runs in release where
//! `../shared/data` is at hand, and says so where not.

use crate::shared_data;

use sinew::cyclic::CutList;
use sinew::cyclic::tracking::StartName;
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::resume::Cells;
use sinew_lab::cyclic::{Cell, Setting, test_cycles};

/// Particles that are compared with a known start, and with an unknown one; seeds.
const PARTICLES: [usize; 3] = [1000, 20_000, 100_000];
const START_PARTICLES: [usize; 2] = [1000, 10_000];
const SEEDS: u64 = 4;
/// Largest error with 20,000 particles, degrees.
const MAX_DEG: f64 = 9.0;
/// Error of `paper` (`cyclic_accuracy.rs`), to which no number of particles came down.
const PAPER_DEG: f64 = 3.80;
/// Largest error with 100,000 particles as a share of that with 1000.
const MAX_SHARE: f64 = 0.5;
/// Error of a uniform start as a share of the standard one's, from the fifth frame on. It is never
/// much above 1, and with few particles sometimes below, since it samples more positions.
const UNIFORM_SHARE: [f64; 2] = [0.85, 1.1];

#[test]
fn more_particles_and_an_unknown_phase_do_what_the_book_says() {
    let Some(folder) = shared_data::in_long_form("cyclic-walking") else { return };
    let list = CutList::read(&folder.join("train_cuts.csv")).unwrap();
    let model = train(&list, TrainingOptions { rate_hz: Some(60.0), ..TrainingOptions::default() }).unwrap();
    let cycles = test_cycles(&CutList::read(&folder.join("test_cuts.csv")).unwrap()).unwrap();
    let setting = Setting { cycles: &cycles, model: &model, rate_hz: 60.0, seeds: SEEDS, cells: &Cells::not_kept() };
    let table = setting.particle_table(&PARTICLES).unwrap();
    let [few, more, most] = std::array::from_fn(|i| table[i].error_deg);
    let share = most / few;
    println!("standard start: {few:.2}, {more:.2}, {most:.2} degrees; the last {share:.3} of the first");
    assert!(more > PAPER_DEG && more < MAX_DEG, "{more}");
    assert!(most > PAPER_DEG && share < MAX_SHARE, "{most} beside {few}");
    let cells = setting.starts(&START_PARTICLES).unwrap();
    let cell = |start: StartName, particles: usize| -> &Cell {
        cells.iter().find(|cell| cell.start == start && cell.particles == Some(particles)).unwrap()
    };
    for particles in START_PARTICLES {
        let [standard, uniform] =
            [StartName::Standard, StartName::Uniform].map(|start| cell(start, particles).late_error_deg);
        println!("{particles}: from the fifth frame on {standard:.2}, uniform over the cycle {uniform:.2}");
        let share = uniform / standard;
        assert!((UNIFORM_SHARE[0]..UNIFORM_SHARE[1]).contains(&share), "{particles}: {uniform} beside {standard}");
    }
}
