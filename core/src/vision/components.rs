//! Statistics of a connected component, accumulated run by run.

use super::runs::{Run, RunList, RunPool};
use crate::camera::Pixel;
use core::f32::consts::{FRAC_1_SQRT_2, PI};
use core::num::NonZeroU64;

/// Smallest upright rectangle of whole pixels around a component; both corners belong to it.
///
/// ```
/// use sinew_core::vision::components::BoundingBox;
///
/// let hand = BoundingBox { min_u: 100, min_v: 40, max_u: 139, max_v: 99 };
/// assert_eq!((hand.width_px(), hand.height_px()), (40, 60), "both corners belong to it");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BoundingBox {
    /// Leftmost column.
    pub min_u: u16,
    /// Topmost row.
    pub min_v: u16,
    /// Rightmost column.
    pub max_u: u16,
    /// Lowest row.
    pub max_v: u16,
}

impl BoundingBox {
    /// Width, pixels (at least 1).
    #[must_use]
    pub fn width_px(&self) -> u32 {
        u32::from(self.max_u.saturating_sub(self.min_u)) + 1
    }

    /// Height, pixels (at least 1).
    #[must_use]
    pub fn height_px(&self) -> u32 {
        u32::from(self.max_v.saturating_sub(self.min_v)) + 1
    }
}

/// Exact integer sums of a component after its last line, from which the features follow.
///
/// Sums hold for masks of up to [`super::mask::MAX_SIDE_PX`] squared.
///
/// ```
/// use sinew_core::camera::Pixel;
/// use sinew_core::vision::component_scanner::ComponentScanner;
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::RunPool;
///
/// // A bar of eight by two pixels; without a pool there are sums, and no shape.
/// let mask = Mask::new(&[0, 0xff00, 0xff00, 0], 32, 4)?;
/// ComponentScanner::<8, 8>::new().scan(&mask, &mut RunPool::new(&mut []), &mut |bar, _| {
///     assert_eq!((bar.area_px(), bar.centroid()), (16, Pixel::new(11.5, 1.5)));
///     let [uu, uv, vv] = bar.moments_px2();
///     assert!(uu > 5.0 && uv == 0.0 && vv < 0.3, "it lies along u");
/// });
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Component {
    area_px: u32,
    twice_sum_u: u64,
    sum_v: u64,
    twelve_sum_uu: u64,
    twice_sum_uv: u64,
    sum_vv: u64,
    bounding_box: BoundingBox,
    run_count: u32,
    /// Pairs of set pixels (u, v), (u + d, v + 1) for d = -1, 0, 1.
    pairs: [u32; 3],
    pub(super) runs: RunList,
    unrecorded_px: u32,
}

impl Component {
    /// A component without pixels.
    const EMPTY: Self = Self {
        area_px: 0,
        twice_sum_u: 0,
        sum_v: 0,
        twelve_sum_uu: 0,
        twice_sum_uv: 0,
        sum_vv: 0,
        bounding_box: BoundingBox { min_u: u16::MAX, min_v: u16::MAX, max_u: 0, max_v: 0 },
        run_count: 0,
        pairs: [0; 3],
        runs: RunList::EMPTY,
        unrecorded_px: 0,
    };

    /// The component of one run `start..end` (not empty) of line `row`.
    pub(super) fn from_run(start: u16, end: u16, row: u16) -> Self {
        let mut component = Self::EMPTY;
        component.bounding_box.min_v = row;
        component.add_run(start, end, row, [0; 3]);
        component
    }

