//! Segmentation, morphology, components with features and temporal edges: this crate against
//! imageproc.
//!
//! Prints a table of medians, measured in turns in this process on one thread. Then runs criterion
//! on the whole chain of each. The chain of imageproc is what its functions offer for the same
//! steps, with its distance transform on the whole frame. It gives labels but no statistics of
//! components. `SINEW_BENCH_FRAMES=first.png,second.png` adds a pair of real frames.

mod imageproc_chain;
mod scene;
mod sinew_chain;

use criterion::Criterion;
use imageproc_chain::ImageprocChain;
use scene::FramePair;
use sinew_chain::SinewChain;
use std::hint::black_box;
use std::time::Instant;

/// Repetitions of which the median is taken.
const ROUNDS: usize = 41;

/// Median duration of each step over [`ROUNDS`] calls, milliseconds.
fn medians_ms<const N: usize>(mut steps: impl FnMut() -> [f64; N]) -> [f64; N] {
    let rounds: Vec<[f64; N]> = (0..ROUNDS).map(|_| steps()).collect();
    std::array::from_fn(|step| {
        let mut times: Vec<f64> = rounds.iter().map(|round| round[step]).collect();
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2] * 1.0e3
    })
}

/// Seconds that `work` takes.
fn timed<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

fn print_table(pair: &FramePair) {
    let (mut ours, mut theirs) = (SinewChain::new(pair), ImageprocChain::new(pair));
    // In turns, so that both see the same state of the machine.
    let both: [f64; 10] = medians_ms(|| {
        let (a, b) = (ours.steps(pair), theirs.steps(pair));
        std::array::from_fn(|i| if i < 5 { a[i] } else { b[i - 5] })
    });
    println!(
        "\n{} ({}x{}), {} blobs, {} edge pixels",
        pair.name,
        pair.width,
        pair.height,
        ours.blob_count(),
        ours.edge_count()
    );
    println!("{:<38}{:>11}{:>14}{:>8}", "step", "sinew ms", "imageproc ms", "ratio");
    let names = [
        "segmentation",
        "opening and closing",
        "components, features, distances",
        "luminance and temporal edges",
        "all",
    ];
    for (i, name) in names.iter().enumerate() {
        println!("{name:<38}{:>11.3}{:>14.3}{:>8.1}", both[i], both[i + 5], both[i + 5] / both[i]);
    }
}

fn main() {
    let mut pairs = vec![FramePair::rendered(640, 480), FramePair::rendered(320, 240)];
    if let Ok(names) = std::env::var("SINEW_BENCH_FRAMES") {
        pairs.push(
            FramePair::read(&names).expect("SINEW_BENCH_FRAMES is two image files of one size, with a comma between"),
        );
    }
    if !std::env::args().any(|argument| argument == "--test") {
        pairs.iter().for_each(print_table);
    }
    let mut criterion = Criterion::default().sample_size(20).configure_from_args();
    for pair in &pairs {
        let mut group = criterion.benchmark_group(format!("{} {}x{}", pair.name, pair.width, pair.height));
        let mut ours = SinewChain::new(pair);
        group.bench_function("sinew", |bencher| bencher.iter(|| ours.whole(pair)));
        let mut theirs = ImageprocChain::new(pair);
        group.bench_function("imageproc", |bencher| bencher.iter(|| theirs.whole(pair)));
    }
    criterion.final_summary();
}
