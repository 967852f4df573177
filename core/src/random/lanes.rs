//! Streams of neighbouring particles side by side: the same numbers as [`Stream`](super::Stream)
//! gives one by one.

use super::normal_table::from_bits;
use super::stream::{first_state, frame_key};

pub use super::stream::LANES;

/// The streams of [`LANES`] particles with successive indices.
///
/// The generator is xoshiro128++ (Blackman and Vigna 2021). Its steps are additions, shifts and
/// exclusive ors of 32 bits. On arrays of lanes compilers turn them into vector instructions.
///
/// ```
/// use sinew_core::random::lanes::{LANES, StreamLanes};
/// use sinew_core::random::Stream;
///
/// // Particles 64, 65, ... of frame 3 at once; lane 5 is the stream of particle 69.
/// let mut lanes = StreamLanes::new(1, 3, 64);
/// assert_eq!(lanes.bits()[5], Stream::new(1, 3, 69).bits());
/// let draws: [f32; LANES] = lanes.normal();
/// assert!(draws.iter().all(|draw| draw.abs() < 6.4));
/// ```
#[derive(Debug, Clone)]
pub struct StreamLanes([[u32; LANES]; 4]);

impl StreamLanes {
    /// The streams of the particles `first_index`, `first_index + 1`, ... in `frame` under `seed`.
    #[inline(always)]
    #[must_use]
    pub fn new(seed: u64, frame: u64, first_index: u32) -> Self {
        let key = frame_key(seed, frame);
        let mut state = [[0; LANES]; 4];
        for lane in 0..LANES {
            let [first, second] = first_state(key, first_index.wrapping_add(lane as u32));
            state[0][lane] = first as u32;
            state[1][lane] = (first >> 32) as u32;
            state[2][lane] = second as u32;
            state[3][lane] = (second >> 32) as u32;
        }
        Self(state)
    }

    /// 32 random bits of each stream.
    #[inline(always)]
    pub fn bits(&mut self) -> [u32; LANES] {
        let mut drawn = [0; LANES];
        let [a, b, c, d] = &mut self.0;
        for lane in 0..LANES {
            drawn[lane] = a[lane].wrapping_add(d[lane]).rotate_left(7).wrapping_add(a[lane]);
            let shifted = b[lane] << 9;
            c[lane] ^= a[lane];
            d[lane] ^= b[lane];
            b[lane] ^= c[lane];
            a[lane] ^= d[lane];
            c[lane] ^= shifted;
            d[lane] = d[lane].rotate_left(11);
        }
        drawn
    }

    /// Uniform in the half-open interval [0, 1), 24 bits.
    #[inline(always)]
    pub fn uniform(&mut self) -> [f32; LANES] {
        let bits = self.bits();
        let mut drawn = [0.0; LANES];
        for lane in 0..LANES {
            drawn[lane] = (bits[lane] >> 8) as i32 as f32 * (1.0 / 16_777_216.0);
        }
        drawn
    }

    /// A draw from the standard normal distribution for each stream, by the table of
    /// [`super::normal_table`].
    #[inline(always)]
    pub fn normal(&mut self) -> [f32; LANES] {
        from_bits(&self.bits())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Stream;
    use super::super::normal::upper_tail;
    use super::*;

    #[test]
    fn the_lanes_are_the_single_streams() {
        let mut lanes = StreamLanes::new(5, 9, u32::MAX - 3);
        let mut single: Vec<_> = (0..LANES as u32).map(|i| Stream::new(5, 9, (u32::MAX - 3).wrapping_add(i))).collect();
        for _ in 0..50 {
            assert_eq!(lanes.bits().to_vec(), single.iter_mut().map(Stream::bits).collect::<Vec<_>>());
            assert_eq!(lanes.uniform().to_vec(), single.iter_mut().map(Stream::uniform).collect::<Vec<_>>());
        }
    }

    #[test]
    fn draws_have_the_moments_and_tails_of_a_normal() {
        const STREAMS: u32 = 100_000;
        const DRAWS: usize = 8;
        let (mut sums, mut beyond) = ([0.0_f64; 4], [0_u32; 5]);
        let mut product = 0.0_f64;
        for first in (0..STREAMS).step_by(LANES) {
            let mut lanes = StreamLanes::new(3, 1, first);
            let mut last = [0.0; LANES];
            for _ in 0..DRAWS {
                let draws = lanes.normal();
                for (lane, &draw) in draws.iter().enumerate() {
                    for (power, sum) in sums.iter_mut().enumerate() {
                        *sum += f64::from(draw).powi(power as i32 + 1);
                    }
                    for (limit, count) in beyond.iter_mut().enumerate() {
                        *count += u32::from(draw.abs() > limit as f32);
                    }
                    product += f64::from(draw * last[lane]) + f64::from(draw * draws[(lane + 1) % LANES]);
                }
                last = draws;
            }
        }
        let n = f64::from(STREAMS) * DRAWS as f64;
        let exact = [(0.0, 1.0), (1.0, 2.0), (0.0, 15.0), (3.0, 96.0)];
        for (power, (sum, (mean, variance))) in sums.into_iter().zip(exact).enumerate() {
            let off = (sum / n - mean) / (variance / n).sqrt();
            assert!(off.abs() < 4.0, "moment {}: {off} standard errors off", power + 1);
        }
        for (limit, &count) in beyond.iter().enumerate().skip(1) {
            let share = 2.0 * f64::from(upper_tail(limit as f32));
            let off = (f64::from(count) / n - share) / (share / n).sqrt();
            assert!(off.abs() < 4.0, "beyond {limit}: {off} standard errors off");
        }
        assert!((product / (2.0 * n).sqrt()).abs() < 5.0, "neighbouring draws are correlated: {product}");
    }
}
