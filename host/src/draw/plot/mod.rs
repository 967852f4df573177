//! Plots of tables: the path of a hand, curves with bands, bars, matrices.
//!
//! Everything is drawn at twice the size and averaged down, which smooths text and lines alike.

mod axis;
mod bars;
mod curves;
mod figure;
mod hand;
mod matrix;

pub use bars::bars_plot;
pub use curves::{Curve, curves_plot};
pub use hand::hand_plot;
pub use matrix::matrix_plot;
