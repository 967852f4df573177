//! One step of the arm tracker on rendered frames: with the edges of both limbs (dynamic Hough
//! transforms of every hypothesis) and without, by variant. Prints medians over all frames, then
//! runs criterion on the default.

use criterion::Criterion;
use sinew::config::Config;
use sinew::frames::FrameView;
use sinew::scene::SceneOptions;
use sinew::skin::SkinModel;
use sinew::track::ArmSet;
use sinew_core::tracker::arm::Variant;
use sinew_lab::clips;
use sinew_lab::observed::{ObservedScene, observe};
use std::hint::black_box;
use std::time::Instant;

/// Passes over the scene.
const PASSES: u64 = 9;

fn scene() -> ObservedScene {
    let skin = SkinModel::from_option("gaussian").expect("a shipped model");
    let options = SceneOptions { frames: 150, ..SceneOptions::default() };
    observe(&clips::builtin(1)[0], &options, &Config::default(), &skin).expect("a built-in scene")
}

/// The scene without moving edges: no Hough transform is run.
fn without_edges(scene: &ObservedScene) -> ObservedScene {
    let still = |view: &FrameView| FrameView { edges: Vec::new(), ..view.clone() };
    ObservedScene { views: scene.views.iter().map(still).collect(), ..scene.clone() }
}

/// Microseconds of each step of one pass.
fn pass_us(scene: &ObservedScene, variant: Variant, seed: u64) -> Vec<f64> {
    let mut config = scene.config.clone();
    config.tracker.variant = variant;
    let mut arms = ArmSet::new(&config, scene.size_px, scene.side, seed).expect("a usable configuration");
    let step = |(frame, view): (usize, &FrameView)| {
        let start = Instant::now();
        black_box(arms.step(frame as u64 * scene.frame_us, Some(view)));
        start.elapsed().as_secs_f64() * 1.0e6
    };
    scene.views.iter().enumerate().map(step).collect()
}

fn median_us(scene: &ObservedScene, variant: Variant) -> f64 {
    let mut times: Vec<f64> = (1..=PASSES).flat_map(|seed| pass_us(scene, variant, seed)).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() {
    let (moving, still) = (scene(), without_edges(&scene()));
    println!("one step, 50 particles, median microseconds: {:>14} {:>14}", "without Hough", "with Hough");
    for variant in Variant::ALL {
        let name = format!("{variant:?}");
        println!("{name:<45}{:>14.1} {:>14.1}", median_us(&still, variant), median_us(&moving, variant));
    }
    let mut criterion = Criterion::default().configure_from_args();
    for (name, scene) in [("pass without Hough", &still), ("pass with Hough", &moving)] {
        criterion.bench_function(name, |bencher| bencher.iter(|| pass_us(scene, Variant::Pik, 1)));
    }
    criterion.final_summary();
}
