//! One arm from the blob of its hand: 50 particles, a made-up wave, two frames without an image.
//!
//!     cargo run --release -p sinew-core --example arm_from_blobs

use core::f32::consts::TAU;
use sinew_core::camera::Camera;
use sinew_core::error::ParameterError;
use sinew_core::math::{Vec3, sin_cos};
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::options::AreaCue;
use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker, Status};
use sinew_core::vision::candidate::HandCandidate;

const FRAMES: u32 = 90;
const RATE_HZ: f32 = 15.0;
/// Time from one frame to the next, microseconds.
const FRAME_US: u64 = 66_667;
/// The shoulder in camera axes: x right, y down, z forward, metres.
const SHOULDER_M: Vec3 = Vec3::new(0.2, -0.1, 1.2);

/// Elbow and hand of a slow wave of all four joints, metres.
fn true_elbow_and_hand_m(model: &ArmModel, frame: u32) -> (Vec3, Vec3) {
    let time_s = frame as f32 / RATE_HZ;
    let wave =
        |middle_rad: f32, swing_rad: f32, period_s: f32| middle_rad + swing_rad * sin_cos(TAU * time_s / period_s).0;
    let angles_rad = [wave(0.9, 0.5, 3.1), wave(0.3, 0.4, 4.3), wave(0.4, 0.4, 3.7), wave(1.3, 0.5, 2.7)];
    model.elbow_and_hand(&SHOULDER_M, &angles_rad)
}

/// The hand as a blob: twice as long as wide, its area by its distance and the forearm's direction.
fn look(camera: &Camera, cue: &AreaCue, elbow_m: Vec3, hand_m: Vec3) -> HandCandidate {
    let pointing = (hand_m - elbow_m).normalize().dot(&hand_m.normalize());
    let scale_px_per_m = camera.focal_px() / hand_m.z;
    let area_px = cue.expected_area_m2(pointing) * scale_px_per_m * scale_px_per_m;
    let shape = HandCandidate { moments_px2: [400.0, 0.0, 100.0], ..HandCandidate::default() };
    let size = area_px / shape.length_weighted_area_px(cue.length_share);
    HandCandidate {
        centre: camera.project(&hand_m).expect("the hand is in front of the camera"),
        moments_px2: shape.moments_px2.map(|moment| moment * size),
        area_px,
        likelihood: 0.8,
    }
}

fn main() -> Result<(), ParameterError> {
    // What stays the same: a webcam of 60 degrees and the left arm, 0.30 m and 0.35 m long.
    let camera = Camera::from_field_of_view(640, 480, 1.05)?;
    let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
    let options = ArmOptions::default();
    let cue = options.area_cue.expect("the default uses the blob's area");
    let model = ArmModel::new(camera, (640, 480), arm, options)?;
    // What changes: the tracker.
    let mut tracker = ArmTracker::<50>::new(&model, SHOULDER_M, 1)?;

    let (mut error_px, mut error_m, mut scored) = (0.0, 0.0, 0.0);
    for frame in 0..FRAMES {
        let (elbow_m, hand_m) = true_elbow_and_hand_m(&model, frame);
        let blobs = [look(&camera, &cue, elbow_m, hand_m)];
        let is_missing = frame == 40 || frame == 41;
        let image = (!is_missing).then_some(ArmImage { candidates: &blobs, edges: &[] });
        let input = ArmFrame { timestamp_us: u64::from(frame) * FRAME_US, image, shoulder_m: SHOULDER_M };
        let estimate = tracker.step(&model, &input);

        // A missing image is an ordinary input: the answer is a prediction, and says so.
        assert_eq!(estimate.status, if is_missing { Status::Predicted } else { Status::Tracking });
        if frame >= 15 {
            let estimated_px = camera.project(&estimate.joints.hand_m).expect("in front of the camera");
            error_px += estimated_px.distance_px(blobs[0].centre);
            error_m += (estimate.joints.hand_m - hand_m).norm();
            scored += 1.0;
        }
    }
    let (error_px, error_m) = (error_px / scored, error_m / scored);
    println!("mean error of the hand after the first second: {error_px:.1} px in the image, {error_m:.3} m in space");
    assert!(error_px < 5.0 && error_m < 0.1, "{error_px} px, {error_m} m");
    Ok(())
}