    /// Adds the run `start..end` (not empty) of line `row`, and its `pairs` with runs of the line
    /// above, see [`overlaps`].
    ///
    /// Lines must not go backwards.
    #[inline(always)]
    pub(super) fn add_run(&mut self, start: u16, end: u16, row: u16, pairs: [u32; 3]) {
        // No product of two factors exceeds 32 bits: sides are at most 8192 pixels. A run of n
        // pixels has the middle m = s / 2. Its sums are n m and n m^2 + n (n^2 - 1) / 12. Twice the
        // first and twelve times the second are whole.
        let (first, next, v) = (u32::from(start), u32::from(end), u32::from(row));
        let (area, s) = (next - first, first + next - 1);
        let (twice_sum_u, sum_v) = (area * s, area * v);
        self.area_px += area;
        self.twice_sum_u += u64::from(twice_sum_u);
        self.sum_v += u64::from(sum_v);
        self.twelve_sum_uu += u64::from(area) * u64::from(3 * s * s + area * area - 1);
        self.twice_sum_uv += u64::from(twice_sum_u) * u64::from(v);
        self.sum_vv += u64::from(sum_v) * u64::from(v);
        let bounds = &mut self.bounding_box;
        bounds.min_u = bounds.min_u.min(start);
        bounds.max_u = bounds.max_u.max(end - 1);
        bounds.max_v = row;
        self.run_count += 1;
        self.pairs.iter_mut().zip(pairs).for_each(|(mine, more)| *mine += more);
        self.unrecorded_px += area;
    }

    /// Takes over all of `other`'s pixels and runs.
    pub(super) fn merge(&mut self, other: &Self, pool: &mut RunPool<'_>) {
        self.area_px += other.area_px;
        self.twice_sum_u += other.twice_sum_u;
        self.sum_v += other.sum_v;
        self.twelve_sum_uu += other.twelve_sum_uu;
        self.twice_sum_uv += other.twice_sum_uv;
        self.sum_vv += other.sum_vv;
        let (a, b) = (&mut self.bounding_box, &other.bounding_box);
        a.min_u = a.min_u.min(b.min_u);
        a.min_v = a.min_v.min(b.min_v);
        a.max_u = a.max_u.max(b.max_u);
        a.max_v = a.max_v.max(b.max_v);
        self.run_count += other.run_count;
        for (mine, theirs) in self.pairs.iter_mut().zip(other.pairs) {
            *mine += theirs;
        }
        self.unrecorded_px += other.unrecorded_px;
        pool.join(&mut self.runs, other.runs);
    }

    /// Keeps a run of this component in the pool, if there is room.
    #[inline(always)]
    pub(super) fn record(&mut self, start: u16, end: u16, row: u16, pool: &mut RunPool<'_>) {
        if pool.append(&mut self.runs, start, end, row) {
            self.unrecorded_px -= u32::from(end - start);
        }
    }

    /// Number of pixels.
    #[must_use]
    pub fn area_px(&self) -> u32 {
        self.area_px
    }

    /// The smallest upright rectangle around it.
    #[must_use]
    pub fn bounding_box(&self) -> BoundingBox {
        self.bounding_box
    }

    /// Centre of gravity.
    #[must_use]
    pub fn centroid(&self) -> Pixel {
        let area = NonZeroU64::new(u64::from(self.area_px)).unwrap_or(NonZeroU64::MIN);
        let mean = |sum: u64| (sum / area) as f32 + (sum % area) as f32 / area.get() as f32;
        Pixel::new(mean(self.twice_sum_u / 2), mean(self.sum_v))
    }

    /// Second central moments of the pixels' centres: uu, uv, vv, square pixels.
    #[must_use]
    pub fn moments_px2(&self) -> [f32; 3] {
        let area = i64::from(self.area_px.max(1));
        let (su, sv) = ((self.twice_sum_u / 2) as i64, self.sum_v as i64);
        let (suu, suv) = ((self.twelve_sum_uu / 12) as i64, (self.twice_sum_uv / 2) as i64);
        let (cu, cv) = (su / area, sv / area);
        // Exact about a whole pixel near the centroid, then moved by the fraction of a pixel that
        // is left.
        let (du, dv) = ((su % area) as f32 / area as f32, (sv % area) as f32 / area as f32);
        let uu = suu - 2 * cu * su + area * cu * cu;
        let vv = self.sum_vv as i64 - 2 * cv * sv + area * cv * cv;
        let uv = suv - cu * sv - cv * su + area * cu * cv;
        let n = area as f32;
        [uu as f32 / n - du * du, uv as f32 / n - du * dv, vv as f32 / n - dv * dv]
    }

