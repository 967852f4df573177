//! The answer to one cloud, as a run keeps and saves it.

use crate::body::tracking::filter::WholeBodyEstimate;
use crate::resume::{real, reals};
use sinew_core::math::Vec3;
use sinew_core::saved_state::{SavedState, StateVisitor};
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES};

/// A finished frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Answer {
    pub frame: u64,
    pub estimate: WholeBodyEstimate,
}

/// What an answer is before it is read.
pub(super) const NO_ANSWER: Answer = Answer {
    frame: 0,
    estimate: WholeBodyEstimate {
        angles_rad: [0.0; BODY_ANGLES],
        ends_m: [Vec3::new(0.0, 0.0, 0.0); BODY_BONES],
        spread_m: [0.0; BODY_BONES],
        observed: [false; BODY_BONES],
        effective_sample_size: 0.0,
        log_evidence: 0.0,
        tempering: 0.0,
        is_degenerate: false,
    },
};

impl SavedState for Answer {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.frame);
        let estimate = &mut self.estimate;
        reals(&mut estimate.angles_rad, visitor);
        estimate.ends_m.iter_mut().for_each(|end| reals(end.as_mut_slice(), visitor));
        reals(&mut estimate.spread_m, visitor);
        estimate.observed.iter_mut().for_each(|flag| visitor.flag(flag));
        for value in [&mut estimate.effective_sample_size, &mut estimate.log_evidence, &mut estimate.tempering] {
            real(value, visitor);
        }
        visitor.flag(&mut estimate.is_degenerate);
    }
}
