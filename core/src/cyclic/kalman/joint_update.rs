//! The measurement update by all angles seen in a frame, for independent noise.
//!
//! It equals the update by one angle after the other, P <- P - w w' / s. There w is the measured
//! column and s the innovation's variance. The sums have another order: first all columns w, then
//! each entry of P once. The columns continue the factor L of the innovation's covariance L D L' to
//! the rest of the state. No square root separates two angles. The measured angles come first, in
//! `order`.
//!
//! A measurement of variance r scales row and column of its angle by r / s. The later columns are
//! subtracted from that, so a precise measurement after a long gap subtracts no large numbers.

use crate::angle::angle_difference;
use crate::cyclic::AngleMeasurement;
use crate::cyclic::kalman::covariance::{
    CANCELLATION_RATIO, KinematicCovariance, ROUNDING_MARGIN, SQUARE, half, mirror,
};
use crate::numeric::log_product::LogProduct;

/// The measured angles of a frame, in front, with their innovations.
///
/// Invariant: `order` has each number below N once, and `count` is at most N.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeenAngles<const N: usize> {
    /// Numbers of the angles: those seen, then the others.
    order: [usize; N],
    /// Number of angles seen.
    count: usize,
    /// Measured less predicted angle, in that order; zero beyond `count`.
    innovation_rad: [f32; N],
    /// Variance of each measurement, in that order.
    noise_variance: [f32; N],
}

impl<const N: usize> SeenAngles<N> {
    /// From the first `angle_count` angles of a measurement; innovations are wrapped.
    #[inline(always)]
    #[must_use]
    pub(super) fn of(measurement: &AngleMeasurement<N>, predicted_rad: &[f32; N], angle_count: usize) -> Self {
        let mut seen = Self { order: [0; N], count: 0, innovation_rad: [0.0; N], noise_variance: [0.0; N] };
        let mut unseen = N;
        for i in (0..N).rev() {
            if i >= angle_count || measurement.angle_rad(i).is_none() {
                unseen -= 1;
                if let Some(place) = seen.order.get_mut(unseen) {
                    *place = i;
                }
            }
        }
        let mut places = seen.order.iter_mut().zip(&mut seen.innovation_rad).zip(&mut seen.noise_variance);
        for i in 0..N.min(angle_count) {
            if let Some(measured_rad) = measurement.angle_rad(i) {
                let std_rad = measurement.std_rad()[i];
                let Some(((order, innovation_rad), noise_variance)) = places.next() else { break };
                *order = i;
                *innovation_rad = angle_difference(measured_rad, predicted_rad[i]);
                *noise_variance = std_rad * std_rad;
                seen.count += 1;
            }
        }
        seen
    }

    /// Number of angles seen.
    #[inline(always)]
    #[must_use]
    pub(super) const fn count(&self) -> usize {
        self.count
    }
}

/// Update of the mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct MeanShift<const N: usize> {
    /// To be added to the angles.
    pub(super) angles_rad: [f32; N],
    /// To be added to the velocities.
    pub(super) velocities: [f32; N],
    /// Normalised innovation squared.
    pub(super) squared: f32,
    /// Determinant of the innovation's covariance.
    pub(super) determinant: LogProduct,
}

/// Places in a row of [`Columns::last`].
const AHEAD: usize = 0;
const VELOCITY: usize = 1;
const INNOVATION: usize = 2;

/// Working memory for the measured columns of the covariance. A row here is a column there; angles
/// are in the order of [`SeenAngles`].
///
/// The covariance's own blocks hold the rest, and its new entries are computed there. `aheads` has
/// each angle's covariances with itself and the later angles at its measurement (earlier entries
/// are meaningless), `velocities` those with the velocities.
struct Columns<const N: usize> {
    /// Covariances with the angles measured before, minus the measurement's variance at the angle
    /// itself, and those with the missing angles.
    past: [[f32; N]; N],
    /// The covariances with the last angle and the last velocity, and the innovation, given the
    /// angles measured before. All have the same sums, and four numbers fill a register. The fourth
    /// is unused. The last column of `velocities` is meaningless meanwhile.
    last: [[f32; SQUARE]; N],
    /// One over the variance of each innovation.
    inverse_variance: [f32; N],
    /// Share of the angle's covariances after the measurement, r / s.
    kept: [f32; N],
    /// Whether a measurement's variance is below [`CANCELLATION_RATIO`] of the innovation's.
    cancels: [bool; N],
}

