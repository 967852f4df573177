//! From pictures to an arm: one session of the page.

use crate::answer::{ANSWER_NUMBERS, PARTICLE_NUMBERS, answer, particle};
use crate::calibration::{adapted, box_around, colour_in};
use crate::either_skin::EitherSkin;
use crate::face::Person;
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
use sinew_core::vision::frame::{FrameAnalyser, last_mask};
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::white_balance::Gains;
use sinew_face::PersonSkin;

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
    models: Models,
    shoulder_m: Vec3,
    tracker: ArmTracker<MAX_PARTICLES>,
    analyser: FrameAnalyser<LINE_CAPACITY, LINE_CAPACITY>,
    click: Option<ClickedSkin>,
    person: Person,
    blobs: BlobList<MAX_BLOBS>,
    edges: EdgeList<MAX_EDGES>,
    /// What the tracker sees of the last frame, the most likely first: places of the tracked hand
    /// once a face is known, else blobs.
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
        let (models, shoulder_m, tracker) = begun(&choice)?;
        let finder =
            BlobFinder::new(BlobMeter::new(DEFAULT_FILL_RATIO)?, HandLikelihood::default(), DEFAULT_MIN_AREA_FRACTION);
        Ok(Self {
            choice,
            models,
            shoulder_m,
            tracker,
            analyser: FrameAnalyser::new(finder, EdgeDetector::default()),
            click: None,
            person: Person::new(choice.size_px),
            blobs: BlobList::new(),
            edges: EdgeList::new(),
            candidates: Vec::new(),
            answer: [f32::NAN; ANSWER_NUMBERS],
            particles: Vec::new(),
        })
    }

    /// Begins anew with another choice: the person is looked for again, what a click has taught
    /// stays.
    ///
    /// # Errors
    /// As [`Self::new`]; the session is as before then.
    pub fn begin_again(&mut self, choice: Choice) -> Result<(), ParameterError> {
        (self.models, self.shoulder_m, self.tracker) = begun(&choice)?;
        self.choice = choice;
        self.analyser.forget_last_frame();
        self.person.begin_again(choice.size_px);
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
        &self.models.of_blobs
    }

    /// The person before the camera.
    #[must_use]
    pub fn person(&self) -> &Person {
        &self.person
    }

    /// Finds candidates and temporal edges of the picture in `frame`. Skin is what the
    /// face and a click have taught, and without both that of the shipped model.
    ///
    /// # Errors
    /// None in practice: the buffers fit every size that a session accepts.
    pub fn see(&mut self, frame: &mut Frame) -> Result<(), ParameterError> {
        let size = self.size_px();
        frame.take_rgba(size.0 * size.1);
        let (rgb, mut buffers) = frame.parts(size);
        self.person.look(rgb, size);
        let (analyser, blobs, edges) = (&mut self.analyser, &mut self.blobs, &mut self.edges);
        match self.person.skin() {
            Some(of_face) => {
                let of_click = self.click.as_ref().and_then(|click| click.of_person.as_ref());
                let skin = EitherSkin { of_face, of_click };
                analyser.analyse(rgb, size, &skin, &mut buffers, blobs, edges)?;
            }
            None => {
                let skin = self.click.as_ref().map_or(SHIPPED, |click| click.of_anyone);
                let skin = skin.for_picture(&Gains::of_picture(rgb, size.0))?;
                analyser.analyse(rgb, size, &skin, &mut buffers, blobs, edges)?;
            }
        }
        let (mask, luminance) = (last_mask(&buffers, size.0, size.1)?, self.analyser.last_luminance(&buffers));
        self.candidates.clear();
        // Blobs are as many as there is room for, and places of a hand are fewer.
        match self.person.find_hand(&mask, luminance, self.choice.side) {
            Some(places) => self.candidates.extend(places.iter().copied().take(MAX_BLOBS)),
            None => self.candidates.extend(self.blobs.candidates().take(MAX_BLOBS)),
        }
        Ok(())
    }

    /// Moves the tracker on to the frame that was seen last, taken at `timestamp_us`, microseconds
    /// since any start.
    pub fn track(&mut self, timestamp_us: u64) -> ArmEstimate {
        let head = self.person.head();
        let model = if head.is_some() { &self.models.of_hands } else { &self.models.of_blobs };
        if let (Some(head), Shoulder::Guessed { .. }) = (head, self.choice.shoulder) {
            let [left, right] = head.shoulders_m(model.camera());
            self.shoulder_m = if self.choice.side == Side::Left { left } else { right };
        }
        let image = Some(ArmImage { candidates: &self.candidates, edges: self.edges.as_slice() });
        let frame = ArmFrame { timestamp_us, image, shoulder_m: self.shoulder_m };
        let estimate = self.tracker.step(model, &frame);
        self.answer = answer(&estimate, model, self.edges.as_slice().len(), head);
        self.particles.clear();
        let weighted = self.tracker.particles().iter().zip(self.tracker.weights());
        self.particles.extend(weighted.map(|(one, &weight)| particle(one, weight, model)).take(MAX_PARTICLES));
        estimate
    }

    /// Learns the skin in a box around the pixel (`u`, `v`) of the picture in `frame`.
    ///
    /// # Errors
    /// A pixel outside of the picture, a box that shows only black; the model is as before then.
    pub fn calibrate(&mut self, frame: &Frame, u: usize, v: usize) -> Result<(), ParameterError> {
        let (width, height) = self.size_px();
        let bounds = box_around((u, v), (width, height), self.person.head())?;
        let rgb = frame.rgb(width * height);
        let of_anyone = adapted(&SHIPPED, rgb, width, bounds)?;
        self.click = Some(ClickedSkin { of_anyone, of_person: colour_in(rgb, width, bounds).map(PersonSkin::new) });
        Ok(())
    }

    /// Goes back to the skin of the face, or the shipped model.
    pub fn forget_calibration(&mut self) {
        self.click = None;
    }
}

/// What a click on the hand has taught.
#[derive(Debug)]
struct ClickedSkin {
    /// The shipped model in this light, for pictures in which no face is known.
    of_anyone: BalancedSkin,
    /// The colour alone, beside that of the face; none where too little is alike.
    of_person: Option<PersonSkin>,
}

/// Camera, arm and options.
#[derive(Debug)]
struct Models {
    of_blobs: ArmModel,
    /// For the hands of a person whose face is known.
    of_hands: ArmModel,
}

/// Models, shoulder and tracker of a choice.
fn begun(choice: &Choice) -> Result<(Models, Vec3, ArmTracker<MAX_PARTICLES>), ParameterError> {
    checked_size(choice.size_px.0, choice.size_px.1)?;
    if !(1..=MAX_PARTICLES).contains(&choice.particles) {
        return Err(ParameterError::new("particles", Rule::Within { low: 1.0, high: MAX_PARTICLES as f32 }));
    }
    let size_px = (choice.size_px.0 as u32, choice.size_px.1 as u32);
    let (of_blobs, shoulder_m) = arm(size_px, choice.side, choice.particles, choice.shoulder)?;
    let options = of_blobs.options().for_hands_over_time();
    let of_hands = ArmModel::new(*of_blobs.camera(), size_px, *of_blobs.geometry(), options)?;
    let tracker = ArmTracker::new(&of_blobs, shoulder_m, choice.seed)?;
    Ok((Models { of_blobs, of_hands }, shoulder_m, tracker))
}
