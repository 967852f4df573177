//! Where the person sits before the camera: near, but so that the hands' paths stay in the picture.

use super::body::Body;
use crate::motion::{ArmMotion, ArmSide};
use sinew_core::camera::Camera;
use sinew_core::math::Vec3;
use sinew_core::random::Stream;

/// Distances from which the search starts, metres.
const DISTANCES_M: [f32; 2] = [1.0, 1.5];
/// Farthest distance, metres.
const FARTHEST_M: f32 = 2.2;
const DISTANCE_STEP_M: f32 = 0.05;
/// Heights of the shoulders over the line of sight that are tried, metres (camera y is down).
const SHOULDER_Y_M: [f32; 9] = [-0.1, -0.05, -0.15, 0.0, -0.2, 0.05, 0.1, 0.15, 0.2];
/// Share of hand positions that have to be inside the image with a margin of a twentieth of its
/// height.
const INSIDE_SHARE: f32 = 0.97;

/// Places the shoulders at a random distance of 1.0 to 1.5 m. Then moves them farther in steps
/// until the hands of `sides` are inside the image nearly always. At the last distance the best
/// height counts.
#[must_use]
pub fn place(
    stream: &mut Stream,
    camera: &Camera,
    size_px: [u32; 2],
    height_m: f32,
    motion: &ArmMotion,
    sides: &[ArmSide],
) -> Body {
    let mut distance_m = DISTANCES_M[0] + (DISTANCES_M[1] - DISTANCES_M[0]) * stream.uniform();
    let sideways_m = 0.06 * (2.0 * stream.uniform() - 1.0);
    loop {
        let mut best: Option<(f32, Body)> = None;
        for y_m in SHOULDER_Y_M {
            let body = Body { height_m, shoulder_middle_m: Vec3::new(sideways_m, y_m, distance_m) };
            let share = share_inside(camera, size_px, &body, motion, sides);
            if best.as_ref().is_none_or(|(most, _)| share > *most) {
                best = Some((share, body));
            }
        }
        distance_m += DISTANCE_STEP_M;
        if let Some((share, body)) = best
            && (share >= INSIDE_SHARE || distance_m > FARTHEST_M)
        {
            return body;
        }
    }
}

/// Share of the hand positions that the image shows.
fn share_inside(camera: &Camera, size_px: [u32; 2], body: &Body, motion: &ArmMotion, sides: &[ArmSide]) -> f32 {
    let margin = 0.05 * size_px[1] as f32;
    let [right, bottom] = size_px.map(|size| size as f32 - 1.0 - margin);
    let mut inside = 0;
    for &side in sides {
        for directions in motion.side(side) {
            let pixel = camera.project(&body.arm(side, directions).hand_m);
            let seen = |u: f32, v: f32| u >= margin && v >= margin && u <= right && v <= bottom;
            inside += usize::from(pixel.is_some_and(|p| seen(p.u_px, p.v_px)));
        }
    }
    inside as f32 / (motion.len() * sides.len()).max(1) as f32
}
