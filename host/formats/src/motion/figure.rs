//! Positions of the joints of the stick figure.

/// Joints of the stick figure, in the order of `sinew_core::skeleton::stick_figure::HUMAN`.
pub const JOINTS: usize = 14;
/// Position of the root among the joints.
pub const HIP_CENTER: usize = 0;
/// Position of the neck among the joints.
pub const NECK: usize = 1;
/// Positions of the left and the right shoulder.
pub const SHOULDERS: [usize; 2] = [2, 5];
/// Positions of the left and the right hip.
pub const HIPS: [usize; 2] = [8, 11];
