//! The host's particle filter on one thread and on two, in turns.

use sinew::cyclic::tracking::particles::ParticleFilter;
use sinew_core::cyclic::particle::ParticleOptions;
use sinew_core::cyclic::{CycleStart, MotionModel};
use std::hint::black_box;
use std::time::Instant;

use super::walk::Walk;

/// Milliseconds of each step of `count` particles on one thread, and on two.
pub fn milliseconds(model: &MotionModel<'_>, walk: &Walk, count: usize, rounds: usize) -> [Vec<f64>; 2] {
    let start = CycleStart::standard(model, walk.angles(0), None, None).expect("a sound start");
    let mut runs = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        let filter = ParticleFilter::new(model, ParticleOptions::default(), &start, start.estimate(), count, 1);
        (pool, filter, Vec::new())
    });
    for frame in 1..=rounds {
        let measurement = walk.measurement(frame);
        for (pool, filter, times) in &mut runs {
            let start = Instant::now();
            black_box(pool.install(|| filter.step(model, &measurement)));
            times.push(1.0e3 * start.elapsed().as_secs_f64());
        }
    }
    runs.map(|(_, _, times)| times)
}
