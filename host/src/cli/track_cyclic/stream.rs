//! Rows that are tracked and written as they are read, so that a recording of any length takes the
//! same memory.

use super::args::TrackCyclicArgs;
use super::place::Place;
use super::summary_line::summary_line;
use crate::cli::console::Console;
use crate::cyclic::angle_table::AngleRows;
use crate::cyclic::tracking::table::EstimateTable;
use crate::cyclic::tracking::{StreamRun, Summary, TrackingOptions};
use crate::error::{Error, Result as LibraryResult, WriteContext};
use crate::output::{GrowingOutput, Target};
use crate::resume::{Begun, Checkpoints, Ended, Interrupted, Left};
use anyhow::Result;
use indicatif::ProgressBar;
use serde_json::json;
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Name of the estimates among the tables that a run leaves.
const ESTIMATES: &str = "estimates";

/// Tracks the rows of a table and writes each estimate at once.
pub(super) fn track(
    args: &TrackCyclicArgs,
    options: TrackingOptions,
    console: &Console,
    stop: &AtomicBool,
    notify: &mut dyn FnMut(usize),
) -> Result<()> {
    let place = Place::of(args)?;
    // What a run that kept its rows left holds no table to go on with.
    let left = place.left(args)?.filter(Left::has_tables);
    let models = args.models()?;
    let count = if args.is_read_once() { None } else { Some(StreamRun::look_over(AngleRows::open(&args.table)?)?) };
    let begun = args.begun(&models)?;
    let mut rows = AngleRows::open(&args.table)?;
    let options = TrackingOptions { rate_hz: Some(args.rate_hz(rows.rate_hz()?)?), ..options };
    let run = StreamRun::new(&models[0], &options, rows.is_spatial())?;
    let mut streamed = Streamed::begin(args, &place, begun, left.as_ref(), rows, run)?;
    let bar = match count {
        Some(count) => console.bar(count as u64, "{wide_bar} row {pos} of {len}, {per_sec}")?,
        None => ProgressBar::hidden(),
    };
    bar.set_position(streamed.run.finished() as u64);
    bar.reset_eta();
    let mut checkpoints = Checkpoints::every(args.checkpoint.interval());
    let tracked = streamed.follow(count, stop, &mut checkpoints, &mut |finished| {
        bar.set_position(finished as u64);
        notify(finished);
    });
    bar.finish_and_clear();
    let summary = streamed.end(tracked, count)?;
    let text = format!("{}wrote {}\n", summary_line(&summary), args.out.display());
    console.answer_beside(&args.out, &text, &json!({ "summary": summary, "out": args.out }))
}

/// A run with its rows and its table.
struct Streamed<'a> {
    args: &'a TrackCyclicArgs,
    place: &'a Place,
    begun: Begun,
    rows: AngleRows<Box<dyn Read>>,
    run: StreamRun<'a>,
    table: EstimateTable<GrowingOutput>,
    started: Instant,
    seconds_before: f64,
}

impl<'a> Streamed<'a> {
    /// Begins a run, or goes on with what one `left`.
    fn begin(
        args: &'a TrackCyclicArgs,
        place: &'a Place,
        begun: Begun,
        left: Option<&Left<Option<String>>>,
        mut rows: AngleRows<Box<dyn Read>>,
        mut run: StreamRun<'a>,
    ) -> Result<Self> {
        let (seconds_before, table) = match (left, place.target()) {
            (Some(left), Target::File(path)) => {
                left.begun.check_options(&begun, &args.out)?;
                left.begun.check_inputs(&begun)?;
                run.restore(left.finished, left.state.as_deref(), &mut rows)?;
                let file = GrowingOutput::File(left.reopened(ESTIMATES, path)?);
                (left.seconds, EstimateTable::go_on(csv::Writer::from_writer(file), run.rates()))
            }
            (_, target) => {
                let writer = csv::Writer::from_writer(GrowingOutput::begin(target)?);
                (0.0, EstimateTable::begin(writer, run.rates(), run.is_spatial(), false)?)
            }
        };
        Ok(Self { args, place, begun, rows, run, table, started: Instant::now(), seconds_before })
    }

