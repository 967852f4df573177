//! One stream of random numbers for each (seed, frame, index).
//!
//! ```
//! use sinew_core::random::Stream;
//!
//! let mut die = Stream::new(1, 0, 0);
//! let throws: Vec<u32> = (0..600).map(|_| die.below(6)).collect();
//! assert!((0..6).all(|face| throws.iter().filter(|&&throw| throw == face).count() > 60));
//! assert!((0..100).all(|_| (0.0..1.0).contains(&die.uniform())));
//! ```

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

/// Streams that advance together in [`super::StreamLanes`].
///
/// Chosen: enough that compilers keep loops over them, which they then vectorise.
pub const LANES: usize = 32;

/// Finaliser of `SplitMix64` (Steele, Lea and Flood 2014): every input bit reaches every output
/// bit.
#[inline]
fn scramble(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// 2^64 over the golden ratio: the increment of `SplitMix64` (Steele, Lea and Flood 2014).
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Key of all streams of a frame.
pub(super) fn frame_key(seed: u64, frame: u64) -> u64 {
    scramble(scramble(seed.wrapping_add(GOLDEN)) ^ frame.wrapping_mul(GOLDEN))
}

/// First state of stream `index`: 128 bits.
#[inline]
pub(super) fn first_state(frame_key: u64, index: u32) -> [u64; 2] {
    let first = scramble(frame_key.wrapping_add(u64::from(index).wrapping_mul(GOLDEN)));
    [first, scramble(first.wrapping_add(GOLDEN))]
}

/// A generator (xoshiro128++) that belongs to one particle in one frame.
///
/// ```
/// use sinew_core::random::Stream;
///
/// // The numbers of particle 7 in frame 42 are always the same.
/// let (seed, frame) = (1, 42);
/// let mut stream = Stream::new(seed, frame, 7);
/// let (side, noise) = (stream.uniform(), stream.normal());
/// let mut again = Stream::new(seed, frame, 7);
/// assert_eq!((again.uniform(), again.normal()), (side, noise));
/// assert_ne!(Stream::new(seed, frame + 1, 7).uniform(), side);
/// ```
#[derive(Debug, Clone)]
pub struct Stream(Xoshiro128PlusPlus);

impl Stream {
    /// The stream of particle `index` in `frame` under `seed`.
    #[must_use]
    pub fn new(seed: u64, frame: u64, index: u32) -> Self {
        let [first, second] = first_state(frame_key(seed, frame), index);
        let mut state = [0; 16];
        for (byte, value) in state.iter_mut().zip(first.to_le_bytes().into_iter().chain(second.to_le_bytes())) {
            *byte = value;
        }
        Self(Xoshiro128PlusPlus::from_seed(state))
    }

    /// 32 random bits.
    #[inline]
    pub fn bits(&mut self) -> u32 {
        self.0.next_u32()
    }

    /// Uniform in the half-open interval [0, 1), 24 bits.
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        (self.bits() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform in the open interval (0, 1), 23 bits.
    #[inline]
    pub fn open_uniform(&mut self) -> f32 {
        ((self.bits() >> 9) as f32 + 0.5) * (1.0 / 8_388_608.0)
    }

    /// Uniform whole number below `bound` (multiply-shift; its bias is below bound / 2^32). Zero
    /// for a bound of zero.
    #[inline]
    pub fn below(&mut self, bound: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(bound)) >> 32) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_streams_are_not_correlated() {
        const DRAWS: usize = 20_000;
        for (frame_step, index_step) in [(0_u64, 1_u32), (1, 0), (1, 1)] {
            let mut sum = 0.0_f64;
            for i in 0..DRAWS as u32 {
                let a = Stream::new(7, 100, i).uniform() - 0.5;
                let b = Stream::new(7, 100 + frame_step, i + index_step).uniform() - 0.5;
                sum += f64::from(a) * f64::from(b);
            }
            let correlation = 12.0 * sum / DRAWS as f64;
            assert!(correlation.abs() < 4.0 / (DRAWS as f64).sqrt(), "correlation {correlation}");
        }
    }

    #[test]
    fn the_uniform_has_its_mean_and_variance() {
        let mut stream = Stream::new(1, 0, 0);
        let n = 200_000;
        let (mut sum, mut square) = (0.0_f64, 0.0_f64);
        for _ in 0..n {
            let u = f64::from(stream.uniform());
            sum += u;
            square += u * u;
        }
        let mean = sum / f64::from(n);
        let variance = square / f64::from(n) - mean * mean;
        assert!((mean - 0.5).abs() < 4.0 * (1.0_f64 / 12.0 / f64::from(n)).sqrt());
        assert!((variance * 12.0 - 1.0).abs() < 0.02);
    }

    #[test]
    fn the_same_key_gives_the_same_bits() {
        assert_eq!(Stream::new(3, 9, 4).bits(), Stream::new(3, 9, 4).bits());
        assert_eq!(Stream::new(1, 0, 0).bits(), 3_330_716_009, "a change here changes every golden track");
    }

    #[test]
    fn whole_numbers_stay_below_their_bound_and_reach_all_of_it() {
        let mut stream = Stream::new(5, 0, 0);
        let mut seen = [0_u32; 7];
        for _ in 0..7_000 {
            seen[stream.below(7) as usize] += 1;
        }
        assert!(seen.iter().all(|&count| (850..1150).contains(&count)), "{seen:?}");
        assert_eq!(stream.below(0), 0);
    }
}
