//! The host's particle filter on one thread and on two, in turns of some frames each.

use sinew::cyclic::tracking::particles::ParticleFilter;
use sinew_core::cyclic::particle::propose::ParticleOptions;
use sinew_core::cyclic::{CycleStart, MotionModel};
use std::hint::black_box;
use std::time::Instant;

use super::walk::Walk;

/// Frames of a turn. In a recording one frame follows the other. Workers that sleep through every
/// second one seem to be woken on one processor. Half of the steps then take as long as on one
/// thread.
const TURN: usize = 8;
/// Frames of a turn that are not counted.
const UNCOUNTED: usize = 1;

/// Milliseconds of each step of `count` particles on one thread, and on two.
pub fn milliseconds(model: &MotionModel<'_>, walk: &Walk, count: usize, rounds: usize) -> [Vec<f64>; 2] {
    let start = CycleStart::standard(model, walk.angles(0), None, None).expect("a sound start");
    let mut runs = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        let filter = ParticleFilter::new(model, ParticleOptions::default(), &start, start.estimate(), count, 1);
        (pool, filter, Vec::new())
    });
    for turn in 0..rounds.div_ceil(TURN - UNCOUNTED) {
        for (pool, filter, times) in &mut runs {
            for frame in 0..TURN {
                let measurement = walk.measurement(1 + turn * TURN + frame);
                let start = Instant::now();
                black_box(pool.install(|| filter.step(model, &measurement)));
                if frame >= UNCOUNTED {
                    times.push(1.0e3 * start.elapsed().as_secs_f64());
                }
            }
        }
    }
    runs.map(|(_, _, times)| times)
}
