//! Measuring the trackers where the truth is known.

pub mod body;
pub mod cli;
pub mod clips;
pub mod cluster;
pub mod cyclic;
pub mod data_split;
pub mod experiments;
pub mod hand_ranking;
pub mod hands;
pub mod hands_report;
pub mod observed;
pub mod people;
pub mod reproduce;
pub mod score;
pub mod skin_faces;
pub mod skin_scores;
pub mod tables;
