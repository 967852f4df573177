//! Built-in motion `stick-wave`: a person on fixed legs waves a stick that both hands hold.

use super::animated::{AnimatedBody, FIRM, goal};
use crate::body::BodyRecording;
use crate::error::Result;
use sinew_core::math::{Vec3, sin_cos, unit};
use sinew_core::random::Stream;
use sinew_core::skeleton::full_body::{COLLARS, FOREARMS};
use std::f32::consts::TAU;

/// Length of the stick, metres.
pub const STICK_M: f32 = 1.2;
/// Number of the frame whose streams the motion is drawn from: no frame of a scene.
const MOTION_FRAME: u64 = u64::MAX - 1;
/// Distance of the hands on the stick, metres.
const GRIP_M: f32 = 0.5;
/// Seconds of the motion.
const DURATION_S: f32 = 20.0;
/// Middle of the stick before the middle of the shoulders at rest: left, down, front, metres.
const REST_M: [f32; 3] = [0.0, 0.15, 0.38];
/// Amplitudes: the middle to the left, down and to the front, metres; the stick's slope and turn,
/// radians.
const AMPLITUDES: [f32; 5] = [0.22, 0.32, 0.12, 1.1, 0.6];
/// Each of these is a sum of this many sines.
const SINES: usize = 3;
const FREQUENCIES_HZ: [f32; 2] = [0.08, 0.55];

/// A stick: both ends in camera axes, metres.
pub type StickEnds = [Vec3; 2];

/// The motion and the stick: `ends[0]` is the one on the side of the person's left hand.
///
/// The hands lie on the stick to a rounding error, since it goes through them. They slide along it
/// where the arms are too short for the drawn path.
#[derive(Debug, Clone)]
pub struct StickWave {
    /// The person.
    pub recording: BodyRecording,
    /// The stick in each frame.
    pub stick_m: Vec<StickEnds>,
}

/// One smooth curve: a sum of sines, within one.
struct Curve([(f32, f32); SINES]);

impl Curve {
    fn new(stream: &mut Stream) -> Self {
        let [low, high] = FREQUENCIES_HZ;
        Self(std::array::from_fn(|_| (low + (high - low) * stream.uniform(), stream.uniform())))
    }

    fn at(&self, time_s: f32) -> f32 {
        let sine = |(frequency_hz, phase): &(f32, f32)| {
            let turns = frequency_hz * time_s + phase;
            sin_cos(TAU * (turns - turns.floor())).0
        };
        self.0.iter().map(sine).sum::<f32>() / SINES as f32
    }
}

/// Draws the motion at `rate_hz`; legs and feet do not move, the trunk a little.
///
/// # Errors
/// None for the person that is built in.
pub fn stick_wave(seed: u64, rate_hz: f32, camera_height_m: f32, distance_m: f32) -> Result<StickWave> {
    let mut body = standing(camera_height_m, distance_m)?;
    body.stiffen("root", 1.0e8);
    for limb in ["l_hip", "r_hip", "l_knee", "r_knee", "l_ankle", "r_ankle"] {
        body.stiffen(limb, 1.0e8);
    }
    body.stiffen("trunk", 3.0e3);
    body.stiffen("head", 1.0e3);
    let shoulders = 0.5 * (body.ends()[COLLARS[0]] + body.ends()[COLLARS[1]]);
    let curves: [Curve; 5] =
        std::array::from_fn(|index| Curve::new(&mut Stream::new(seed, MOTION_FRAME, index as u32)));
    let frames = (DURATION_S * rate_hz).round().max(1.0) as usize;
    let (mut joints_m, mut stick_m) = (Vec::with_capacity(frames), Vec::with_capacity(frames));
    for frame in 0..frames {
        let hands = wanted_hands(&curves, frame as f32 / rate_hz, shoulders);
        let goals = [0, 1].map(|side| goal(FOREARMS[side], hands[side], FIRM));
        body.reach(&goals);
        let ends = body.ends();
        let [left, right] = FOREARMS.map(|bone| ends[bone]);
        let half = unit(left - right).unwrap_or(Vec3::x()) * (0.5 * STICK_M);
        let middle = 0.5 * (left + right);
        joints_m.push(body.joints());
        stick_m.push([middle + half, middle - half]);
    }
    Ok(StickWave { recording: BodyRecording { rate_hz, joints_m }, stick_m })
}

