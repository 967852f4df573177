//! Fewer points from a cloud that has too many.

use super::point_cloud::PointCloud;
use sinew_core::random::Stream;

/// Index of the stream that draws points: the last one, far from those of a frame's particles.
const STREAM_INDEX: u32 = u32::MAX;

impl PointCloud {
    /// Keeps `max_points` of the points, drawn without replacement, each subset as likely as any
    /// other (selection sampling: Knuth, volume 2, algorithm 3.4.2 S). The order stays; the draw
    /// depends on `seed` and `frame` only. Returns how many points there were.
    pub fn limit(&mut self, max_points: usize, seed: u64, frame: u64) -> usize {
        let before = self.points_m.len();
        if before <= max_points {
            return before;
        }
        let mut stream = Stream::new(seed, frame, STREAM_INDEX);
        let (mut left, mut wanted) = (before, max_points);
        self.points_m.retain(|_| {
            // A file's largest size keeps the count far below 2^32.
            let chosen = (stream.below(u32::try_from(left).unwrap_or(u32::MAX)) as usize) < wanted;
            left -= 1;
            wanted -= usize::from(chosen);
            chosen
        });
        before
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sinew_core::math::Vec3;

    fn numbered(count: usize) -> PointCloud {
        PointCloud::from_points((0..count).map(|index| Vec3::new(0.0, 0.0, 0.25 + index as f32 * 0.25)))
    }

    proptest! {
        #[test]
        fn exactly_so_many_stay_in_order(count in 0_usize..300, max_points in 0_usize..300, seed: u64, frame: u64) {
            let mut cloud = numbered(count);
            prop_assert_eq!(cloud.limit(max_points, seed, frame), count);
            prop_assert_eq!(cloud.points_m.len(), count.min(max_points));
            prop_assert!(cloud.points_m.windows(2).all(|pair| pair[0].z < pair[1].z));
            let mut again = numbered(count);
            again.limit(max_points, seed, frame);
            prop_assert_eq!(cloud, again);
        }
    }

    /// Each of 10 points stays in 3 of 10 draws: 6000 +- 5 standard deviations (65) of 20,000.
    #[test]
    fn every_point_is_as_likely() {
        let mut kept = [0_u32; 10];
        for seed in 0..20_000 {
            let mut cloud = numbered(10);
            cloud.limit(3, seed, 7);
            for point in &cloud.points_m {
                kept[(point.z * 4.0) as usize - 1] += 1;
            }
        }
        assert!(kept.iter().all(|&count| (5_675..6_325).contains(&count)), "{kept:?}");
    }

    #[test]
    fn another_frame_draws_other_points() {
        let (mut first, mut second) = (numbered(1000), numbered(1000));
        first.limit(100, 1, 1);
        second.limit(100, 1, 2);
        assert_ne!(first, second);
    }
}
