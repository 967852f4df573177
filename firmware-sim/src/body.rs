//! The image `body`: a person who waves before a depth camera, 500 points a frame, the pose of the
//! upper body out. The clouds are simulated on the board, the same on every machine.

use crate::port::{Part, Port, counted, put};
use sinew_core::error::ParameterError;
use sinew_core::math::Vec3;
use sinew_core::observation::body_surface::BodySurface;
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::pik::motion::BodyScene;
use sinew_core::random::Stream;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::upper_body::{UPPER_ANGLES, UPPER_BONES, upper_body, upper_radii_m};
use sinew_core::slot::Slot;
use sinew_core::tracker::body::upper::{DEFAULT_UPPER_OPTIONS, UpperBodyTracker};
use sinew_record::{BodyResult, Cost, End, Failure, RecordError};
use static_cell::ConstStaticCell;

/// Points of a frame.
pub const POINTS: usize = 500;
/// Frames: four seconds.
pub const FRAMES: u32 = 60;
/// Time between two frames, seconds.
pub const DT_S: f32 = 1.0 / 15.0;
/// Frames in which the right forearm shows no points.
const HIDDEN: core::ops::Range<u32> = 30..36;
/// A frame without any point.
const DARK: u32 = 45;
/// Standard deviation of a point along its line of sight, metres: that of a depth camera at 2 m.
const RANGE_STD_M: f32 = 0.01;
/// Bone of the right forearm.
const RIGHT_FOREARM: usize = sinew_core::skeleton::full_body::FOREARMS[1];

/// The person's pose in a frame: sways, looks about and waves with both arms.
#[must_use]
pub fn true_pose_rad(frame: u32) -> [f32; UPPER_ANGLES] {
    let wave = |per_s: f32, phase: f32| {
        let (sine, _) = sinew_core::math::sin_cos(core::f32::consts::TAU * per_s * DT_S * frame as f32 + phase);
        sine
    };
    let mut pose = [0.0; UPPER_ANGLES];
    (pose[0], pose[2]) = (0.05 * wave(0.25, 0.0), 2.0);
    pose[6] = 0.1 * wave(0.3, 0.0);
    for (first, phase) in [(9, 0.0), (13, 1.5)] {
        pose[first] = 0.7 - 0.5 * wave(0.25, 1.57) + 0.2 * wave(0.6, phase) - 0.2 * wave(0.0, phase);
        pose[first + 1] = 0.2;
        pose[first + 3] = 1.0 + 0.5 * wave(0.5, phase) - 0.5 * wave(0.0, phase);
    }
    pose
}

/// The body that is looked at.
///
/// # Errors
/// None: the measures are those of an adult.
// Not inlined: it needs its stack before any frame does.
#[inline(never)]
pub fn scene() -> Result<BodyScene<UPPER_BONES, UPPER_ANGLES>, ParameterError> {
    let measures = BodyMeasures::of_height(DEFAULT_UPPER_OPTIONS.height_m)?;
    Ok(BodyScene {
        skeleton: upper_body(&measures)?,
        radii_m: upper_radii_m(&measures),
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: 0.05, outlier_m: 0.08 },
        self_penetration: None,
    })
}

/// Fills `points_m` with points on the skin that faces the camera, and gives their number.
#[inline(never)]
pub fn look(scene: &BodyScene<UPPER_BONES, UPPER_ANGLES>, frame: u32, points_m: &mut [Vec3; POINTS]) -> usize {
    if frame == DARK {
        return 0;
    }
    let surface: BodySurface<UPPER_BONES> = scene.surface(&scene.posture(&true_pose_rad(frame)));
    let (mut stream, mut count) = (Stream::new(5, u64::from(frame), 0), 0);
    for (point_m, index) in points_m.iter_mut().zip(0_usize..) {
        let Some(seen) = surface.capsules.get(index % surface.capsules.len().max(1)) else { break };
        let axis_m = seen.capsule.start_m + seen.along_m * stream.uniform();
        let out = stream.normal3();
        let out = out / sinew_core::math::length(&out).max(1.0e-6);
        // The side that faces the camera, which is at the origin.
        let out = if out.dot(&axis_m) > 0.0 { -out } else { out };
        let place_m = (axis_m + out * seen.capsule.radius_m) * (1.0 + 0.5 * RANGE_STD_M * stream.normal());
        let is_hidden = seen.bone == RIGHT_FOREARM && HIDDEN.contains(&frame);
        // A hole of the sensor.
        *point_m = if is_hidden { Vec3::zeros() } else { place_m };
        count += 1;
    }
    count
}

/// The tracker, the person and the points of a frame.
#[derive(Debug)]
pub struct BodyApp {
    body: UpperBodyTracker,
    person: Slot<BodyScene<UPPER_BONES, UPPER_ANGLES>>,
    points_m: [Vec3; POINTS],
    step: Cost,
}

impl BodyApp {
    /// Before the first frame.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            body: UpperBodyTracker::empty(),
            person: Slot::Empty,
            points_m: [Vec3::new(0.0, 0.0, 0.0); POINTS],
            step: Cost::zero(),
        }
    }

    #[inline(never)]
    fn begin(&mut self) -> Result<(), ParameterError> {
        self.person = Slot::Full(scene()?);
        self.body.begin(&DEFAULT_UPPER_OPTIONS, true_pose_rad(0))
    }

    #[inline(never)]
    fn frame<P: Port>(&mut self, frame: u32) -> Option<BodyResult> {
        let count = look(self.person.get()?, frame, &mut self.points_m);
        let points_m = self.points_m.get_mut(..count)?;
        let body = &mut self.body;
        let (estimate, _) = counted::<P, _>(&mut self.step, || body.step(points_m, DT_S))?;
        Some(BodyResult::new(frame, &estimate))
    }
}

impl Default for BodyApp {
    fn default() -> Self {
        Self::new()
    }
}

/// All memory that tracking takes lies here, not on the stack.
static APP: ConstStaticCell<BodyApp> = ConstStaticCell::new(BodyApp::new());

/// Tracks the simulated person once.
///
/// # Errors
/// None in practice: all answers have room.
pub fn run<P: Port>(port: &mut P) -> Result<(), RecordError> {
    follow(port, APP.take())
}

/// As [`run`], with memory of the caller.
///
/// # Errors
/// Those of [`run`].
pub fn follow<P: Port>(port: &mut P, app: &mut BodyApp) -> Result<(), RecordError> {
    let (_, results, costs) = port.split();
    if app.begin().is_err() {
        return put(results, &Failure { frame: 0, code: Failure::REFUSED });
    }
    for frame in 1..=FRAMES {
        if let Some(result) = app.frame::<P>(frame) {
            put(results, &result)?;
        }
    }
    put(results, &End { records: FRAMES })?;
    put(costs, &Part::BodyStep.cost(&app.step))
}
