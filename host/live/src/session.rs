//! From pictures to an arm: one session of the page.

use crate::answer::{ANSWER_NUMBERS, PARTICLE_NUMBERS, answer, particle};
use crate::calibration::{adapted, box_around};
use crate::frame::{Frame, checked_size};
use crate::person::{Shoulder, arm};
use crate::skin_model::{BalancedSkin, SHIPPED};
use heapless::Vec;
use sinew_core::error::{ParameterError, Rule};
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::{ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmTracker};
use sinew_core::vision::blobs::{BlobFinder, BlobList, DEFAULT_MIN_AREA_FRACTION};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::{EdgeDetector, EdgeList};
use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
use sinew_core::vision::frame::FrameAnalyser;
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::white_balance::Gains;

/// Particles that there is room for.
pub const MAX_PARTICLES: usize = 512;
/// Maximum number of blobs of a frame, the host's number.
pub const MAX_BLOBS: usize = 64;
/// Most temporal edge pixels of a frame, the host's number.
pub const MAX_EDGES: usize = 4096;
/// Runs of a line and components that grow at once, the host's number.
const LINE_CAPACITY: usize = 1024;

/// What the page chooses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Width and height of all pictures, pixels.
    pub size_px: (usize, usize),
    /// The person's own side.
    pub side: Side,
    /// Number of particles, 1 to [`MAX_PARTICLES`].
    pub particles: usize,
    /// Seed of all that is random.
    pub seed: u64,
    /// Where the shoulder is.
    pub shoulder: Shoulder,
}

/// Tracker and vision of one arm, and what the last frame gave.
#[derive(Debug)]
pub struct Session {
    choice: Choice,
    model: ArmModel,
    shoulder_m: Vec3,
    tracker: ArmTracker<MAX_PARTICLES>,
    analyser: FrameAnalyser<LINE_CAPACITY, LINE_CAPACITY>,
    skin: BalancedSkin,
    blobs: BlobList<MAX_BLOBS>,
    edges: EdgeList<MAX_EDGES>,
    /// Blobs of the last frame as the tracker sees them, the most likely first.
    pub candidates: Vec<HandCandidate, MAX_BLOBS>,
    /// The last frame's answer, see [`answer()`].
    pub answer: [f32; ANSWER_NUMBERS],
    /// The last frame's particles, see [`particle()`].
    pub particles: Vec<[f32; PARTICLE_NUMBERS], MAX_PARTICLES>,
}

impl Session {
    /// A session before its first frame, with the shipped skin model.
    ///
    /// # Errors
    /// A size or a number of particles that there is no room for.
    pub fn new(choice: Choice) -> Result<Self, ParameterError> {
        let (model, shoulder_m, tracker) = begun(&choice)?;
        let finder =
            BlobFinder::new(BlobMeter::new(DEFAULT_FILL_RATIO)?, HandLikelihood::default(), DEFAULT_MIN_AREA_FRACTION);
        Ok(Self {
            choice,
            model,
            shoulder_m,
            tracker,
            analyser: FrameAnalyser::new(finder, EdgeDetector::default()),
            skin: SHIPPED,
            blobs: BlobList::new(),
            edges: EdgeList::new(),
            candidates: Vec::new(),
            answer: [f32::NAN; ANSWER_NUMBERS],
            particles: Vec::new(),
        })
    }

    /// Begins anew with another choice; the skin model stays.
    ///
    /// # Errors
    /// As [`Self::new`]; the session is as before then.
    pub fn begin_again(&mut self, choice: Choice) -> Result<(), ParameterError> {
        (self.model, self.shoulder_m, self.tracker) = begun(&choice)?;
        self.choice = choice;
        self.analyser.forget_last_frame();
        self.candidates.clear();
        self.particles.clear();
        self.answer = [f32::NAN; ANSWER_NUMBERS];
        Ok(())
    }

    /// Width and height of the pictures, pixels.
    #[must_use]
    pub fn size_px(&self) -> (usize, usize) {
        self.choice.size_px
    }

    /// Camera, arm and options.
    #[must_use]
    pub fn model(&self) -> &ArmModel {
        &self.model
    }

    /// Finds blobs and temporal edges of the picture in `frame`.
    ///
    /// # Errors
    /// None in practice: the buffers fit every size that a session accepts.
    pub fn see(&mut self, frame: &mut Frame) -> Result<(), ParameterError> {
        let size = self.size_px();
        frame.take_rgba(size.0 * size.1);
        let (rgb, mut buffers) = frame.parts(size);
        let skin = self.skin.for_picture(&Gains::of_picture(rgb, size.0))?;
        self.analyser.analyse(rgb, size, &skin, &mut buffers, &mut self.blobs, &mut self.edges)?;
        self.candidates.clear();
        // As many as blobs, of which there are no more than that.
        self.candidates.extend(self.blobs.candidates().take(MAX_BLOBS));
        Ok(())
    }

    /// Moves the tracker on to the frame that was seen last, taken at `timestamp_us`, microseconds
    /// since any start.
    pub fn track(&mut self, timestamp_us: u64) -> ArmEstimate {
        let image = Some(ArmImage { candidates: &self.candidates, edges: self.edges.as_slice() });
        let frame = ArmFrame { timestamp_us, image, shoulder_m: self.shoulder_m };
        let estimate = self.tracker.step(&self.model, &frame);
        self.answer = answer(&estimate, &self.model, self.edges.as_slice().len());
        self.particles.clear();
        let weighted = self.tracker.particles().iter().zip(self.tracker.weights());
        self.particles.extend(weighted.map(|(one, &weight)| particle(one, weight, &self.model)).take(MAX_PARTICLES));
        estimate
    }

    /// Adapts the shipped skin model to a box around the pixel (`u`, `v`) of the picture in
    /// `frame`.
    ///
    /// # Errors
    /// A pixel outside of the picture, a box that shows only black; the model is as before then.
    pub fn calibrate(&mut self, frame: &Frame, u: usize, v: usize) -> Result<(), ParameterError> {
        let (width, height) = self.size_px();
        let bounds = box_around((u, v), (width, height))?;
        self.skin = adapted(&SHIPPED, frame.rgb(width * height), width, bounds)?;
        Ok(())
    }

    /// Goes back to the shipped skin model.
    pub fn forget_calibration(&mut self) {
        self.skin = SHIPPED;
    }
}

/// Model, shoulder and tracker of a choice.
fn begun(choice: &Choice) -> Result<(ArmModel, Vec3, ArmTracker<MAX_PARTICLES>), ParameterError> {
    checked_size(choice.size_px.0, choice.size_px.1)?;
    if !(1..=MAX_PARTICLES).contains(&choice.particles) {
        return Err(ParameterError::new("particles", Rule::Within { low: 1.0, high: MAX_PARTICLES as f32 }));
    }
    let size_px = (choice.size_px.0 as u32, choice.size_px.1 as u32);
    let (model, shoulder_m) = arm(size_px, choice.side, choice.particles, choice.shoulder)?;
    let tracker = ArmTracker::new(&model, shoulder_m, choice.seed)?;
    Ok((model, shoulder_m, tracker))
}
