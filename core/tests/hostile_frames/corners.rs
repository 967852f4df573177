//! Draws from the corners of `f32`.

use sinew_core::math::Vec3;
use sinew_core::random::Stream;

/// Sizes of the corners, each with both signs.
const SIZES: [f32; 12] =
    [0.0, 1.0e-45, 1.0e-39, f32::MIN_POSITIVE, 1.0, 1.0e3, 1.0e10, 1.0e19, 1.0e35, f32::MAX, f32::INFINITY, f32::NAN];
/// First of the sizes that no border lets in.
const REFUSED: usize = 6;
/// Corners of a timestamp, microseconds.
const TIMES_US: [u64; 6] = [0, 1, 1_000_000, 1 << 32, u64::MAX - 1, u64::MAX];

/// A source of hostile numbers.
pub struct Corners {
    stream: Stream,
    /// Whether only numbers are drawn that every border refuses.
    only_refused: bool,
}

impl Corners {
    /// The numbers of one tracker.
    pub fn new(seed: u64, only_refused: bool) -> Self {
        Self { stream: Stream::new(seed, 0, 0), only_refused }
    }

    /// Whether every hostile number is one that is refused.
    pub fn only_refused(&self) -> bool {
        self.only_refused
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.stream.uniform() * count as f32) as usize).min(count - 1)
    }

    /// True once in `count` times.
    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// A corner.
    pub fn corner(&mut self) -> f32 {
        let sizes = if self.only_refused { &SIZES[REFUSED..] } else { &SIZES };
        let size = sizes[self.below(sizes.len())];
        if self.one_in(2) { size } else { -size }
    }

    /// `clean`, or a corner in one of three draws.
    pub fn number(&mut self, clean: f32) -> f32 {
        if self.one_in(3) { self.corner() } else { clean }
    }

    /// The same for each coordinate.
    pub fn place(&mut self, clean: Vec3) -> Vec3 {
        clean.map(|coordinate| self.number(coordinate))
    }

    /// `clean`, or a corner of the times.
    pub fn time_us(&mut self, clean: u64) -> u64 {
        if !self.only_refused && self.one_in(3) { TIMES_US[self.below(TIMES_US.len())] } else { clean }
    }
}
