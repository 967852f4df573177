//! Missing patches: discs of the picture, moving slowly over the body, in which a stereo camera
//! finds no points.

use sinew_core::camera::Pixel;
use sinew_core::math::sin_cos;
use sinew_core::random::Stream;
use std::f32::consts::TAU;

/// Number of the frame whose streams the patches are drawn from: no frame of a scene.
const PATCH_FRAME: u64 = u64::MAX;
/// Radii, shares of the body's height in the picture.
const RADII: [f32; 2] = [0.04, 0.09];
/// Turns in a second along each axis.
const RATES_HZ: [f32; 2] = [0.02, 0.12];

/// One disc: its middle swings over the rectangle that the body takes in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Patch {
    radius: f32,
    rates_hz: [f32; 2],
    phases: [f32; 2],
}

/// The patches of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Patches(Vec<Patch>);

/// A disc in the picture, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Its middle.
    pub centre: Pixel,
    /// Its radius, pixels.
    pub radius_px: f32,
}

impl Disc {
    /// Whether it holds a pixel.
    #[must_use]
    pub fn holds(&self, pixel: Pixel) -> bool {
        self.centre.distance_px(pixel) < self.radius_px
    }
}

impl Patches {
    /// `count` patches drawn under `seed`.
    #[must_use]
    pub fn new(seed: u64, count: u32) -> Self {
        let patch = |index| {
            let mut stream = Stream::new(seed, PATCH_FRAME, index);
            let mut between = |[low, high]: [f32; 2]| low + (high - low) * stream.uniform();
            Patch {
                radius: between(RADII),
                rates_hz: [between(RATES_HZ), between(RATES_HZ)],
                phases: [between([0.0, 1.0]), between([0.0, 1.0])],
            }
        };
        Self((0..count).map(patch).collect())
    }

    /// The discs at `time_s` for a body that takes the rectangle from `low` to `high`.
    #[must_use]
    pub fn discs(&self, time_s: f32, low: Pixel, high: Pixel) -> Vec<Disc> {
        let disc = |patch: &Patch| {
            let place = |axis: usize, low: f32, high: f32| {
                // Whole turns are taken off first: a sine of large angles would lose its places.
                let turns = patch.rates_hz[axis] * time_s + patch.phases[axis];
                low + (high - low) * (0.5 + 0.5 * sin_cos(TAU * (turns - turns.floor())).0)
            };
            Disc {
                centre: Pixel::new(place(0, low.u_px, high.u_px), place(1, low.v_px, high.v_px)),
                radius_px: patch.radius * (high.v_px - low.v_px).max(0.0),
            }
        };
        self.0.iter().map(disc).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_move_slowly_over_the_body() {
        let patches = Patches::new(3, 4);
        let (low, high) = (Pixel::new(200.0, 50.0), Pixel::new(400.0, 450.0));
        assert_ne!(patches, Patches::new(4, 4));
        let mut travelled_px = 0.0;
        for frame in 0..300 {
            let time_s = frame as f32 / 15.0;
            for (now, next) in
                patches.discs(time_s, low, high).iter().zip(patches.discs(time_s + 1.0 / 15.0, low, high))
            {
                let step_px = now.centre.distance_px(next.centre);
                assert!(step_px < 15.0, "{step_px}");
                travelled_px += step_px;
                assert!(now.centre.u_px >= 200.0 && now.centre.u_px <= 400.0 && now.centre.v_px <= 450.0);
                assert!((16.0..36.1).contains(&now.radius_px));
                assert!(now.holds(now.centre) && !now.holds(Pixel::new(now.centre.u_px + 40.0, now.centre.v_px)));
            }
        }
        assert!(travelled_px > 1000.0);
    }
}
