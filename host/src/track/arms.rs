//! One arm or both, with their models: what `track arm`, `demo` and `evaluate arm` step through.

use crate::config::{BodyConfig, Config, options_for};
use crate::error::Result;
use crate::frames::FrameView;
use crate::resume::{from_text, to_text};
use serde::{Deserialize, Serialize};
use sinew_core::camera::{Camera, Pixel};
use sinew_core::math::Vec3;
use sinew_core::saved_state::StateKind;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::{
    ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmOptions, ArmPair, ArmTracker, PairFrame, Particle,
};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;
use std::str::FromStr;

/// Which arms are tracked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum SideChoice {
    /// The person's left arm.
    Left,
    /// The person's right arm.
    #[default]
    Right,
    /// Both.
    Both,
}

impl SideChoice {
    /// All, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::Left, Self::Right, Self::Both];

    /// Name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Both => "both",
        }
    }
}

impl FromStr for SideChoice {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|side| side.name() == name);
        found.ok_or_else(|| format!("has to be `left`, `right` or `both`, not `{name}`"))
    }
}

/// The trackers of a run: one arm, or two that share their blobs. The capacity is the particle
/// count, rounded up.
#[derive(Debug)]
enum Trackers<const CAPACITY: usize> {
    One(Box<ArmTracker<CAPACITY>>),
    Two(Box<ArmPair<CAPACITY>>),
}

#[derive(Debug)]
enum Sized {
    Small(Trackers<64>),
    Middle(Trackers<1024>),
    Large(Trackers<5000>),
}

/// Arms with their models and state.
#[derive(Debug)]
pub struct ArmSet {
    models: Vec<ArmModel>,
    /// For candidates of a person.
    person_models: Vec<ArmModel>,
    shoulders_m: Vec<Vec3>,
    trackers: Sized,
}

/// What a frame gave for one arm.
#[derive(Debug, Clone)]
pub struct ArmView {
    /// The estimate.
    pub estimate: ArmEstimate,
    /// Where the candidate is that carries the estimate.
    pub carrier: Option<Pixel>,
    /// Particles with their weights.
    pub particles: Vec<(Particle, f32)>,
}

impl ArmSet {
    /// Trackers for images of this size.
    ///
    /// # Errors
    /// Names the parameter of the configuration that cannot be used.
    pub fn new(config: &Config, size_px: (u32, u32), side: SideChoice, seed: u64) -> Result<Self> {
        let camera = config.camera.build(size_px.0, size_px.1)?;
        Self::of_camera(config, (camera, size_px), side, seed)
    }

    /// The same for a camera that is not the configuration's, with the size of its images.
    pub(super) fn of_camera(
        config: &Config,
        (camera, size_px): (Camera, (u32, u32)),
        side: SideChoice,
        seed: u64,
    ) -> Result<Self> {
        let sides: &[Side] = match side {
            SideChoice::Left => &[Side::Left],
            SideChoice::Right => &[Side::Right],
            SideChoice::Both => &[Side::Left, Side::Right],
        };
        let options = options_for(&config.tracker, &config.body);
        let models_with = |options: ArmOptions| -> Result<Vec<ArmModel>> {
            sides.iter().map(|&side| Ok(ArmModel::new(camera, size_px, config.body.arm(side)?, options)?)).collect()
        };
        let (models, person_models) = (models_with(options)?, models_with(options.for_hands_over_time())?);
        let shoulders_m: Vec<Vec3> = sides.iter().map(|&side| shoulder_m(&config.body, side)).collect();
        let trackers = match config.tracker.particles {
            0..=64 => Sized::Small(Trackers::new(&models, &shoulders_m, seed)?),
            65..=1024 => Sized::Middle(Trackers::new(&models, &shoulders_m, seed)?),
            _ => Sized::Large(Trackers::new(&models, &shoulders_m, seed)?),
        };
        Ok(Self { models, person_models, shoulders_m, trackers })
    }

    /// The models, in the order of the views.
    #[must_use]
    pub fn models(&self) -> &[ArmModel] {
        &self.models
    }

