//! Histogram filter over position and speed in the cycle, for an unknown person.
//!
//! The phase-coupled filter has one mode. The grid weights all positions and does not learn the
//! person, so it cannot follow a wrong phase with it. Histogram filter: Thrun, Burgard and Fox,
//! Probabilistic Robotics (2005), section 4.1.

use crate::cyclic::coupled::constants::{GATE_SIGMAS, GRID_DIFFUSION, LINEAR_CYCLES, TEMPERED_ANGLES, TEMPERING};
use crate::cyclic::phase::{position_difference, wrap_position};
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::{abs, exp, exp_small, least_angle, max, min, round};
use crate::numeric::rolled::rolled;

/// Positions of the grid. Chosen: a cell is about a fifth of [`MODE_REACH`].
pub const POSITIONS: usize = 32;
/// Positions at which a measurement's likelihood is computed; between them it is linear.
const TABLE: usize = 64;
/// Positions of the table that are computed side by side.
const LANES: usize = 8;
/// Speeds of the grid, relative to the model's mean speed. Chosen: from standing to twice the mean,
/// in factors of about the root of 2.
const SPEED_RATIOS: [f32; 6] = [0.0, 0.5, 0.7, 1.0, 1.4, 2.0];
pub(crate) const SPEEDS: usize = SPEED_RATIOS.len();

/// Whether a velocity, cycles per frame, is nearer to standing than to the grid's slowest speed,
/// forwards or backwards.
pub(crate) fn is_standing(model: &CoupledModel<'_>, velocity: f32) -> bool {
    abs(velocity) < 0.5 * SPEED_RATIOS[1] * model.mean_cycle_velocity()
}

/// Weights of position and speed; their sum is one.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::coupled::phase::phase_grid::PhaseGrid;
///
/// // An unknown person walks on from position 0.7: the grid's weight gathers at one position.
/// let model = WALKING.model()?;
/// let mut grid = PhaseGrid::uniform();
/// assert!(grid.weight_near(0.7) < 0.4);
/// for frame in 0..30_u8 {
///     let position = 0.7 + f32::from(frame) * model.mean_cycle_velocity();
///     let pose_rad = model.mean_pose_rad::<13>(model.point(position));
///     grid.advance(&model, 1.0);
///     grid.weigh(&model, &AngleMeasurement::new(&pose_rad.map(Some), 0.1)?);
/// }
/// assert!(grid.weight_near(0.7 + 29.0 * model.mean_cycle_velocity()) > 0.9);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseGrid {
    pub(crate) weights: [[f32; POSITIONS]; SPEEDS],
    /// Way of each speed's grid since the start, cycles, [0, 1).
    pub(crate) travelled: [f32; SPEEDS],
}

/// A mode of the grid: means and covariance of position and velocity.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::phase::position_difference;
/// use sinew_core::cyclic::coupled::phase::phase_grid::PhaseGrid;
///
/// // Known to a twentieth of a cycle, at about the mean speed.
/// let model = WALKING.model()?;
/// let mode = PhaseGrid::near(0.3).mode(&model);
/// assert!(mode.weight > 0.9 && position_difference(mode.position, 0.3).abs() < 0.01);
/// let [position_variance, _, _] = mode.covariance;
/// assert!((0.03 * 0.03..0.07 * 0.07).contains(&position_variance));
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseMode {
    /// Part of the weight within [`MODE_REACH`] of the position.
    pub weight: f32,
    /// Position, [0, 1).
    pub position: f32,
    /// Velocity, cycles per frame.
    pub velocity: f32,
    /// Covariance: cc, cv, vv.
    pub covariance: [f32; 3],
}

/// Half the width of a mode, cycles: as far as the filter's linearisation about a place holds.
pub const MODE_REACH: f32 = LINEAR_CYCLES;
/// Cells of one speed that may lie within it.
const NEAR_CELLS: usize = 12;
const _: () = assert!(MODE_REACH * (POSITIONS as f32) < 5.0 && TABLE == 2 * POSITIONS && TABLE.is_multiple_of(LANES));

impl PhaseGrid {
    /// All positions and speeds alike.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    #[must_use]
    pub const fn uniform() -> Self {
        let weight = 1.0 / (POSITIONS * SPEEDS) as f32;
        Self { weights: [[weight; POSITIONS]; SPEEDS], travelled: [0.0; SPEEDS] }
    }

    /// A normal of a twentieth of a cycle about `position`, all speeds alike.
    #[must_use]
    pub fn near(position: f32) -> Self {
        let mut grid = Self::uniform();
        for row in &mut grid.weights {
            for (cell, weight) in row.iter_mut().enumerate() {
                let scaled = 20.0 * position_difference(cell as f32 / POSITIONS as f32, position);
                *weight *= exp(-0.5 * scaled * scaled);
            }
        }
        grid.normalise();
        grid
    }

