//! The image `arm`: blobs and temporal edges in, the arm out, by 50 particles.

use crate::log::debug;
use crate::player::{Answers, Application, Refusal, play};
use crate::port::{Part, Port, counted};
use heapless::Vec;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::slot::Slot;
use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmModel, ArmTracker};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;
use sinew_core::vision::front_end::PersonHands;
use sinew_core::vision::objects::head::HeadBox;
use sinew_record::{ArmInput, ArmResult, ArmSetup, CandidateChunk, Cost, EdgeChunk, Kind, Record, RecordError};
use static_cell::ConstStaticCell;

/// Particles that there is room for.
pub const PARTICLES: usize = 50;
/// Candidates of a frame that there is room for.
pub const CANDIDATES: usize = 16;
/// Edge pixels of a frame that there is room for.
pub const EDGES: usize = 1024;

/// One arm's tracker, its model, and what a step costs.
#[derive(Debug)]
pub struct Arm {
    model: Slot<ArmModel>,
    /// For candidates of a person's hands.
    person_model: Slot<ArmModel>,
    tracker: Slot<ArmTracker<PARTICLES>>,
    /// The shoulder by the head, where it was last seen.
    shoulder_m: Option<Vec3>,
    last_frame: Option<u32>,
    step: Cost,
}

impl Arm {
    /// Before the first record.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            model: Slot::Empty,
            person_model: Slot::Empty,
            tracker: Slot::Empty,
            shoulder_m: None,
            last_frame: None,
            step: Cost::zero(),
        }
    }

    /// Begins a recording.
    ///
    /// # Errors
    /// A parameter out of its range, more particles than there is room for.
    // Not inlined: what begins a tracker and what steps it need their stack one after the other,
    // not at once.
    #[inline(never)]
    pub fn begin(&mut self, setup: &ArmSetup) -> Result<(), Refusal> {
        let model = setup.model()?;
        self.tracker.get_or_insert(ArmTracker::empty).begin(&model, setup.shoulder_m, setup.seed)?;
        (self.model, self.shoulder_m, self.last_frame) = (Slot::Full(model), None, None);
        Ok(())
    }

    /// Gets ready for the candidates of a person's hands, after [`Arm::begin`].
    ///
    /// # Errors
    /// None after the other.
    #[inline(never)]
    pub fn begin_person(&mut self, setup: &ArmSetup) -> Result<(), Refusal> {
        let Some(model) = self.model.get() else { return Ok(()) };
        let [width, height] = setup.image_size_px;
        let options = model.options().for_hands_over_time();
        self.person_model = Slot::Full(ArmModel::new(*model.camera(), (width, height), *model.geometry(), options)?);
        Ok(())
    }

    /// Answers one frame.
    ///
    /// # Errors
    /// A frame before the setup or not after the last one.
    pub fn frame<P: Port>(&mut self, input: &ArmInput, image: Option<ArmImage<'_>>) -> Result<ArmResult, Refusal> {
        self.step::<P>(input, image, None)
    }

    /// Answers one frame with the candidates of both hands of a person whose head is there.
    ///
    /// # Errors
    /// As [`Arm::frame`].
    pub fn frame_of_person<P: Port>(
        &mut self,
        input: &ArmInput,
        PersonHands { head, hands }: &PersonHands<'_>,
        edges: &[EdgePixel],
    ) -> Result<ArmResult, Refusal> {
        let model = self.person_model.get().ok_or(RecordError::OutOfOrder)?;
        let [left, right] = hands;
        let candidates = if model.side() == Side::Left { left } else { right };
        let image = ArmImage { candidates, edges };
        self.step::<P>(input, Some(image), Some(*head))
    }

    #[inline(never)]
    fn step<P: Port>(
        &mut self,
        input: &ArmInput,
        image: Option<ArmImage<'_>>,
        head: Option<HeadBox>,
    ) -> Result<ArmResult, Refusal> {
        let model = if head.is_some() { &self.person_model } else { &self.model };
        let (Slot::Full(model), Slot::Full(tracker)) = (model, &mut self.tracker) else {
            return Err(RecordError::OutOfOrder.into());
        };
        if self.last_frame.is_some_and(|last| last >= input.frame) {
            return Err(RecordError::OutOfOrder.into());
        }
        if let Some(head) = head {
            let [left_m, right_m] = head.shoulders_m(model.camera());
            self.shoulder_m = Some(if model.side() == Side::Left { left_m } else { right_m });
        }
        let shoulder_m = self.shoulder_m.unwrap_or(input.shoulder_m);
        let frame = ArmFrame { timestamp_us: input.timestamp_us, image, shoulder_m };
        let estimate = counted::<P, _>(&mut self.step, || tracker.step(model, &frame));
        self.last_frame = Some(input.frame);
        debug!("frame {}: hand at {} m", input.frame, estimate.joints.hand_m.z);
        Ok(ArmResult { frame: input.frame, estimate })
    }

    /// Number of the last frame, 0 before the first.
    #[must_use]
    pub fn last_frame(&self) -> u32 {
        self.last_frame.unwrap_or(0)
    }

    /// What the steps cost.
    #[must_use]
    pub const fn step_cost(&self) -> &Cost {
        &self.step
    }
}

