//! Which way a person's hips face from frame to frame, and whether that turns.

use crate::motion::joint_names::{HIPS, SpatialJoints};
use sinew_core::math::{Vec3, unit};

/// Time over which headings are averaged, seconds: about a cycle, so that the pelvis's own swing
/// goes out.
const WINDOW_S: f64 = 1.2;

/// Heading of each frame: level, square to the line through the hips, averaged over a cycle's time;
/// `None` where hips are missing for that long.
#[must_use]
pub fn headings(frames: &[SpatialJoints], up: Vec3, rate_hz: f64) -> Vec<Option<Vec3>> {
    let single: Vec<Option<Vec3>> = frames
        .iter()
        .map(|joints| {
            let left = joints[HIPS[0]]? - joints[HIPS[1]]?;
            unit((left - up * left.dot(&up)).cross(&up))
        })
        .collect();
    let half = ((0.5 * WINDOW_S * rate_hz).round() as usize).clamp(1, 1_000_000);
    (0..frames.len())
        .map(|frame| {
            let window = &single[frame.saturating_sub(half)..(frame + half + 1).min(frames.len())];
            unit(window.iter().flatten().sum())
        })
        .collect()
}

/// Length of the mean heading: 1 for a person who keeps their direction, 0 for one who walks in
/// circles. 1 where no heading is known.
#[must_use]
pub fn straightness(headings: &[Option<Vec3>]) -> f32 {
    let count = headings.iter().flatten().count();
    if count == 0 { 1.0 } else { (headings.iter().flatten().sum::<Vec3>() / count as f32).norm() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::joint_names::JOINTS;
    use core::f32::consts::TAU;

    /// Hips of a person who turns `turns` times in 300 frames and swings the pelvis.
    fn person(turns: f32) -> Vec<SpatialJoints> {
        let joints = |frame: usize| {
            let time = frame as f32 / 300.0;
            let angle = TAU * turns * time + 0.3 * (TAU * 5.0 * time).sin();
            let mut joints = [None; JOINTS];
            joints[HIPS[0]] = Some(Vec3::new(0.1 * angle.cos(), 1.0, -0.1 * angle.sin()));
            joints[HIPS[1]] = Some(Vec3::new(-0.1 * angle.cos(), 1.1, 0.1 * angle.sin()));
            joints
        };
        (0..300).map(joints).collect()
    }

    #[test]
    fn the_heading_is_square_to_the_hips_without_their_swing() {
        let headings = headings(&person(0.0), Vec3::y(), 50.0);
        for (frame, heading) in headings.iter().enumerate().skip(30).take(240) {
            assert!((heading.unwrap() - Vec3::z()).norm() < 0.03, "{frame}: {heading:?}");
        }
        assert!(straightness(&headings) > 0.99);
    }

    #[test]
    fn walking_in_a_circle_is_not_straight() {
        assert!(straightness(&headings(&person(1.0), Vec3::y(), 50.0)) < 0.1);
        assert!((straightness(&[None]) - 1.0).abs() < 1.0e-6);
    }
}
