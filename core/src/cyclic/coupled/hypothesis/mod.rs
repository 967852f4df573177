//! One hypothesis of the phase-coupled filter: a place in the cycle, and the person learned there.
//!
//! An angle is the mean cycle at c plus its deviation ([`crate::cyclic::Deviation`]). Given (c, v)
//! the angles are taken as independent of each other, and each has a block of five numbers. All
//! together inform (c, v), and (c, v) informs each.

pub(crate) mod correct;
pub mod predict;
pub(crate) mod rival;

use crate::cyclic::CoupledModel;
use crate::cyclic::coupled::constants::SPEED_SPREAD;
use crate::cyclic::coupled::person::block::{AngleBlock, PARTS, Spread};
use crate::cyclic::coupled::person::spread_scale::SpreadScale;
use crate::cyclic::coupled::phase::cycle_pair::CyclePair;
use crate::cyclic::coupled::phase::phase_grid::PhaseMode;
use crate::cyclic::phase::{POSITIONS_IN_CYCLE, position_difference, wrap_position};
use crate::cyclic::start::MAX_CYCLE_VELOCITY;
use crate::math::{clamp, max, round};
use crate::numeric::rolled::rolled;
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::PI;

/// Place and speed in the cycle with their covariance, and each angle's deviation given them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hypothesis<const N: usize> {
    pub(crate) blocks: [AngleBlock; N],
    pub(crate) position: f32,
    pub(crate) velocity: f32,
    /// Covariance of position and velocity.
    pub(crate) pair: CyclePair,
    /// Whole cycles since the start.
    pub(crate) cycles: i32,
    pub(crate) spread_scale: SpreadScale,
    /// Innovation of each angle in the last frame that had it, rad.
    pub(crate) last_innovation_rad: [f32; N],
    /// Mean correction of the position in a frame over about a cycle, cycles. Corrections within a
    /// cycle cancel where the velocity is right; over half a cycle the mean is half again as
    /// unsteady.
    drift: f32,
    /// Number of this hypothesis in the run. One that moves elsewhere is another.
    pub(crate) number: u32,
}

impl<const N: usize> SavedState for Hypothesis<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for block in &mut self.blocks {
            block.visit(visitor);
        }
        visitor.real(&mut self.position, &POSITIONS_IN_CYCLE);
        visitor.real(&mut self.velocity, &(-MAX_CYCLE_VELOCITY..=MAX_CYCLE_VELOCITY));
        self.pair.visit(visitor);
        visitor.integer(&mut self.cycles);
        self.spread_scale.visit(visitor);
        visitor.reals(&mut self.last_innovation_rad, &(-1.01 * PI..=1.01 * PI));
        visitor.real(&mut self.drift, &(-1.0..=1.0));
        visitor.word(&mut self.number);
    }
}

impl<const N: usize> Hypothesis<N> {
    /// Zeros, before [`Self::forget`]: they need neither flash nor stack.
    pub(crate) const fn empty() -> Self {
        Self {
            blocks: [AngleBlock::zero(); N],
            position: 0.0,
            velocity: 0.0,
            pair: CyclePair { cc: 0.0, cv: 0.0, vv: 0.0 },
            cycles: 0,
            spread_scale: SpreadScale::zero(),
            last_innovation_rad: [0.0; N],
            drift: 0.0,
            number: 0,
        }
    }

    /// Resets to position 0, the model's mean speed and an unknown person.
    pub(crate) fn forget(&mut self, model: &CoupledModel<'_>) {
        let velocity = model.mean_cycle_velocity();
        self.position = 0.0;
        self.velocity = velocity;
        self.pair =
            CyclePair { cc: 1.0e-5, cv: 0.0, vv: max(1.0e-6, SPEED_SPREAD * SPEED_SPREAD * velocity * velocity) };
        self.cycles = 0;
        self.number = 0;
        self.forget_person(model);
    }

    /// Resets what was learned of the person.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn forget_person(&mut self, model: &CoupledModel<'_>) {
        for (i, block) in self.blocks.iter_mut().enumerate().take(rolled(N)) {
            *block = AngleBlock::unknown(&spread(model, i));
        }
        self.spread_scale = SpreadScale::new();
        self.last_innovation_rad = [0.0; N];
        self.drift = 0.0;
    }

    /// Begins with an unknown person at the place and speed of `mode`, the shorter way from where
    /// `other` is.
    pub(crate) fn begin_at(&mut self, model: &CoupledModel<'_>, (mode, number): (&PhaseMode, u32), other: &Self) {
        self.forget_person(model);
        (self.cycles, self.position) = (other.cycles, other.position);
        self.move_to(mode, number);
    }

    /// Moves to the place and speed of `mode`, as the hypothesis of that number. What was learned
    /// of the person stays.
    pub(crate) fn move_to(&mut self, mode: &PhaseMode, number: u32) {
        self.number = number;
        self.move_by(position_difference(mode.position, self.position));
        self.velocity = mode.velocity;
        self.drift = 0.0;
        let [cc, cv, vv] = mode.covariance;
        self.pair = CyclePair { cc, cv, vv };
        for block in &mut self.blocks {
            block.regression = [[0.0; 2]; PARTS];
        }
    }

    /// Corrects position and velocity by `shift`, and averages the position's corrections.
    pub(crate) fn shift_by(&mut self, model: &CoupledModel<'_>, shift: [f32; 2]) {
        let way = clamp(shift[0], -0.5, 0.5);
        self.velocity = clamp(self.velocity + shift[1], -0.5, 0.5);
        self.drift += model.mean_cycle_velocity() * (way - self.drift);
        self.move_by(way);
    }

    /// Speed at which the position moved, corrections included, cycles per frame.
    ///
    /// A person whom the model does not fit moves position and velocity by corrections that do not
    /// cancel over a cycle, so the velocity alone is not the rate of the cycles. Where an angle
    /// winds, it is: corrections there are few and large.
    pub(crate) fn travelled_velocity(&self, model: &CoupledModel<'_>) -> f32 {
        if model.winds() { self.velocity } else { self.velocity + self.drift }
    }

    pub(crate) fn move_by(&mut self, way: f32) {
        let position = self.position + way;
        let wrapped = wrap_position(position);
        self.cycles = self.cycles.saturating_add(round(position - wrapped) as i32);
        self.position = wrapped;
    }
}

/// Stationary spread of an angle's parts.
#[cfg_attr(target_arch = "x86_64", inline(always))]
pub(crate) fn spread(model: &CoupledModel<'_>, index: usize) -> Spread {
    let deviation = &model.parts().deviation;
    let at = |values: &[f32]| values.get(index).copied().unwrap_or(1.0);
    let square = |std: f32| std * std;
    Spread {
        offset: square(at(deviation.offset_std_rad)),
        cosine: square(at(deviation.cosine_std_rad)),
        sine: square(at(deviation.sine_std_rad)),
        rest: square(at(deviation.rest_std_rad)),
        rate: at(deviation.rest_rate_per_cycle),
    }
}
