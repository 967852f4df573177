//! The hand: a palm, four fingers of two phalanges each, a thumb and the bare wrist; it opens,
//! closes and turns slowly.

use super::body::{ArmJoints, Body};
use super::shape::Shape;
use crate::motion::{ArmSide, anthropometry};
use sinew_core::math::{Mat3, Vec3, axis_rotation, clamp, sin_cos, unit};
use sinew_core::random::Stream;

/// Finger roots over the palm's width and finger lengths (index to little), shares of the hand's
/// length; 0.45 of a hand is fingers.
const FINGERS: [(f32, f32); 4] = [(0.165, 0.42), (0.055, 0.46), (-0.055, 0.43), (-0.160, 0.34)];

/// Share of its length by which the hand is drawn beyond the wrist. The half-open hand, seen flat,
/// then has the middle of its silhouette at [`ArmJoints::hand_m`], the hand of truth and trackers.
const BEYOND_WRIST: f32 = 0.08;

/// Shape of a hand at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandPose {
    /// Bend of each finger joint, radians: 0 is flat, 1.3 nearly a fist.
    pub curl_rad: f32,
    /// Angle between neighbouring fingers, radians.
    pub spread_rad: f32,
    /// Turn of the palm about the forearm, radians.
    pub roll_rad: f32,
}

/// A slow oscillation: mean and two sines.
#[derive(Debug, Clone, Copy)]
struct Drift {
    mean: f32,
    sines: [(f32, f32, f32); 2],
}

impl Drift {
    fn new(stream: &mut Stream, [low, high]: [f32; 2], amplitude: f32) -> Self {
        let mean = low + (high - low) * stream.uniform();
        let sines = [0.06, 0.2].map(|slowest_hz| {
            let turn_rate = core::f32::consts::TAU * slowest_hz * (1.0 + stream.uniform());
            (turn_rate, core::f32::consts::TAU * stream.uniform(), amplitude * (0.3 + 0.4 * stream.uniform()))
        });
        Self { mean, sines }
    }

    fn at(&self, time_s: f32) -> f32 {
        self.sines.iter().fold(self.mean, |sum, &(rate, phase, size)| sum + size * sin_cos(rate * time_s + phase).0)
    }
}

/// How a hand changes its shape over time.
#[derive(Debug, Clone, Copy)]
pub struct HandMotion {
    curl: Drift,
    spread: Drift,
    roll: Drift,
}

impl HandMotion {
    /// A random hand motion.
    #[must_use]
    pub fn new(stream: &mut Stream) -> Self {
        Self {
            curl: Drift::new(stream, [0.1, 0.9], 0.4),
            spread: Drift::new(stream, [0.0, 0.16], 0.08),
            roll: Drift::new(stream, [-1.4, 1.4], 0.8),
        }
    }

    /// The hand at `time_s`.
    #[must_use]
    pub fn at(&self, time_s: f32) -> HandPose {
        HandPose {
            curl_rad: clamp(self.curl.at(time_s), 0.05, 1.3),
            spread_rad: clamp(self.spread.at(time_s), 0.0, 0.22),
            roll_rad: self.roll.at(time_s),
        }
    }
}

