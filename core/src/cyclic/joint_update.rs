//! The measurement update by all angles seen in a frame, for independent noise.
//!
//! It is the update by one angle after the other, P <- P - w w' / s with w the measured column and s the innovation's
//! variance, in another order of the same sums: first all columns w, which continue the factor L of the innovation's
//! covariance L D L' to the rest of the state, then each entry of P at once. No root stands between one angle and the next.
//! The angles seen come first, in `order`.
//!
//! Once an angle is measured with variance r, row and column become r / s of what they were before that measurement; later
//! columns are taken off that. So a precise measurement after a long gap leaves no difference of large numbers.

use super::AngleMeasurement;
use super::covariance::{KinematicCovariance, MARGIN, SEVERE, SQUARE, half, mirror};
use super::log_product::LogProduct;
use crate::angle::angle_difference;

/// The angles that a frame shows, in front, and what it says about them.
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
    /// What a measurement shows of the first `angle_count` angles, relative to those predicted: the shorter way round.
    #[inline]
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
    #[inline]
    #[must_use]
    pub(super) const fn count(&self) -> usize {
        self.count
    }
}

/// What an update says about the mean.
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

/// Columns of the covariance that the angles seen call for. A row here is a column there; angles in the order of
/// [`SeenAngles`].
struct Columns<const N: usize> {
    /// Covariances with this angle and those after it when the measurement is taken in; what stands before has no meaning.
    ahead: [[f32; N]; N],
    /// Those with the angles measured before, less the measurement's variance at the angle itself, and those with the angles
    /// never seen.
    settled: [[f32; N]; N],
    /// Covariances with the velocities.
    velocity: [[f32; N]; N],
    /// Those divided by the innovation's variance.
    weighed_velocity: [[f32; N]; N],
    /// One over the variance of each innovation.
    inverse_variance: [f32; N],
    /// Part of the angle's covariances that the measurement leaves.
    left: [f32; N],
    /// Whether the measurement takes nearly all of the angle's variance away.
    is_severe: [bool; N],
}

impl<const N: usize> KinematicCovariance<N> {
    /// The update by all angles seen.
    ///
    /// With `keeps_velocities` the gain moves the angles only (Joseph's form): the velocities keep their covariance.
    #[inline]
    pub(super) fn correct(&mut self, seen: &SeenAngles<N>, keeps_velocities: bool) -> MeanShift<N> {
        let count = seen.count.min(N);
        let mut columns = Columns {
            ahead: self.angle,
            settled: [[0.0; N]; N],
            velocity: self.cross,
            weighed_velocity: [[0.0; N]; N],
            inverse_variance: [0.0; N],
            left: [0.0; N],
            is_severe: [false; N],
        };
        if count < N {
            columns.ahead = seen.order.map(|i| seen.order.map(|j| self.entry(i, j)));
            columns.velocity = seen.order.map(|i| self.cross.get(i).copied().unwrap_or([0.0; N]));
        }
        let (mut weighed, mut ahead_rad) = ([0.0; N], [0.0; N]);
        let (mut squared, mut determinant) = (0.0, LogProduct::one());
        for place in 0..count {
            let variance = columns.find(place, count, seen.noise_variance[place]);
            let innovation_rad = seen.innovation_rad[place] - ahead_rad[place];
            weighed[place] = innovation_rad * columns.inverse_variance[place];
            add_scaled(&mut ahead_rad, weighed[place], &columns.ahead[place]);
            squared += innovation_rad * weighed[place];
            determinant.multiply(variance);
        }
        // A measured angle ends at its measurement less R times the weighed innovations, which the settled columns hold.
        let mut shift = MeanShift {
            angles_rad: combined(&weighed, &columns.settled, count),
            velocities: combined(&weighed, &columns.velocity, count),
            squared,
            determinant,
        };
        add_scaled(&mut shift.angles_rad, 1.0, &seen.innovation_rad);
        if count < N {
            shift.angles_rad = in_place(seen, &shift.angles_rad);
        }
        if keeps_velocities {
            shift.velocities = [0.0; N];
        } else {
            self.reduce_velocities(&columns, count);
        }
        self.reduce_angles(&columns, seen, count);
        self.loosen(&columns, seen, count);
        shift
    }

