//! An arm tracker's state as it is saved.

use super::estimate::ArmJoints;
use super::frame::MAX_CANDIDATES;
use super::limbs::LimbDensities;
use super::memory::BlobMemory;
use super::pair::ArmPair;
use super::particle::Particle;
use super::state::ArmTracker;
use crate::math::Vec3;
use crate::saved_state::{FINITE, NOT_NEGATIVE, SavedState, StateVisitor};

/// No place and no speed of an arm is greater, metres and metres per second.
/// Chosen: refuses a corrupt state, never a tracked one.
const MAX_M: f32 = 1.0e6;

fn place(value: &mut Vec3, visitor: &mut impl StateVisitor) {
    visitor.reals(value.as_mut_slice(), &(-MAX_M..=MAX_M));
}

impl SavedState for Particle {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.angles_rad, &FINITE);
        place(&mut self.elbow_m, visitor);
        place(&mut self.hand_m, visitor);
        let mut driver = self.driver.map_or(0, |driver| usize::from(driver) + 1);
        visitor.index(&mut driver, MAX_CANDIDATES);
        self.driver = driver.checked_sub(1).map(|driver| driver as u8);
    }
}

impl SavedState for ArmJoints {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        place(&mut self.shoulder_m, visitor);
        place(&mut self.elbow_m, visitor);
        place(&mut self.hand_m, visitor);
    }
}

impl SavedState for LimbDensities {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.upper.visit(visitor);
        self.fore.visit(visitor);
    }
}

impl SavedState for BlobMemory {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.length(&mut self.blobs, super::memory::Remembered::default());
        for blob in &mut self.blobs {
            for pixel in [&mut blob.centre, &mut blob.anchor] {
                visitor.real(&mut pixel.u_px, &FINITE);
                visitor.real(&mut pixel.v_px, &FINITE);
            }
            visitor.real(&mut blob.belief, &(0.0..=1.0));
            visitor.real(&mut blob.still_s, &NOT_NEGATIVE);
            visitor.flag(&mut blob.is_confirmed);
        }
    }
}

impl<const CAPACITY: usize> SavedState for ArmTracker<CAPACITY> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.seed);
        visitor.long(&mut self.frame);
        visitor.optional_long(&mut self.timestamp_us);
        visitor.real(&mut self.unseen_s, &(0.0..=60.0));
        visitor.flag(&mut self.ever_seen);
        // The other generation is written before it is read.
        let [even, odd] = &mut self.generations;
        let particles = if self.current & 1 == 0 { even } else { odd };
        visitor.length(particles, Particle::default());
        for particle in particles.iter_mut() {
            particle.visit(visitor);
        }
        self.weights.visit(visitor);
        if self.weights.len() != particles.len() {
            visitor.refuse();
        }
        self.limbs.visit(visitor);
        self.memory.visit(visitor);
        visitor.flag(&mut self.hand_is_confirmed);
        self.estimate.visit(visitor);
        place(&mut self.hand_velocity_m_per_s, visitor);
        place(&mut self.elbow_velocity_m_per_s, visitor);
    }
}

impl<const CAPACITY: usize> SavedState for ArmPair<CAPACITY> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for tracker in &mut self.trackers {
            tracker.visit(visitor);
        }
    }
}
