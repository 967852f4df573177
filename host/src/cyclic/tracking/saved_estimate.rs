//! An estimate as saved state.

use crate::resume::{real, reals};
use sinew_core::cyclic::CyclicEstimate;
use sinew_core::saved_state::StateVisitor;

/// Shows all numbers of an estimate.
pub(super) fn visit_estimate<const N: usize>(estimate: &mut CyclicEstimate<N>, visitor: &mut impl StateVisitor) {
    reals(&mut estimate.angles_rad, visitor);
    estimate.turns.iter_mut().for_each(|turns| visitor.integer(turns));
    reals(&mut estimate.angle_variance_rad2, visitor);
    for value in [
        &mut estimate.cycle_position,
        &mut estimate.cycle_position_variance,
        &mut estimate.cycle_velocity_per_frame,
        &mut estimate.cycle_velocity_variance,
        &mut estimate.log_likelihood,
    ] {
        real(value, visitor);
    }
    visitor.flag(&mut estimate.outlier);
    visitor.flag(&mut estimate.misfit);
}
