//! Probabilistic inverse kinematics: goals in space, poses by a Laplace proposal (PIK paper,
//! sections 4 and 5).
//!
//! ```
//! use sinew_core::kinematics::forward::posture;
//! use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
//! use sinew_core::math::{Mat3, Vec3};
//! use sinew_core::pik::proposal::LaplaceProposal;
//! use sinew_core::random::Stream;
//! use sinew_core::skeleton::arm::{ARM_ANGLES, FOREARM};
//! use sinew_core::skeleton::{ArmGeometry, Side};
//!
//! // A goal for the hand, known to 2 cm, becomes poses around the likeliest one.
//! let skeleton = ArmGeometry::new(Side::Right, 0.30, 0.35)?.skeleton()?;
//! let previous_rad = [0.4, 0.2, 0.1, 1.0];
//! let goal_m = posture(&skeleton, &Vec3::zeros(), &previous_rad).ends[FOREARM] + Vec3::new(0.03, -0.02, 0.0);
//! let goals = [Goal { bone: FOREARM, position_m: goal_m, precision: Mat3::identity() / (0.02 * 0.02) }];
//! let density = PoseDensity {
//!     skeleton: &skeleton,
//!     root_m: Vec3::zeros(),
//!     goals: &goals,
//!     previous_rad,
//!     stiffness: [50.0; ARM_ANGLES],
//!     held: 0,
//! };
//! let proposal = LaplaceProposal::new(&density.mode(10)).expect("a mode has curvature");
//!
//! let mut mean_m = Vec3::zeros();
//! for index in 0..200 {
//!     let pose = proposal.draw(skeleton.limits(), &mut Stream::new(1, 0, index)).angles_rad;
//!     assert_eq!(skeleton.clamp(pose), pose, "no draw leaves the limits");
//!     mean_m += posture(&skeleton, &Vec3::zeros(), &pose).ends[FOREARM] / 200.0;
//! }
//! assert!((mean_m - goal_m).norm() < 0.02);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub mod angular;
pub mod end_effector;
pub mod example;
pub mod goal;
pub mod guided;
pub mod motion;
pub mod processes;
pub mod proposal;
pub mod root;
