//! Where the filter's linearisation does not hold: a grid of phases runs beside it. Its mode is
//! where a search ends and where a rival begins.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::constants::{
    GRID_INTERVAL_FRAMES, LINEAR_CYCLES, MAX_WINDING_DIFFERENCE_CYCLES, MIN_MODE_WEIGHT, MISFIT_CYCLES,
};
use crate::cyclic::coupled::hypothesis::rival::is_elsewhere;
use crate::cyclic::coupled::measurement::winding::Winding;
use crate::cyclic::coupled::phase::phase_grid::{PhaseGrid, PhaseMode, is_standing};
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::phase::position_difference;
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::abs;

impl<const N: usize> CoupledFilter<N> {
    /// Updates the grid by a measurement, and acts on its mode.
    ///
    /// Returns the grid's mode if the grid was updated.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn watch(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> Option<PhaseMode> {
        let frames = self.unwatched_frames;
        if self.leader.pair.cc > LINEAR_CYCLES * LINEAR_CYCLES {
            self.searching = true;
            self.end_rival();
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
    /// at once, and so does one that stands where the grid moves: its deviations follow any motion,
    /// so its likelihood says nothing.
    fn compare(&mut self, model: &CoupledModel<'_>, mode: &PhaseMode) {
        if !is_elsewhere(mode.position, self.leader.position) || !is_on(Part::Rival) {
            if self.second_speed_cycles == 0.0 {
                self.end_rival();
            }
            return;
        }
        if !self.rival.is_at(mode) {
            let number = self.next_number();
            self.second_speed_cycles = 0.0;
            self.rival.begin_at(model, (mode, number), &self.leader);
        }
        let misfits = self.leader.spread_scale.is_doubtful();
        let stands = is_standing(model, self.leader.velocity) && !is_standing(model, mode.velocity);
        if (misfits || stands) && is_on(Part::GivingWay) {
            self.misfit_cycles = if misfits { MISFIT_CYCLES } else { self.misfit_cycles };
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
        let number = self.next_number();
        self.leader.move_to(mode, number);
        self.searching = false;
        self.winding = Winding::new();
    }

    /// The rival leads from here on. They change places, since a copy would stand on the stack.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(super) fn lead_by_rival(&mut self) {
        core::mem::swap(&mut self.leader, &mut self.rival.hypothesis);
        self.end_rival();
        self.winding = Winding::new();
    }

    /// Without a rival from here on.
    const fn end_rival(&mut self) {
        self.second_speed_cycles = 0.0;
        self.rival.end();
    }

    /// Number of the hypothesis that begins now.
    const fn next_number(&mut self) -> u32 {
        self.hypotheses = self.hypotheses.wrapping_add(1);
        self.hypotheses
    }
}
