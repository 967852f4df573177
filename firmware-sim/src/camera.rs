//! A synthetic camera: a person who faces it, delivered line by line.

use core::f32::consts::TAU;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::error::ParameterError;
use sinew_core::math::{Vec3, sin_cos};
use sinew_core::observation::limbs::distance_to_segment_px;
use sinew_core::random::Stream;
use sinew_core::tracker::arm::ArmModel;

/// Width of the image, pixels.
pub const WIDTH: usize = 160;
/// Height of the image, pixels.
pub const HEIGHT: usize = 120;
/// Bytes of one line of interleaved RGB.
pub const LINE_BYTES: usize = 3 * WIDTH;
/// Time between two frames, microseconds.
pub const FRAME_US: u64 = 66_667;
/// The person's left shoulder, metres in camera axes.
pub const SHOULDER_M: Vec3 = Vec3::new(0.19, -0.05, 1.25);

/// Middle of the face, metres: skin that is not a hand.
const FACE_M: Vec3 = Vec3::new(0.0, -0.28, 1.25);
const FACE_RADIUS_M: f32 = 0.085;
const HAND_RADIUS_M: f32 = 0.062;
const SLEEVE_RADIUS_M: f32 = 0.045;
/// Frames in which the hand is hidden.
const HIDDEN: core::ops::Range<u64> = 30..36;
/// A frame that the camera fails to deliver.
const MISSING: u64 = 48;

const SKIN: [u8; 3] = [200, 140, 103];
const SLEEVE: [u8; 3] = [45, 60, 105];
const WALL: [u8; 3] = [95, 108, 100];

/// A disc in the image.
#[derive(Debug, Clone, Copy)]
struct Disc {
    centre: Pixel,
    radius_px: f32,
}

impl Disc {
    /// Image of a sphere.
    fn of(camera: &Camera, centre_m: &Vec3, radius_m: f32) -> Option<Self> {
        let centre = camera.project(centre_m)?;
        Some(Self { centre, radius_px: radius_m * camera.focal_px() / centre_m.z })
    }

    fn holds(&self, pixel: Pixel) -> bool {
        self.centre.distance_px(pixel) <= self.radius_px
    }
}

/// What one frame shows.
#[derive(Debug, Clone, Copy)]
pub struct Scene {
    /// The true hand, metres.
    pub hand_m: Vec3,
    frame: u64,
    shoulder: Pixel,
    elbow: Pixel,
    wrist: Pixel,
    sleeve_px: f32,
    hand: Option<Disc>,
    face: Option<Disc>,
}

/// Renders scenes of a moving arm from a seed.
#[derive(Debug, Clone, Copy)]
pub struct SyntheticCamera {
    camera: Camera,
    seed: u64,
}

impl SyntheticCamera {
    /// A camera of 60 degrees.
    ///
    /// # Errors
    /// None with the constants of this file.
    pub fn new(seed: u64) -> Result<Self, ParameterError> {
        Ok(Self { camera: Camera::from_field_of_view(WIDTH as u32, HEIGHT as u32, TAU / 6.0)?, seed })
    }

    /// The camera's geometry.
    #[must_use]
    pub fn geometry(&self) -> Camera {
        self.camera
    }

    /// The scene of `frame`; `None` where the camera fails.
    #[must_use]
    pub fn scene(&self, model: &ArmModel, frame: u64) -> Option<Scene> {
        if frame == MISSING {
            return None;
        }
        let mut stream = Stream::new(self.seed, 0, 0);
        let mut wave = |middle: f32, swing: f32| {
            let (period, start) = (35.0 + 25.0 * stream.uniform(), TAU * stream.uniform());
            middle + swing * sin_cos(start + TAU * frame as f32 / period).0
        };
        let angles_rad = [wave(0.8, 0.3), wave(0.2, 0.3), wave(0.4, 0.4), wave(1.4, 0.4)];
        let (elbow_m, hand_m) = model.elbow_and_hand(&SHOULDER_M, &angles_rad);
        let wrist_m = hand_m + (elbow_m - hand_m) * 0.2;
        Some(Scene {
            hand_m,
            frame,
            shoulder: self.camera.project(&SHOULDER_M)?,
            elbow: self.camera.project(&elbow_m)?,
            wrist: self.camera.project(&wrist_m)?,
            sleeve_px: SLEEVE_RADIUS_M * self.camera.focal_px() / elbow_m.z,
            hand: Disc::of(&self.camera, &hand_m, HAND_RADIUS_M).filter(|_| !HIDDEN.contains(&frame)),
            face: Disc::of(&self.camera, &FACE_M, FACE_RADIUS_M),
        })
    }

    /// Writes line `v` of `scene` as interleaved RGB, with a sensor's noise.
    pub fn line(&self, scene: &Scene, v: usize, rgb: &mut [u8; LINE_BYTES]) {
        let mut noise = Stream::new(self.seed, 1 + scene.frame, v as u32);
        for (u, pixel) in rgb.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            let colour = scene.colour(Pixel::new(u as f32, v as f32));
            let bits = noise.bits();
            for (channel, (out, value)) in pixel.iter_mut().zip(colour).enumerate() {
                *out = value + (bits >> (8 * channel) & 7) as u8;
            }
        }
    }
}

impl Scene {
    /// Colour at `pixel`; what lies in front comes first.
    fn colour(&self, pixel: Pixel) -> [u8; 3] {
        let skin = |disc: &Option<Disc>| disc.is_some_and(|disc| disc.holds(pixel));
        let sleeve = |a: Pixel, b: Pixel| distance_to_segment_px(pixel, a, b) <= self.sleeve_px;
        if skin(&self.hand) {
            SKIN
        } else if sleeve(self.shoulder, self.elbow) || sleeve(self.elbow, self.wrist) {
            SLEEVE
        } else if skin(&self.face) {
            SKIN
        } else {
            WALL
        }
    }
}
