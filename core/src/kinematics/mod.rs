//! Forward and inverse kinematics: from angles to places and back.
//!
//! ```
//! use sinew_core::kinematics::forward::posture;
//! use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
//! use sinew_core::math::{Mat3, Vec3};
//! use sinew_core::skeleton::arm::{ARM_ANGLES, FOREARM};
//! use sinew_core::skeleton::{ArmGeometry, Side};
//!
//! let skeleton = ArmGeometry::new(Side::Right, 0.30, 0.35)?.skeleton()?;
//! let shoulder_m = Vec3::new(-0.2, -0.1, 1.2);
//! let pose = [0.4, 0.2, 0.1, 1.0];
//! let hand_m = posture(&skeleton, &shoulder_m, &pose).ends[FOREARM];
//!
//! // Back: from another pose to one whose hand is there, inside the limits.
//! let goals = [Goal {
//!     bone: FOREARM,
//!     position_m: hand_m,
//!     precision: Mat3::identity() / (0.002 * 0.002),
//! }];
//! let density = PoseDensity {
//!     skeleton: &skeleton,
//!     root_m: shoulder_m,
//!     goals: &goals,
//!     previous_rad: [0.2, 0.0, 0.0, 0.7],
//!     stiffness: [1.0; ARM_ANGLES],
//!     held: 0,
//! };
//! let mode = density.mode(20);
//! assert!(mode.converged() && mode.residual_m < 0.002, "{mode:?}");
//! assert_eq!(skeleton.clamp(mode.angles_rad), mode.angles_rad);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub(crate) mod body_information;
pub mod cholesky;
pub mod forward;
pub mod gradient_projection;
pub mod inverse;
pub mod jacobian;
pub mod pose_density;
mod rotation;
pub mod solver_memory;
