//! Where the filter's linearisation does not hold: a grid of phases runs beside it. Its mode is
//! where a search ends and where a rival begins.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::hypothesis::LOST_STD;
use crate::cyclic::coupled::phase_grid::{PhaseGrid, PhaseMode};
use crate::cyclic::coupled::rival::is_elsewhere;
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::coupled::winding::Winding;
use crate::cyclic::phase::position_difference;
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::abs;

/// Frames between two updates of the grid while the filter is locked.
///
/// Chosen: the grid costs as much as the filter, and neighbouring frames carry nearly the same
/// evidence.
const GRID_INTERVAL_FRAMES: f32 = 3.0;
/// Weight of a mode of the grid from which it counts as the only one. Chosen: nine to one. 0.8 and
/// 0.95 do as well.
const MIN_MODE_WEIGHT: f32 = 0.9;
/// Phase difference from which the leader moves to the grid's place in a motion with a winding
/// angle, cycles. Chosen: a quarter, half of the farthest.
const MAX_WINDING_DIFFERENCE_CYCLES: f32 = 0.25;
/// Cycles of the model for which the rows count as another motion after a leader has given way.
/// Chosen: in one cycle the next leader shows whether it fits.
const MISFIT_CYCLES: f32 = 1.0;

impl<const N: usize> CoupledFilter<N> {
    /// Updates the grid by a measurement, and acts on its mode.
    ///
    /// Returns the grid's mode if the grid was updated.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn watch(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> Option<PhaseMode> {
        let frames = self.unwatched_frames;
        if self.leader.pair.cc > LOST_STD * LOST_STD {
            self.searching = true;
            self.rival.end();
        }
        if !self.searching && frames < GRID_INTERVAL_FRAMES {
            return None;
        }
        self.unwatched_frames = 0.0;
        let mode = self.update_grid(model, measurement, frames);
        if mode.weight > MIN_MODE_WEIGHT {
            if self.searching {
                self.move_leader(&mode);
            } else if model.winds() {
                self.compare_winding(&mode);
            } else {
                self.compare(model, &mode);
            }
        }
        Some(mode)
    }

    /// Moves the grid on by `frames`, updates it by the measurement, and returns its mode.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn update_grid(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>, frames: f32) -> PhaseMode {
        let mut grid = PhaseGrid::uniform();
        self.grid.load_into(&mut grid);
        grid.advance(model, frames);
        grid.weigh(model, measurement);
        self.grid.store(&grid);
        grid.mode(model)
    }

    /// A place other than the leader's is the rival's. A leader that does not fit gives way to it
    /// at once: its deviations follow any motion, so its likelihood says nothing.
    fn compare(&mut self, model: &CoupledModel<'_>, mode: &PhaseMode) {
        if !is_elsewhere(mode.position, self.leader.position) || !is_on(Part::Rival) {
            self.rival.end();
            return;
        }
        self.rival.stand_at(model, mode, &self.leader);
        if self.leader.spread_scale.is_doubtful() && is_on(Part::GivingWay) {
            self.misfit_cycles = MISFIT_CYCLES;
            self.lead_by_rival();
        }
    }

    /// In an even circle an offset and a leading phase are the same, so likelihoods do not
    /// distinguish places, and the leader keeps its person.
    fn compare_winding(&mut self, mode: &PhaseMode) {
        if abs(position_difference(mode.position, self.leader.position)) > MAX_WINDING_DIFFERENCE_CYCLES {
            self.move_leader(mode);
        }
    }

    /// The leader goes on from the place of `mode`.
    fn move_leader(&mut self, mode: &PhaseMode) {
        self.leader.move_to(mode);
        self.searching = false;
        self.count_relock();
    }

    /// The rival leads from here on. They change places, since a copy would stand on the stack.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(super) fn lead_by_rival(&mut self) {
        core::mem::swap(&mut self.leader, &mut self.rival.hypothesis);
        self.rival.end();
        self.count_relock();
    }

    /// Counts that the leader's phase is independent of the frames before.
    fn count_relock(&mut self) {
        self.relocks = self.relocks.wrapping_add(1);
        self.winding = Winding::new();
    }
}
