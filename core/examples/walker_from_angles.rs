//! Pose, phase and cadence of a walker from noisy joint angles, through a gap of half a second.
//!
//!     cargo run --release -p sinew-core --features walking-model --example walker_from_angles

use sinew_core::cyclic::model::walking::WALKING;
use sinew_core::cyclic::{AngleMeasurement, ModelError};
use sinew_core::random::Stream;
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use sinew_core::tracker::cyclic::{CyclicFrameInput, CyclicTracker, CyclicTrackerOptions, FirstPhase};

const FRAMES: usize = 600;
/// Standard deviation of the measured angles, radians: six degrees.
const NOISE_STD_RAD: f32 = 0.105;
/// Frames without a measurement.
const GAP: core::ops::Range<usize> = 300..330;

fn main() -> Result<(), ModelError> {
    let model = WALKING.model()?;
    let step = model.mean_cycle_velocity();
    let true_pose_rad = |frame: usize| model.mean_pose_rad::<HUMAN_ANGLES>(model.point((frame as f32 * step).fract()));
    let measure = |frame: usize| -> CyclicFrameInput<HUMAN_ANGLES> {
        if GAP.contains(&frame) {
            return AngleMeasurement::nothing().into();
        }
        let mut stream = Stream::new(1, frame as u64, 0);
        let seen = true_pose_rad(frame).map(|angle| Some(angle + NOISE_STD_RAD * stream.normal()));
        AngleMeasurement::new(&seen, NOISE_STD_RAD).expect("a standard deviation above zero").into()
    };

    let (options, first) = (CyclicTrackerOptions::default(), FirstPhase::default());
    let mut tracker =
        CyclicTracker::<HUMAN_ANGLES>::new(&model, options, &measure(0), first).expect("a model of 13 angles");
    let (mut error_rad, mut cadence_per_min, mut cycles) = (0.0, 0.0, 0);
    for frame in 1..FRAMES {
        let answer = tracker.step(&model, &measure(frame));
        let truth_rad = true_pose_rad(frame);
        for (estimate, truth) in answer.estimate.angles_rad.iter().zip(truth_rad) {
            error_rad += (estimate - truth).abs() / (FRAMES * HUMAN_ANGLES) as f32;
        }
        (cadence_per_min, cycles) = (answer.cadence_per_min, answer.cycles_completed);
    }

    let error_deg = error_rad.to_degrees();
    let true_cadence_per_min = 60.0 * model.rate_hz() * step;
    println!("mean error of the angles: {error_deg:.2} degrees, measured with 6 degrees of noise");
    println!("cadence: {cadence_per_min:.1} per minute, in truth {true_cadence_per_min:.1}; {cycles} cycles");
    assert!(error_deg < 2.0);
    assert!((cadence_per_min - true_cadence_per_min).abs() < 1.0);
    Ok(())
}
