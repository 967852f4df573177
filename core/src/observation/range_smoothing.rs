//! Distances from the camera, averaged over neighbouring lines of sight.
//!
//! The noise of a stereo camera's distances grows with the square of the distance: 2 cm at 2.5 m,
//! 16 cm at 7 m. That is more than a limb's thickness. Neighbouring lines of sight mostly end on
//! the same skin, so each point moves along its own line towards the mean distance of its
//! neighbours. The larger the noise, the further it moves. The noise is estimated from the
//! neighbours; the camera's model is not needed.
//!
//! A hand that points to the camera is seen beside the trunk behind it. So the mean is that of the
//! neighbours about the mean itself, and not about one noisy distance: a mean shift along the line
//! of sight (Comaniciu and Meer 2002, section 2).

use crate::error::{ParameterError, Rule, positive};
use crate::math::{Vec3, abs, clamp, floor, length, max, min, sqrt, unit};
use core::cmp::Ordering;
use heapless::Vec;

/// Largest number of differences between neighbours of which the median is taken; of more every
/// n-th.
const MAX_DIFFERENCES: usize = 512;
/// Median of |a - b| for standard normal a and b: the root of 2 times 0.6745.
const MEDIAN_DIFFERENCE: f32 = 0.953_87;
/// Neighbours count up to this many standard deviations of a difference about the mean.
///
/// Chosen on the tuning runners: from 1.7 to 2.4 with three means the share of near frames that
/// have a lost joint is below that of one mean with 3, the usual gate of 99.7 %.
const GATE_SIGMAS: f32 = 2.0;
/// Means that are taken one after the other, each about the one before; the first is about the
/// point's own distance.
///
/// Chosen on the tuning runners: five are no better.
const MEANS: usize = 3;
/// Integer units of a metre, and of a unit direction, in sums that do not depend on their order.
///
/// Chosen: micrometres, far below a sensor's noise; the sums fit in 64 bits.
const UNITS_PER_METRE: f32 = 1.0e6;
/// Largest distance of a point in the mean, metres.
///
/// Chosen: bounds the integer sums, far beyond a room.
const MAX_RANGE_M: f32 = 1.0e3;
/// Smallest number of neighbours in a mean, the point itself included.
///
/// Chosen: of fewer the mean is noise itself.
const MIN_NEIGHBOURS: f32 = 4.0;

/// A point as the camera sees it.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::range_smoothing::{RangeSmoothing, SightLine};
///
/// // The caller gives the working memory; each of two hundred points stays on its line of sight.
/// let mut points_m =
///     core::array::from_fn::<Vec3, 200, _>(|i| Vec3::new(0.002 * i as f32, 0.0, 3.0));
/// let before = points_m;
/// let mut lines = [SightLine::default(); 200];
/// RangeSmoothing::new(0.04, 0.03)?.smooth(&mut points_m, &Vec3::zeros(), &mut lines);
/// assert!(points_m.iter().zip(&before).all(|(after, before)| after.cross(before).norm() < 1e-4));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SightLine {
    /// Row of the view that the line goes through.
    row: i32,
    /// Tangents across the view: along the row and across rows.
    tangents: [f32; 2],
    /// Distance from the camera, metres.
    range_m: f32,
    /// Index of the point.
    index: u32,
}

/// How distances are averaged.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::range_smoothing::{RangeSmoothing, SightLine};
/// use sinew_core::random::Stream;
///
/// // A wall six metres away, seen with 12 cm of noise: most of it goes.
/// let mut stream = Stream::new(1, 0, 0);
/// let mut points_m = core::array::from_fn::<Vec3, 600, _>(|i| {
///     let place_m = Vec3::new(0.015 * (i % 30) as f32, 0.015 * (i / 30) as f32, 6.0);
///     place_m * (1.0 + 0.02 * stream.normal())
/// });
/// let off_m = |points_m: &[Vec3]| {
///     (points_m.iter().map(|p| (p.z - 6.0).powi(2)).sum::<f32>() / 600.0).sqrt()
/// };
/// let before_m = off_m(&points_m);
/// RangeSmoothing::new(0.04, 0.03)?.smooth(
///     &mut points_m,
///     &Vec3::zeros(),
///     &mut [SightLine::default(); 600],
/// );
/// assert!(before_m > 0.1 && off_m(&points_m) < 0.4 * before_m);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeSmoothing {
    radius_m: f32,
    skin_std_m: f32,
    along_share: f32,
}