    /// Length of the outline (holes' outlines too), pixels; see [`crofton_perimeter`].
    #[must_use]
    pub fn perimeter_px(&self) -> f32 {
        crofton_perimeter(self.area_px, self.run_count, self.pairs)
    }

    /// Pixels of runs that found no room in the pool; zero when the shape is complete.
    #[must_use]
    pub fn unrecorded_px(&self) -> u32 {
        self.unrecorded_px
    }

    /// The component's runs in `pool`, in no particular order.
    pub fn runs<'p>(&self, pool: &'p RunPool<'_>) -> impl Iterator<Item = Run> + 'p {
        pool.iter(self.runs)
    }
}

/// Pairs of pixels (u, v), (u + d, v + 1), d = -1, 0, 1, of two runs of successive lines, columns
/// from and to.
#[inline]
pub(super) fn overlaps(above: (u16, u16), below: (u16, u16)) -> [u32; 3] {
    let (a0, a1, b0, b1) = (i32::from(above.0), i32::from(above.1), i32::from(below.0), i32::from(below.1));
    // A shift by one moves the common part's ends only where they are the upper run's.
    let common = a1.min(b1) - a0.max(b0);
    let left = common - i32::from(a1 <= b1) + i32::from(a0 > b0);
    let right = common + i32::from(a1 < b1) - i32::from(a0 >= b0);
    [left, common, right].map(|pairs| pairs.max(0) as u32)
}

