//! The image `camera`: a frame's lines arrive, hands and edge pixels come out, the arm and the
//! cyclic tracker step.

use crate::arm::Arm;
use crate::cyclic::CyclicApp;
use crate::player::{Answers, Application, Refusal, play};
use crate::port::{Part, Port, counted};
use sinew_core::checksum::Crc32;
use sinew_core::tracker::arm::ArmImage;
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::front_end::pixel_format::Rgb565;
use sinew_core::vision::front_end::{PersonFrame, PersonLines};
use sinew_record::{ArmInput, CameraFace, CameraLine, CameraSetup, Cost, Kind, Record, RecordError, VisionResult};
use static_cell::ConstStaticCell;

/// Everything that a camera's firmware keeps.
#[derive(Debug)]
pub struct CameraApp {
    person_lines: PersonLines<Rgb565>,
    /// Whether a line of the coming frame was read.
    begun: bool,
    arm: Arm,
    cyclic: CyclicApp,
    /// The front end in the coming frame.
    lines: Cost,
    vision: Cost,
    frame: Cost,
}

impl CameraApp {
    /// Before the first record.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            person_lines: PersonLines::empty(),
            begun: false,
            arm: Arm::new(),
            cyclic: CyclicApp::new(),
            lines: Cost::zero(),
            vision: Cost::zero(),
            frame: Cost::zero(),
        }
    }

    // Not inlined: what begins a tracker and what steps it need their stack one after the other,
    // not at once.
    #[inline(never)]
    fn begin(&mut self, setup: &CameraSetup) -> Result<(), Refusal> {
        let [width, height] = setup.size_px.map(usize::from);
        let skin = setup.skin()?;
        self.person_lines.begin((width, height), &skin)?;
        self.begun = false;
        Ok(())
    }

    fn check_begun(&self) -> Result<(), Refusal> {
        if self.person_lines.has_begun() { Ok(()) } else { Err(RecordError::OutOfOrder.into()) }
    }

    #[inline(never)]
    fn line<P: Port>(&mut self, record: &Record<'_>) -> Result<(), Refusal> {
        let line: CameraLine = record.read()?;
        self.check_begun()?;
        let (person_lines, begun) = (&mut self.person_lines, self.begun);
        counted::<P, _>(&mut self.lines, || {
            if !begun {
                person_lines.begin_frame();
            }
            person_lines.line(usize::from(line.row), &line.pixels);
        });
        self.begun = true;
        Ok(())
    }

    /// Ends the frame and steps the arm; a frame without any line is one without an image.
    #[inline(never)]
    fn end<P: Port>(&mut self, input: &ArmInput, answers: &mut Answers<'_, P::Output>) -> Result<(), Refusal> {
        self.check_begun()?;
        let seen = if self.begun {
            counted::<P, _>(&mut self.lines, || self.person_lines.end_frame())
        } else {
            self.person_lines.forget_last_frame();
            None
        };
        let spent = u32::try_from(self.lines.total).unwrap_or(u32::MAX);
        (self.begun, self.lines) = (false, Cost::zero());
        let before = self.arm.step_cost().total;
        let result = match &seen {
            None => self.arm.frame::<P>(input, None)?,
            Some(PersonFrame { lines, person: Some(person) }) => {
                self.arm.frame_of_person::<P>(input, person, lines.edges)?
            }
            Some(PersonFrame { lines, person: None }) => {
                let image = ArmImage { candidates: lines.candidates, edges: lines.edges };
                self.arm.frame::<P>(input, Some(image))?
            }
        };
        let step = u32::try_from(self.arm.step_cost().total - before).unwrap_or(u32::MAX);
        if let Some(seen) = &seen {
            self.vision.add(spent);
            answers.put(&vision_result(input.frame, seen))?;
        }
        self.frame.add(spent.saturating_add(step).saturating_add(self.cyclic.last_step()));
        answers.put(&result)?;
        Ok(())
    }
}

/// What is reported of blobs, edges and hands themselves.
fn vision_result(frame: u32, PersonFrame { lines, person }: &PersonFrame<'_>) -> VisionResult {
    let add = |sum: Crc32, candidate: &HandCandidate| {
        let [uu, uv, vv] = candidate.moments_px2;
        let (u, v) = (candidate.centre.u_px, candidate.centre.v_px);
        let numbers = [u, v, uu, uv, vv, candidate.area_px, candidate.likelihood];
        numbers.into_iter().fold(sum, |sum, value| sum.and_word(value.to_bits()))
    };
    let blobs = lines.candidates.iter().fold(Crc32::new(), add);
    let edges = lines.edges.iter().fold(blobs, |sum, edge| sum.and_word(u32::from(edge.u) | u32::from(edge.v) << 16));
    let hands = person.iter().flat_map(|person| person.hands.iter().flatten());
    let all = hands.fold(edges, add);
    let losses = lines.losses;
    VisionResult {
        frame,
        blobs: lines.blobs.len() as u16,
        edges: lines.edges.len() as u16,
        checksum: all.value(),
        losses: [
            losses.dropped_components,
            losses.dropped_px,
            losses.dropped_blobs,
            losses.dropped_edges,
            losses.missing_lines,
            losses.ignored_lines,
        ],
    }
}

impl Default for CameraApp {
    fn default() -> Self {
        Self::new()
    }
}

impl Application for CameraApp {
    fn take<P: Port>(&mut self, record: &Record<'_>, answers: &mut Answers<'_, P::Output>) -> Result<(), Refusal> {
        match record.kind {
            Kind::CameraSetup => self.begin(&record.read()?),
            Kind::ArmSetup => {
                let setup = record.read()?;
                self.arm.begin(&setup)?;
                self.arm.begin_person(&setup)
            }
            Kind::CameraLine => self.line::<P>(record),
            Kind::CameraFace => {
                self.person_lines.add_face(record.read::<CameraFace>()?.head);
                Ok(())
            }
            Kind::ArmInput => self.end::<P>(&record.read()?, answers),
            _ => self.cyclic.take::<P>(record, answers),
        }
    }

    fn last_frame(&self) -> u32 {
        self.arm.last_frame()
    }

    fn costs(&self, report: &mut dyn FnMut(&Cost)) {
        report(&Part::FrontEnd.cost(&self.vision));
        report(&Part::ArmStep.cost(self.arm.step_cost()));
        report(&Part::CyclicStep.cost(self.cyclic.step_cost()));
        report(&Part::Frame.cost(&self.frame));
    }
}

/// All memory that tracking takes lies here, not on the stack.
static APP: ConstStaticCell<CameraApp> = ConstStaticCell::new(CameraApp::new());

/// Tracks the recording once.
///
/// # Errors
/// Those of [`play`].
pub fn run<P: Port>(port: &mut P) -> Result<(), RecordError> {
    play(port, APP.take())
}
