//! Rendered scenes with known truth: a person in front of a webcam whose arms perform an
//! [`ArmMotion`].
//!
//! A frame depends on options and number only, so frames can be rendered in any order and by many
//! threads. The same options give the same bytes in every build.

pub mod background;
pub mod body;
pub mod canvas;
pub mod export;
pub mod framing;
pub mod hand;
pub mod motion_source;
pub mod options;
pub mod palette;
pub mod schedule;
pub mod shape;
pub mod truth;

pub use motion_source::MotionSource;
pub use options::{BackgroundStyle, SceneOptions, Sides};
pub use truth::{FrameTruth, SideTruth};

use crate::motion::{ArmDirections, ArmMotion, ArmSide};
use body::{ArmJoints, Body, Clothes};
use canvas::{Canvas, Encoding, Light, Noise, Surface};
use hand::HandMotion;
use image::RgbImage;
use shape::Shape;
use sinew_core::camera::Camera;
use sinew_core::error::{ParameterError, Rule};
use sinew_core::math::{Vec3, unit};
use sinew_core::random::Stream;

/// Shortest and longest run of frames in which a hand is hidden.
const HIDDEN_RUN: [usize; 2] = [3, 10];
/// Shortest and longest run of frames in which the face shows.
const FACE_RUN: [usize; 2] = [15, 45];
/// Frames in which an arm goes behind the back, and comes back.
const AWAY_BLEND: usize = 5;
/// Half width and half height of the card that hides a hand, metres.
const CARD_HALF_M: [f32; 2] = [0.15, 0.17];

/// What the streams of a scene are for; each purpose has one of its own.
#[derive(Debug, Clone, Copy)]
enum Purpose {
    Person,
    Background,
    Light,
    Framing,
    Face,
    Hidden,
    Hand,
    NoiseTable,
    NoiseOfFrame,
}

/// Keeps scenes apart from trackers that run under the same seed.
const SEED_SALT: u64 = 0x51_4E_45_57_53_43_4E_45;

fn stream(seed: u64, purpose: Purpose, number: u64) -> Stream {
    Stream::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ SEED_SALT, number, purpose as u32)
}

/// How a hand is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hiding {
    Glove,
    Card,
}

/// One moving arm.
#[derive(Debug)]
struct MovingArm {
    side: ArmSide,
    poses: Vec<ArmDirections>,
    hand: HandMotion,
    hidden: Vec<Option<Hiding>>,
}

/// A scene: everything that all frames share.
#[derive(Debug)]
pub struct Scene {
    options: SceneOptions,
    camera: Camera,
    body: Body,
    clothes: Clothes,
    light: Light,
    encoding: Encoding,
    noise: Noise,
    arms: Vec<MovingArm>,
    face_shown: Vec<bool>,
    /// Background and trunk without and with the face.
    still: [Canvas; 2],
}

impl Scene {
    /// Builds the scene in which a person performs `motion`.
    ///
    /// # Errors
    /// An option that breaks a rule, by name.
    pub fn new(motion: &ArmMotion, options: &SceneOptions) -> Result<Self, ParameterError> {
        options.validate()?;
        let wrong_rate = |_| ParameterError::new("frames_per_second", Rule::Positive);
        let motion = motion.resampled(options.frames_per_second).map_err(wrong_rate)?;
        let motion = motion.with_length(options.frames).map_err(|_| ParameterError::new("frames", Rule::NotEmpty))?;
        let (seed, size_px) = (options.seed, [options.width_px, options.height_px]);
        let camera = Camera::from_field_of_view(size_px[0], size_px[1], options.field_of_view_rad)?;
        let sides = options.sides.list();
        let mut framing = stream(seed, Purpose::Framing, 0);
        let body = framing::place(&mut framing, &camera, size_px, options.body_height_m, &motion, &sides);
        let light = random_light(&mut stream(seed, Purpose::Light, 0));
        let encoding = Encoding::srgb();
        let mut backdrop = Canvas::new(size_px[0], size_px[1]);
        let mut random = stream(seed, Purpose::Background, 0);
        let wall = background::paint(&mut backdrop, &encoding, &light, options.background, &mut random);
        let clothes = random_clothes(&mut stream(seed, Purpose::Person, 0), &wall);
        let resting: Vec<ArmSide> =
            [ArmSide::Left, ArmSide::Right].into_iter().filter(|s| !sides.contains(s)).collect();
        let still = [false, true].map(|face_shown| {
            let mut canvas = backdrop.clone();
            for (shape, surface) in body::trunk(&body, &clothes, face_shown) {
                canvas.draw(&camera, &encoding, &light, &shape, &surface);
            }
            for &side in &resting {
                for (shape, surface) in body::sleeve(&body, &body.arm(side, &body::hanging(side)), &clothes) {
                    canvas.draw(&camera, &encoding, &light, &shape, &surface);
                }
            }
            canvas
        });
        let frames = options.frames;
        let mut faces = stream(seed, Purpose::Face, 0);
        let face_shown = schedule::runs(&mut faces, frames, options.false_blob_fraction, FACE_RUN[0], FACE_RUN[1]);
        let row_length = 3 * size_px[0] as usize;
        let noise = Noise::new(&mut stream(seed, Purpose::NoiseTable, 0), options.noise_std, row_length);
        let arms = sides.into_iter().map(|side| MovingArm::new(options, side, &motion)).collect();
        let options = options.clone();
        Ok(Self { options, camera, body, clothes, light, encoding, noise, arms, face_shown, still })
    }

