//! State of the phase-coupled filter: measurements move the cycle position, and a person's
//! deviation is learned.
//!
//! An angle is the mean cycle at c plus its deviation ([`crate::cyclic::Deviation`]). Given (c, v)
//! the angles are taken as independent of each other, and each has a block of five numbers. All
//! together inform (c, v), and (c, v) informs each.

use crate::angle::split_turns;
use crate::cyclic::CoupledModel;
use crate::cyclic::coupled::block::{AngleBlock, Spread};
use crate::cyclic::coupled::cycle_pair::CyclePair;
use crate::cyclic::coupled::measured_path::MeasuredPath;
use crate::cyclic::coupled::measurement_noise::MeasurementNoise;
use crate::cyclic::coupled::spread_scale::SpreadScale;
use crate::cyclic::coupled::stored_grid::StoredGrid;
use crate::cyclic::coupled::watch::agreement::Watch;
use crate::cyclic::coupled::winding::Winding;
use crate::cyclic::phase::wrap_position;
use crate::cyclic::recognition::explained_variance::ExplainedVariance;
use crate::math::{clamp, round};

/// Standard deviation of c, cycles, above which the linearisation does not hold and the filter
/// searches by the grid. Chosen: about a sixth of a cycle, over which the mean pose is no straight
/// line.
pub(super) const LOST_STD: f32 = 0.15;

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
    pub(super) blocks: [AngleBlock; N],
    pub(super) angles_rad: [f32; N],
    pub(super) turns: [i32; N],
    pub(super) position: f32,
    pub(super) velocity: f32,
    /// Covariance of position and velocity.
    pub(super) pair: CyclePair,
    pub(super) cycles: i32,
    pub(super) grid: StoredGrid,
    pub(super) watch: Watch,
    pub(super) noise: MeasurementNoise<N>,
    pub(super) spread_scale: SpreadScale,
    /// Innovation of each angle in the last frame that had it, rad.
    pub(super) last_innovation_rad: [f32; N],
    pub(super) winding: Winding<N>,
    pub(super) path: MeasuredPath<N>,
    /// Variance that the mean cycle explains at the filter's position.
    pub(super) swing: ExplainedVariance<N>,
    /// Mean correction of the position in a frame over about a cycle, cycles. Corrections within a
    /// cycle cancel where the velocity is right; over half a cycle the mean is half again as
    /// unsteady.
    pub(super) drift: f32,
    /// Number of relocks.
    pub(super) relocks: u16,
}

const _: () = assert!(size_of::<CoupledFilter<13>>() <= 2732, "the state has to fit 2.7 KiB");

impl<const N: usize> CoupledFilter<N> {
    /// A filter before [`Self::begin`], for static memory: it takes no stack. Its estimates are
    /// meaningless.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            blocks: [AngleBlock::zero(); N],
            angles_rad: [0.0; N],
            turns: [0; N],
            position: 0.0,
            velocity: 0.0,
            pair: CyclePair { cc: 0.0, cv: 0.0, vv: 0.0 },
            cycles: 0,
            grid: StoredGrid::empty(),
            watch: Watch::new(),
            noise: MeasurementNoise::new(),
            spread_scale: SpreadScale::new(),
            last_innovation_rad: [0.0; N],
            winding: Winding::new(),
            path: MeasuredPath::new(),
            drift: 0.0,
            relocks: 0,
            swing: ExplainedVariance::new(),
        }
    }

    /// Whether the phase is unknown, so that the estimate is the mean over the grid.
    #[must_use]
    pub const fn is_searching(&self) -> bool {
        self.watch.searching
    }

    /// Cycles completed since the start (negative backwards).
    #[must_use]
    pub const fn cycles(&self) -> i32 {
        self.cycles
    }

    /// Corrects position and velocity by `shift`, and averages the position's corrections.
    pub(super) fn shift_by(&mut self, model: &CoupledModel<'_>, shift: [f32; 2]) {
        let way = clamp(shift[0], -0.5, 0.5);
        self.velocity = clamp(self.velocity + shift[1], -0.5, 0.5);
        self.drift += model.mean_cycle_velocity() * way;
        self.move_by(way);
    }

    /// Forgets a frame's part of the corrections of the position.
    pub(super) fn forget_drift(&mut self, model: &CoupledModel<'_>) {
        self.drift -= model.mean_cycle_velocity() * self.drift;
    }

    /// Speed at which the position moved, corrections included, cycles per frame.
    ///
    /// A person whom the model does not fit moves position and velocity by corrections that do not
    /// cancel over a cycle, so the velocity alone is not the rate of the cycles. Where an angle
    /// winds, it is: corrections there are few and large.
    pub(super) fn travelled_velocity(&self, model: &CoupledModel<'_>) -> f32 {
        if model.winds() { self.velocity } else { self.velocity + self.drift }
    }

    pub(super) fn move_by(&mut self, way: f32) {
        let position = self.position + way;
        let wrapped = wrap_position(position);
        self.cycles = self.cycles.saturating_add(round(position - wrapped) as i32);
        self.position = wrapped;
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

/// Stationary spread of an angle's parts.
#[cfg_attr(target_arch = "x86_64", inline(always))]
pub(super) fn spread(model: &CoupledModel<'_>, index: usize) -> Spread {
    let deviation = &model.parts().deviation;
    let at = |values: &[f32]| values.get(index).copied().unwrap_or(1.0);
    let square = |std: f32| std * std;
    Spread {
        offset: square(at(deviation.offset_std_rad)),
        swing: square(at(deviation.swing_std_rad)),
        rest: square(at(deviation.rest_std_rad)),
        rate: at(deviation.rest_rate_per_cycle),
    }
}
