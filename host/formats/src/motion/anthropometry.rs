//! Segment lengths as fractions of body height: Drillis and Contini (1966), in the form of D. A.
//! Winter, "Biomechanics and Motor Control of Human Movement", figure 4.1.

/// Shoulder to elbow.
pub const UPPER_ARM: f32 = 0.186;
/// Elbow to wrist.
pub const FOREARM: f32 = 0.146;
/// Wrist to finger tips.
pub const HAND: f32 = 0.108;
/// Elbow to the middle of the hand: the forearm and half a hand. The hand's centre lies on the
/// forearm's extension.
pub const ELBOW_TO_HAND_CENTRE: f32 = FOREARM + 0.5 * HAND;
/// Middle of the body to the shoulder joint, sideways.
pub const SHOULDER_HALF_WIDTH: f32 = 0.129;
/// Shoulder joint to the chin, upwards (0.870 - 0.818).
pub const SHOULDER_TO_CHIN: f32 = 0.052;
/// Chin to the crown (1 - 0.870).
pub const HEAD_HEIGHT: f32 = 0.130;
/// Middle of the body to the hip joint, sideways.
pub const HIP_HALF_WIDTH: f32 = 0.0955;
/// Hip joint to shoulder joint, upwards (0.818 - 0.530).
pub const TRUNK: f32 = 0.288;
/// Hip joint to knee joint (0.530 - 0.285).
pub const THIGH: f32 = 0.245;
/// Knee joint to ankle joint (0.285 - 0.039).
pub const SHANK: f32 = 0.246;