/// A person who faces the camera with knees a little bent and both hands before the body.
fn standing(camera_height_m: f32, distance_m: f32) -> Result<AnimatedBody> {
    const SOLE_M: f32 = 0.042;
    let mut body = AnimatedBody::new(&[
        ("root_z", distance_m),
        ("l_hip_flexion", 0.1),
        ("r_hip_flexion", 0.1),
        ("l_hip_abduction", 0.12),
        ("r_hip_abduction", 0.12),
        ("l_knee_flexion", 0.2),
        ("r_knee_flexion", 0.2),
        ("l_ankle_flexion", 0.1),
        ("r_ankle_flexion", 0.1),
        ("l_shoulder_elevation", 0.5),
        ("r_shoulder_elevation", 0.5),
        ("l_shoulder_deviation", 0.4),
        ("r_shoulder_deviation", 0.4),
        ("l_shoulder_rotation", 0.5),
        ("r_shoulder_rotation", 0.5),
        ("l_elbow_flexion", 1.2),
        ("r_elbow_flexion", 1.2),
    ])?;
    let lowest_m = body.ends().iter().map(|end| end.y).fold(f32::NEG_INFINITY, f32::max);
    body.angles[1] = camera_height_m - SOLE_M - lowest_m;
    Ok(body)
}

/// Where the left and the right hand are to go.
fn wanted_hands(curves: &[Curve; 5], time_s: f32, shoulders: Vec3) -> [Vec3; 2] {
    let [x, y, z, slope_rad, turn_rad] = std::array::from_fn(|index| AMPLITUDES[index] * curves[index].at(time_s));
    // Facing the camera: left is x, down is y, front is -z.
    let middle = shoulders + Vec3::new(REST_M[0] + x, REST_M[1] + y, -(REST_M[2] + z));
    let ((sine, cosine), (turn_sine, turn_cosine)) = (sin_cos(slope_rad), sin_cos(turn_rad));
    let along = Vec3::new(cosine * turn_cosine, sine, cosine * turn_sine) * (0.5 * GRIP_M);
    [middle + along, middle - along]
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::skeleton::full_body::{FEET, SHANKS};

    #[test]
    fn both_hands_hold_the_stick_and_the_legs_stand() {
        for seed in 0..5 {
            let wave = stick_wave(seed, 15.0, 1.0, 3.0).unwrap();
            assert_eq!((wave.recording.joints_m.len(), wave.stick_m.len()), (300, 300));
            let (mut path_m, mut lowest, mut highest) = (0.0, f32::INFINITY, f32::NEG_INFINITY);
            for (frame, (joints, [a, b])) in wave.recording.joints_m.iter().zip(&wave.stick_m).enumerate() {
                assert!(((a - b).norm() - STICK_M).abs() < 1.0e-4);
                let hands = FOREARMS.map(|bone| joints[bone].unwrap());
                let gammas = hands.map(|hand| {
                    let gamma = (hand - a).dot(&(b - a)) / (STICK_M * STICK_M);
                    assert!((hand - a - (b - a) * gamma).norm() < 1.0e-4);
                    gamma
                });
                assert!(gammas[0] > 0.1 && gammas[0] < gammas[1] - 0.2 && gammas[1] < 0.9, "{gammas:?}");
                (lowest, highest) = (lowest.min(hands[0].y), highest.max(hands[0].y));
                for bone in [FEET, SHANKS].concat() {
                    let moved_m = (joints[bone].unwrap() - wave.recording.joints_m[0][bone].unwrap()).norm();
                    assert!(moved_m < 1.0e-3, "{moved_m}");
                }
                if frame > 0 {
                    let before = wave.recording.joints_m[frame - 1];
                    for bone in 0..joints.len() {
                        let step_m = (joints[bone].unwrap() - before[bone].unwrap()).norm();
                        assert!(step_m < 0.2, "seed {seed} frame {frame} bone {bone}: {step_m}");
                    }
                    path_m += (hands[0] - before[FOREARMS[0]].unwrap()).norm();
                }
            }
            assert!(path_m > 5.0 && highest - lowest > 0.3, "seed {seed}: {path_m} {}", highest - lowest);
        }
    }
}
