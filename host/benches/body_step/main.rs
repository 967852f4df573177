//! One step of the body tracker on the built-in scene with a stick (2000 points, 16 capsules): frames a second with all threads by model and number
//! of particles, the time relative to the angular model with as many, and how it grows with the points. `RAYON_NUM_THREADS=1` for one thread.

use criterion::Criterion;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew::evaluate::body::MotionChoice;
use sinew::evaluate::body::trial::SeenMotion;
use sinew_core::pik::processes::stick::StickSight;
use std::hint::black_box;
use std::time::Instant;

/// Frames of a pass.
const FRAMES: usize = 60;
/// Passes; the median frame of all is told.
const PASSES: u64 = 3;

/// Seconds of each step of one pass, every `stride`-th block of points kept.
fn pass_s(seen: &SeenMotion, kind: BodyModelKind, particles: usize, stride: usize, seed: u64) -> Vec<f64> {
    let mut filter = BodyFilter::new(kind, BodyTuning::default(), &seen.measures, seen.first_rad, particles, seed)
        .expect("usable numbers");
    let step = |(frame, blocks): (usize, &Vec<_>)| {
        let kept: Vec<_> = blocks.iter().step_by(stride).copied().collect();
        let stick = seen.stick.get(frame).copied().unwrap_or(StickSight::Unseen);
        let start = Instant::now();
        black_box(filter.step(&kept, 1.0 / seen.rate_hz, stick));
        start.elapsed().as_secs_f64()
    };
    seen.clouds.iter().enumerate().skip(1).take(FRAMES).map(step).collect()
}

fn median_s(seen: &SeenMotion, kind: BodyModelKind, particles: usize, stride: usize) -> f64 {
    let mut times: Vec<f64> = (1..=PASSES).flat_map(|seed| pass_s(seen, kind, particles, stride, seed)).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() {
    let seen = MotionChoice::StickWave.seen(None, 1).expect("a built-in scene");
    println!("{} threads, 2000 points, median of a step", rayon::current_num_threads());
    println!("{:16} {:>9} {:>12} {:>10} {:>14}", "model", "particles", "milliseconds", "frames/s", "over angular");
    for particles in [100, 500] {
        let angular = median_s(&seen, BodyModelKind::Angular, particles, 1);
        for kind in [BodyModelKind::Angular, BodyModelKind::EndEffector, BodyModelKind::Stick, BodyModelKind::Guided] {
            let time = median_s(&seen, kind, particles, 1);
            let (name, ratio) = (kind.name(), time / angular);
            println!("{name:16} {particles:>9} {:>12.2} {:>10.1} {ratio:>14.2}", 1.0e3 * time, 1.0 / time);
        }
    }
    for stride in [1, 2, 4] {
        let time = median_s(&seen, BodyModelKind::EndEffector, 500, stride);
        println!("end-effector, 500 particles, {} points: {:.2} ms", 2000 / stride, 1.0e3 * time);
    }
    let mut criterion = Criterion::default().configure_from_args();
    criterion.bench_function("guided, 100 particles", |bencher| {
        bencher.iter(|| pass_s(&seen, BodyModelKind::Guided, 100, 1, 1));
    });
}