/// Where the cloud lies as the camera sees it.
struct View {
    camera_m: Vec3,
    ahead: Vec3,
    along: Vec3,
    across: Vec3,
    /// Tangent of the radius about a point at the mean distance.
    reach: f32,
}

impl RangeSmoothing {
    /// Means over `radius_m` metres to each side.
    ///
    /// Where distances scatter by `skin_std_m` metres, as those of a limb's skin do, points move
    /// half of the way.
    ///
    /// # Errors
    /// Both have to be positive.
    pub fn new(radius_m: f32, skin_std_m: f32) -> Result<Self, ParameterError> {
        Ok(Self {
            radius_m: positive("smoothing radius_m", radius_m)?,
            skin_std_m: positive("smoothing skin_std_m", skin_std_m)?,
            along_share: 0.0,
        })
    }

    /// Points keep this share of the measured scatter of their neighbours' distances, less the
    /// skin's own, as a standard deviation along their lines of sight. Means over neighbours have
    /// less scatter, but share it with them.
    ///
    /// # Errors
    /// A share that is below zero or not finite.
    pub fn keeping(mut self, along_share: f32) -> Result<Self, ParameterError> {
        if !(along_share >= 0.0 && along_share.is_finite()) {
            return Err(ParameterError::new("smoothing along_share", Rule::NotNegative));
        }
        self.along_share = along_share;
        Ok(self)
    }

    /// Moves `points_m`, metres, along their lines of sight from the camera at `camera_m`.
    ///
    /// `lines` is working memory; points beyond its length stay. So do points that are not finite,
    /// at the camera, or more than a right angle off the cloud's middle. The result does not depend
    /// on the order of the points.
    ///
    /// Gives the standard deviation of a point along its line of sight, beyond that across, metres
    /// ([`Self::keeping`]).
    pub fn smooth(&self, points_m: &mut [Vec3], camera_m: &Vec3, lines: &mut [SightLine]) -> f32 {
        let Some(view) = self.view(points_m, camera_m) else { return 0.0 };
        let mut count = 0;
        for (index, point_m) in points_m.iter().enumerate() {
            if let (Some(line), Some(slot)) = (view.line(index, point_m), lines.get_mut(count)) {
                *slot = line;
                count += 1;
            }
        }
        let lines = lines.get_mut(..count).unwrap_or_default();
        lines.sort_unstable_by(SightLine::in_rows);
        let noise_m = noise_m(lines, view.reach);
        let share = noise_m * noise_m / (noise_m * noise_m + self.skin_std_m * self.skin_std_m);
        if !(share > 0.0) {
            return 0.0;
        }
        let gate_m = GATE_SIGMAS * core::f32::consts::SQRT_2 * noise_m;
        let mut first_in_reach = [0; 3];
        for line in &*lines {
            let mean_m = mean_range_m(lines, line, (view.reach, gate_m), &mut first_in_reach);
            if let (Some(mean_m), Some(point_m)) = (mean_m, points_m.get_mut(line.index as usize)) {
                let moved = 1.0 + share * (mean_m - line.range_m) / line.range_m;
                *point_m = view.camera_m + (*point_m - view.camera_m) * moved;
            }
        }
        self.along_share * sqrt(max(noise_m * noise_m - self.skin_std_m * self.skin_std_m, 0.0))
    }

