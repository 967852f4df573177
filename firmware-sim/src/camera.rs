//! The image `camera`: a frame's lines arrive, blobs and edge pixels come out, the arm and the
//! cyclic tracker step.

use crate::arm::Arm;
use crate::cyclic::CyclicApp;
use crate::player::{Answers, Application, Refusal, play};
use crate::port::{Part, Port, counted};
use sinew_core::checksum::Crc32;
use sinew_core::slot::Slot;
use sinew_core::tracker::arm::ArmImage;
use sinew_core::vision::front_end::edge_lines::EdgeSteps;
use sinew_core::vision::front_end::pixel_format::Rgb565;
use sinew_core::vision::front_end::skin_table::SkinTable;
use sinew_core::vision::front_end::{FrameLines, LineFrontEnd, QvgaFrontEnd};
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_record::{ArmInput, CameraLine, CameraSetup, Cost, Kind, Record, RecordError, VisionResult};
use static_cell::ConstStaticCell;

/// Everything that a camera's firmware keeps.
#[derive(Debug)]
pub struct CameraApp {
    skin: SkinTable<Rgb565>,
    front_end: Slot<QvgaFrontEnd>,
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
            skin: SkinTable::new(),
            front_end: Slot::Empty,
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
        let front_end = LineFrontEnd::new((width, height), HandLikelihood::default(), EdgeSteps::default())?;
        self.skin.learn(&skin);
        (self.front_end, self.begun) = (Slot::Full(front_end), false);
        Ok(())
    }

    #[inline(never)]
    fn line<P: Port>(&mut self, record: &Record<'_>) -> Result<(), Refusal> {
        let line: CameraLine = record.read()?;
        let front_end = self.front_end.get_mut().ok_or(RecordError::OutOfOrder)?;
        let (skin, begun) = (&self.skin, self.begun);
        counted::<P, _>(&mut self.lines, || {
            if !begun {
                front_end.begin_frame();
            }
            front_end.line(usize::from(line.row), &line.pixels, skin);
        });
        self.begun = true;
        Ok(())
    }

    /// Ends the frame and steps the arm; a frame without any line is one without an image.
    #[inline(never)]
    fn end<P: Port>(&mut self, input: &ArmInput, answers: &mut Answers<'_, P::Output>) -> Result<(), Refusal> {
        let front_end = self.front_end.get_mut().ok_or(RecordError::OutOfOrder)?;
        let seen = if self.begun {
            Some(counted::<P, _>(&mut self.lines, || front_end.end_frame()))
        } else {
            front_end.forget_last_frame();
            None
        };
        let spent = u32::try_from(self.lines.total).unwrap_or(u32::MAX);
        (self.begun, self.lines) = (false, Cost::zero());
        let image = seen.as_ref().map(|seen| ArmImage { candidates: seen.candidates, edges: seen.edges });
        let before = self.arm.step_cost().total;
        let result = self.arm.frame::<P>(input, image)?;
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

/// What is reported of the blobs and edges themselves.
fn vision_result(frame: u32, seen: &FrameLines<'_>) -> VisionResult {
    let mut sum = Crc32::new();
    for candidate in seen.candidates {
        let [uu, uv, vv] = candidate.moments_px2;
        let (u, v) = (candidate.centre.u_px, candidate.centre.v_px);
        for value in [u, v, uu, uv, vv, candidate.area_px, candidate.likelihood] {
            sum = sum.and_word(value.to_bits());
        }
    }
    for edge in seen.edges {
        sum = sum.and_word(u32::from(edge.u) | u32::from(edge.v) << 16);
    }
    let losses = seen.losses;
    VisionResult {
        frame,
        blobs: seen.blobs.len() as u16,
        edges: seen.edges.len() as u16,
        checksum: sum.value(),
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
            Kind::ArmSetup => self.arm.begin(&record.read()?),
            Kind::CameraLine => self.line::<P>(record),
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