    /// Tracks all rows, `count` of them where that is known, or those before `stop` is set; whether
    /// it was all.
    fn follow(
        &mut self,
        count: Option<usize>,
        stop: &AtomicBool,
        checkpoints: &mut Checkpoints,
        notify: &mut dyn FnMut(usize),
    ) -> LibraryResult<bool> {
        let is_live = count.is_none();
        loop {
            if checkpoints.is_due() {
                self.save()?;
            }
            let Some(row) = self.rows.next_row()? else { return Ok(true) };
            let (table, out) = (&mut self.table, &self.args.out);
            self.run.step(&row, &mut |answer| {
                table.add(answer, None).writing(|| format!("`{}` cannot be written", out.display()))
            })?;
            if is_live {
                self.flush()?;
            }
            let finished = self.run.finished();
            notify(finished);
            let is_stopped = stop.load(Ordering::Relaxed) && (finished > 0 || is_live);
            if is_stopped && count != Some(finished) {
                return Ok(false);
            }
        }
    }

    fn flush(&mut self) -> LibraryResult<()> {
        let flushed = self.table.writer().flush();
        flushed.writing(|| format!("`{}` cannot be written", self.args.out.display()))
    }

    /// Keeps what `--resume` needs.
    fn save(&mut self) -> LibraryResult<()> {
        let Some(file) = self.place.resume_file() else { return Ok(()) };
        self.flush()?;
        let seconds = self.seconds_before + self.started.elapsed().as_secs_f64();
        let left = Left::new(self.begun.clone(), self.run.finished(), seconds, None, self.run.saved()?);
        let mark = self.table.writer().get_ref().mark()?;
        file.put(&mark.into_iter().fold(left, |left, mark| left.with_table(ESTIMATES, mark)))
    }

    /// Gives the table its name, and returns what the run comes to, or how it ended.
    fn end(mut self, tracked: LibraryResult<bool>, count: Option<usize>) -> Result<Summary> {
        let (finished, out) = (self.run.finished(), self.args.out.clone());
        let interrupted = Interrupted { finished, all: count, unit: "rows", out };
        let summary = self.run.summary();
        if self.place.resume_file().is_none() {
            return self.end_for_good(tracked, summary, interrupted);
        }
        let is_complete = matches!(tracked, Ok(true));
        match Ended::of(tracked, &mut || self.save().is_ok()) {
            Ended::Unwritable(error) => return Err(error.into()),
            ended => ended.conclude(self.save_and_finish(is_complete), interrupted)?,
        }
        Ok(summary?)
    }

    /// A run that is killed meanwhile can be resumed after its last row.
    fn save_and_finish(mut self, is_complete: bool) -> LibraryResult<()> {
        self.save()?;
        let place = self.place;
        self.finish()?;
        if is_complete { place.clear() } else { Ok(()) }
    }

    /// The end of a run that cannot be resumed: what there is of its table stays.
    fn end_for_good(
        self,
        tracked: LibraryResult<bool>,
        summary: LibraryResult<Summary>,
        interrupted: Interrupted,
    ) -> Result<Summary> {
        match tracked {
            // A reader of standard output that has gone away wants no more.
            Err(error) if error.is_closed_pipe() && *self.place.target() == Target::Standard => Ok(summary?),
            Ok(is_complete) => {
                let summary = summary?;
                self.finish()?;
                if is_complete { Ok(summary) } else { Err(interrupted.into()) }
            }
            Err(error) if error.is_output() || interrupted.finished == 0 => Err(error.into()),
            Err(error) => {
                self.finish()?;
                let Interrupted { finished, unit, out, .. } = interrupted;
                let kept = format!("the results of the {finished} finished {unit} are in `{}`", out.display());
                Err(Error::Unfinished { error: Box::new(error), kept }.into())
            }
        }
    }

    fn finish(mut self) -> LibraryResult<()> {
        self.flush()?;
        let written = self.table.into_writer().into_inner();
        written.writing(|| format!("`{}` cannot be written", self.args.out.display()))?.finish()
    }
}
