//! Effect of a jump: the filter continues from the grid's phase, or fuses it with its own.

use crate::cyclic::coupled::block::PARTS;
use crate::cyclic::coupled::cycle_pair::{CyclePair, Information};
use crate::cyclic::coupled::phase_grid::PhaseMode;
use crate::cyclic::coupled::spread_scale::SpreadScale;
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::coupled::winding::Winding;
use crate::cyclic::phase::position_difference;
use crate::cyclic::recognition::explained_variance::ExplainedVariance;
use crate::cyclic::{AngleMeasurement, CoupledModel};

/// Inflation of the grid's variances when its phase is fused.
///
/// Chosen: grid and filter see the same measurements, so their errors are not independent.
const GRID_VARIANCE_INFLATION: f32 = 3.0;

impl<const N: usize> CoupledFilter<N> {
    /// Corrects position and velocity by the grid's mode, as by a measurement of both.
    pub(super) fn fuse_grid_phase(&mut self, model: &CoupledModel<'_>, mode: &PhaseMode) {
        let way = position_difference(position_difference(mode.position, self.position), self.watch.mean_phase_offset);
        let mut information = Information::NONE;
        information.add(&[1.0, 0.0], 1.0 / (GRID_VARIANCE_INFLATION * mode.covariance[0]), way);
        information.add(
            &[0.0, 1.0],
            1.0 / (GRID_VARIANCE_INFLATION * mode.covariance[2]),
            mode.velocity - self.velocity,
        );
        let shift = self.pair.correct(&information);
        self.blocks.iter_mut().for_each(|block| block.follow(shift));
        self.shift_by(model, shift);
    }

    /// Learns from one measurement how the person differs from the mean cycle at the present phase.
    /// The phase does not move.
    pub(super) fn learn_offsets_here(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) {
        let (velocity, pair) = (self.velocity, self.pair);
        self.pair = CyclePair { cc: 1.0e-8, cv: 0.0, vv: 1.0e-12 };
        self.correct_phase(model, measurement);
        (self.velocity, self.pair) = (velocity, pair);
    }

    /// Continues from the phase of `mode`. What was learned of the person does not depend on it.
    pub(super) fn relock_to(&mut self, mode: &PhaseMode) {
        self.move_by(position_difference(mode.position, self.position));
        self.velocity = mode.velocity;
        self.drift = 0.0;
        let [cc, cv, vv] = mode.covariance;
        self.pair = CyclePair { cc, cv, vv };
        for block in &mut self.blocks {
            block.regression = [[0.0; 2]; PARTS];
        }
        self.watch.searching = false;
        self.watch.agrees = false;
        self.relocks = self.relocks.wrapping_add(1);
        self.watch.disagreement_frames = 0.0;
        self.watch.nis.restart();
        self.swing = ExplainedVariance::new();
        self.spread_scale = SpreadScale::new();
        self.winding = Winding::new();
    }
}