impl<const N: usize> KinematicCovariance<N> {
    /// The update by all angles seen.
    ///
    /// With `keeps_velocities` the gain moves the angles only (Joseph's form): the velocities keep
    /// their covariance.
    #[inline(always)]
    pub(super) fn correct(&mut self, seen: &SeenAngles<N>, keeps_velocities: bool) -> MeanShift<N> {
        let count = seen.count.min(N);
        if count < N {
            self.order_angles(seen);
        }
        let Self { angle: aheads, cross: velocities, velocity: covariance } = self;
        let mut columns = Columns::of(seen, (aheads, velocities), count);
        let mut shift =
            MeanShift { angles_rad: [0.0; N], velocities: [0.0; N], squared: 0.0, determinant: LogProduct::one() };
        for place in 0..count {
            let variance = columns.find((aheads, velocities), place, count, seen.noise_variance[place]);
            let innovation_rad = columns.last[place][INNOVATION];
            shift.squared += innovation_rad * innovation_rad * columns.inverse_variance[place];
            shift.determinant.multiply(variance);
        }
        let any_cancels = columns.cancels.contains(&true);
        let margins = any_cancels.then(|| columns.margins(aheads, velocities, count));
        if !keeps_velocities {
            shift.velocities = columns.reduce_velocities(velocities, covariance, count);
        }
        shift.angles_rad = columns.reduce_angles(aheads, velocities, count);
        for i in 0..N {
            shift.angles_rad[i] = seen.innovation_rad[i] - shift.angles_rad[i];
        }
        if let Some((of_angles, of_velocities)) = margins {
            for i in 0..N {
                aheads[i][i] += of_angles[i];
                covariance[i][i] += of_velocities[i];
            }
        }
        if count < N {
            shift.angles_rad = in_place(seen, &shift.angles_rad);
            self.put_angles_back(seen);
        }
        shift
    }

    /// Brings the angles into the order of `seen`.
    fn order_angles(&mut self, seen: &SeenAngles<N>) {
        self.angle = seen.order.map(|i| seen.order.map(|j| self.entry(i, j)));
        self.cross = seen.order.map(|i| self.cross.get(i).copied().unwrap_or([0.0; N]));
    }

    /// Takes [`Self::order_angles`] back.
    fn put_angles_back(&mut self, seen: &SeenAngles<N>) {
        let (angle, cross) = (self.angle, self.cross);
        for (&index, (angle, cross)) in seen.order.iter().zip(angle.iter().zip(&cross)) {
            if let (Some(angle_row), Some(cross_row)) = (self.angle.get_mut(index), self.cross.get_mut(index)) {
                (*angle_row, *cross_row) = (in_place(seen, angle), *cross);
            }
        }
    }
}

impl<const N: usize> Columns<N> {
    /// Before the first measurement.
    #[inline(always)]
    fn of(seen: &SeenAngles<N>, (aheads, velocities): (&[[f32; N]; N], &[[f32; N]; N]), count: usize) -> Self {
        let mut columns = Self {
            past: [[0.0; N]; N],
            last: [[0.0; SQUARE]; N],
            inverse_variance: [0.0; N],
            kept: [0.0; N],
            cancels: [false; N],
        };
        for place in 0..count.min(N) {
            columns.past[place][place] = -seen.noise_variance[place];
            columns.last[place] =
                [aheads[place][const { N - 1 }], velocities[place][const { N - 1 }], seen.innovation_rad[place], 0.0];
        }
        columns
    }

    /// Finds the columns of the measurement at `place` from those before; returns the variance of
    /// its innovation.
    #[inline(always)]
    fn find(
        &mut self,
        (aheads, velocities): (&mut [[f32; N]; N], &mut [[f32; N]; N]),
        place: usize,
        count: usize,
        noise_variance: f32,
    ) -> f32 {
        let (mut ahead, mut past, mut velocity) = (aheads[place], self.past[place], velocities[place]);
        let mut last = self.last[place];
        if place < half::<N>() {
            for earlier in 0..place {
                let factor = self.inverse_variance[earlier] * aheads[earlier][place];
                subtract_but_last(&mut ahead, factor, &aheads[earlier]);
                subtract_first_half(&mut past, factor, &self.past[earlier]);
                subtract_but_last(&mut velocity, factor, &velocities[earlier]);
                subtract_scaled(&mut last, factor, &self.last[earlier]);
            }
        } else {
            for earlier in 0..half::<N>() {
                let factor = self.inverse_variance[earlier] * aheads[earlier][place];
                subtract_second_half(&mut ahead, factor, &aheads[earlier]);
                subtract_first_half(&mut past, factor, &self.past[earlier]);
                subtract_but_last(&mut velocity, factor, &velocities[earlier]);
                subtract_scaled(&mut last, factor, &self.last[earlier]);
            }
            for earlier in half::<N>()..place {
                let factor = self.inverse_variance[earlier] * aheads[earlier][place];
                subtract_second_half(&mut ahead, factor, &aheads[earlier]);
                subtract_but_last(&mut past, factor, &self.past[earlier]);
                subtract_but_last(&mut velocity, factor, &velocities[earlier]);
                subtract_scaled(&mut last, factor, &self.last[earlier]);
            }
        }
        ahead[const { N - 1 }] = last[AHEAD];
        aheads[place] = ahead;
        let variance = aheads[place][place] + noise_variance;
        let inverse_variance = 1.0 / variance;
        self.inverse_variance[place] = inverse_variance;
        self.kept[place] = noise_variance * inverse_variance;
        self.cancels[place] = noise_variance < CANCELLATION_RATIO * variance;
        (self.past[place], velocities[place], self.last[place]) = (past, velocity, last);
        for j in count..N {
            self.past[place][j] = aheads[place][j];
        }
        variance
    }

