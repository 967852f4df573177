//! A run over rows that come one after another, of which none is kept.

use super::options::TrackingOptions;
use super::run::{NO_ANGLE, TrackedFrame, check_angles, is_seen, is_spatial, tracked};
use super::steps::Steps;
use super::summary::{RunningSummary, Summary};
use super::walk::{Answer, Walk};
use crate::cyclic::CyclicModel;
use crate::cyclic::angle_table::{ANGLES, AngleRows, ReadRow, SPACE_ANGLES};
use crate::error::{Result, bail, ensure};
use crate::resume::{REMEDY, from_text, to_text};
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};
use std::io::Read;

/// Takes the answers, in the order of rows.
pub type Answered<'a> = &'a mut dyn FnMut(&TrackedFrame) -> Result<()>;

/// One filter over rows as they come.
#[derive(Debug)]
pub struct StreamRun<'a> {
    model: &'a CyclicModel,
    options: &'a TrackingOptions,
    /// Frames per second of the recording, and frames of the model in one of these.
    rates: (f64, f64),
    /// Numbers of the frames before the first one with an angle.
    waiting: Vec<u64>,
    begun: Option<Begun<'a>>,
}

/// The run from the first row with an angle on.
#[derive(Debug)]
struct Begun<'a> {
    walk: AnyWalk<'a>,
    summary: RunningSummary,
}

#[derive(Debug)]
enum AnyWalk<'a> {
    Plane(Walk<'a, ANGLES>),
    Space(Walk<'a, SPACE_ANGLES>),
}

impl<'a> StreamRun<'a> {
    /// A run that waits for its first row with an angle; `is_spatial` says whether rows have two
    /// angles a joint.
    ///
    /// # Errors
    /// An option out of range, smoothing, or a rate so low that a step is too long. Also a model
    /// with two angles a joint for rows with one.
    pub fn new(model: &'a CyclicModel, options: &'a TrackingOptions, is_spatial: bool) -> Result<Self> {
        ensure!(!options.smooth, "`--smooth` needs a recording that is kept whole");
        check_angles(model, is_spatial)?;
        let steps = Steps::new(&model.view(), options)?;
        Ok(Self { model, options, rates: (steps.rate_hz(), steps.step_frames()), waiting: Vec::new(), begun: None })
    }

    /// Frames per second of the recording, and frames of the model in one of these.
    #[must_use]
    pub const fn rates(&self) -> (f64, f64) {
        self.rates
    }

    /// Whether the answers have two angles a joint.
    #[must_use]
    pub fn is_spatial(&self) -> bool {
        is_spatial(self.model)
    }

    /// Rows that are answered.
    #[must_use]
    pub fn finished(&self) -> usize {
        self.begun.as_ref().map_or(0, |begun| begun.summary.rows() as usize)
    }

    /// Takes the next row. Nothing is answered before the first row with an angle; then the rows
    /// before it are answered with the first state as well.
    ///
    /// # Errors
    /// None for rows of a table, or what `answered` says.
    pub fn step(&mut self, row: &ReadRow, answered: Answered<'_>) -> Result<()> {
        let Some(begun) = &mut self.begun else { return self.wait(row, answered) };
        let answer = begun.walk.step(row)?;
        begun.summary.add(&answer);
        answered(&answer)
    }

    fn wait(&mut self, row: &ReadRow, answered: Answered<'_>) -> Result<()> {
        self.waiting.push(row.row.frame);
        if !is_seen(&row.row) {
            return Ok(());
        }
        let waiting = std::mem::take(&mut self.waiting);
        let walk = AnyWalk::begin(self.model, self.options, waiting[0], row)?;
        let seen = row.row.frame;
        // Before its first measurement a filter knows nothing.
        let answer = |frame| TrackedFrame { is_known: frame == seen, ..walk.first_answer(frame) };
        let answers: Vec<TrackedFrame> = waiting.into_iter().map(answer).collect();
        let mut summary = RunningSummary::new(&answers[0], self.rates.0, self.rates.1);
        answers[1..].iter().for_each(|answer| summary.add(answer));
        self.begun = Some(Begun { walk, summary });
        answers.iter().try_for_each(answered)
    }

    /// Reads a table to its end, so that nothing is wrong with it when it is tracked; its number of
    /// rows.
    ///
    /// # Errors
    /// A row breaks a rule, or none has an angle.
    pub fn look_over<R: Read>(mut rows: AngleRows<R>) -> Result<usize> {
        let (mut count, mut has_angle) = (0, false);
        while let Some(row) = rows.next_row()? {
            count += 1;
            has_angle |= is_seen(&row.row);
        }
        ensure!(has_angle, "{NO_ANGLE}");
        Ok(count)
    }

    /// What the rows so far come to.
    ///
    /// # Errors
    /// No row had an angle.
    pub fn summary(&self) -> Result<Summary> {
        let Some(begun) = &self.begun else { bail!("{NO_ANGLE}") };
        Ok(begun.summary.summary())
    }

    /// The state after the last row that is answered as text, which [`StreamRun::restore`] takes;
    /// `None` before the first.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<Option<String>> {
        self.begun.as_mut().map(|begun| to_text(StateKind::Cyclic, begun)).transpose()
    }

    /// Goes on from a state that was saved after `finished` rows with the same model and options;
    /// `rows` gives these rows again.
    ///
    /// # Errors
    /// The text is not whole, or of another run; or a row cannot be read.
    pub fn restore<R: Read>(&mut self, finished: usize, saved: Option<&str>, rows: &mut AngleRows<R>) -> Result<()> {
        for _ in 0..finished {
            let Some(row) = rows.next_row()? else { break };
            match &mut self.begun {
                None => self.wait(&row, &mut |_| Ok(()))?,
                Some(begun) => begun.walk.go_on_after(row.row.frame),
            }
        }
        if let (Some(text), Some(begun)) = (saved, &mut self.begun) {
            from_text(StateKind::Cyclic, text, begun)?;
        }
        ensure!(self.finished() == finished, "what the run left does not fit its number of rows; {REMEDY}");
        Ok(())
    }
}