    /// Rows of the angles after all measurements: up to the diagonal at least, the rest from the rows below.
    #[inline]
    fn reduce_angles(&mut self, columns: &Columns<N>, seen: &SeenAngles<N>, count: usize) {
        // It is no more; said here, it lets no index be checked.
        let count = count.min(N);
        for place in 0..N {
            let (mut angle, mut cross) = columns.start(place, count);
            let first = if place < count { place + 1 } else { 0 };
            if place < half::<N>() {
                for later in first..count {
                    let factor = columns.inverse_variance[later] * columns.settled[later][place];
                    subtract_first_half(&mut angle, factor, &columns.settled[later]);
                    subtract_scaled(&mut cross, factor, &columns.velocity[later]);
                }
            } else {
                for later in first..count {
                    let factor = columns.inverse_variance[later] * columns.settled[later][place];
                    subtract_scaled(&mut angle, factor, &columns.settled[later]);
                    subtract_scaled(&mut cross, factor, &columns.velocity[later]);
                }
            }
            self.angle[place] = angle;
            if let Some(row) = self.cross.get_mut(seen.order[place]) {
                *row = cross;
            }
        }
        for i in 0..half::<N>() {
            for j in half::<N>()..N {
                self.angle[i][j] = self.angle[j][i];
            }
        }
        if count < N {
            let ordered = self.angle;
            for (&index, row) in seen.order.iter().zip(&ordered) {
                if let Some(slot) = self.angle.get_mut(index) {
                    *slot = in_place(seen, row);
                }
            }
        }
    }

    /// Raises the diagonal by what rounding may have taken where a measurement took nearly all of an angle's variance away.
    #[inline]
    fn loosen(&mut self, columns: &Columns<N>, seen: &SeenAngles<N>, count: usize) {
        for place in 0..count.min(N) {
            if !columns.is_severe[place] {
                continue;
            }
            let (settled, ahead) = (&columns.settled[place], &columns.ahead[place]);
            let angle = in_place(seen, &core::array::from_fn(|j| if j < place { settled[j] } else { ahead[j] }));
            let margin = MARGIN * columns.inverse_variance[place];
            for i in 0..N {
                let velocity = columns.velocity[place][i];
                self.angle[i][i] += margin * angle[i] * angle[i];
                self.velocity[i][i] += margin * velocity * velocity;
            }
        }
    }

    /// The velocities' covariance less the sum of w w' / s, in squares of four rows and columns.
    #[inline]
    fn reduce_velocities(&mut self, columns: &Columns<N>, count: usize) {
        let first = |rows| <[[f32; N]]>::get(rows, ..count).unwrap_or_default();
        let (velocity, weighed_velocity) = (first(&columns.velocity), first(&columns.weighed_velocity));
        let (row_blocks, last_rows) = self.velocity.as_chunks_mut::<SQUARE>();
        let first_of_last = SQUARE * row_blocks.len();
        for (block, rows) in row_blocks.iter_mut().enumerate() {
            for part in 0..=block {
                let mut square = [[0.0; SQUARE]; SQUARE];
                for (column, weighed) in velocity.iter().zip(weighed_velocity) {
                    let (w, v) = (weighed.as_chunks::<SQUARE>().0.get(block), column.as_chunks::<SQUARE>().0.get(part));
                    let (Some(w), Some(v)) = (w, v) else { break };
                    for i in 0..SQUARE {
                        for j in 0..SQUARE {
                            square[i][j] += w[i] * v[j];
                        }
                    }
                }
                for (row, sums) in rows.iter_mut().zip(&square) {
                    if let Some(row) = row.as_chunks_mut::<SQUARE>().0.get_mut(part) {
                        for j in 0..SQUARE {
                            row[j] -= sums[j];
                        }
                    }
                }
            }
        }
        for (i, row) in last_rows.iter_mut().enumerate() {
            let mut sums = *row;
            for (column, weighed) in velocity.iter().zip(weighed_velocity) {
                subtract_scaled(&mut sums, weighed[first_of_last + i], column);
            }
            *row = sums;
        }
        mirror(&mut self.velocity);
    }
}