    fn view(&self, points_m: &[Vec3], camera_m: &Vec3) -> Option<View> {
        // Whole numbers add up to the same in any order.
        let (mut sums, mut range, mut count) = ([0_i64; 3], 0_i64, 0_i64);
        for point_m in points_m {
            let sight = point_m - camera_m;
            let range_m = length(&sight);
            if let (true, Some(direction)) = (range_m.is_finite(), unit(sight)) {
                for (sum, part) in sums.iter_mut().zip(direction.iter()) {
                    *sum += (UNITS_PER_METRE * part) as i64;
                }
                range += (UNITS_PER_METRE * min(range_m, MAX_RANGE_M)) as i64;
                count += 1;
            }
        }
        let sum = Vec3::from(sums.map(|sum| sum as f32));
        let ahead = unit(sum)?;
        // Any axis that is not along the view gives two across it.
        let other = if abs(ahead.x) < 0.8 { Vec3::x() } else { Vec3::y() };
        let across = unit(ahead.cross(&other))?;
        let reach = self.radius_m * UNITS_PER_METRE * count as f32 / max(range as f32, 1.0);
        Some(View { camera_m: *camera_m, ahead, along: across.cross(&ahead), across, reach })
    }
}

impl View {
    fn line(&self, index: usize, point_m: &Vec3) -> Option<SightLine> {
        let sight = point_m - self.camera_m;
        let (range_m, depth_m) = (length(&sight), sight.dot(&self.ahead));
        if !(range_m.is_finite() && depth_m > 0.0) {
            return None;
        }
        let tangents = [sight.dot(&self.along) / depth_m, sight.dot(&self.across) / depth_m];
        let row = clamp(floor(tangents[1] / self.reach), -1.0e9, 1.0e9) as i32;
        Some(SightLine { row, tangents, range_m, index: index as u32 })
    }
}

impl SightLine {
    /// Row by row, from one side to the other; by their numbers alone, so that the order given does
    /// not matter.
    fn in_rows(&self, other: &Self) -> Ordering {
        let numbers = |line: &Self| [line.tangents[0], line.tangents[1], line.range_m];
        let by_number = || {
            let pairs = numbers(self).into_iter().zip(numbers(other));
            pairs.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
        };
        self.row.cmp(&other.row).then_with(by_number)
    }
}

/// Standard deviation of neighbours' distances about each other, from the median of the
/// differences; zero without neighbours.
fn noise_m(lines: &[SightLine], reach: f32) -> f32 {
    let mut differences: Vec<f32, MAX_DIFFERENCES> = Vec::new();
    let stride = lines.len().div_ceil(MAX_DIFFERENCES).max(1);
    for (one, next) in lines.iter().zip(lines.iter().skip(1)).step_by(stride) {
        if one.row == next.row && next.tangents[0] - one.tangents[0] < reach {
            // The stride was taken so that all fit.
            let _ = differences.push(abs(next.range_m - one.range_m));
        }
    }
    if differences.is_empty() {
        return 0.0;
    }
    let middle = differences.len() / 2;
    *differences.select_nth_unstable_by(middle, f32::total_cmp).1 / MEDIAN_DIFFERENCE
}

