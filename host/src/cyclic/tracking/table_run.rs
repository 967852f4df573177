//! A run over an angle table that may be stopped between rows and taken up again.

use super::bank::{MAX_MOTIONS, NamedMotion, named, shown};
use super::kept::Kept;
use super::options::TrackingOptions;
use super::run::{Tracked, check_angles, is_spatial};
use crate::cyclic::angle_table::{ANGLES, SPACE_ANGLES};
use crate::cyclic::model_file::{shipped, shipped_names};
use crate::cyclic::{AngleTable, CyclicModel};
use crate::error::{Result, bail, ensure};
use crate::resume::{REMEDY, from_text, to_text};
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};

/// Tracks `table`. The first row with an angle gives the first state (see [`super::StartName`]) and
/// is answered with it.
///
/// # Errors
/// An option out of range, a rate so low that a step is too long, a table without any angle.
pub fn track(table: &AngleTable, model: &CyclicModel, options: &TrackingOptions) -> Result<Tracked> {
    let mut run = TableRun::begin(table, std::slice::from_ref(model), options)?;
    run.run(&|| false, &mut |_| ())?;
    Ok(run.answered()?.0)
}

/// Checks that all models have one rate and one number of angles.
fn check_alike(models: &[CyclicModel]) -> Result<()> {
    let first = models[0].numbers();
    if let Some(other) = models.iter().map(CyclicModel::numbers).find(|other| other.rate_hz != first.rate_hz) {
        let shipped_hz = shipped_names().into_iter().filter_map(shipped).map(|model| model.numbers().rate_hz);
        let rates_hz = [first.rate_hz, other.rate_hz];
        let wanted_hz = shipped_hz.into_iter().find(|rate| rates_hz.contains(rate)).unwrap_or(first.rate_hz);
        bail!(
            "`--model`: these models are of {} and {} frames a second, and motions can be told apart at one rate only; \
             make the tables of your own model by `sinew angles --rate {wanted_hz}`, then cut and train it anew",
            first.rate_hz,
            other.rate_hz
        );
    }
    if let Some(other) = models.iter().map(CyclicModel::numbers).find(|other| other.angle_count != first.angle_count) {
        bail!(
            "`--model`: these models have {} and {} angles, and motions can be told apart by models of one number of \
             angles only; train them alike, all with `sinew angles --view space` or all without",
            first.angle_count,
            other.angle_count
        );
    }
    Ok(())
}

/// The filters of all models over one table, row by row.
#[derive(Debug)]
pub struct TableRun<'a> {
    table: &'a AngleTable,
    models: &'a [CyclicModel],
    options: &'a TrackingOptions,
    walks: Walks<'a>,
    /// Frames per second of the recording, and frames of the model in one of these.
    rates: (f64, f64),
}

