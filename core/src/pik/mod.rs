//! Probabilistic inverse kinematics: goals in space, poses by a Laplace proposal (PIK paper, sections 4 and 5).

pub mod angular;
pub mod end_effector;
pub mod goal;
pub mod guided;
pub mod motion;
pub mod processes;
pub mod proposal;
pub mod root;
