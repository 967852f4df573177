//! A frame's 3D points in blocks of neighbours, so that a whole block is compared with few bones.

use crate::math::{Vec3, abs, floor, length, max};
use crate::ranges::{MAX_M, is_place};
use heapless::Vec;

/// Points of a block: a few vectors of the processor.
pub const BLOCK_POINTS: usize = 16;
/// Bits of each coordinate in a Morton key.
const KEY_BITS: u32 = 10;
/// Edge of a cell of the Morton order, metres.
///
/// Chosen: 1024 cells span 20 m.
const CELL_M: f32 = 0.02;
/// A point nearer to the camera than this is an error of the sensor, metres.
///
/// Chosen: sensors code missing points as the camera's centre.
pub const MIN_RANGE_M: f32 = 0.01;

/// Neighbouring points, coordinate by coordinate.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::point_cloud::PointCloud;
///
/// let mut points_m = [Vec3::new(0.1, 0.0, 2.0), Vec3::new(-0.1, 0.0, 2.0)];
/// let mut cloud = PointCloud::<4>::new();
/// assert_eq!(cloud.set(&mut points_m, &Vec3::zeros()).over_capacity, 0);
/// let block = &cloud.blocks()[0];
/// assert_eq!(block.count, 2, "the rest of its sixteen places repeats the last point");
/// // A ball that holds them all: whole blocks are judged by it before single points are.
/// assert!(
///     (0..2).all(
///         |index| (block.point_m(index) - block.centre_m).norm() <= block.radius_m + 1e-6
///     )
/// );
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointBlock {
    /// First coordinates, metres.
    pub x: [f32; BLOCK_POINTS],
    /// Second coordinates, metres.
    pub y: [f32; BLOCK_POINTS],
    /// Third coordinates, metres.
    pub z: [f32; BLOCK_POINTS],
    /// Number of points; the rest repeat the last one and have no weight.
    pub count: u8,
    /// Centre of a sphere round all of them, metres.
    pub centre_m: Vec3,
    /// Radius of that sphere, metres.
    pub radius_m: f32,
    /// Standard deviation of the points along their lines of sight, beyond what they have across
    /// them, metres; zero where both are the same.
    pub along_std_m: f32,
}

impl PointBlock {
    /// Point `index`, metres.
    #[inline]
    #[must_use]
    pub fn point_m(&self, index: usize) -> Vec3 {
        match (self.x.get(index), self.y.get(index), self.z.get(index)) {
            (Some(&x), Some(&y), Some(&z)) => Vec3::new(x, y, z),
            _ => self.centre_m,
        }
    }

    /// Whether count and points are within their ranges ([`crate::ranges`]), as those of a
    /// [`PointCloud`] are.
    pub(crate) fn is_usable(&self) -> bool {
        let mut coordinates_m = self.x.iter().chain(&self.y).chain(&self.z);
        usize::from(self.count) <= BLOCK_POINTS
            && coordinates_m.all(|coordinate_m| abs(*coordinate_m) <= 2.0 * MAX_M)
            && is_place(&(self.centre_m * 0.5))
            && (0.0..=4.0 * MAX_M).contains(&self.radius_m)
            && (0.0..=MAX_M).contains(&self.along_std_m)
    }

    /// The block of those of its points that `keeps` wants; none where it wants none.
    #[must_use]
    pub fn retained(&self, keeps: impl Fn(&Vec3) -> bool) -> Option<Self> {
        let all = (0..usize::from(self.count)).map(|index| self.point_m(index));
        let kept: Vec<Vec3, BLOCK_POINTS> = all.filter(keeps).take(BLOCK_POINTS).collect();
        (!kept.is_empty()).then(|| Self { along_std_m: self.along_std_m, ..Self::of(&kept) })
    }

    fn of(points_m: &[Vec3]) -> Self {
        let mut block = Self {
            x: [0.0; BLOCK_POINTS],
            y: [0.0; BLOCK_POINTS],
            z: [0.0; BLOCK_POINTS],
            count: points_m.len() as u8,
            centre_m: Vec3::zeros(),
            radius_m: 0.0,
            along_std_m: 0.0,
        };
        let mut last = Vec3::zeros();
        for i in 0..BLOCK_POINTS {
            last = points_m.get(i).copied().unwrap_or(last);
            (block.x[i], block.y[i], block.z[i]) = (last.x, last.y, last.z);
            block.centre_m += last * (1.0 / BLOCK_POINTS as f32);
        }
        for i in 0..BLOCK_POINTS {
            block.radius_m = max(block.radius_m, length(&(block.point_m(i) - block.centre_m)));
        }
        block
    }
}