/// Distance of the skin that `line` ends on: mean distance of the neighbours in its own row and
/// those beside it, of those within the gate about the mean before; `None` where they are few.
///
/// `first_in_reach` holds, for the three rows, where the neighbours of the previous line began.
fn mean_range_m(
    lines: &[SightLine],
    line: &SightLine,
    (reach, gate_m): (f32, f32),
    first_in_reach: &mut [usize; 3],
) -> Option<f32> {
    for (first, row) in first_in_reach.iter_mut().zip(line.row - 1..=line.row + 1) {
        let before = |other: &SightLine| (other.row, other.tangents[0]) < (row, line.tangents[0] - reach);
        *first += lines.iter().skip(*first).take_while(|other| before(other)).count();
    }
    let mut mean_off_m = None;
    for _ in 0..MEANS {
        let about_m = mean_off_m.unwrap_or(0.0);
        let (mut sum_m, mut count) = (0.0, 0.0);
        for (first, row) in first_in_reach.iter().zip(line.row - 1..=line.row + 1) {
            for other in lines.iter().skip(*first) {
                let (along, across) = (other.tangents[0] - line.tangents[0], other.tangents[1] - line.tangents[1]);
                if other.row != row || along > reach {
                    break;
                }
                let off_m = other.range_m - line.range_m;
                if along * along + across * across <= reach * reach && abs(off_m - about_m) <= gate_m {
                    sum_m += off_m;
                    count += 1.0;
                }
            }
        }
        if count < MIN_NEIGHBOURS {
            break;
        }
        mean_off_m = Some(sum_m / count);
    }
    mean_off_m.map(|off_m| line.range_m + off_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use proptest::prelude::*;

    const SMOOTHING: RangeSmoothing = RangeSmoothing { radius_m: 0.04, skin_std_m: 0.015, along_share: 0.0 };

    fn smoothed(points_m: &[Vec3], camera_m: &Vec3) -> std::vec::Vec<Vec3> {
        let mut points_m = points_m.to_vec();
        let mut lines = std::vec![SightLine::default(); points_m.len()];
        let _ = SMOOTHING.smooth(&mut points_m, camera_m, &mut lines);
        points_m
    }

    /// `count` points of a wall one metre wide and high, `range_m` away, with noise along their
    /// lines of sight.
    fn wall(count: usize, range_m: f32, noise_m: f32, stream: &mut Stream) -> std::vec::Vec<Vec3> {
        let mut point = || {
            let (x, y) = (stream.uniform() - 0.5, stream.uniform() - 0.5);
            Vec3::new(x, y, range_m) * (1.0 + noise_m / range_m * stream.normal())
        };
        (0..count).map(|_| point()).collect()
    }

    fn off_m(points_m: &[Vec3], range_m: f32) -> f32 {
        let squares = points_m.iter().map(|point| (point.z - range_m).powi(2));
        (squares.sum::<f32>() / points_m.len() as f32).sqrt()
    }

    #[test]
    fn noise_goes_where_it_is_large_and_the_skin_stays_where_it_is_small() {
        let mut stream = Stream::new(5, 0, 0);
        for (range_m, noise_m, least, most) in [(7.0, 0.16, 0.15, 0.4), (2.0, 0.005, 0.85, 1.0)] {
            let points_m = wall(4000, range_m, noise_m, &mut stream);
            let left = off_m(&smoothed(&points_m, &Vec3::zeros()), range_m) / off_m(&points_m, range_m);
            assert!((least..most).contains(&left), "{left} of {noise_m} m are left");
        }
    }

    #[test]
    fn two_skins_behind_one_another_are_not_mixed() {
        let mut stream = Stream::new(6, 0, 0);
        let mut points_m = wall(2000, 3.0, 0.02, &mut stream);
        let behind = points_m.len();
        points_m.extend(wall(2000, 3.3, 0.02, &mut stream));
        let smoothed_m = smoothed(&points_m, &Vec3::zeros());
        assert!(off_m(&smoothed_m[..behind], 3.0) < 0.03, "{}", off_m(&smoothed_m[..behind], 3.0));
        assert!(off_m(&smoothed_m[behind..], 3.3) < 0.03, "{}", off_m(&smoothed_m[behind..], 3.3));
    }

    /// A fist 5 m away and 40 cm before a chest, with 10 cm of noise. About a point's own distance,
    /// with a gate of 3, half of its points would lie farther than 6 cm from it.
    #[test]
    fn a_fist_before_a_chest_is_not_drawn_into_it() {
        let is_fist = |x: f32, y: f32| x * x + y * y < 0.05 * 0.05;
        let (mut near, mut all) = (0.0, 0.0);
        for seed in 0..6 {
            let mut stream = Stream::new(seed, 0, 0);
            let mut points_m = std::vec::Vec::new();
            for _ in 0..1500 {
                let [x, y] = [stream.uniform(), stream.uniform()].map(|share| 0.6 * share - 0.3);
                let z = if is_fist(x, y) { 5.1 } else { 5.5 };
                points_m.push(Vec3::new(x, y, z) * (1.0 + 0.1 / z * stream.normal()));
            }
            for (before, after) in points_m.iter().zip(smoothed(&points_m, &Vec3::zeros())) {
                // The line of sight of the noisy point: its place on a plane that was drawn.
                let at = |z: f32| is_fist(before.x / before.z * z, before.y / before.z * z);
                if at(5.1) && at(5.5) {
                    all += 1.0;
                    near += if abs(after.z - 5.1) < 0.06 { 1.0 } else { 0.0 };
                }
            }
        }
        assert!(all > 150.0 && (0.58..0.85).contains(&(near / all)), "{near} of {all}");
    }

    #[test]
    fn what_cannot_be_smoothed_stays_as_it_is() {
        let few = [Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.01, 0.0, 2.3), Vec3::new(0.0, 0.01, 1.9)];
        assert_eq!(smoothed(&few, &Vec3::zeros()), few);
        assert!(smoothed(&[], &Vec3::zeros()).is_empty());
        assert_eq!(smoothed(&[Vec3::zeros(); 9], &Vec3::zeros()), [Vec3::zeros(); 9], "all at the camera");
        let mut points_m = wall(500, 5.0, 0.1, &mut Stream::new(7, 0, 0));
        points_m.extend([Vec3::new(0.0, f32::NAN, 5.0), Vec3::new(0.1, 0.0, f32::INFINITY), Vec3::new(0.0, 0.0, -4.0)]);
        let after_m = smoothed(&points_m, &Vec3::zeros());
        assert!(after_m[500].y.is_nan() && after_m[501..] == points_m[501..]);
        assert!(after_m[..500] != points_m[..500], "and the others are smoothed all the same");
        // Room for fewer lines than there are points: the first ones are smoothed.
        let mut short_m = points_m.clone();
        let _ = SMOOTHING.smooth(&mut short_m, &Vec3::zeros(), &mut [SightLine::default(); 400]);
        assert!(short_m[400..500] == points_m[400..500] && short_m[..400] != points_m[..400]);
    }

    #[test]
    fn numbers_have_to_be_positive() {
        assert_eq!(RangeSmoothing::new(0.0, 0.02).unwrap_err().parameter, "smoothing radius_m");
        assert_eq!(RangeSmoothing::new(0.04, f32::NAN).unwrap_err().parameter, "smoothing skin_std_m");
    }

    proptest! {
        #[test]
        fn points_move_along_their_lines_between_the_others_whatever_their_order(
            seed in 0_u64..1000, turn in 0.0_f32..6.0, noise_m in 0.01_f32..0.3,
        ) {
            let mut stream = Stream::new(seed, 0, 0);
            let camera_m = Vec3::new(0.3, -0.2, 0.1);
            let turned = crate::math::axis_rotation(&Vec3::y(), turn);
            let points_m: std::vec::Vec<Vec3> =
                wall(600, 4.0, noise_m, &mut stream).iter().map(|point| turned * point + camera_m).collect();
            let after_m = smoothed(&points_m, &camera_m);
            let range_m = |point: &Vec3| (point - camera_m).norm();
            let (nearest, farthest) = points_m.iter().map(range_m).fold((f32::MAX, 0.0_f32), |(a, b), r| (a.min(r), b.max(r)));
            for (before, after) in points_m.iter().zip(&after_m) {
                let (before, after) = (before - camera_m, after - camera_m);
                prop_assert!(before.cross(&after).norm() < 1.0e-4 * before.norm() * after.norm());
                prop_assert!(after.norm() > nearest - 1.0e-3 && after.norm() < farthest + 1.0e-3);
            }
            let reversed: std::vec::Vec<Vec3> = points_m.iter().rev().copied().collect();
            let mut again = smoothed(&reversed, &camera_m);
            again.reverse();
            prop_assert_eq!(after_m, again);
        }
    }
}