    /// Scales all weights to a sum of one; uniform where they have no sum.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn normalise(&mut self) {
        let sum: f32 = self.weights.iter().map(|row| row.iter().sum::<f32>()).sum();
        if !(sum > 1.0e-30 && sum.is_finite()) {
            *self = Self::uniform();
            return;
        }
        let scale = 1.0 / sum;
        self.weights.iter_mut().flatten().for_each(|weight| *weight *= scale);
    }

    /// Moves on by `step_frames`; speeds may change to the next slower or faster one.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn advance(&mut self, model: &CoupledModel<'_>, step_frames: f32) {
        for (travelled, ratio) in self.travelled.iter_mut().zip(SPEED_RATIOS) {
            *travelled = wrap_position(*travelled + ratio * model.mean_cycle_velocity() * step_frames);
        }
        let moved = min(GRID_DIFFUSION * step_frames, 0.3);
        let old = self.weights;
        for speed in 0..SPEEDS {
            let others = [speed.checked_sub(1), (speed + 1 < SPEEDS).then_some(speed + 1)];
            let stay = 1.0 - moved * others.iter().flatten().count() as f32;
            let mut row = old[speed].map(|weight| stay * weight);
            for other in others.into_iter().flatten() {
                let (Some(from), Some(travelled)) = (old.get(other), self.travelled.get(other)) else { continue };
                let shift = round((self.travelled[speed] - travelled) * POSITIONS as f32) as i32;
                let shift = shift.rem_euclid(POSITIONS as i32) as usize;
                for (weight, from) in row.iter_mut().zip(twice(from).iter().skip(shift)) {
                    *weight += moved * from;
                }
            }
            let around: [f32; POSITIONS + 2] = core::array::from_fn(|i| row[(i + POSITIONS - 1) % POSITIONS]);
            let neighbours = around.iter().zip(&around[1..]).zip(&around[2..]);
            for (weight, ((before, here), after)) in self.weights[speed].iter_mut().zip(neighbours) {
                *weight = here + moved * (after + before - 2.0 * here);
            }
        }
    }

    /// Updates by a measurement of an unknown person.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn weigh<const N: usize>(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) {
        let likelihood = likelihood_table(model, measurement);
        // Of the table's positions a speed's cells lie behind all even or all odd ones.
        let every_second = |first: usize| core::array::from_fn(|i| likelihood[(2 * i + first) % TABLE]);
        let [even, odd]: [[f32; TABLE]; 2] = [every_second(0), every_second(1)];
        for (row, &travelled) in self.weights.iter_mut().zip(&self.travelled) {
            let (shift, part) = cells_and_rest(travelled, TABLE);
            let [before, after] = if shift.is_multiple_of(2) { [&even, &odd] } else { [&odd, &even] };
            let pairs = before.iter().skip(shift / 2).zip(after.iter().skip(shift.div_ceil(2)));
            for (weight, (a, b)) in row.iter_mut().zip(pairs) {
                *weight *= a + part * (b - a);
            }
        }
        self.normalise();
    }

    /// Part of the weight within [`MODE_REACH`] of `position`.
    #[must_use]
    pub fn weight_near(&self, position: f32) -> f32 {
        let mut sum = 0.0;
        self.each_near(position, |_, weight, _| sum += weight);
        sum
    }

    /// Calls `take` with speed, weight and distance from `position` of each cell within
    /// [`MODE_REACH`].
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn each_near(&self, position: f32, mut take: impl FnMut(usize, f32, f32)) {
        for (speed, (weights, &travelled)) in self.weights.iter().zip(&self.travelled).enumerate() {
            let (below, rest) = cells_and_rest(wrap_position(position - travelled), POSITIONS);
            for ahead in 0..rolled(NEAR_CELLS) {
                // From five cells before the position to six behind it: no other can be near
                // enough.
                let way = (ahead as f32 - 5.0 - rest) / POSITIONS as f32;
                if abs(way) <= MODE_REACH {
                    take(speed, weights[(below + POSITIONS + ahead - 5) % POSITIONS], way);
                }
            }
        }
    }

    /// Weight by position alone, on positions i / [`POSITIONS`].
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[must_use]
    pub fn by_position(&self) -> [f32; POSITIONS] {
        let mut sums = [0.0; POSITIONS];
        // One room for all rows.
        let mut twice = [0.0; 2 * POSITIONS];
        for (weights, &travelled) in self.weights.iter().zip(&self.travelled) {
            let (shift, part) = cells_and_rest(travelled, POSITIONS);
            for half in twice.as_chunks_mut::<POSITIONS>().0 {
                *half = *weights;
            }
            let before = twice.iter().skip(POSITIONS - 1 - shift);
            let here = twice.iter().skip(POSITIONS - shift);
            for (sum, (before, here)) in sums.iter_mut().zip(before.zip(here)) {
                *sum += part * before + (1.0 - part) * here;
            }
        }
        sums
    }

    /// The mode with the largest weight.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[must_use]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn mode(&self, model: &CoupledModel<'_>) -> PhaseMode {
        let sums = self.by_position();
        let mut best = (0, 0.0);
        for (cell, weight) in sums_around(&sums).into_iter().enumerate() {
            if weight > best.1 {
                best = (cell, weight);
            }
        }
        let centre = best.0 as f32 / POSITIONS as f32;
        let velocities = SPEED_RATIOS.map(|ratio| ratio * model.mean_cycle_velocity());
        let (mut weight, mut way, mut velocity) = (0.0, 0.0, 0.0);
        self.each_near(centre, |speed, part, at| {
            weight += part;
            way += part * at;
            velocity += part * velocities[speed];
        });
        let weight = max(weight, 1.0e-6);
        let (way, velocity) = (way / weight, velocity / weight);
        let (mut cc, mut cv, mut vv) = (0.0, 0.0, 0.0);
        self.each_near(centre, |speed, part, at| {
            let (off, faster) = (at - way, velocities[speed] - velocity);
            cc += part * (off * off);
            cv += part * (off * faster);
            vv += part * (faster * faster);
        });
        let (cc, cv, vv) = (cc / weight, cv / weight, vv / weight);
        let (cell, step) = (1.0 / POSITIONS as f32, 0.15 * model.mean_cycle_velocity());
        let covariance = [cc + cell * cell / 12.0, cv, vv + step * step];
        PhaseMode { weight, position: wrap_position(centre + way), velocity, covariance }
    }
}

