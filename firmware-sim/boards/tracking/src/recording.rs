//! The recordings in flash, read as they would arrive.

use crate::layout::{ANGLES, FRAMES, HEIGHT, UNITS_PER_RAD, WALK_FRAMES, WIDTH};

static WALK: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/walk.bin"));
static RUNS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/frames.bin"));

/// The angles of a frame of the walk, radians; after the last the first comes again.
#[must_use]
pub fn angles_rad(frame: usize) -> [f32; ANGLES] {
    let start = 2 * ANGLES * (frame % WALK_FRAMES);
    let mut angles_rad = [0.0; ANGLES];
    let units = WALK.iter().skip(start).zip(WALK.iter().skip(start + 1)).step_by(2);
    for (angle, (&low, &high)) in angles_rad.iter_mut().zip(units) {
        *angle = f32::from(i16::from_le_bytes([low, high])) / UNITS_PER_RAD;
    }
    angles_rad
}

/// Reads the camera's frames line by line, again and again.
#[derive(Debug)]
pub struct Lines {
    rest: &'static [u8],
    line: usize,
}

impl Lines {
    /// From the first frame on.
    #[must_use]
    pub const fn new() -> Self {
        Self { rest: &[], line: 0 }
    }

    /// Writes the next line into `pixels`.
    pub fn read(&mut self, pixels: &mut [u16; WIDTH]) {
        if self.line == 0 {
            self.rest = RUNS;
        }
        self.line = (self.line + 1) % (HEIGHT * FRAMES);
        let mut rest: &mut [u16] = pixels;
        while let ([length, low, high, others @ ..], false) = (self.rest, rest.is_empty()) {
            let length = usize::from(*length) + 1;
            let (run, after) = rest.split_at_mut(length.min(rest.len()));
            run.fill(u16::from_le_bytes([*low, *high]));
            (self.rest, rest) = (others, after);
        }
    }
}

impl Default for Lines {
    fn default() -> Self {
        Self::new()
    }
}
