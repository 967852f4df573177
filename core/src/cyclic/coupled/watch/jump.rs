//! When the coupled filter takes the grid's phase in place of its own: all conditions for a jump.
//!
//! 1. While the filter is searching, it relocks as soon as one mode of the grid holds
//!    [`MIN_MODE_WEIGHT`].
//! 2. While it is locked, it relocks when such a mode has disagreed with it for
//!    [`MAX_DISAGREEMENT_FRAMES`] in a row, unless the filter overrules the grid. It overrules the
//!    grid when its NIS is good and its lock is not spurious.
//! 3. For [`FUSION_CYCLES`] after a relock, the grid's phase is fused with the filter's.

use super::agreement::MIN_MODE_WEIGHT;
use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::phase_grid::{PhaseGrid, PhaseMode};
use crate::cyclic::coupled::state::{CoupledFilter, LOST_STD};
use crate::cyclic::recognition::explained_variance::cycle_variances_rad2;
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::clamp;

/// Frames between two updates of the grid while the filter is locked.
///
/// Chosen: the grid costs as much as the filter, and neighbouring frames carry nearly the same
/// evidence.
const GRID_INTERVAL_FRAMES: f32 = 3.0;
/// Frames in a row of disagreement after which the filter relocks.
///
/// Chosen: a tenth of a second at 60 Hz.
const MAX_DISAGREEMENT_FRAMES: f32 = 6.0;
/// Cycles at the mean speed in which the filter learns a person. After them it may overrule the
/// grid.
///
/// Chosen: a little more than one cycle, so that every position was seen once.
const LEARNING_CYCLES: f32 = 1.5;
/// Cycles at the mean speed after a relock in which the grid's phase is fused with the filter's.
///
/// Chosen: until one cycle was measured, a small swing cannot be distinguished from a slow motion.
const FUSION_CYCLES: f32 = 1.2;
/// Share of the variance seen that the mean cycle may leave unexplained at the filter's phase.
///
/// Chosen between two measurements: at the right phase at most two thirds are unexplained, at a
/// wrong one or backwards at least nine tenths.
const MAX_UNEXPLAINED_SHARE: f32 = 0.9;
/// Smallest swing, as a share of the cycle's, from which a lock can be spurious. Chosen: who stands
/// does not swing.
const MIN_SWING_SHARE: f32 = 0.15;
/// Smallest filled part of the swing's memory from which a lock can be spurious. Chosen: a third of
/// a cycle.
const MIN_FILLED_SHARE: f32 = 0.28;
/// Positions at which the cycle's own variance is computed. Chosen: few, since each update checks
/// it.
const CYCLE_POSITIONS: u8 = 8;
/// Most frames for which one comparison with the grid counts. Chosen: a gap is no disagreement.
const MAX_GRID_FRAMES: f32 = 4.0;

impl<const N: usize> CoupledFilter<N> {
    /// Updates the grid by a measurement and relocks where a condition for a jump holds.
    ///
    /// Returns the grid's mode if the grid was updated.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(in crate::cyclic::coupled) fn watch(
        &mut self,
        model: &CoupledModel<'_>,
        measurement: &AngleMeasurement<N>,
    ) -> Option<PhaseMode> {
        let frames = self.watch.unwatched_frames;
        if self.pair.cc > LOST_STD * LOST_STD {
            self.watch.searching = true;
        }
        if !self.watch.searching && frames < GRID_INTERVAL_FRAMES {
            return None;
        }
        self.watch.unwatched_frames = 0.0;
        self.update_explained_variance(model, measurement, frames);
        let mode = self.update_grid(model, measurement, frames);
        let frames = clamp(frames, 1.0, MAX_GRID_FRAMES);
        if self.watch.searching {
            if mode.weight > MIN_MODE_WEIGHT {
                self.relock_to(&mode);
            }
            return Some(mode);
        }
        if self.velocity < 0.0 && !self.watch.nis.is_lost() && !self.is_spurious_lock(model, measurement) {
            // The grid has forward motion only.
            self.watch.agrees = false;
            return Some(mode);
        }
        self.watch.compare(&mode, self.position, frames);
        if self.watch.disagreement_frames > MAX_DISAGREEMENT_FRAMES
            && !self.overrules_grid(model, measurement)
            && is_on(Part::Relock)
        {
            // What was learned of the person since the last lock was learned at a wrong phase.
            self.forget_person(model);
            let position = mode.position - self.watch.mean_phase_offset;
            self.relock_to(&PhaseMode { position, ..mode });
            self.learn_offsets_here(model, measurement);
        } else if mode.weight > MIN_MODE_WEIGHT && self.was_relocked_lately(model) {
            self.fuse_grid_phase(model, &mode);
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

    /// Adds how much of the measurement the mean cycle explains at the filter's phase.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn update_explained_variance(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>, frames: f32) {
        let expected_rad = model.mean_pose_rad::<N>(model.point(self.position));
        self.swing.add(frames * model.mean_cycle_velocity(), measurement, &expected_rad);
    }

    /// Whether the filter has learned the person and predicts well by it. The grid knows the mean
    /// person only.
    fn overrules_grid(&self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> bool {
        is_on(Part::OverrulesGrid)
            && !self.spread_scale.is_misfit()
            && self.watch.nis.is_good(LEARNING_CYCLES / model.mean_cycle_velocity())
            && !self.is_spurious_lock(model, measurement)
    }

    /// Whether the person swings and the mean cycle, at the filter's phase, explains nothing of it.
    /// A good NIS is then due to deviations that follow any motion.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn is_spurious_lock(&self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> bool {
        if self.swing.filled_share() < MIN_FILLED_SHARE || !is_on(Part::SpuriousLock) {
            return false;
        }
        let cycle_rad2 = cycle_variances_rad2(model, CYCLE_POSITIONS);
        let unexplained = self.swing.unexplained_share(&cycle_rad2, measurement.std_rad());
        unexplained.is_some_and(|share| share > MAX_UNEXPLAINED_SHARE)
            && self.swing.swing_share(&cycle_rad2, measurement.std_rad()) > MIN_SWING_SHARE
    }

    /// Whether the filter relocked less than [`FUSION_CYCLES`] ago.
    fn was_relocked_lately(&self, model: &CoupledModel<'_>) -> bool {
        is_on(Part::Fusion) && self.relocks > 0 && self.watch.nis.is_new(FUSION_CYCLES / model.mean_cycle_velocity())
    }
}