    /// Answers one frame; `view` is `None` where the image is missing. One view an arm, left first.
    pub fn step(&mut self, timestamp_us: u64, view: Option<&FrameView>) -> Vec<ArmView> {
        let image = view.map(|view| ArmImage { candidates: &view.candidates, edges: &view.edges });
        self.trackers.step(&self.models, &self.shoulders_m, timestamp_us, image)
    }

    /// Answers one frame whose `hands` a detector found, for all arms together.
    pub fn step_hands(&mut self, timestamp_us: u64, edges: &[EdgePixel], hands: &[HandCandidate]) -> Vec<ArmView> {
        let image = Some(ArmImage { candidates: hands, edges });
        self.trackers.step(&self.person_models, &self.shoulders_m, timestamp_us, image)
    }

    /// Answers one frame in which the left and the right hand have candidates of their own.
    pub fn step_each(
        &mut self,
        timestamp_us: u64,
        edges: &[EdgePixel],
        hands: &[Vec<HandCandidate>; 2],
    ) -> Vec<ArmView> {
        let frames: Vec<ArmFrame<'_>> = (self.models.iter().zip(&self.shoulders_m))
            .map(|(model, &shoulder_m)| {
                let candidates = &hands[side_index(model.side())];
                ArmFrame { timestamp_us, image: Some(ArmImage { candidates, edges }), shoulder_m }
            })
            .collect();
        match &mut self.trackers {
            Sized::Small(trackers) => trackers.step_each(&self.person_models, &frames),
            Sized::Middle(trackers) => trackers.step_each(&self.person_models, &frames),
            Sized::Large(trackers) => trackers.step_each(&self.person_models, &frames),
        }
    }

    /// Whether a hand may be at `pixel`: its line of sight passes a shoulder within an arm's
    /// length.
    #[must_use]
    pub fn reach(&self, pixel: Pixel) -> bool {
        self.models.iter().zip(&self.shoulders_m).any(|(model, shoulder_m)| {
            let (ray, geometry) = (model.camera().back_project(pixel), model.geometry());
            (ray.project(shoulder_m) - shoulder_m).norm() <= geometry.upper_arm_m + geometry.forearm_m
        })
    }

    /// Moves the shoulders, left and right, metres in camera axes; they stay there.
    pub fn place_shoulders(&mut self, shoulders_m: &[Vec3; 2]) {
        for (model, shoulder_m) in self.models.iter().zip(&mut self.shoulders_m) {
            *shoulder_m = shoulders_m[side_index(model.side())];
        }
    }

    /// The state of the trackers after the last step as text, which [`ArmSet::restore`] takes.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<String> {
        match &mut self.trackers {
            Sized::Small(trackers) => trackers.saved(),
            Sized::Middle(trackers) => trackers.saved(),
            Sized::Large(trackers) => trackers.saved(),
        }
    }

    /// Puts the trackers into a state that was saved with the same configuration, sides and size.
    ///
    /// # Errors
    /// The text is not whole, or of other trackers.
    pub fn restore(&mut self, saved: &str) -> Result<()> {
        match &mut self.trackers {
            Sized::Small(trackers) => trackers.restore(saved),
            Sized::Middle(trackers) => trackers.restore(saved),
            Sized::Large(trackers) => trackers.restore(saved),
        }
    }

    /// Particles with their weights after the last step, in the order of the views.
    #[must_use]
    pub fn particles(&self) -> Vec<Vec<(Particle, f32)>> {
        match &self.trackers {
            Sized::Small(trackers) => trackers.particles(),
            Sized::Middle(trackers) => trackers.particles(),
            Sized::Large(trackers) => trackers.particles(),
        }
    }

    /// Images of shoulder, elbow and hand; `None` where one lies behind the camera.
    #[must_use]
    pub fn joints_px(&self, joints_m: [Vec3; 3]) -> Option<[Pixel; 3]> {
        let camera = self.models.first()?.camera();
        let [shoulder, elbow, hand] = joints_m.map(|joint| camera.project(&joint));
        Some([shoulder?, elbow?, hand?])
    }
}

impl Sized {
    fn step(
        &mut self,
        models: &[ArmModel],
        shoulders_m: &[Vec3],
        timestamp_us: u64,
        image: Option<ArmImage<'_>>,
    ) -> Vec<ArmView> {
        match self {
            Self::Small(trackers) => trackers.step(models, shoulders_m, timestamp_us, image),
            Self::Middle(trackers) => trackers.step(models, shoulders_m, timestamp_us, image),
            Self::Large(trackers) => trackers.step(models, shoulders_m, timestamp_us, image),
        }
    }
}