impl<const N: usize> Columns<N> {
    /// Finds the columns of the measurement at `place` from those before; returns the variance of its innovation.
    #[inline]
    fn find(&mut self, place: usize, count: usize, noise_variance: f32) -> f32 {
        let (mut ahead, mut settled, mut velocity) = (self.ahead[place], [0.0; N], self.velocity[place]);
        if place < half::<N>() {
            for earlier in 0..place {
                let factor = self.inverse_variance[earlier] * self.ahead[earlier][place];
                subtract_scaled(&mut ahead, factor, &self.ahead[earlier]);
                subtract_first_half(&mut settled, factor, &self.settled[earlier]);
                subtract_scaled(&mut velocity, factor, &self.velocity[earlier]);
            }
        } else {
            for earlier in 0..half::<N>() {
                let factor = self.inverse_variance[earlier] * self.ahead[earlier][place];
                subtract_second_half(&mut ahead, factor, &self.ahead[earlier]);
                subtract_first_half(&mut settled, factor, &self.settled[earlier]);
                subtract_scaled(&mut velocity, factor, &self.velocity[earlier]);
            }
            for earlier in half::<N>()..place {
                let factor = self.inverse_variance[earlier] * self.ahead[earlier][place];
                subtract_second_half(&mut ahead, factor, &self.ahead[earlier]);
                subtract_scaled(&mut settled, factor, &self.settled[earlier]);
                subtract_scaled(&mut velocity, factor, &self.velocity[earlier]);
            }
        }
        let variance = ahead[place] + noise_variance;
        let inverse_variance = 1.0 / variance;
        self.inverse_variance[place] = inverse_variance;
        self.left[place] = noise_variance * inverse_variance;
        self.is_severe[place] = noise_variance < SEVERE * variance;
        (self.ahead[place], self.settled[place], self.velocity[place]) = (ahead, settled, velocity);
        self.weighed_velocity[place] = velocity.map(|covariance| inverse_variance * covariance);
        self.settled[place][place] = -noise_variance;
        for j in count..N {
            self.settled[place][j] = self.ahead[place][j];
        }
        variance
    }

    /// Covariances of the angle at `place` with angles and velocities right after its own measurement, where later
    /// measurements have not been taken in; before all of them where the angle is not seen.
    #[inline]
    fn start(&self, place: usize, count: usize) -> ([f32; N], [f32; N]) {
        if place < count {
            let left = self.left[place];
            let (mut angle, mut velocity) = (self.settled[place], self.velocity[place]);
            for j in 0..N {
                angle[j] *= left;
                velocity[j] *= left;
            }
            angle[place] = left * self.ahead[place][place];
            (angle, velocity)
        } else {
            let mut angle = self.ahead[place];
            angle.iter_mut().take(count).for_each(|covariance| *covariance = 0.0);
            (angle, self.velocity[place])
        }
    }
}

/// Values in the order of the angles seen, put at the angles' own places.
#[inline]
fn in_place<const N: usize>(seen: &SeenAngles<N>, ordered: &[f32; N]) -> [f32; N] {
    let mut values = [0.0; N];
    for (&index, value) in seen.order.iter().zip(ordered) {
        if let Some(slot) = values.get_mut(index) {
            *slot = *value;
        }
    }
    values
}

/// The sum of the first `count` of `rows`, each with its factor.
#[inline]
fn combined<const N: usize>(factors: &[f32; N], rows: &[[f32; N]; N], count: usize) -> [f32; N] {
    let mut sum = [0.0; N];
    for (&factor, row) in factors.iter().zip(rows).take(count) {
        add_scaled(&mut sum, factor, row);
    }
    sum
}

/// `target` += `factor` `direction`.
#[inline]
fn add_scaled<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in 0..N {
        target[j] += factor * direction[j];
    }
}

/// `target` -= `factor` `direction`.
#[inline]
fn subtract_scaled<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in 0..N {
        target[j] -= factor * direction[j];
    }
}

/// As [`subtract_scaled`], the first [`half`] of the numbers.
#[inline]
fn subtract_first_half<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in 0..const { half::<N>() } {
        target[j] -= factor * direction[j];
    }
}

/// As [`subtract_scaled`], the numbers from [`half`] on.
#[inline]
fn subtract_second_half<const N: usize>(target: &mut [f32; N], factor: f32, direction: &[f32; N]) {
    for j in const { half::<N>() }..N {
        target[j] -= factor * direction[j];
    }
}
