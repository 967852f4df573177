//! One arm from the blob of its hand: 50 particles, a made-up reach, and two frames without an image.
//!
//!     cargo run --release -p sinew-core --example arm_from_blobs

use sinew_core::camera::Camera;
use sinew_core::error::ParameterError;
use sinew_core::math::{Vec3, sin_cos};
use sinew_core::observation::candidate::HandCandidate;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker, Status};

const FRAMES: u32 = 90;
const RATE_HZ: f32 = 15.0;
/// Time from one frame to the next, microseconds.
const FRAME_US: u64 = 66_667;
/// The shoulder in camera axes: x right, y down, z forward, metres.
const SHOULDER_M: Vec3 = Vec3::new(0.2, -0.1, 1.2);
/// Area of a hand, square metres.
const HAND_M2: f32 = 0.0194;

/// The hand of a slow reach to the side and back, metres.
fn true_hand_m(frame: u32) -> Vec3 {
    let (sine, cosine) = sin_cos(0.8 * frame as f32 / RATE_HZ);
    SHOULDER_M + Vec3::new(0.2 * sine, 0.15 + 0.1 * cosine, -0.4)
}

fn main() -> Result<(), ParameterError> {
    // What stays the same: a webcam of 60 degrees and the person's left arm, 0.30 m and 0.35 m long.
    let camera = Camera::from_field_of_view(640, 480, 1.05)?;
    let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
    let model = ArmModel::new(camera, (640, 480), arm, ArmOptions::default())?;
    // What changes: the tracker.
    let mut tracker = ArmTracker::<50>::new(&model, SHOULDER_M, 1)?;

    let (mut error_px, mut error_m, mut scored) = (0.0, 0.0, 0.0);
    for frame in 0..FRAMES {
        let hand_m = true_hand_m(frame);
        let hand_px = camera.project(&hand_m).expect("the hand is in front of the camera");
        let scale = camera.focal_px() / hand_m.z;
        let area_px = HAND_M2 * scale * scale;
        let variance_px2 = area_px / 12.0;
        let blobs = [HandCandidate {
            centre: hand_px,
            moments_px2: [variance_px2, 0.0, variance_px2],
            area_px,
            likelihood: 0.8,
        }];
        let is_missing = frame == 40 || frame == 41;
        let image = (!is_missing).then_some(ArmImage { candidates: &blobs, edges: &[] });
        let input = ArmFrame { timestamp_us: u64::from(frame) * FRAME_US, image, shoulder_m: SHOULDER_M };
        let estimate = tracker.step(&model, &input);

        // A missing image is an ordinary input: the answer is a prediction, and says so.
        assert_eq!(estimate.status, if is_missing { Status::Predicted } else { Status::Tracking });
        if frame >= 15 {
            let estimated_px = camera.project(&estimate.joints.hand_m).expect("in front of the camera");
            error_px += estimated_px.distance_px(hand_px);
            error_m += (estimate.joints.hand_m - hand_m).norm();
            scored += 1.0;
        }
    }
    let (error_px, error_m) = (error_px / scored, error_m / scored);
    println!(
        "mean error of the hand from the second second on: {error_px:.1} px in the image, {error_m:.3} m in space"
    );
    assert!(error_px < 15.0 && error_m < 0.15, "{error_px} px, {error_m} m");
    Ok(())
}