/// Left, then right.
fn side_index(side: Side) -> usize {
    usize::from(side == Side::Right)
}

fn shoulder_m(body: &BodyConfig, side: Side) -> Vec3 {
    let [left, right] = body.shoulders_m();
    if side == Side::Left { left } else { right }
}

impl<const CAPACITY: usize> Trackers<CAPACITY> {
    // Not inlined: three capacities in one function would need the stack of all of them.
    #[inline(never)]
    fn new(models: &[ArmModel], shoulders_m: &[Vec3], seed: u64) -> Result<Self> {
        if let ([left, right], [left_m, right_m]) = (models, shoulders_m) {
            return Ok(Self::Two(Box::new(ArmPair::new([left, right], [*left_m, *right_m], seed)?)));
        }
        Ok(Self::One(Box::new(ArmTracker::new(&models[0], shoulders_m[0], seed)?)))
    }

    fn saved(&mut self) -> Result<String> {
        match self {
            Self::One(tracker) => to_text(StateKind::Arm, tracker.as_mut()),
            Self::Two(pair) => to_text(StateKind::ArmPair, pair.as_mut()),
        }
    }

    fn restore(&mut self, saved: &str) -> Result<()> {
        match self {
            Self::One(tracker) => from_text(StateKind::Arm, saved, tracker.as_mut()),
            Self::Two(pair) => from_text(StateKind::ArmPair, saved, pair.as_mut()),
        }
    }

    fn particles(&self) -> Vec<Vec<(Particle, f32)>> {
        match self {
            Self::One(tracker) => vec![weighted(tracker)],
            Self::Two(pair) => pair.trackers().iter().map(weighted).collect(),
        }
    }

    #[inline(never)]
    fn step_each(&mut self, models: &[ArmModel], frames: &[ArmFrame<'_>]) -> Vec<ArmView> {
        match (self, models, frames) {
            (Self::One(tracker), [model, ..], [frame, ..]) => {
                let estimate = tracker.step(model, frame);
                vec![view(estimate, tracker, frame.image)]
            }
            (Self::Two(pair), [left, right], [of_left, of_right]) => {
                let estimates = pair.step_each([left, right], [of_left, of_right]);
                let images = [of_left.image, of_right.image];
                let arms = estimates.into_iter().zip(pair.trackers()).zip(images);
                arms.map(|((estimate, tracker), image)| view(estimate, tracker, image)).collect()
            }
            _ => Vec::new(),
        }
    }

    #[inline(never)]
    fn step(
        &mut self,
        models: &[ArmModel],
        shoulders_m: &[Vec3],
        timestamp_us: u64,
        image: Option<ArmImage<'_>>,
    ) -> Vec<ArmView> {
        match self {
            Self::One(tracker) => {
                let frame = ArmFrame { timestamp_us, image, shoulder_m: shoulders_m[0] };
                let estimate = tracker.step(&models[0], &frame);
                vec![view(estimate, tracker, image)]
            }
            Self::Two(pair) => {
                let frame = PairFrame { timestamp_us, image, shoulders_m: [shoulders_m[0], shoulders_m[1]] };
                let estimates = pair.step([&models[0], &models[1]], &frame);
                let arms = estimates.into_iter().zip(pair.trackers());
                arms.map(|(estimate, tracker)| view(estimate, tracker, image)).collect()
            }
        }
    }
}

fn view<const CAPACITY: usize>(
    estimate: ArmEstimate,
    tracker: &ArmTracker<CAPACITY>,
    image: Option<ArmImage<'_>>,
) -> ArmView {
    let carrier = estimate.candidate.and_then(|index| image?.candidates.get(index)).map(|candidate| candidate.centre);
    ArmView { estimate, carrier, particles: weighted(tracker) }
}

fn weighted<const CAPACITY: usize>(tracker: &ArmTracker<CAPACITY>) -> Vec<(Particle, f32)> {
    tracker.particles().iter().copied().zip(tracker.weights().iter().copied()).collect()
}