impl SavedState for Begun<'_> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        match &mut self.walk {
            AnyWalk::Plane(walk) => walk.visit(visitor),
            AnyWalk::Space(walk) => walk.visit(visitor),
        }
        self.summary.visit(visitor);
    }
}

impl<'a> AnyWalk<'a> {
    fn begin(model: &'a CyclicModel, options: &'a TrackingOptions, first_frame: u64, row: &ReadRow) -> Result<Self> {
        let frames = [first_frame, row.row.frame];
        Ok(if is_spatial(model) {
            Self::Space(Walk::begin(model.view(), options, frames, &angles(row))?)
        } else {
            Self::Plane(Walk::begin(model.view(), options, frames, &angles(row))?)
        })
    }

    fn first_answer(&self, frame: u64) -> TrackedFrame {
        match self {
            Self::Plane(walk) => answered_frame(frame, &walk.first_answer()),
            Self::Space(walk) => answered_frame(frame, &walk.first_answer()),
        }
    }

    fn step(&mut self, row: &ReadRow) -> Result<TrackedFrame> {
        let frame = row.row.frame;
        Ok(match self {
            Self::Plane(walk) => answered_frame(frame, &walk.step(frame, &angles(row))?),
            Self::Space(walk) => answered_frame(frame, &walk.step(frame, &angles(row))?),
        })
    }

    fn go_on_after(&mut self, frame: u64) {
        match self {
            Self::Plane(walk) => walk.go_on_after(frame),
            Self::Space(walk) => walk.go_on_after(frame),
        }
    }
}

fn answered_frame<const N: usize>(frame: u64, answer: &Answer<N>) -> TrackedFrame {
    tracked(frame, &answer.estimate, answer.cycles)
}

fn angles<const N: usize>(row: &ReadRow) -> [Option<f32>; N] {
    std::array::from_fn(|angle| row.angle_rad(angle).map(|angle| angle as f32))
}