/// Shapes of the hand at the end of the arm `joints`.
#[must_use]
pub fn shapes(body: &Body, side: ArmSide, joints: &ArmJoints, pose: &HandPose) -> Vec<Shape> {
    let length = anthropometry::HAND * body.height_m;
    let along = unit(joints.hand_m - joints.wrist_m).unwrap_or(Vec3::y());
    // Without roll the palm looks to the camera's side of the forearm.
    let facing = -Vec3::z();
    let normal = unit(facing - along * facing.dot(&along)).unwrap_or(Vec3::x());
    let normal = axis_rotation(&along, pose.roll_rad) * normal;
    let thumbwards = if side == ArmSide::Left { normal.cross(&along) } else { along.cross(&normal) };
    let at = |forward: f32, sideways: f32| {
        joints.wrist_m + (along * (forward + BEYOND_WRIST) + thumbwards * sideways) * length
    };
    let palm = Shape::Ellipsoid {
        centre: at(0.29, 0.0),
        axes: Mat3::from_rows(&[along.transpose(), thumbwards.transpose(), normal.transpose()]),
        radii: Vec3::new(0.31, 0.235, 0.10) * length,
    };
    let wrist = Shape::Capsule { start: at(-0.22, 0.0), end: at(0.08, 0.0), radius: 0.145 * length };
    let mut shapes = vec![palm, wrist];
    for (index, (sideways, reach)) in FINGERS.into_iter().enumerate() {
        let fan = axis_rotation(
            &normal,
            if side == ArmSide::Left { -1.0 } else { 1.0 } * pose.spread_rad * (index as f32 - 1.5),
        );
        let straight = fan * along;
        let bent = |angle_rad: f32| {
            let (sine, cosine) = sin_cos(angle_rad);
            straight * cosine + normal * sine
        };
        let root = at(0.50, sideways);
        let knuckle = root + bent(pose.curl_rad) * (0.55 * reach * length);
        let tip = knuckle + bent(2.1 * pose.curl_rad) * (0.45 * reach * length);
        shapes.push(Shape::Capsule { start: root, end: knuckle, radius: 0.050 * length });
        shapes.push(Shape::Capsule { start: knuckle, end: tip, radius: 0.043 * length });
    }
    let (sine, cosine) = sin_cos(0.9 - 0.4 * pose.curl_rad);
    let thumb_direction = thumbwards * sine + along * cosine + normal * (0.5 * pose.curl_rad);
    let thumb_root = at(0.20, 0.16);
    shapes.push(Shape::Capsule {
        start: thumb_root,
        end: thumb_root + unit(thumb_direction).unwrap_or(along) * (0.33 * length),
        radius: 0.058 * length,
    });
    shapes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::body::to_camera;

    /// Mean of the surface points that a camera sees of an upright hand before it, relative to the
    /// hand's point.
    fn middle_of_silhouette(side: ArmSide, pose: &HandPose) -> Vec3 {
        let body = Body { height_m: 1.75, shoulder_middle_m: Vec3::new(0.0, 0.0, 1.0) };
        let hand_m = Vec3::new(0.0, 0.0, 1.0);
        let wrist_m = hand_m - to_camera(&Vec3::y()) * (0.5 * anthropometry::HAND * body.height_m);
        let joints = ArmJoints { shoulder_m: wrist_m, elbow_m: wrist_m, wrist_m, hand_m };
        let shapes: Vec<_> = shapes(&body, side, &joints, pose).iter().map(Shape::prepare).collect();
        let (mut sum, mut count) = (Vec3::zeros(), 0.0);
        for row in -130..130 {
            for column in -130..130 {
                let direction = Vec3::new(column as f32 * 0.001, row as f32 * 0.001, 1.0);
                // What the sleeve covers is left out.
                let bare = direction.y < wrist_m.y - 0.005;
                if bare && shapes.iter().any(|shape| shape.hit(&direction).is_some()) {
                    sum += direction - hand_m;
                    count += 1.0;
                }
            }
        }
        sum / count
    }

    #[test]
    fn the_half_open_hand_is_seen_where_the_truth_says() {
        for side in [ArmSide::Left, ArmSide::Right] {
            let middle = middle_of_silhouette(side, &HandPose { curl_rad: 0.5, spread_rad: 0.08, roll_rad: 0.0 });
            assert!(middle.norm() < 0.008, "{side:?}: {middle:?}");
        }
    }

    #[test]
    fn a_thumb_points_to_the_body_s_middle_when_the_palm_faces_the_camera() {
        // Arms raised, palms to the front: the thumbs of both hands point to the head.
        let pose = HandPose { curl_rad: 0.05, spread_rad: 0.0, roll_rad: 0.0 };
        assert!(middle_of_silhouette(ArmSide::Left, &pose).x < -0.001);
        assert!(middle_of_silhouette(ArmSide::Right, &pose).x > 0.001);
    }
}