/// A row after itself, so that it can be read around the circle from any cell.
#[inline]
fn twice(row: &[f32; POSITIONS]) -> [f32; 2 * POSITIONS] {
    let mut twice = [0.0; 2 * POSITIONS];
    for half in twice.as_chunks_mut::<POSITIONS>().0 {
        *half = *row;
    }
    twice
}

/// Sum of the cells within [`MODE_REACH`] of each, around the circle.
#[cfg_attr(target_arch = "x86_64", inline(always))]
fn sums_around(cells: &[f32; POSITIONS]) -> [f32; POSITIONS] {
    const REACH: usize = (MODE_REACH * POSITIONS as f32) as usize;
    let around: [f32; POSITIONS + 2 * REACH] = core::array::from_fn(|i| cells[(i + POSITIONS - REACH) % POSITIONS]);
    let mut sums = [0.0; POSITIONS];
    for shift in 0..=2 * REACH {
        for (sum, value) in sums.iter_mut().zip(around.iter().skip(shift)) {
            *sum += value;
        }
    }
    sums
}

/// Likelihood of a measurement at each position of the table, the greatest being one.
#[cfg_attr(target_arch = "x86_64", inline(always))]
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
fn likelihood_table<const N: usize>(model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> [f32; TABLE] {
    let spread = model.deviation_std_rad::<N>();
    let count = model.angle_count().min(N);
    let tempering = max(TEMPERING * measurement.present(count) as f32 / TEMPERED_ANGLES, TEMPERING);
    let seen = |i: usize| if i < count { measurement.angle_rad(i) } else { None };
    let measured: [f32; N] = core::array::from_fn(|i| seen(i).unwrap_or(0.0));
    // A missing angle has no precision.
    let precision: [f32; N] = core::array::from_fn(|i| {
        let std = measurement.std_rad()[i];
        if seen(i).is_some() { 0.5 / (tempering * (spread[i] * spread[i] + std * std)) } else { 0.0 }
    });
    let limit = 0.5 * GATE_SIGMAS * GATE_SIGMAS / tempering;
    let mut scores = [0.0_f32; TABLE];
    let mut greatest = [f32::NEG_INFINITY; LANES];
    for (block, scores) in scores.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
        let poses_rad = lanes_of_poses::<N>(model, block);
        let mut sums = [0.0; LANES];
        for i in 0..N {
            for (sum, pose_rad) in sums.iter_mut().zip(&poses_rad[i]) {
                let off = least_angle(measured[i] - pose_rad);
                *sum += min(precision[i] * off * off, limit);
            }
        }
        for lane in 0..LANES {
            scores[lane] = -sums[lane];
            greatest[lane] = max(greatest[lane], scores[lane]);
        }
    }
    let greatest = greatest.into_iter().fold(f32::NEG_INFINITY, max);
    // All angles at their limits are exp(-42) for 13 of them.
    scores.map(|score| exp_small(max(score - greatest, -80.0)))
}

/// Mean poses at [`LANES`] positions of the table, by angle.
#[inline(always)]
fn lanes_of_poses<const N: usize>(model: &CoupledModel<'_>, block: usize) -> [[f32; LANES]; N] {
    let mut poses_rad = [[0.0; LANES]; N];
    for lane in 0..LANES {
        let pose_rad: [f32; N] = model.pose_at(model.point_among(LANES * block + lane, TABLE));
        for (lanes, angle_rad) in poses_rad.iter_mut().zip(pose_rad) {
            lanes[lane] = angle_rad;
        }
    }
    poses_rad
}

/// A way in [0, 1) as whole cells of `cells` to a cycle, and the rest as a part of a cell.
#[cfg_attr(target_arch = "x86_64", inline(always))]
fn cells_and_rest(way: f32, cells: usize) -> (usize, f32) {
    let along = way * cells as f32;
    let whole = (along as usize).min(cells - 1);
    (whole, along - whole as f32)
}
