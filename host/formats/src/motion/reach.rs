//! The built-in motion: the hand reaches for random targets in front of the body.
//!
//! Each reach is a straight line with the minimum-jerk profile 10 s^3 - 15 s^4 + 6 s^5 (Flash and
//! Hogan, 1985). A pause may follow. The elbow's swivel about the line from shoulder to hand drifts
//! slowly. Lengths are fractions of body height, so the directions fit any body of these
//! proportions.

use super::anthropometry::{ELBOW_TO_HAND_CENTRE, UPPER_ARM};
use super::arm_motion::{ArmDirections, ArmMotion, ArmSide};
use super::error::MotionError;
use sinew_core::math::{Vec3, clamp, sin_cos, sqrt, unit};
use sinew_core::random::Stream;

/// Stretched arm, in body heights.
const REACH: f32 = UPPER_ARM + ELBOW_TO_HAND_CENTRE;
/// Nearest and farthest distance of the hand from the shoulder, as shares of the stretched arm.
const DISTANCE_SHARES: [f32; 2] = [0.35, 0.96];
/// Box of the targets round the shoulder, shares of the stretched arm: outwards, up, front.
const TARGET_LOW: [f32; 3] = [-0.55, -0.65, 0.15];
/// Upper corner of that box.
const TARGET_HIGH: [f32; 3] = [0.75, 0.55, 0.95];
/// Mean hand speed of a reach, stretched arms a second, lowest and highest.
const SPEEDS: [f32; 2] = [0.6, 1.8];
/// Shortest reach, seconds.
const SHORTEST_S: f32 = 0.4;
/// A pause follows a reach with this probability.
const PAUSE_PROBABILITY: f32 = 0.4;
/// Shortest and longest pause, seconds.
const PAUSES_S: [f32; 2] = [0.2, 0.9];
/// Swivel of the elbow from straight down, outwards, lowest and highest, radians.
const SWIVELS_RAD: [f32; 2] = [0.1, 1.2];
/// Draws of a target before the last one is taken as it is, moved to the nearest allowed distance.
const TARGET_TRIES: usize = 32;

/// Frames per second that are accepted.
pub const RATES_HZ: [f32; 2] = [0.1, 10_000.0];

/// `frames` frames of random reaches of both arms at `frames_per_second`; the same seed gives the
/// same motion.
///
/// # Errors
/// If the rate is not in [`RATES_HZ`] or `frames` is zero.
pub fn random_reaches(seed: u64, frames_per_second: f32, frames: usize) -> Result<ArmMotion, MotionError> {
    if !(RATES_HZ[0]..=RATES_HZ[1]).contains(&frames_per_second) {
        let rule = format!("must lie from {} to {}, not {frames_per_second}", RATES_HZ[0], RATES_HZ[1]);
        return Err(MotionError::Parameter { parameter: "frames_per_second", rule });
    }
    if frames == 0 {
        return Err(MotionError::Parameter { parameter: "frames", rule: "must be greater than zero".into() });
    }
    let [left, right] = [ArmSide::Left, ArmSide::Right].map(|side| {
        let stream = Stream::new(seed, 0, if side == ArmSide::Left { 0 } else { 1 });
        Reacher::new(stream, side).play(frames_per_second, frames)
    });
    ArmMotion::new(frames_per_second, left, right)
}

/// From `low` to `high`, uniform.
fn between(stream: &mut Stream, [low, high]: [f32; 2]) -> f32 {
    low + (high - low) * stream.uniform()
}

/// One reach with the pause after it; positions in stretched arms, relative to the shoulder,
/// outwards-up-front.
#[derive(Debug, Clone, Copy)]
struct Reach {
    from: Vec3,
    to: Vec3,
    swivel_from_rad: f32,
    swivel_to_rad: f32,
    duration_s: f32,
    pause_s: f32,
}

#[derive(Debug)]
struct Reacher {
    stream: Stream,
    side: ArmSide,
    reach: Reach,
    /// Time since the present reach began.
    elapsed_s: f32,
}

impl Reacher {
    fn new(mut stream: Stream, side: ArmSide) -> Self {
        let from = target(&mut stream);
        let swivel_rad = between(&mut stream, SWIVELS_RAD);
        let reach = next_reach(&mut stream, from, swivel_rad);
        Self { stream, side, reach, elapsed_s: 0.0 }
    }

    fn play(mut self, frames_per_second: f32, frames: usize) -> Vec<ArmDirections> {
        let step_s = 1.0 / frames_per_second;
        (0..frames)
            .map(|_| {
                let directions = self.directions();
                self.elapsed_s += step_s;
                while self.elapsed_s >= self.reach.duration_s + self.reach.pause_s {
                    self.elapsed_s -= self.reach.duration_s + self.reach.pause_s;
                    self.reach = next_reach(&mut self.stream, self.reach.to, self.reach.swivel_to_rad);
                }
                directions
            })
            .collect()
    }

