//! As firmware places it: the tracker in static memory, begun in place, and no heap.
//!
//!     cargo run --release -p sinew-core --example static_placement
//!
//! `firmware-sim/` has the same for an emulated Cortex-M4F.

use core::mem::size_of;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::error::ParameterError;
use sinew_core::math::Vec3;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::{ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker, Status};
use sinew_core::vision::candidate::HandCandidate;
use static_cell::{ConstStaticCell, StaticCell};

/// Time from one frame to the next, microseconds.
const FRAME_US: u64 = 66_667;
const SHOULDER_M: Vec3 = Vec3::new(0.2, -0.1, 1.2);

/// An empty tracker is all zero, so it lies in `.bss` and takes no flash.
static TRACKER: ConstStaticCell<ArmTracker<50>> = ConstStaticCell::new(ArmTracker::empty());
/// The model is computed once, from the camera and the arm.
static MODEL: StaticCell<ArmModel> = StaticCell::new();

/// What firmware keeps in its main loop: two references.
struct App {
    model: &'static ArmModel,
    tracker: &'static mut ArmTracker<50>,
}

impl App {
    fn begin() -> Result<Self, ParameterError> {
        let camera = Camera::from_field_of_view(320, 240, 1.05)?;
        let arm = ArmGeometry::new(Side::Right, 0.30, 0.35)?;
        let model = MODEL.init(ArmModel::new(camera, (320, 240), arm, ArmOptions::default())?);
        let tracker = TRACKER.take();
        tracker.begin(model, SHOULDER_M, 1)?;
        Ok(Self { model, tracker })
    }

    fn frame(&mut self, frame: u32, blobs: &[HandCandidate]) -> ArmEstimate {
        let image = Some(ArmImage { candidates: blobs, edges: &[] });
        let timestamp_us = u64::from(frame) * FRAME_US;
        self.tracker.step(self.model, &ArmFrame { timestamp_us, image, shoulder_m: SHOULDER_M })
    }
}

fn main() -> Result<(), ParameterError> {
    let mut app = App::begin()?;
    let mut distance_px = f32::INFINITY;
    for frame in 0..30_u8 {
        let seen = Pixel::new(150.0 - f32::from(frame), 130.0);
        let blob = HandCandidate { centre: seen, moments_px2: [100.0, 0.0, 100.0], area_px: 1175.0, likelihood: 0.8 };
        let estimate = app.frame(u32::from(frame), &[blob]);
        assert_eq!(estimate.status, Status::Tracking);
        let hand_px = app.model.camera().project(&estimate.joints.hand_m).expect("in front of the camera");
        distance_px = hand_px.distance_px(seen);
    }
    let bytes = size_of::<ArmTracker<50>>() + size_of::<ArmModel>();
    println!(
        "static memory of tracker and model: {bytes} bytes; on the stack between frames: {} bytes",
        size_of::<App>()
    );
    println!("the hand is {distance_px:.1} px from its blob");
    assert!(bytes < 16 * 1024, "{bytes} bytes");
    assert!(distance_px < 15.0, "{distance_px} px");
    Ok(())
}
