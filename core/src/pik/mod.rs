//! Probabilistic inverse kinematics: goals in space, poses by a Laplace proposal (PIK paper, sections 4 and 5).

pub mod goal;
pub mod proposal;
