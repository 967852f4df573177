//! The measurement update by all angles seen in a frame, for independent noise.
//!
//! It is the update by one angle after the other, P <- P - w w' with w the measured column over the root of the innovation
//! variance, in another order of the same sums: first all columns w, which are a Cholesky factor of the innovation's
//! covariance continued to the rest of the state, then each entry of P at once. The angles seen come first, in `order`.
//!
//! Once an angle is measured with variance r, row and column become r / s of what they were before that measurement; later
//! columns are taken off that. So a precise measurement after a long gap leaves no difference of large numbers.

use super::AngleMeasurement;
use super::covariance::{KinematicCovariance, MARGIN, SEVERE, mirror};
use super::log_product::LogProduct;
use crate::angle::angle_difference;
use crate::math::sqrt;

/// Rows and columns of the squares that the velocities' covariance is worked on in: sixteen sums stay in registers.
const SQUARE: usize = 4;

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

/// Columns of the covariance that the angles seen call for, scaled by the roots of their innovation variances. A row here is
/// a column there; angles in the order of [`SeenAngles`].
struct Columns<const N: usize> {
    /// Covariances with this angle and those after it when the measurement is taken in; what stands before has no meaning.
    ahead: [[f32; N]; N],
    /// Those with the angles measured before, minus [`Self::left`] at the angle itself, and those with the angles never seen.
    settled: [[f32; N]; N],
    /// Covariances with the velocities.
    velocity: [[f32; N]; N],
    /// Covariance of each angle with itself.
    own: [f32; N],
    /// Part of it that is left after the measurement, times the root of the innovation variance.
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
            own: [0.0; N],
            left: [0.0; N],
            is_severe: [false; N],
        };
        if count < N {
            columns.ahead = seen.order.map(|i| seen.order.map(|j| self.entry(i, j)));
            columns.velocity = seen.order.map(|i| self.cross.get(i).copied().unwrap_or([0.0; N]));
        }
        let mut shift =
            MeanShift { angles_rad: [0.0; N], velocities: [0.0; N], squared: 0.0, determinant: LogProduct::one() };
        let mut ahead_rad = [0.0; N];
        for place in 0..count {
            let (variance, inverse_std) = columns.find(place, count, seen.noise_variance[place]);
            let scaled = (seen.innovation_rad[place] - ahead_rad[place]) * inverse_std;
            add_scaled(&mut ahead_rad, scaled, &columns.ahead[place]);
            add_scaled(&mut shift.angles_rad, scaled, &columns.settled[place]);
            shift.angles_rad[place] = ahead_rad[place];
            add_scaled(&mut shift.velocities, scaled, &columns.velocity[place]);
            shift.squared += scaled * scaled;
            shift.determinant.multiply(variance);
        }
        shift.angles_rad = in_place(seen, &shift.angles_rad);
        if keeps_velocities {
            shift.velocities = [0.0; N];
        } else {
            self.reduce_velocities(&columns.velocity[..count]);
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
                    let factor = columns.settled[later][place];
                    subtract_first_half(&mut angle, factor, &columns.settled[later]);
                    subtract_scaled(&mut cross, factor, &columns.velocity[later]);
                }
            } else {
                for later in first..count {
                    let factor = columns.settled[later][place];
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
            for i in 0..N {
                let velocity = columns.velocity[place][i];
                self.angle[i][i] += MARGIN * angle[i] * angle[i];
                self.velocity[i][i] += MARGIN * velocity * velocity;
            }
        }
    }

    /// The velocities' covariance less the sum of w w', in squares of four rows and columns.
    #[inline]
    fn reduce_velocities(&mut self, columns: &[[f32; N]]) {
        let (row_blocks, last_rows) = self.velocity.as_chunks_mut::<SQUARE>();
        let first_of_last = SQUARE * row_blocks.len();
        for (block, rows) in row_blocks.iter_mut().enumerate() {
            for part in 0..=block {
                let mut square = [[0.0; SQUARE]; SQUARE];
                for column in columns {
                    let blocks = column.as_chunks::<SQUARE>().0;
                    let (Some(w), Some(v)) = (blocks.get(block), blocks.get(part)) else { break };
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
            for column in columns {
                subtract_scaled(&mut sums, column[first_of_last + i], column);
            }
            *row = sums;
        }
        mirror(&mut self.velocity);
    }
}

impl<const N: usize> Columns<N> {
    /// Finds the columns of the measurement at `place` from those before; returns variance and inverse standard deviation of
    /// its innovation.
    #[inline]
    fn find(&mut self, place: usize, count: usize, noise_variance: f32) -> (f32, f32) {
        let (mut ahead, mut settled, mut velocity) = (self.ahead[place], [0.0; N], self.velocity[place]);
        if place < half::<N>() {
            for earlier in 0..place {
                let factor = self.ahead[earlier][place];
                subtract_scaled(&mut ahead, factor, &self.ahead[earlier]);
                subtract_first_half(&mut settled, factor, &self.settled[earlier]);
                subtract_scaled(&mut velocity, factor, &self.velocity[earlier]);
            }
        } else {
            for earlier in 0..half::<N>() {
                let factor = self.ahead[earlier][place];
                subtract_second_half(&mut ahead, factor, &self.ahead[earlier]);
                subtract_first_half(&mut settled, factor, &self.settled[earlier]);
                subtract_scaled(&mut velocity, factor, &self.velocity[earlier]);
            }
            for earlier in half::<N>()..place {
                let factor = self.ahead[earlier][place];
                subtract_second_half(&mut ahead, factor, &self.ahead[earlier]);
                subtract_scaled(&mut settled, factor, &self.settled[earlier]);
                subtract_scaled(&mut velocity, factor, &self.velocity[earlier]);
            }
        }
        let variance = ahead[place] + noise_variance;
        let inverse_std = 1.0 / sqrt(variance);
        self.own[place] = inverse_std * ahead[place];
        self.left[place] = noise_variance * inverse_std;
        self.is_severe[place] = noise_variance < SEVERE * variance;
        for j in 0..N {
            ahead[j] *= inverse_std;
            settled[j] *= inverse_std;
            velocity[j] *= inverse_std;
        }
        (self.ahead[place], self.settled[place], self.velocity[place]) = (ahead, settled, velocity);
        self.settled[place][place] = -self.left[place];
        for j in count..N {
            self.settled[place][j] = self.ahead[place][j];
        }
        (variance, inverse_std)
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
            angle[place] = left * self.own[place];
            (angle, velocity)
        } else {
            let mut angle = self.ahead[place];
            angle.iter_mut().take(count).for_each(|covariance| *covariance = 0.0);
            (angle, self.velocity[place])
        }
    }
}

/// Numbers of a row that come first, whole blocks: the rows of a triangle that begin or end there need the other half alone.
const fn half<const N: usize>() -> usize {
    let half = (N / 2).div_ceil(SQUARE) * SQUARE;
    if half < N { half } else { N }
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
