//! A body tracker's state as it is saved.

use super::rival::Rival;
use super::state::BodyTracker;
use super::velocity::{EstimateVelocity, Velocity};
use crate::math::Vec3;
use crate::pik::motion::BodyParticle;
use crate::saved_state::{SavedState, StateVisitor};
use core::ops::RangeInclusive;

/// Any number of a state. Chosen: refuses a corrupt state, never a tracked one, and squares of such
/// numbers are far from the greatest `f32`.
pub(super) const NUMBER: RangeInclusive<f32> = -1.0e9..=1.0e9;

pub(super) fn places(values: &mut [Vec3], visitor: &mut impl StateVisitor) {
    for value in values {
        visitor.reals(value.as_mut_slice(), &NUMBER);
    }
}

impl<const BONES: usize, const ANGLES: usize> SavedState for BodyParticle<BONES, ANGLES> {
    /// The log-weights are left out: each step sets them anew before it reads them.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.angles_rad, &NUMBER);
        places(&mut self.ends_m, visitor);
        visitor.reals(&mut self.memory, &NUMBER);
    }
}

impl<const BONES: usize, const ANGLES: usize> SavedState for Velocity<BONES, ANGLES> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.angles_per_s, &NUMBER);
        places(&mut self.ends_m_per_s, visitor);
    }
}

impl<const BONES: usize, const ANGLES: usize> SavedState for EstimateVelocity<BONES, ANGLES> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.last.visit(visitor);
        self.change.visit(visitor);
        visitor.flag(&mut self.is_known);
    }
}

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> SavedState for BodyTracker<BONES, ANGLES, N, S>
where
    S: AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// A state is for a tracker with as many particles. The other set, the ancestors and where the
    /// body is expected are written before they are read.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.seed);
        visitor.long(&mut self.frame);
        let particles = self.particles.as_mut();
        let mut count = particles.len();
        visitor.index(&mut count, N);
        if count != particles.len() {
            visitor.refuse();
            return;
        }
        for particle in particles.iter_mut() {
            particle.visit(visitor);
        }
        self.weights.visit(visitor);
        if self.weights.len() != count {
            visitor.refuse();
        }
        places(&mut self.first_m, visitor);
        self.before.visit(visitor);
        self.deadband.reported.visit(visitor);
        places(&mut self.deadband.off_m, visitor);
        self.velocity.visit(visitor);
        let mut is_rivalled = self.rival.is_some();
        visitor.flag(&mut is_rivalled);
        // Without a rival the same numbers are written, so that every state is as long.
        let blank = Rival { pose: self.before, velocity: self.velocity, log_weight: 0.0 };
        let mut rival = self.rival.unwrap_or(blank);
        rival.pose.visit(visitor);
        rival.velocity.visit(visitor);
        visitor.real(&mut rival.log_weight, &NUMBER);
        self.rival = is_rivalled.then_some(rival);
        visitor.reals(&mut self.noise.shares, &NUMBER);
        for is_unseen in &mut self.noise.is_unseen {
            visitor.flag(is_unseen);
        }
    }
}