/// What was left out of a cloud.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::point_cloud::{LeftOut, PointCloud};
///
/// // A sensor codes holes as NaN, or as points at the camera.
/// let mut points_m = [Vec3::new(0.0, 0.0, 2.0), Vec3::zeros(), Vec3::new(0.1, f32::NAN, 2.0)];
/// let mut cloud = PointCloud::<1>::new();
/// let left_out = cloud.set(&mut points_m, &Vec3::zeros());
/// assert_eq!(left_out, LeftOut { not_finite: 1, at_camera: 1, over_capacity: 0 });
/// assert_eq!(cloud.len(), 1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LeftOut {
    /// Points with a coordinate that is not finite, or farther than [`MAX_M`] from the camera.
    pub not_finite: u32,
    /// Points within [`MIN_RANGE_M`] of the camera.
    pub at_camera: u32,
    /// Points beyond the capacity.
    pub over_capacity: u32,
}

/// The points of one frame: at most `BLOCKS` times [`BLOCK_POINTS`].
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::point_cloud::{BLOCK_POINTS, PointCloud};
///
/// // Forty points on a wall, and room for two blocks of sixteen.
/// let mut points_m =
///     core::array::from_fn::<Vec3, 40, _>(|i| Vec3::new(0.02 * i as f32, 0.0, 2.0));
/// let mut cloud = PointCloud::<2>::new();
/// let left_out = cloud.set(&mut points_m, &Vec3::zeros());
/// assert_eq!(
///     (cloud.len(), left_out.over_capacity),
///     (2 * BLOCK_POINTS, 8),
///     "what has no room is counted"
/// );
/// assert!(
///     cloud.blocks().iter().all(|block| block.radius_m < 0.2),
///     "neighbours share a block"
/// );
/// ```
#[derive(Debug, Clone)]
pub struct PointCloud<const BLOCKS: usize> {
    blocks: Vec<PointBlock, BLOCKS>,
    points: usize,
}

impl<const BLOCKS: usize> Default for PointCloud<BLOCKS> {
    fn default() -> Self {
        Self { blocks: Vec::new(), points: 0 }
    }
}

impl<const BLOCKS: usize> PointCloud<BLOCKS> {
    /// No points.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// No points, for static memory.
    ///
    /// ```
    /// use sinew_core::observation::point_cloud::PointCloud;
    ///
    /// static CLOUD: PointCloud<32> = PointCloud::empty();
    /// assert!(CLOUD.is_empty() && CLOUD.blocks().is_empty());
    /// ```
    #[must_use]
    pub const fn empty() -> Self {
        Self { blocks: Vec::new(), points: 0 }
    }

    /// Becomes the cloud of `points_m`, which are brought into Morton order in place (those left
    /// out come last).
    ///
    /// Points that are not finite, beyond [`MAX_M`] or at the camera are left out. Of others beyond
    /// the capacity, as many as it holds are taken evenly through the list. All are counted. No
    /// point at all is a frame without evidence. It takes four bytes of stack a point.
    pub fn set(&mut self, points_m: &mut [Vec3], camera_m: &Vec3) -> LeftOut {
        let mut left_out = LeftOut::default();
        let (mut kept, mut usable) = (0, 0);
        let capacity = BLOCKS * BLOCK_POINTS;
        let usable_count = if points_m.len() > capacity { Self::usable_count(points_m, camera_m) } else { capacity };
        for i in 0..points_m.len() {
            let Some(&point) = points_m.get(i) else { break };
            let distance = length(&(point - camera_m));
            if !(distance <= MAX_M) {
                left_out.not_finite += 1;
            } else if distance < MIN_RANGE_M {
                left_out.at_camera += 1;
            } else {
                usable += 1;
                // The first so many of n points hold as large a part of those that are kept.
                if kept >= capacity || kept * usable_count >= usable * capacity {
                    left_out.over_capacity += 1;
                    continue;
                }
                if let Some(place) = points_m.get_mut(kept) {
                    let other = core::mem::replace(place, point);
                    if let Some(place) = points_m.get_mut(i) {
                        *place = other;
                    }
                }
                kept += 1;
            }
        }
        let points_m = points_m.get_mut(..kept).unwrap_or_default();
        Self::sort(points_m);
        self.blocks.clear();
        self.points = kept;
        for chunk in points_m.chunks(BLOCK_POINTS) {
            // The capacity was kept above.
            let _ = self.blocks.push(PointBlock::of(chunk));
        }
        left_out
    }

