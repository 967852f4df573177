//! Files for other programs: TRC (joint positions) and MOT (angles), which OpenSim and its kin
//! open, and CSV of anatomical angles.

pub mod mot;
pub mod series;
pub mod trc;