    fn directions(&self) -> ArmDirections {
        let share = minimum_jerk(self.elapsed_s / self.reach.duration_s);
        let hand = within_reach(self.reach.from + (self.reach.to - self.reach.from) * share);
        let swivel_rad = self.reach.swivel_from_rad + (self.reach.swivel_to_rad - self.reach.swivel_from_rad) * share;
        let elbow = elbow(&hand, swivel_rad);
        let to_torso = |v: Vec3| if self.side == ArmSide::Left { v } else { Vec3::new(-v.x, v.y, v.z) };
        ArmDirections {
            upper_arm: to_torso(unit(elbow).unwrap_or(-Vec3::y())),
            forearm: to_torso(unit(hand - elbow).unwrap_or(Vec3::z())),
        }
    }
}

fn next_reach(stream: &mut Stream, from: Vec3, swivel_from_rad: f32) -> Reach {
    let to = target(stream);
    let duration_s = ((to - from).norm() / between(stream, SPEEDS)).max(SHORTEST_S);
    let pause_s = if stream.uniform() < PAUSE_PROBABILITY { between(stream, PAUSES_S) } else { 0.0 };
    let swivel_to_rad = clamp(swivel_from_rad + 0.3 * stream.normal(), SWIVELS_RAD[0], SWIVELS_RAD[1]);
    Reach { from, to, swivel_from_rad, swivel_to_rad, duration_s, pause_s }
}

fn target(stream: &mut Stream) -> Vec3 {
    let mut target = Vec3::z();
    for _ in 0..TARGET_TRIES {
        target = Vec3::from_fn(|axis, _| between(stream, [TARGET_LOW[axis], TARGET_HIGH[axis]]));
        if target == within_reach(target) {
            break;
        }
    }
    within_reach(target)
}

fn within_reach(hand: Vec3) -> Vec3 {
    let distance = hand.norm();
    let allowed = clamp(distance, DISTANCE_SHARES[0], DISTANCE_SHARES[1]);
    if distance == allowed { hand } else { unit(hand).unwrap_or(Vec3::z()) * allowed }
}

fn minimum_jerk(time: f32) -> f32 {
    let s = clamp(time, 0.0, 1.0);
    s * s * s * (10.0 + s * (-15.0 + 6.0 * s))
}

/// Elbow on the circle round the line from shoulder to hand, turned outwards by `swivel_rad` from
/// its lowest point.
fn elbow(hand: &Vec3, swivel_rad: f32) -> Vec3 {
    let (upper, fore) = (UPPER_ARM / REACH, ELBOW_TO_HAND_CENTRE / REACH);
    let distance = hand.norm();
    let axis = unit(*hand).unwrap_or(Vec3::z());
    let along = (upper * upper - fore * fore + distance * distance) / (2.0 * distance);
    let radius = sqrt((upper * upper - along * along).max(0.0));
    let down = -Vec3::y();
    let lowest = unit(down - axis * down.dot(&axis)).unwrap_or(Vec3::x());
    // Outwards where the arm points to the front, backwards where it points outwards.
    let outwards = axis.cross(&lowest);
    let (sine, cosine) = sin_cos(swivel_rad);
    axis * along + (lowest * cosine + outwards * sine) * radius
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hand_stays_in_reach_and_moves_smoothly() {
        let motion = random_reaches(7, 60.0, 3000).unwrap();
        for side in [ArmSide::Left, ArmSide::Right] {
            let hands: Vec<Vec3> = motion
                .side(side)
                .iter()
                .map(|d| (d.upper_arm * UPPER_ARM + d.forearm * ELBOW_TO_HAND_CENTRE) / REACH)
                .collect();
            let outwards = if side == ArmSide::Left { 1.0 } else { -1.0 };
            let mut path = 0.0;
            for (before, now) in hands.iter().zip(&hands[1..]) {
                assert!((0.34..0.97).contains(&now.norm()), "{}", now.norm());
                assert!(outwards * now.x > -0.6 && now.z > -0.2);
                // 1.875 is the peak of a minimum-jerk reach's speed over its mean.
                assert!((now - before).norm() * 60.0 < 1.875 * SPEEDS[1] * 1.5);
                path += (now - before).norm();
            }
            assert!(path > 10.0, "the hand hardly moves: {path}");
        }
    }

    #[test]
    fn the_elbow_never_jumps() {
        let motion = random_reaches(3, 120.0, 6000).unwrap();
        let arms = motion.side(ArmSide::Left);
        let fastest = arms.windows(2).map(|w| (w[1].upper_arm - w[0].upper_arm).norm()).fold(0.0, f32::max);
        assert!(fastest * 120.0 < 25.0, "{} rad/s", fastest * 120.0);
    }

    #[test]
    fn a_seed_fixes_the_motion() {
        assert_eq!(random_reaches(1, 15.0, 100).unwrap(), random_reaches(1, 15.0, 100).unwrap());
        assert_ne!(random_reaches(1, 15.0, 100).unwrap(), random_reaches(2, 15.0, 100).unwrap());
    }
}