impl Default for Arm {
    fn default() -> Self {
        Self::new()
    }
}

/// The arm with the lists of the frame that is coming in.
#[derive(Debug)]
pub struct ArmApp {
    arm: Arm,
    candidates: Vec<HandCandidate, CANDIDATES>,
    edges: Vec<EdgePixel, EDGES>,
}

impl ArmApp {
    /// Before the first record.
    #[must_use]
    pub const fn new() -> Self {
        Self { arm: Arm::new(), candidates: Vec::new(), edges: Vec::new() }
    }

    /// Steps, if everything came that belongs to the frame; the lists are empty then in any case.
    fn frame<P: Port>(&mut self, input: &ArmInput) -> Result<ArmResult, Refusal> {
        let whole =
            self.candidates.len() == usize::from(input.candidates) && self.edges.len() == usize::from(input.edges);
        let image = ArmImage { candidates: &self.candidates, edges: &self.edges };
        let answer = if whole {
            self.arm.frame::<P>(input, Some(image).filter(|_| input.has_image))
        } else {
            Err(RecordError::Lost.into())
        };
        self.candidates.clear();
        self.edges.clear();
        answer
    }
}

impl Default for ArmApp {
    fn default() -> Self {
        Self::new()
    }
}

impl Application for ArmApp {
    fn take<P: Port>(&mut self, record: &Record<'_>, answers: &mut Answers<'_, P::Output>) -> Result<(), Refusal> {
        match record.kind {
            Kind::ArmSetup => self.arm.begin(&record.read()?)?,
            Kind::CandidateChunk => {
                let chunk: CandidateChunk = record.read()?;
                self.candidates
                    .extend_from_slice(&chunk.0)
                    .map_err(|_| RecordError::Capacity { list: "candidates" })?;
            }
            Kind::EdgeChunk => {
                let chunk: EdgeChunk = record.read()?;
                self.edges.extend_from_slice(&chunk.0).map_err(|_| RecordError::Capacity { list: "edges" })?;
            }
            Kind::ArmInput => {
                let result = self.frame::<P>(&record.read()?)?;
                answers.put(&result)?;
            }
            _ => return Err(RecordError::OutOfOrder.into()),
        }
        Ok(())
    }

    fn last_frame(&self) -> u32 {
        self.arm.last_frame()
    }

    fn costs(&self, report: &mut dyn FnMut(&Cost)) {
        report(&Part::ArmStep.cost(self.arm.step_cost()));
    }
}

/// All memory that tracking takes lies here, not on the stack.
static APP: ConstStaticCell<ArmApp> = ConstStaticCell::new(ArmApp::new());

/// Tracks the recording once.
///
/// # Errors
/// Those of [`play`].
pub fn run<P: Port>(port: &mut P) -> Result<(), RecordError> {
    play(port, APP.take())
}
