//! Who goes on: ancestors by weight, and which candidate drives each one's hand.

use super::context::FrameContext;
use super::particle::Particle;
use crate::particle::resampling::{permute, systematic};
use crate::random::Stream;
use heapless::Vec;

/// Systematic resampling, then a permutation, so that the order of the ancestors does not decide
/// who drives them.
pub(super) fn select_ancestors<const CAPACITY: usize>(weights: &[f32], mut stream: Stream) -> Vec<u16, CAPACITY> {
    let mut ancestors: Vec<u16, CAPACITY> = Vec::new();
    // As many as there are particles, so it always fits.
    let _ = ancestors.resize(weights.len(), 0);
    systematic(weights, stream.uniform(), &mut ancestors);
    permute(&mut ancestors, &mut stream);
    ancestors
}

impl FrameContext<'_> {
    /// Which candidate drives each ancestor's hand, if any.
    ///
    /// Unpaid, an ancestor that is at a blob stays with it while that blob has particles left: sent
    /// elsewhere it would only meet the gate. The others, and all where the weight corrects for
    /// goals, are assigned in the given (permuted) order.
    pub fn assign_drivers<'p, const CAPACITY: usize>(
        &self,
        ancestors: impl Iterator<Item = Option<&'p Particle>>,
    ) -> Vec<Option<usize>, CAPACITY> {
        let corrects_weight = self.model.options().variant.traits().corrects_weight;
        let mut left = self.counts;
        let mut drivers: Vec<Option<usize>, CAPACITY> = Vec::new();
        for ancestor in ancestors {
            let place = ancestor.filter(|_| !corrects_weight).and_then(|p| self.model.camera().project(&p.hand_m));
            let own = self.candidate_at(place).filter(|&index| left.get(index).is_some_and(|&n| n > 0));
            if let Some(count) = own.and_then(|index| left.get_mut(index)) {
                *count -= 1;
            }
            // One entry a particle, so it always fits.
            let _ = drivers.push(own);
        }
        let mut rest = left.iter().enumerate().flat_map(|(blob, &n)| (0..n).map(move |_| blob));
        for driver in drivers.iter_mut().filter(|driver| driver.is_none()) {
            *driver = rest.next();
        }
        drivers
    }
}