    /// Rows of the angles after all measurements, at least up to the diagonal; the rest follows
    /// from the rows below. A row starts as it is right after its own measurement, or unchanged
    /// where its angle is missing. Returns the residuals: from the corrected angles to the
    /// measurements, or to the predictions where an angle is missing.
    #[inline(always)]
    fn reduce_angles(&self, aheads: &mut [[f32; N]; N], velocities: &mut [[f32; N]; N], count: usize) -> [f32; N] {
        // Changes nothing, since `count` is at most N, and lets the compiler drop the bounds
        // checks.
        let count = count.min(N);
        let mut residual = [0.0; N];
        // The missing angles need all columns.
        for place in count..N {
            let (mut angle, mut velocity) = (aheads[place], velocities[place]);
            angle.iter_mut().take(count).for_each(|covariance| *covariance = 0.0);
            let mut last = [0.0, velocity[const { N - 1 }], 0.0, 0.0];
            self.subtract_updates::<false>(place, 0..count, (&mut angle, &mut velocity, &mut last), velocities);
            velocity[const { N - 1 }] = last[VELOCITY];
            residual[place] = last[INNOVATION];
            (aheads[place], velocities[place]) = (angle, velocity);
        }
        for place in 0..count {
            let kept = self.kept[place];
            let mut angle = self.past[place].map(|covariance| kept * covariance);
            let mut velocity = velocities[place].map(|covariance| kept * covariance);
            let mut last = self.last[place].map(|covariance| kept * covariance);
            let (rows, later) = ((&mut angle, &mut velocity, &mut last), place + 1..count);
            let taken = if place < half::<N>() {
                self.subtract_updates::<true>(place, later, rows, velocities)
            } else {
                self.subtract_updates::<false>(place, later, rows, velocities)
            };
            velocity[const { N - 1 }] = last[VELOCITY];
            residual[place] = last[INNOVATION];
            let variance = kept * aheads[place][place] - taken;
            (aheads[place], velocities[place]) = (angle, velocity);
            aheads[place][place] = variance;
        }
        for i in 0..half::<N>() {
            for j in half::<N>()..N {
                aheads[i][j] = aheads[j][i];
            }
        }
        residual
    }

    /// Subtracts the updates by measurements at `later` places from the covariances of the angle at
    /// `place` with angles and velocities, and from its innovation. Returns the decrease of its
    /// variance. With `FIRST_HALF` only the first half of the angles changes.
    #[inline(always)]
    fn subtract_updates<const FIRST_HALF: bool>(
        &self,
        place: usize,
        later: core::ops::Range<usize>,
        (angle, velocity, last): (&mut [f32; N], &mut [f32; N], &mut [f32; SQUARE]),
        velocities: &[[f32; N]; N],
    ) -> f32 {
        let mut taken = 0.0;
        for later in later {
            let covariance = self.past[later][place];
            let factor = self.inverse_variance[later] * covariance;
            taken += factor * covariance;
            if FIRST_HALF {
                subtract_first_half(angle, factor, &self.past[later]);
            } else {
                subtract_scaled(angle, factor, &self.past[later]);
            }
            subtract_but_last(velocity, factor, &velocities[later]);
            subtract_scaled(last, factor, &self.last[later]);
        }
        taken
    }

    /// Bounds on the rounding of the variances of angles and velocities, where a measurement is far
    /// more precise than the prediction.
    #[cold]
    fn margins(&self, aheads: &[[f32; N]; N], velocities: &[[f32; N]; N], count: usize) -> ([f32; N], [f32; N]) {
        let mut margins = ([0.0; N], [0.0; N]);
        for place in 0..count.min(N) {
            if !self.cancels[place] {
                continue;
            }
            let margin = ROUNDING_MARGIN * self.inverse_variance[place];
            for j in 0..N {
                let angle = if j < place { self.past[place][j] } else { aheads[place][j] };
                let velocity = if j < N - 1 { velocities[place][j] } else { self.last[place][VELOCITY] };
                margins.0[j] += margin * angle * angle;
                margins.1[j] += margin * velocity * velocity;
            }
        }
        margins
    }

