//! One step of the body tracker on the built-in scene with a stick. The scene has 2000 points, a
//! whole body 16 capsules, an upper body 8. Prints frames a second with all threads by model and
//! number of particles, and the time relative to the angular model. Also prints how the time grows
//! with points, particles and bones. `RAYON_NUM_THREADS=1` for one thread.

use criterion::Criterion;
use sinew::body::BodyPart;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew_core::pik::processes::stick::StickSight;
use sinew_lab::body::MotionChoice;
use sinew_lab::body::trial::SeenMotion;
use std::hint::black_box;
use std::time::Instant;

/// Frames of a pass.
const FRAMES: usize = 60;
/// Passes; prints the median time of a frame over all.
const PASSES: u64 = 3;

/// Seconds of each step of one pass with what is done to its points before, every `stride`-th of
/// them kept.
fn pass_s(
    seen: &SeenMotion,
    kind: BodyModelKind,
    tuning: BodyTuning,
    particles: usize,
    stride: usize,
    seed: u64,
) -> Vec<f64> {
    let who = (&seen.measures, seen.first_rad);
    let mut filter = BodyFilter::of_part(seen.part, kind, tuning, who, particles, seed).expect("usable numbers");
    let step = |(frame, points_m): (usize, &Vec<_>)| {
        let mut kept: Vec<_> = points_m.iter().step_by(stride).copied().collect();
        let stick = seen.stick.get(frame).copied().unwrap_or(StickSight::Unseen);
        let start = Instant::now();
        let blocks = filter.blocks(&mut kept);
        black_box(filter.step(&blocks, 1.0 / seen.rate_hz, stick));
        start.elapsed().as_secs_f64()
    };
    seen.clouds_m.iter().enumerate().skip(1).take(FRAMES).map(step).collect()
}

fn median_s(seen: &SeenMotion, kind: BodyModelKind, particles: usize, stride: usize) -> f64 {
    let mut times: Vec<f64> =
        (1..=PASSES).flat_map(|seed| pass_s(seen, kind, BodyTuning::default(), particles, stride, seed)).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Models against each other.
fn print_models(seen: &SeenMotion) {
    let part = seen.part.name();
    println!(
        "{:6} {:16} {:>9} {:>12} {:>10} {:>14}",
        "body", "model", "particles", "milliseconds", "frames/s", "over angular"
    );
    for particles in [100, 500] {
        let angular = median_s(seen, BodyModelKind::Angular, particles, 1);
        for kind in [BodyModelKind::Angular, BodyModelKind::EndEffector, BodyModelKind::Stick, BodyModelKind::Guided] {
            let time = median_s(seen, kind, particles, 1);
            let (name, ratio) = (kind.name(), time / angular);
            println!("{part:6} {name:16} {particles:>9} {:>12.2} {:>10.1} {ratio:>14.2}", 1.0e3 * time, 1.0 / time);
        }
    }
}

/// Milliseconds of end-effector by points (columns) and particles (rows).
fn print_growth(seen: &SeenMotion) {
    let strides = [1, 2, 4, 8];
    print!("{:6} {:>9}", seen.part.name(), "particles");
    for stride in strides {
        print!(" {:>9} points", 2000 / stride);
    }
    for particles in [125, 250, 500, 1000] {
        print!("\n{:6} {particles:>9}", "");
        for stride in strides {
            print!(" {:>16.2}", 1.0e3 * median_s(seen, BodyModelKind::EndEffector, particles, stride));
        }
    }
    println!();
}

/// What one core does with few guided particles: the arithmetic of a smaller machine begins there.
fn print_one_thread(seen: &SeenMotion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (particles, stride) in [(25, 1), (25, 4), (50, 4)] {
        let time = pool.install(|| median_s(seen, BodyModelKind::Guided, particles, stride));
        let (part, points) = (seen.part.name(), 2000 / stride);
        println!("{part:6} one thread, guided, {particles} particles, {points} points: {:.2} ms", 1.0e3 * time);
    }
}

/// What limbs that may not pass through one another cost.
fn print_self_penetration(seen: &SeenMotion) {
    let without = BodyTuning { self_penetration_std_m: 0.0, ..BodyTuning::default() };
    for kind in [BodyModelKind::EndEffector, BodyModelKind::Guided] {
        let mut times = [Vec::new(), Vec::new()];
        for seed in 1..=PASSES {
            for (times, tuning) in times.iter_mut().zip([without, BodyTuning::default()]) {
                times.extend(pass_s(seen, kind, tuning, 500, 1, seed));
            }
        }
        let [without, with] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            1.0e3 * times[times.len() / 2]
        });
        println!("{:16} 500 particles: {without:.2} ms, with self-penetration {with:.2} ms", kind.name());
    }
}

fn main() {
    let read = MotionChoice::StickWave.read(None).expect("a built-in motion");
    let [whole, upper] = [BodyPart::Whole, BodyPart::Upper].map(|part| read.seen(part, 1).expect("a built-in scene"));
    if !std::env::args().any(|argument| argument == "--test") {
        println!("{} threads, 2000 points, median of a step", rayon::current_num_threads());
        [&whole, &upper].into_iter().for_each(print_models);
        [&whole, &upper].into_iter().for_each(print_growth);
        [&whole, &upper].into_iter().for_each(print_one_thread);
        print_self_penetration(&whole);
    }
    let mut criterion = Criterion::default().configure_from_args();
    criterion.bench_function("guided, 100 particles", |bencher| {
        bencher.iter(|| pass_s(&whole, BodyModelKind::Guided, BodyTuning::default(), 100, 1, 1));
    });
}