/// Perimeter of a set of pixels from how often lines in four directions cross its outline
/// (Cauchy-Crofton).
///
/// Rows cross the outline twice a run. Columns and diagonals cross it twice for each pixel without
/// a set neighbour in that direction. These counts follow from the area and the `pairs` of set
/// pixels. A pair is (u, v) and (u + d, v + 1), where d is -1, 0 or 1. With diagonals 1/sqrt 2
/// apart, `P = pi/8 (rows + columns + (both diagonals) / sqrt 2)`.
///
/// The mean over directions is unbiased. A straight edge reads from 5.2 % too short (upright and at
/// 45 degrees) to 2.7 % too long (between), a disc right (asserted by tests).
///
/// ```
/// use sinew_core::vision::components::crofton_perimeter;
///
/// // A square of ten pixels: 90 of them have one below, 81 one to the left or right below.
/// let perimeter_px = crofton_perimeter(100, 10, [81, 90, 81]);
/// assert!(
///     (perimeter_px - 36.8).abs() < 0.1,
///     "upright edges read 5 % short, and corners are cut"
/// );
/// ```
#[must_use]
pub fn crofton_perimeter(area_px: u32, run_count: u32, pairs: [u32; 3]) -> f32 {
    let crossings = |pairs: u32| 2.0 * area_px.saturating_sub(pairs) as f32;
    let upright = 2.0 * run_count as f32 + crossings(pairs[1]);
    PI / 8.0 * (upright + FRAC_1_SQRT_2 * (crossings(pairs[0]) + crossings(pairs[2])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::component_scanner::ComponentScanner;
    use crate::vision::mask::{MAX_SIDE_PX, MaskMut, words_per_row};

    /// The only component of the points where `inside` holds.
    fn component(width: usize, height: usize, inside: impl Fn(f32, f32) -> bool) -> Component {
        let mut words = vec![0; words_per_row(width) * height];
        let mut mask = MaskMut::new(&mut words, width, height).unwrap();
        (0..height).for_each(|v| (0..width).for_each(|u| mask.set(u, v, inside(u as f32, v as f32))));
        let mut scanner = ComponentScanner::<8, 8>::new();
        let mut found = None;
        scanner.scan(&mask.view(), &mut RunPool::new(&mut []), &mut |c, _| assert!(found.replace(*c).is_none()));
        found.unwrap()
    }

    #[test]
    fn sums_of_runs_are_exact() {
        let mut sums = [0_u64; 2];
        // Miri takes a minute for all.
        let last = if cfg!(miri) { 64 } else { MAX_SIDE_PX as u16 };
        for end in 1..=last {
            let u = u64::from(end - 1);
            sums = [sums[0] + u, sums[1] + u * u];
            let whole = Component::from_run(0, end, 3);
            assert_eq!([whole.twice_sum_u, whole.twelve_sum_uu], [2 * sums[0], 12 * sums[1]]);
            assert_eq!(whole.twice_sum_uv, 6 * sums[0]);
            let (mut parts, middle) = (Component::from_run(0, end / 3 + 1, 3), end / 3 + 1);
            if middle < end {
                parts.add_run(middle, end, 3, [0; 3]);
                assert_eq!(Component { run_count: 1, ..parts }, whole);
            }
        }
    }

    #[test]
    fn pairs_of_runs_are_counted_pixel_by_pixel() {
        let set = |run: (u16, u16), u: i32| (i32::from(run.0)..i32::from(run.1)).contains(&u);
        // Miri takes a minute for all.
        for code in (0..8_u16.pow(4)).step_by(if cfg!(miri) { 97 } else { 1 }) {
            let [a0, a1, b0, b1] = [code % 8, code / 8 % 8, code / 64 % 8, code / 512];
            let (above, below) = ((a0, a0 + 1 + a1), (b0, b0 + 1 + b1));
            let counted = [-1, 0, 1].map(|d| (-1..17).filter(|&u| set(above, u) && set(below, u + d)).count() as u32);
            assert_eq!(overlaps(above, below), counted, "{above:?} {below:?}");
        }
    }

    #[test]
    #[cfg_attr(miri, ignore = "takes a minute")]
    fn perimeters_of_discs_are_right_to_two_percent() {
        let mut worst = 0.0_f32;
        for radius in [8.3_f32, 12.4, 20.5, 40.2] {
            for shift in [0.0, 0.25, 0.5] {
                let disc =
                    component(100, 100, |u, v| (u - 48.0 - shift).powi(2) + (v - 47.0).powi(2) <= radius * radius);
                let ratio = disc.perimeter_px() / (2.0 * PI * radius);
                worst = worst.max((ratio - 1.0).abs());
            }
        }
        assert!((0.001..0.02).contains(&worst), "{worst}");
    }

    #[test]
    #[cfg_attr(miri, ignore = "takes a minute")]
    fn perimeters_of_turned_squares_stay_within_the_stated_bounds() {
        let (mut low, mut high) = (f32::MAX, 0.0_f32);
        for degrees in (0..90).step_by(3) {
            let (s, c) = (degrees as f32).to_radians().sin_cos();
            let square = component(120, 120, |u, v| {
                let (du, dv) = (u - 59.5, v - 59.5);
                (c * du + s * dv).abs() <= 30.0 && (c * dv - s * du).abs() <= 30.0
            });
            let ratio = square.perimeter_px() / 240.0;
            (low, high) = (low.min(ratio), high.max(ratio));
        }
        assert!((0.93..0.955).contains(&low) && (1.015..1.04).contains(&high), "{low} {high}");
    }

    #[test]
    #[cfg_attr(miri, ignore = "takes a minute")]
    fn a_full_mask_of_the_largest_size_does_not_overflow() {
        let words = vec![u32::MAX; MAX_SIDE_PX / 32];
        let mut scanner = ComponentScanner::<2, 2>::new();
        let mut pool = RunPool::new(&mut []);
        let mut found = None;
        for _ in 0..MAX_SIDE_PX + 3 {
            scanner.line(&words, &mut pool, &mut |_, _| panic!("nothing ends yet"));
        }
        scanner.finish(&mut pool, &mut |c, _| found = Some(*c));
        let full = found.unwrap();
        let side = MAX_SIDE_PX as f64;
        let moments = full.moments_px2();
        let variance = (side * side - 1.0) / 12.0;
        assert!((f64::from(moments[0]) / variance - 1.0).abs() < 1.0e-6 && moments[1].abs() < 0.5, "{moments:?}");
        assert_eq!(full.centroid(), Pixel::new(4095.5, 4095.5));
        assert_eq!(full.area_px(), 8192 * 8192);
        assert_eq!(full.bounding_box().width_px(), 8192);
    }
}
