//! A second hypothesis: another place in the cycle, which the grid names, or another speed at the
//! start.
//!
//! Leader and rival see the same frames, and each learns its person. Their log-likelihoods, summed
//! since the rival began, decide which of them leads: the sequential probability ratio test of
//! Wald 1945, Sequential Tests of Statistical Hypotheses, Annals of Mathematical Statistics 16.
//! What a rival has to learn of the person counts against it, as in a Bayes factor.

use crate::cyclic::CoupledModel;
use crate::cyclic::coupled::constants::{MIN_DIFFERENCE_CYCLES, MIN_LOG_ODDS, SPEED_SPREAD};
use crate::cyclic::coupled::hypothesis::Hypothesis;
use crate::cyclic::coupled::phase::evidence::FrameInnovation;
use crate::cyclic::coupled::phase::phase_grid::PhaseMode;
use crate::cyclic::phase::position_difference;
use crate::math::{abs, clamp};
use crate::saved_state::{SavedState, StateVisitor};

/// Largest ln of the ratio that is kept, either way. Chosen: beyond any that frames give.
const MAX_LOG_ODDS: f32 = 1.0e6;

/// Whether two positions are different places in the cycle.
pub(crate) fn is_elsewhere(one: f32, other: f32) -> bool {
    abs(position_difference(one, other)) > MIN_DIFFERENCE_CYCLES
}

/// The second hypothesis and what speaks for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rival<const N: usize> {
    pub(crate) hypothesis: Hypothesis<N>,
    exists: bool,
    /// ln of its likelihood over the leader's since it began.
    log_odds: f32,
}

impl<const N: usize> SavedState for Rival<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.hypothesis.visit(visitor);
        visitor.flag(&mut self.exists);
        visitor.real(&mut self.log_odds, &(-MAX_LOG_ODDS..=MAX_LOG_ODDS));
    }
}

impl<const N: usize> Rival<N> {
    /// Without a rival.
    pub(crate) const fn none() -> Self {
        Self { hypothesis: Hypothesis::empty(), exists: false, log_odds: 0.0 }
    }

    /// Whether there is one.
    pub(crate) const fn exists(&self) -> bool {
        self.exists
    }

    /// Resets to no rival; what is left of one would be saved with the state.
    pub(crate) fn forget(&mut self, model: &CoupledModel<'_>) {
        self.hypothesis.forget(model);
        (self.exists, self.log_odds) = (false, 0.0);
    }

    /// Ends the rival.
    pub(crate) const fn end(&mut self) {
        self.exists = false;
    }

    /// Whether it is at the grid's `mode` already.
    pub(crate) fn is_at(&self, mode: &PhaseMode) -> bool {
        self.exists && !is_elsewhere(mode.position, self.hypothesis.position)
    }

    /// Begins at the grid's mode with an unknown person, as the hypothesis of that number.
    pub(crate) fn begin_at(&mut self, model: &CoupledModel<'_>, at: (&PhaseMode, u32), leader: &Hypothesis<N>) {
        self.hypothesis.begin_at(model, at, leader);
        (self.exists, self.log_odds) = (true, 0.0);
    }

    /// Begins at the leader's place with its person, faster by so many standard deviations of the
    /// speeds of people. The odds are even.
    pub(crate) fn begin_faster(&mut self, leader: &Hypothesis<N>, deviations: f32) {
        self.hypothesis = *leader;
        self.hypothesis.velocity *= 1.0 + deviations * SPEED_SPREAD;
        self.hypothesis.number = leader.number.wrapping_add(1);
        (self.exists, self.log_odds) = (true, 0.0);
    }

    /// Adds a frame by the innovations of rival and leader; returns whether the rival leads from
    /// here on.
    pub(crate) fn beats(&mut self, own: &FrameInnovation, leaders: &FrameInnovation) -> bool {
        let more = own.log_likelihood - leaders.log_likelihood;
        self.log_odds = clamp(self.log_odds + more, -MAX_LOG_ODDS, MAX_LOG_ODDS);
        self.log_odds > MIN_LOG_ODDS
    }
}