    /// Subtracts the sum of w w' / s from the velocities' covariance, in squares of four rows and
    /// columns; returns the update of the velocities.
    #[inline(always)]
    fn reduce_velocities(&self, velocities: &[[f32; N]; N], covariance: &mut [[f32; N]; N], count: usize) -> [f32; N] {
        // Changes nothing, since `count` is at most N, and lets the compiler drop the bounds
        // checks.
        let count = count.min(N);
        let Some((last_row, rows)) = covariance.split_last_mut() else { return [0.0; N] };
        let (row_blocks, rest) = rows.as_chunks_mut::<SQUARE>();
        let first_of_rest = SQUARE * row_blocks.len();
        for (block, rows) in row_blocks.iter_mut().enumerate() {
            for part in (0..=block).step_by(2) {
                if part < block {
                    self.reduce_squares::<2>(velocities, rows, (block, part), count);
                } else {
                    self.reduce_squares::<1>(velocities, rows, (block, part), count);
                }
            }
        }
        for (i, row) in rest.iter_mut().enumerate() {
            for place in 0..count {
                let factor = self.inverse_variance[place] * velocities[place][first_of_rest + i];
                subtract_but_last(row, factor, &velocities[place]);
            }
        }
        let shift = self.reduce_last_velocity(velocities, last_row, count);
        mirror(covariance);
        shift
    }

    /// [`Self::reduce_velocities`] for the last row, and the shift of the velocities.
    #[inline(always)]
    fn reduce_last_velocity(&self, velocities: &[[f32; N]; N], row: &mut [f32; N], count: usize) -> [f32; N] {
        let (mut shift, mut sum, mut sum_last) = ([0.0; N], [0.0; N], [0.0; SQUARE]);
        for place in 0..count {
            let last = self.last[place].map(|covariance| self.inverse_variance[place] * covariance);
            let of_place = velocities[place];
            for j in 0..const { N - 1 } {
                sum[j] += last[VELOCITY] * of_place[j];
                shift[j] += last[INNOVATION] * of_place[j];
            }
            for j in 0..SQUARE {
                sum_last[j] += last[VELOCITY] * self.last[place][j];
            }
        }
        (sum[const { N - 1 }], shift[const { N - 1 }]) = (sum_last[VELOCITY], sum_last[INNOVATION]);
        for j in 0..N {
            row[j] -= sum[j];
        }
        shift
    }

    /// [`Self::reduce_velocities`] for `WIDE` squares side by side, the first at row `block` and
    /// column `part`.
    #[inline(always)]
    fn reduce_squares<const WIDE: usize>(
        &self,
        velocities: &[[f32; N]; N],
        rows: &mut [[f32; N]; SQUARE],
        (block, part): (usize, usize),
        count: usize,
    ) {
        let mut sums = [[[0.0; SQUARE]; WIDE]; SQUARE];
        for place in 0..count {
            let column = velocities[place].as_chunks::<SQUARE>().0;
            let Some(squares) = column.get(part..).and_then(<[_]>::first_chunk::<WIDE>) else { break };
            let Some(weighed) = column.get(block) else { break };
            let weighed = weighed.map(|covariance| self.inverse_variance[place] * covariance);
            for i in 0..SQUARE {
                for wide in 0..WIDE {
                    for j in 0..SQUARE {
                        sums[i][wide][j] += weighed[i] * squares[wide][j];
                    }
                }
            }
        }
        for (row, sums) in rows.iter_mut().zip(&sums) {
            for (value, sum) in row.iter_mut().skip(SQUARE * part).zip(sums.as_flattened()) {
                *value -= sum;
            }
        }
    }
}

/// Values in the order of the angles seen, put at the angles' own places.
#[inline(always)]
fn in_place<const N: usize>(seen: &SeenAngles<N>, ordered: &[f32; N]) -> [f32; N] {
    let mut values = [0.0; N];
    for (&index, value) in seen.order.iter().zip(ordered) {
        if let Some(slot) = values.get_mut(index) {
            *slot = *value;
        }
    }
    values
}

/// `target` -= `factor` `direction`.
#[inline(always)]
fn subtract_scaled<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in 0..N {
        target[j] -= factor * direction[j];
    }
}

/// As [`subtract_scaled`], all numbers but the last.
#[inline(always)]
fn subtract_but_last<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in 0..const { N - 1 } {
        target[j] -= factor * direction[j];
    }
}

/// As [`subtract_scaled`], the first [`half`] of the numbers.
#[inline(always)]
fn subtract_first_half<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in 0..const { half::<N>() } {
        target[j] -= factor * direction[j];
    }
}

/// As [`subtract_scaled`], the numbers from [`half`] on but the last.
#[inline(always)]
fn subtract_second_half<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in const { half::<N>() }..const { N - 1 } {
        target[j] -= factor * direction[j];
    }
}