/// One filter a model.
#[derive(Debug)]
enum Walks<'a> {
    Plane(Vec<Kept<'a, ANGLES>>),
    Space(Vec<Kept<'a, SPACE_ANGLES>>),
}

impl<'a> TableRun<'a> {
    /// Filters at the first row with an angle (see [`super::StartName`]), which is answered with
    /// the first state. With several models the likeliest motion of each row is named and
    /// shown.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long, or a table without any angle.
    /// No model or too many, or models that differ in rate or number of angles.
    pub fn begin(table: &'a AngleTable, models: &'a [CyclicModel], options: &'a TrackingOptions) -> Result<Self> {
        options.check()?;
        ensure!(
            (1..=MAX_MOTIONS).contains(&models.len()),
            "`--model`: 1 to {MAX_MOTIONS} motions can be told apart, not {}",
            models.len()
        );
        check_alike(models)?;
        check_angles(&models[0], table.angle_count() == SPACE_ANGLES)?;
        let (walks, rates) = if is_spatial(&models[0]) {
            let walks = walks(table, models, options)?;
            let rates = walks[0].rates();
            (Walks::Space(walks), rates)
        } else {
            let walks = walks(table, models, options)?;
            let rates = walks[0].rates();
            (Walks::Plane(walks), rates)
        };
        Ok(Self { table, models, options, rates, walks })
    }

    /// Rows that are answered.
    #[must_use]
    pub fn finished(&self) -> usize {
        match &self.walks {
            Walks::Plane(walks) => walks[0].finished(),
            Walks::Space(walks) => walks[0].finished(),
        }
    }

    /// Rows of the table.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.table.rows().len()
    }

    /// Answers all rows, or those before `stop` says so; `notify` gets their number after each.
    /// Returns whether the last one was reached.
    ///
    /// # Errors
    /// None for rows of the table.
    pub fn run(&mut self, stop: &dyn Fn() -> bool, notify: &mut dyn FnMut(usize)) -> Result<bool> {
        while self.finished() < self.rows() {
            if stop() {
                return Ok(false);
            }
            self.step()?;
            notify(self.finished());
        }
        Ok(true)
    }

    fn step(&mut self) -> Result<()> {
        match &mut self.walks {
            Walks::Plane(walks) => walks.iter_mut().try_for_each(Kept::step),
            Walks::Space(walks) => walks.iter_mut().try_for_each(Kept::step),
        }
    }

    /// What was answered so far, as if the table ended there, and where there are several models
    /// the motion of each row.
    ///
    /// # Errors
    /// None for rows of the table.
    pub fn answered(&self) -> Result<(Tracked, Option<Vec<NamedMotion>>)> {
        match &self.walks {
            Walks::Plane(walks) => self.collected(walks),
            Walks::Space(walks) => self.collected(walks),
        }
    }

    fn collected<const N: usize>(&self, walks: &[Kept<'_, N>]) -> Result<(Tracked, Option<Vec<NamedMotion>>)> {
        let (rate_hz, step_frames) = self.rates;
        let run = |walk: &Kept<'_, N>| Tracked { frames: walk.frames(), rate_hz, step_frames };
        let mut runs: Vec<Tracked> = walks.iter().map(run).collect();
        if runs.len() == 1 {
            return Ok((runs.remove(0), None));
        }
        let motions = named::<N>(self.table, self.models, &runs, self.options)?;
        Ok((shown(&runs, &motions), Some(motions)))
    }

    /// The state after the last row that is answered as text, which [`TableRun::restore`] takes;
    /// `None` where the whole recording is asked for: the way back needs the states of all
    /// rows, which are sooner computed again than read.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<Option<String>> {
        if self.options.smooth {
            return Ok(None);
        }
        Ok(Some(to_text(StateKind::Cyclic, &mut self.walks)?))
    }

    /// Goes on from a state that was saved after `finished` rows with the same table, models and
    /// options.
    ///
    /// # Errors
    /// The text is not whole, or of another run.
    pub fn restore(&mut self, finished: usize, saved: Option<&str>) -> Result<()> {
        match saved {
            Some(text) => {
                from_text(StateKind::Cyclic, text, &mut self.walks)?;
                self.walks.go_on();
            }
            None => {
                while self.finished() < finished.min(self.rows()) {
                    self.step()?;
                }
            }
        }
        ensure!(self.is_at(finished), "what the run left does not fit its number of rows; {REMEDY}");
        Ok(())
    }

    /// Whether each model has answered so many rows, the first one with an angle among them.
    fn is_at(&self, finished: usize) -> bool {
        fn all_at<const N: usize>(walks: &[Kept<'_, N>], finished: usize) -> bool {
            walks.iter().all(|walk| walk.finished() == finished && walk.first() < finished)
        }
        finished <= self.rows()
            && match &self.walks {
                Walks::Plane(walks) => all_at(walks, finished),
                Walks::Space(walks) => all_at(walks, finished),
            }
    }
}

impl Walks<'_> {
    fn go_on(&mut self) {
        match self {
            Self::Plane(walks) => walks.iter_mut().for_each(Kept::go_on),
            Self::Space(walks) => walks.iter_mut().for_each(Kept::go_on),
        }
    }
}

impl SavedState for Walks<'_> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        match self {
            Self::Plane(walks) => walks.iter_mut().for_each(|walk| walk.visit(visitor)),
            Self::Space(walks) => walks.iter_mut().for_each(|walk| walk.visit(visitor)),
        }
    }
}

fn walks<'a, const N: usize>(
    table: &'a AngleTable,
    models: &'a [CyclicModel],
    options: &'a TrackingOptions,
) -> Result<Vec<Kept<'a, N>>> {
    models.iter().map(|model| Kept::begin(table, model.view(), options)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::SyntheticPerson;

    #[test]
    fn a_state_whose_models_answered_unlike_rows_is_refused() {
        let models = ["walking", "running"].map(|name| CyclicModel::from_option(name).unwrap());
        let table = SyntheticPerson::draw(&models[0], 60.0, 1).unwrap().measured(1, 0.05, 0.0, 1).unwrap();
        let options = TrackingOptions::default();
        let begin = || TableRun::begin(&table, &models, &options).unwrap();
        let mut run = begin();
        run.step().unwrap();
        let finished = run.finished();
        begin().restore(finished, run.saved().unwrap().as_deref()).unwrap();
        if let Walks::Plane(walks) = &mut run.walks {
            walks[1].step().unwrap();
        }
        let message = begin().restore(finished, run.saved().unwrap().as_deref()).unwrap_err().to_string();
        assert!(message.contains("does not fit its number of rows"), "{message}");
    }
}