    #[inline(never)]
    fn usable_count(points_m: &[Vec3], camera_m: &Vec3) -> usize {
        let is_usable = |point: &&Vec3| (MIN_RANGE_M..=MAX_M).contains(&length(&(*point - camera_m)));
        points_m.iter().filter(is_usable).count().max(BLOCKS * BLOCK_POINTS)
    }

    // Not inlined: the keys leave the stack before the points are looked at.
    #[inline(never)]
    fn sort(points_m: &mut [Vec3]) {
        let mut keys = [[0; BLOCK_POINTS]; BLOCKS];
        heap_sort(points_m, keys.as_flattened_mut());
    }

    /// All points scatter by `along_std_m` metres along their lines of sight, beyond what they do
    /// across them.
    ///
    /// ```
    /// use sinew_core::math::Vec3;
    /// use sinew_core::observation::point_cloud::PointCloud;
    ///
    /// let mut cloud = PointCloud::<1>::new();
    /// let _ = cloud.set(&mut [Vec3::new(0.0, 0.0, 7.0)], &Vec3::zeros());
    /// cloud.scatter_by(0.16);
    /// assert_eq!(cloud.blocks()[0].along_std_m, 0.16);
    /// ```
    pub fn scatter_by(&mut self, along_std_m: f32) {
        for block in &mut self.blocks {
            block.along_std_m = crate::math::clamp(along_std_m, 0.0, MAX_M);
        }
    }

    /// The blocks, in Morton order.
    #[must_use]
    pub fn blocks(&self) -> &[PointBlock] {
        &self.blocks
    }

    /// How many points there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points
    }

    /// Whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points == 0
    }
}

/// Sorts points by their Morton keys, in n log n steps at most and so that a linker can prove that
/// it cannot panic (J. W. J. Williams, Algorithm 232: heapsort, 1964). `keys` has one for each
/// point, so that each is computed once.
fn heap_sort(points_m: &mut [Vec3], keys: &mut [u32]) {
    for (key, point_m) in keys.iter_mut().zip(&*points_m) {
        *key = morton_key(point_m).0;
    }
    let count = points_m.len().min(keys.len());
    for root in (0..count / 2).rev() {
        sift_down((points_m, keys), root, count);
    }
    for end in (1..count).rev() {
        exchange(points_m, 0, end);
        exchange(keys, 0, end);
        sift_down((points_m, keys), 0, end);
    }
}

/// Brings the point at `root` below all greater ones of the heap of the first `count`.
fn sift_down((points_m, keys): (&mut [Vec3], &mut [u32]), mut root: usize, count: usize) {
    loop {
        let (left, right) = (2 * root + 1, 2 * root + 2);
        if left >= count {
            return;
        }
        let child = if right < count && is_greater((points_m, keys), right, left) { right } else { left };
        if !is_greater((points_m, keys), child, root) {
            return;
        }
        exchange(points_m, root, child);
        exchange(keys, root, child);
        root = child;
    }
}

/// Whether a point comes after another one in the order of [`morton_key`].
fn is_greater((points_m, keys): (&[Vec3], &[u32]), one: usize, other: usize) -> bool {
    let (first, second) = (keys.get(one), keys.get(other));
    if first != second {
        return first > second;
    }
    points_m.get(one).map(morton_key) > points_m.get(other).map(morton_key)
}

fn exchange<T: Copy>(values: &mut [T], one: usize, other: usize) {
    let (Some(&first), Some(&second)) = (values.get(one), values.get(other)) else { return };
    if let Some(place) = values.get_mut(one) {
        *place = second;
    }
    if let Some(place) = values.get_mut(other) {
        *place = first;
    }
}

/// Bits of the coordinates in turns, then the coordinates themselves, so that the order never
/// depends on the order given.
fn morton_key(point_m: &Vec3) -> (u32, [u32; 3]) {
    let cell = |x: f32| {
        let half = (1 << (KEY_BITS - 1)) as f32;
        crate::math::clamp(floor(x / CELL_M) + half, 0.0, 2.0 * half - 1.0) as u32
    };
    let (x, y, z) = (cell(point_m.x), cell(point_m.y), cell(point_m.z - 0.5 * CELL_M * (1 << KEY_BITS) as f32));
    let key = every_third_bit(x) | every_third_bit(y) << 1 | every_third_bit(z) << 2;
    (key, [point_m.x.to_bits(), point_m.y.to_bits(), point_m.z.to_bits()])
}