    /// Number of frames.
    #[must_use]
    #[allow(clippy::len_without_is_empty)] // never empty
    pub fn len(&self) -> usize {
        self.face_shown.len()
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// The person's lengths and place.
    #[must_use]
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The options that the scene was made with.
    #[must_use]
    pub fn options(&self) -> &SceneOptions {
        &self.options
    }

    /// The picture of one frame; frames beyond the last show the last.
    #[must_use]
    pub fn render(&self, frame: usize) -> RgbImage {
        let frame = frame.min(self.len() - 1);
        let canvas = self.drawn(frame);
        canvas.developed(&self.noise, &mut stream(self.options.seed, Purpose::NoiseOfFrame, frame as u64))
    }

    /// The truth of one frame; frames beyond the last have that of the last.
    #[must_use]
    pub fn truth(&self, frame: usize) -> FrameTruth {
        let frame = frame.min(self.len() - 1);
        let sides = self.arms.iter().map(|arm| SideTruth {
            side: arm.side,
            joints: self.joints(arm, frame),
            hand_visible: self.sees_hand(arm, frame),
        });
        FrameTruth { frame, time_s: self.time_s(frame), false_blob: self.face_shown[frame], sides: sides.collect() }
    }

    fn time_s(&self, frame: usize) -> f32 {
        frame as f32 / self.options.frames_per_second
    }

    fn joints(&self, arm: &MovingArm, frame: usize) -> ArmJoints {
        self.body.arm(arm.side, &arm.poses[frame])
    }

    fn is_away(&self, frame: usize) -> bool {
        self.options.away.as_ref().is_some_and(|range| range.contains(&frame))
    }

    fn hand_shapes(&self, arm: &MovingArm, frame: usize) -> Vec<Shape> {
        hand::shapes(&self.body, arm.side, &self.joints(arm, frame), &arm.hand.at(self.time_s(frame)))
    }

    fn drawn(&self, frame: usize) -> Canvas {
        let mut canvas = self.still[usize::from(self.face_shown[frame])].clone();
        let mut draw = |shape: &Shape, surface: &Surface| {
            canvas.draw(&self.camera, &self.encoding, &self.light, shape, surface);
        };
        for arm in &self.arms {
            let joints = self.joints(arm, frame);
            for (shape, surface) in body::sleeve(&self.body, &joints, &self.clothes) {
                draw(&shape, &surface);
            }
            let bare = arm.hidden[frame] != Some(Hiding::Glove) && !self.is_away(frame);
            let surface = Surface::Plain(if bare { self.clothes.skin } else { self.clothes.glove });
            for shape in self.hand_shapes(arm, frame) {
                draw(&shape, &surface);
            }
            if arm.hidden[frame] == Some(Hiding::Card) {
                draw(&card(&joints), &Surface::Plain(self.clothes.glove));
            }
        }
        canvas
    }

    /// Whether at least half of the hand's parts are in the image with nothing before them.
    fn sees_hand(&self, arm: &MovingArm, frame: usize) -> bool {
        if arm.hidden[frame].is_some() || self.is_away(frame) {
            return false;
        }
        let still = &self.still[usize::from(self.face_shown[frame])];
        let others: Vec<Shape> = self.arms.iter().flat_map(|other| self.occluders(other, arm.side, frame)).collect();
        let others: Vec<_> = others.iter().map(Shape::prepare).collect();
        let shapes = self.hand_shapes(arm, frame);
        let seen = shapes.iter().filter(|shape| {
            let (middle, radius) = shape.bounding_ball();
            let Some(pixel) = self.camera.project(&middle) else { return false };
            let direction = middle / middle.z;
            let nearest = middle.z - radius;
            !still.hides(pixel, nearest)
                && !others.iter().any(|other| other.hit(&direction).is_some_and(|hit| hit.depth_m < nearest))
        });
        2 * seen.count() >= shapes.len()
    }

    /// What of the arm `other` may hide the hand of `side`.
    fn occluders(&self, other: &MovingArm, side: ArmSide, frame: usize) -> Vec<Shape> {
        let joints = self.joints(other, frame);
        let mut shapes = body::sleeve(&self.body, &joints, &self.clothes).map(|(shape, _)| shape).to_vec();
        if other.side != side {
            shapes.extend(self.hand_shapes(other, frame));
            shapes.extend((other.hidden[frame] == Some(Hiding::Card)).then(|| card(&joints)));
        }
        shapes
    }
}

impl MovingArm {
    fn new(options: &SceneOptions, side: ArmSide, motion: &ArmMotion) -> Self {
        let number = u64::from(side == ArmSide::Right);
        let mut poses = motion.side(side).to_vec();
        if let Some(away) = &options.away {
            let behind = body::behind_the_back(side);
            for (frame, pose) in poses.iter_mut().enumerate().take(away.end).skip(away.start) {
                let steps = (frame - away.start + 1).min(away.end - frame).min(AWAY_BLEND);
                *pose = pose.towards(&behind, steps as f32 / AWAY_BLEND as f32);
            }
        }
        let mut random = stream(options.seed, Purpose::Hidden, number);
        let marks = schedule::runs(&mut random, options.frames, options.hidden_fraction, HIDDEN_RUN[0], HIDDEN_RUN[1]);
        let mut hiding = None;
        let hidden = marks.into_iter().map(|marked| {
            hiding = match (marked, hiding) {
                (false, _) => None,
                (true, Some(way)) => Some(way),
                (true, None) => Some(if random.below(2) == 0 { Hiding::Glove } else { Hiding::Card }),
            };
            hiding
        });
        let hidden = hidden.collect();
        Self { side, poses, hand: HandMotion::new(&mut stream(options.seed, Purpose::Hand, number)), hidden }
    }
}

/// The card before a hand.
fn card(joints: &ArmJoints) -> Shape {
    let hand = joints.hand_m;
    // Nearer to the camera on the hand's own line of sight, so that it covers the hand from
    // everywhere in the image.
    Shape::Card { centre: hand * ((hand.z - 0.13).max(0.1) / hand.z), half: CARD_HALF_M }
}

fn random_light(stream: &mut Stream) -> Light {
    let towards =
        Vec3::new(1.6 * (stream.uniform() - 0.5), -0.4 - 0.8 * stream.uniform(), -0.8 - 0.4 * stream.uniform());
    let exposure = 0.75 + 0.5 * stream.uniform();
    let ambient = 0.4 + 0.25 * stream.uniform();
    Light { direction: unit(towards).unwrap_or(-Vec3::z()), colour: palette::light(stream) * exposure, ambient }
}

fn random_clothes(stream: &mut Stream, wall: &palette::Rgb) -> Clothes {
    let skin = palette::skin(stream);
    let hair = palette::hair(stream);
    let shirt = palette::garment(stream, &[*wall]);
    let sleeve = palette::garment(stream, &[*wall, shirt]);
    let mut folded = |colour, folds: f32| Surface::Folded {
        colour,
        folds: folds * (0.7 + 0.6 * stream.uniform()),
        depth: 0.06 + 0.10 * stream.uniform(),
        phase_rad: core::f32::consts::TAU * stream.uniform(),
    };
    let (shirt, sleeve) = (folded(shirt, 1.5), folded(sleeve, 12.0));
    let hood = palette::garment(stream, &[*wall]);
    let glove = palette::garment(stream, &[*wall]);
    Clothes { skin, hair, shirt, sleeve, hood, glove }
}

#[cfg(test)]
mod tests;
