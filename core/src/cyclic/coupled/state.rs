//! State of the phase-coupled filter: measurements move the cycle position, and a person's
//! deviation is learned.

use crate::angle::split_turns;
use crate::cyclic::AngleMeasurement;
use crate::cyclic::CoupledModel;
use crate::cyclic::coupled::hypothesis::Hypothesis;
use crate::cyclic::coupled::hypothesis::rival::Rival;
use crate::cyclic::coupled::measurement::measured_path::MeasuredPath;
use crate::cyclic::coupled::measurement::measurement_noise::MeasurementNoise;
use crate::cyclic::coupled::measurement::winding::Winding;
use crate::cyclic::coupled::person::block::Basis;
use crate::cyclic::coupled::phase::stored_grid::StoredGrid;
use crate::math::wrap_angle;

/// State of the filter `coupled` for models of up to `N` angles.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::phase::position_difference;
/// use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
///
/// // A person walks into view at an unknown phase: the filter searches the whole cycle.
/// let model = WALKING.model()?;
/// let position = |frame: u8| 0.7 + f32::from(frame) * model.mean_cycle_velocity();
/// let seen = |frame| AngleMeasurement::new(&model.mean_pose_rad::<13>(model.point(position(frame))).map(Some), 0.3);
/// let mut filter = CoupledFilter::anywhere(&model, &seen(0)?)?;
/// assert!(filter.is_searching());
/// for frame in 1..=90 {
///     filter.step(&model, &seen(frame)?);
/// }
/// assert!(!filter.is_searching());
/// assert!(position_difference(filter.cycle().position, position(90)).abs() < 0.02);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledFilter<const N: usize> {
    /// Place and person of the estimate.
    pub(super) leader: Hypothesis<N>,
    /// The start's second speed, then another place where the grid names one.
    pub(super) rival: Rival<N>,
    pub(super) grid: StoredGrid,
    /// Frames since the grid last moved.
    pub(super) unwatched_frames: f32,
    /// Whether the phase is unknown, so that the estimate is the mean over the grid.
    pub(super) searching: bool,
    /// Cycles of the model for which the rows still count as another motion.
    pub(super) misfit_cycles: f32,
    /// Cycles of the model for which the rival is the start's second speed.
    pub(super) second_speed_cycles: f32,
    pub(super) noise: MeasurementNoise<N>,
    pub(super) angles_rad: [f32; N],
    pub(super) turns: [i32; N],
    pub(super) winding: Winding<N>,
    pub(super) path: MeasuredPath<N>,
    /// Number of hypotheses that began after the first.
    pub(super) hypotheses: u32,
}

const _: () = assert!(size_of::<CoupledFilter<13>>() <= 4096, "the state has to fit 4 KiB");

impl<const N: usize> CoupledFilter<N> {
    /// A filter before [`Self::begin`], for static memory: zeros, which take no stack. Its
    /// estimates are meaningless.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            leader: Hypothesis::empty(),
            rival: Rival::none(),
            grid: StoredGrid::empty(),
            unwatched_frames: 0.0,
            searching: false,
            misfit_cycles: 0.0,
            second_speed_cycles: 0.0,
            noise: MeasurementNoise::zero(),
            angles_rad: [0.0; N],
            turns: [0; N],
            winding: Winding::new(),
            path: MeasuredPath::new(),
            hypotheses: 0,
        }
    }

    /// Whether the phase is unknown, so that the estimate is the mean over the grid.
    #[must_use]
    pub const fn is_searching(&self) -> bool {
        self.searching
    }

    /// Cycles completed since the start (negative backwards).
    #[must_use]
    pub const fn cycles(&self) -> i32 {
        self.leader.cycles
    }

    /// Angles of the leader, with their turns.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(super) fn update_angles(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) {
        let pose = model.mean_pose_rad::<N>(model.point(self.leader.position));
        let basis = Basis::at(self.leader.position);
        self.winding.count_cycles(self.leader.cycles);
        for i in 0..model.angle_count().min(N) {
            let (before, angle) = (self.angles_rad[i], wrap_angle(pose[i] + self.leader.blocks[i].deviation(&basis)));
            self.turn_to(i, angle);
            let beyond = self.path.turns(i, [before, angle], measurement);
            self.turns[i] = self.turns[i].saturating_add(beyond);
            let turns_a_cycle = model.parts().turns_per_cycle.get(i).map_or(0, |turns| i32::from(*turns));
            self.winding.update(
                i,
                self.turns[i].wrapping_sub(turns_a_cycle.wrapping_mul(self.leader.cycles)),
                self.angles_rad[i] - pose[i],
            );
        }
        self.winding.initialise();
    }

    /// Sets an angle; its turns follow from the shorter way since the last one. Beyond `N` it does
    /// nothing.
    pub(super) fn turn_to(&mut self, index: usize, angle_rad: f32) {
        let (Some(last_rad), Some(turns)) = (self.angles_rad.get_mut(index), self.turns.get_mut(index)) else { return };
        let (_, turns_less) = split_turns(angle_rad - *last_rad);
        *turns = turns.saturating_sub(turns_less);
        *last_rad = angle_rad;
    }
}