/// The [`KEY_BITS`] bits of a number with two zeros before each: halves move apart, then quarters.
fn every_third_bit(number: u32) -> u32 {
    let halves = (number | number << 16) & 0x0300_00ff;
    let quarters = (halves | halves << 8) & 0x0300_f00f;
    let pairs = (quarters | quarters << 4) & 0x030c_30c3;
    (pairs | pairs << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    fn cloud(count: u32) -> std::vec::Vec<Vec3> {
        let mut stream = Stream::new(4, 0, 0);
        (0..count).map(|_| Vec3::new(0.0, 0.0, 3.0) + stream.normal3() * 0.4).collect()
    }

    #[test]
    fn bits_are_spread_in_their_order() {
        for number in 0..1 << KEY_BITS {
            let one_by_one = (0..KEY_BITS).fold(0, |sum, bit| sum | (number >> bit & 1) << (3 * bit));
            assert_eq!(every_third_bit(number), one_by_one);
        }
    }

    #[test]
    fn what_cannot_be_a_point_is_left_out_and_counted() {
        let mut points = cloud(5);
        points[1].y = f32::NAN;
        points[3] = Vec3::new(0.001, 0.0, 0.0);
        points.push(Vec3::new(0.0, f32::INFINITY, 1.0));
        let mut blocks = PointCloud::<4>::new();
        assert_eq!(blocks.set(&mut points, &Vec3::zeros()), LeftOut { not_finite: 2, at_camera: 1, over_capacity: 0 });
        assert_eq!((blocks.len(), blocks.blocks().len()), (3, 1));
        assert_eq!(blocks.set(&mut [], &Vec3::zeros()), LeftOut::default());
        assert!(blocks.is_empty() && blocks.blocks().is_empty());
        let mut one = [Vec3::z()];
        let _ = blocks.set(&mut one, &Vec3::zeros());
        assert_eq!((blocks.len(), blocks.blocks()[0].radius_m), (1, 0.0));
    }

    #[test]
    fn points_over_the_capacity_are_counted() {
        let mut blocks = PointCloud::<2>::new();
        let left_out = blocks.set(&mut cloud(40), &Vec3::zeros());
        assert_eq!((left_out.over_capacity, blocks.len()), (8, 2 * BLOCK_POINTS));
    }

    /// A depth image is given row by row: its first rows alone are a head.
    #[test]
    fn of_too_many_points_those_evenly_through_the_list_are_taken() {
        let x_m = |i: u32| if i.is_multiple_of(3) { f32::NAN } else { 0.01 * i as f32 };
        let mut points: std::vec::Vec<Vec3> = (0..480).map(|i| Vec3::new(x_m(i), 0.0, 2.0)).collect();
        let left_out = PointCloud::<2>::new().set(&mut points, &Vec3::zeros());
        assert_eq!(left_out, LeftOut { not_finite: 160, at_camera: 0, over_capacity: 288 });
        for part in 0..8 {
            let is_in = |point: &&Vec3| (point.x / 0.6) as u32 == part;
            assert_eq!(points[..32].iter().filter(is_in).count(), 4, "part {part}");
        }
    }

    #[test]
    fn points_come_in_the_order_of_their_keys() {
        for count in [0, 1, 2, 3, 17, 500] {
            let (mut points, mut sorted) = (cloud(count), cloud(count));
            let _ = PointCloud::<32>::new().set(&mut points, &Vec3::zeros());
            sorted.sort_by_key(morton_key);
            assert_eq!(points, sorted, "{count} points");
        }
    }

    #[test]
    fn the_order_given_does_not_matter_and_neighbours_share_a_block() {
        let (mut points, mut reversed) = (cloud(2000), cloud(2000));
        reversed.reverse();
        let (mut a, mut b) = (PointCloud::<128>::new(), PointCloud::<128>::new());
        let _ = (a.set(&mut points, &Vec3::zeros()), b.set(&mut reversed, &Vec3::zeros()));
        assert_eq!(a.blocks(), b.blocks());
        // A skin is thin; its points spread by 0.4 m along two axes.
        points.iter_mut().for_each(|point| point.z = 3.0);
        let _ = a.set(&mut points, &Vec3::zeros());
        let mean = a.blocks().iter().map(|block| block.radius_m).sum::<f32>() / a.blocks().len() as f32;
        let spread = 0.4 * 2.0_f32.sqrt();
        assert!(mean < 0.4 * spread, "blocks of {mean} m in a cloud of {spread} m");
    }
}
